"""From a view of the page to the scene that computes it, and from scenes to views."""

import json
import math

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.live.requests import SceneAsked, View
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.scene import Scene, scene_of
from vibro_sweep.scene.written import system_data
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.units import AS_STORED, Display, display_of

SPEEDS = {"speed_right": "right", "speed_left": "left"}
PEAKS = ("contact_force_max", "penetration_max")  # one number of an orbit
OBSERVE = ("section", "lyapunov")
COLUMNS = 1000
MOST_RECORDED, LONGEST_TRANSIENT = 400, 2000  # of a scene that is opened; the page can ask for more


def scene_of_view(view: View) -> Scene:
    """The scene of a sweep that a view shows. Raises SceneError, ArgumentError."""
    data = view.scene.model_dump(exclude_defaults=True)
    if view.scene.dynamics == "map":
        data["order"] = view.scene.order
    section = {"kind": "impact", "stop": SPEEDS[view.y]} if view.y in SPEEDS else {"kind": "phase"}
    observe = [*OBSERVE, *(["contacts"] if view.y in PEAKS else [])]
    scene = scene_of(data | {"observe": observe, "section": section}, "view")
    if view.y not in heights(scene):
        raise ArgumentError(f"y: must be one of {', '.join(heights(scene))}")
    return scene


def heights(scene: Scene) -> list[str]:
    """What can stand on the vertical axis. A compliant stop has contacts in place of impacts, a mapping neither."""
    system = scene.system
    q = system.linear
    speeds = [
        name
        for name, stop, side in zip(SPEEDS, (q.contact.high, q.contact.low), (1, -1), strict=True)
        if np.isfinite(stop) and scene.dynamics == "flow" and not q.contact.is_compliant(side)
    ]
    peaks = PEAKS if q.compliant else ()
    return [*state(system.masses), *([] if system.gap_is_x1 else ["gap"]), *speeds, *peaks]


def needed(system: Oscillator, y: str) -> list[str]:
    """The variables of a sweep from which `y` follows."""
    return [*state(system.masses)[1::2]] if y in SPEEDS else [y]


def height_of(system: Oscillator, y: str, arrays: dict[str, np.ndarray]) -> np.ndarray:
    """What stands on the vertical axis, from the variables of a sweep; the last dimension is the dots of an orbit."""
    if y in PEAKS:
        return arrays[y][..., None]
    if y not in SPEEDS:
        return arrays[y]
    rate = sum(n * arrays[name] for n, name in zip(system.linear.contact.normal, needed(system, y), strict=True) if n)
    return rate if SPEEDS[y] == "right" else -rate


def view_of(scene: Scene) -> View:
    """The view that shows a scene first: along its first swept number; without one along its clearance."""
    axis = next((key for key in scene.sweep if key in scene.system.described), "b")
    system = system_data(scene.system, ())
    if axis in scene.sweep:
        values = scene.sweep[axis]
        low, high = float(min(values)), float(max(values))
    else:
        low, high = span(float(scene.system.numbers[axis]))
    start = scene.data().get("start", {}) if set(scene.sweep) == {axis} else {}
    in_cycles = display_of_scene(scene).in_cycles
    if axis == FREQUENCY.name and in_cycles:
        axis, low, high = CYCLES.name, low / (2 * math.pi), high / (2 * math.pi)
    if axis == CYCLES.name or in_cycles:
        del system[FREQUENCY.name]
        system[CYCLES.name] = scene.system.frequency
    if scene.start.kind == "random":
        start = start | {"random": min(scene.start.count, 4)}
    asked = {
        "system": json.loads(json.dumps(system)),
        "sweep": {axis: {"start": low, "stop": high, "num": COLUMNS}},
        "start": start,
        "orbit": {
            "transient": min(scene.transient, LONGEST_TRANSIENT),
            "record": min(scene.record, MOST_RECORDED),
        },
    }
    if scene.dynamics == "map":
        asked |= {"dynamics": "map", "order": scene.order, "expand_at": scene.expand_at}
    if scene.picture_units:
        asked["picture"] = {"units": [*scene.picture_units]}
    y = "speed_" + scene.section.stop if scene.section.kind == "impact" else "x1"
    return View(scene=SceneAsked(**asked), y=y)


def display_of_scene(scene: Scene) -> Display:
    """The units in which the page shows numbers."""
    return display_of(scene.picture_units) or AS_STORED


def by_cycles(view: View) -> bool:
    """Whether the frequency stands in place of omega."""
    return CYCLES.name in view.scene.system or view.axis == CYCLES.name


def span(value: float) -> tuple[float, float]:
    """A range around a number where nothing else is known."""
    return (0.5 * value, 1.5 * value) if value > 0 else (value - 1.0, value + 1.0)
