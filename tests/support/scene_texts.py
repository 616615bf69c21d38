"""Scenes from their text."""

import tempfile
from pathlib import Path

import vibro_sweep as vs


def parsed(text: str, name: str = "scene"):
    """The scene of a file with this text and name, of a sweep, of branches or of curves. Raises SceneError."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{Path(name).stem}.yaml"
        path.write_text(text, encoding="utf-8")
        return vs.load_scene(path)
