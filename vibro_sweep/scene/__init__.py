"""From YAML to a `Scene`: forms, axes, starts, messages and the JSON Schema."""

from vibro_sweep.scene.continuation import (
    Continuation,
    parse_continuation,
)
from vibro_sweep.scene.form import json_schema
from vibro_sweep.scene.loading import load_scene
from vibro_sweep.scene.problems import SceneError
from vibro_sweep.scene.scene import Scene, Section, Trajectory, parse_scene, scene_of
from vibro_sweep.scene.starts import Start

__all__ = [
    "Continuation",
    "Scene",
    "SceneError",
    "Section",
    "Start",
    "Trajectory",
    "json_schema",
    "load_scene",
    "parse_continuation",
    "parse_scene",
    "scene_of",
]
