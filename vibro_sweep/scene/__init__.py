"""From YAML to a `Scene`: forms, axes, starts, messages and the JSON Schema."""

from vibro_sweep.scene.form import json_schema
from vibro_sweep.scene.problems import SceneError
from vibro_sweep.scene.scene import Scene, Section, Trajectory, load_scene, parse_scene, scene_of
from vibro_sweep.scene.starts import Start

__all__ = [
    "Scene",
    "SceneError",
    "Section",
    "Start",
    "Trajectory",
    "json_schema",
    "load_scene",
    "parse_scene",
    "scene_of",
]
