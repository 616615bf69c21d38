"""The scene that a page begins with, from whatever a user has: a system, a scene, its file or its results."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from vibro_sweep.checks.arguments import checked_interval, checked_word
from vibro_sweep.checks.errors import ArgumentError, ArgumentTypeError
from vibro_sweep.checks.file_names import checked_path
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.live.presets import described_sweep, scene_of_results, scene_to_explore
from vibro_sweep.live.views import COLUMNS, span
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.scene import Scene, scene_of
from vibro_sweep.scene.written import changed


def shown_scene(system: object, parameter: str | None, bounds: Sequence[float] | None, name: str) -> Scene:
    """The scene. parameter, bounds : of a system, what is swept and from where to where; name : of the scene, then

    Raises ValueError for what has no number to sweep, SceneError and StoreError for files.
    """
    if isinstance(system, Oscillator):
        return _swept(system, "b" if parameter is None else parameter, bounds, name)
    scene = _of_a_sweep(system)
    for argument, value in (("parameter", parameter), ("bounds", bounds)):
        if value is not None:
            raise ArgumentError(not_allowed(argument, value, "left out: what is given for system is swept already"))
    return scene


def _swept(system: Oscillator, parameter: str, bounds: Sequence[float] | None, name: str) -> Scene:
    checked_word("parameter", parameter, tuple(system.described))
    value = float(getattr(system, parameter))
    lo, hi = span(value) if bounds is None else checked_interval("bounds", bounds, value)
    sweep = {parameter: {"start": lo, "stop": hi, "num": COLUMNS}}
    return scene_of(changed({}, {"system": system, "sweep": sweep, "transient": 1000, "record": 200}), name)


def _of_a_sweep(system: object) -> Scene:
    if isinstance(system, Scene):
        return described_sweep(system, "the scene")
    if isinstance(system, (str, Path)):
        return scene_to_explore(checked_path("system", system))
    attributes = getattr(system, "attrs", None)
    if isinstance(attributes, Mapping) and attributes:
        return scene_of_results(attributes, "the Dataset")
    raise ArgumentTypeError(not_allowed("system", system, "a System, an Oscillator, a scene, a sweep or its file"))
