"""The scenes that a page can begin with."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import cut
from vibro_sweep.files.opening import open_file
from vibro_sweep.oscillator.function_model import BUILD
from vibro_sweep.scene import Scene, load_scene
from vibro_sweep.scene.scene import parse_scene


def presets_of(paths: Iterable[Path]) -> dict[str, Scene]:
    """The scenes of these files that sweep a number of an oscillator, by name; others have no diagram."""
    scenes = {path.stem: load_scene(path) for path in paths}
    return {name: scene for name, scene in scenes.items() if isinstance(scene, Scene) and _has_axis(scene)}


def scene_to_explore(path: Path) -> Scene:
    """The scene of a file: of YAML, or that from which a sweep's HDF5 file was made.

    Raises SceneError, StoreError, and ArgumentError for what is not a sweep of an oscillator with numbers.
    """
    if path.suffix.lower() in (".yaml", ".yml"):
        scene = load_scene(path)
        if not isinstance(scene, Scene):
            raise ArgumentError(f"{path} follows branches; explore takes the scene of a sweep")
    else:
        with open_file(path) as data:
            attributes = {name: str(data.attrs[name]) for name in ("kind", "type", "scene") if name in data.attrs}
        return scene_of_results(attributes, str(path))
    return described_sweep(scene, str(path))


def scene_of_results(attributes: Mapping[str, str], name: str) -> Scene:
    """The scene that results were made from, by their attributes. Raises SceneError and ArgumentError."""
    kind, made_by = attributes.get("kind", "something else"), attributes.get("type")
    if kind != "sweep":
        raise ArgumentError(f"{name} holds {cut(kind)}; explore takes a sweep")
    if made_by == BUILD:
        raise ArgumentError(f"{name} sweeps a function; explore moves along a number of an oscillator")
    return described_sweep(parse_scene(attributes["scene"], name), name)


def described_sweep(scene: Scene, name: str) -> Scene:
    """The scene; ArgumentError where it has no number of an oscillator to move along."""
    if not scene.system.described or (scene.sweep and not _has_axis(scene)):
        raise ArgumentError(f"{name} sweeps no number of an oscillator; explore moves along one")
    return scene


def _has_axis(scene: Scene) -> bool:
    return any(key in scene.system.described for key in scene.sweep)
