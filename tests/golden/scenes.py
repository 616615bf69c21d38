"""Scenes as texts: the Dataset of what is computed, and the same scene with other rounding."""

import math
import tempfile
from pathlib import Path

import numpy as np
import yaml

import vibro_sweep as vs


def computed(text: str):
    """The Dataset that `open` gives of the file of a scene, loaded."""
    with tempfile.TemporaryDirectory() as folder, vs.open(written(text, Path(folder))) as data:
        return data.load()


def written(text: str, folder: Path) -> Path:
    """The file of a scene, which is made in a folder."""
    scene, path = folder / "scene.yaml", folder / "scene.h5"
    scene.write_text(text)
    vs.run(vs.load_scene(scene), path, workers=1)
    return path


def moved(text: str, runs: int):
    """The scene, so many times, with each number of its system moved by one rounding up or down."""
    scene, rng = yaml.safe_load(text), np.random.default_rng(0)
    for _ in range(runs):
        yield yaml.safe_dump(scene | {"system": _neighbours(scene["system"], rng)}, sort_keys=False)


def _neighbours(value, rng):
    if isinstance(value, dict):
        return {key: _neighbours(inner, rng) for key, inner in value.items()}
    if isinstance(value, list):
        return [_neighbours(inner, rng) for inner in value]
    if isinstance(value, float) and value:
        return math.nextafter(value, rng.choice([-math.inf, math.inf]))
    return value
