"""The resolved numbers of a scene, as its file holds them: every reader has them without the scene's text.

A number that is the same at all points is an attribute of the file; one that is swept is a coordinate; and one that
follows from swept ones (b*, and tau where it is `grazing`) is a dataset over the keys that it depends on. What has its
default (no offset, R_left as R, mu_c as mu_k) is not stored.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from vibro_sweep.oscillator.function_model import FunctionModel, sizes_of, stored_names, stored_of
from vibro_sweep.oscillator.grid import grid, linears
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.oscillator.models import DEFAULT
from vibro_sweep.oscillator.models.declaration import UNITS
from vibro_sweep.oscillator.oscillator import in_closed_form
from vibro_sweep.oscillator.other_words import own_name, with_omega
from vibro_sweep.oscillator.paper_motion import grazing_clearance
from vibro_sweep.oscillator.stacks import dot, modulus
from vibro_sweep.oscillator.steady import gap_responses, static_states, steady_amplitudes
from vibro_sweep.scene.scene import Scene
from vibro_sweep.tables.coordinates import start
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY

USUAL = {"offset": 0.0, "m": 1.0}  # numbers that most oscillators have, and that are not stored
SLAB = 100_000  # points whose numbers are computed at once


def attributes(scene: Scene) -> dict[str, Any]:
    """Numbers and words that hold for all points: name -> value.

    The system's numbers, `tau` in radians, `b_star` (`b_right` and `b_left` where these may differ), its options but
    for matrices, and for units, which the variables have; the `type` of a model and `along` where they are not the
    paper's; `dynamics` with its `order` and `expand_at`, the initial state (`start_x1`, ...; of a `follow` that of its
    first point) unless it is random or held by a stop, `transient`, `record` and, where there is one, `settle` in
    forcing periods, `section`: `phase`, or `impact` with `section_stop`;
    `picture` and `picture_units` where there are any.
    """
    system = scene.system
    result: dict[str, Any] = {name: value for name, value in system.numbers.items() if value not in (None, "grazing")}
    result = {name: value for name, value in result.items() if value != USUAL.get(name)}
    result |= {"tau": system.phase}
    if not depends_on(scene):
        result |= {name: float(value) for name, value in following(scene, ()).items() if name != "tau"}
    known = (*scene.sweep, *map(own_name, scene.sweep), *dimensions(scene))
    result = {name: value for name, value in result.items() if name not in known}
    result |= {name: _plain(value) for name, value in system.options.items() if value is not None}
    result = {name: value for name, value in result.items() if name not in (UNITS.name, *matrices(scene))}
    if isinstance(system, FunctionModel):
        result = {name: value for name, value in result.items() if name != "tau"}
    result |= {} if system.model.name == DEFAULT else {"type": system.model.name}
    result |= {} if system.gap_is_x1 else {"contact_normal": system.linear.contact.normal}
    result |= {"dynamics": scene.dynamics}
    if scene.dynamics == "map":
        result |= {"order": scene.order} | ({} if scene.expand_at is None else {"expand_at": scene.expand_at})
    if scene.start.kind != "random" and not scene.from_rest:
        state = dict(zip(start(system.masses), scene.start.state, strict=True))
        result |= {name: value for name, value in state.items() if name not in scene.sweep}
    result |= {"transient": scene.transient, "record": scene.record, "section": scene.section.kind}
    result |= {} if scene.settle is None else {"settle": scene.settle}
    result |= {"section_stop": scene.section.stop} if scene.section.kind == "impact" else {}
    result |= {"picture_units": ", ".join(scene.picture_units)} if scene.picture_units else {}
    return result | ({"picture": scene.picture} if scene.picture else {})


def matrices(scene: Scene) -> dict[str, np.ndarray]:
    """The matrices among the system's options: netCDF has no attributes of two dimensions, so they are variables of a
    file."""
    entries = {name: np.array(value) for name, value in scene.system.options.items() if isinstance(value, tuple)}
    return {name: value for name, value in entries.items() if value.ndim == 2}


def _plain(value):
    """A flag as a number, a vector as an array."""
    return int(value) if isinstance(value, bool) else np.array(value) if isinstance(value, tuple) else value


def depends_on(scene: Scene) -> tuple[str, ...]:
    """The swept keys on which the free motion, or where it touches the stops, depends; in order."""
    described = scene.system.described
    return tuple(key for key in scene.sweep if key == "offset" or (key in described and described[key].free_motion))


def _graze(scene: Scene) -> tuple[str, ...]:
    """b*, or the clearances of the two stops where these may differ."""
    numbers = scene.system.numbers
    shifted = numbers.get("offset") or "offset" in scene.sweep
    pushed = any(value for name, value in numbers.items() if name.startswith("constant"))
    pushed = pushed or any(key.startswith("constant") for key in scene.sweep)
    return ("b_right", "b_left") if shifted or pushed else ("b_star",)


def dimensions(scene: Scene) -> dict[str, tuple[str, ...]]:
    """The numbers that follow from swept ones, and the keys over which they are stored."""
    keys = depends_on(scene)
    if isinstance(scene.system, FunctionModel):
        names = (*stored_names(scene.system.masses), "b_right", "b_left")
        return dict.fromkeys((name for name in names if name not in scene.sweep), keys) if keys else {}
    fixed = "tau" in scene.sweep or scene.system.tau != "grazing" or keys == ("offset",)
    names = (*(() if fixed else ("tau",)), *_graze(scene))
    return dict.fromkeys(names, keys) if keys else {}


def following(scene: Scene, box: tuple[slice, ...]) -> dict[str, np.ndarray]:
    """Numbers that follow over a box of the keys of `depends_on`, each of the box's shape: tau, and where both stops
    graze."""
    axes = {key: scene.sweep[key][part] for key, part in zip(depends_on(scene), box, strict=True)}
    if isinstance(scene.system, FunctionModel):
        return _of_built(linears(scene.system, axes))
    numbers = grid(scene.system, axes)
    offset = numbers.get("offset", 0.0)
    if in_closed_form(scene.system, axes):
        size, middle = grazing_clearance(numbers), 0.0
    else:
        size, middle = _free_motion(linears(scene.system, axes))
    sides = {"tau": numbers["tau"], "b_star": size, "b_right": size + middle - offset, "b_left": size - middle + offset}
    return {name: sides[name] for name in ("tau", *_graze(scene))}


def _of_built(q: Linear) -> dict[str, np.ndarray]:
    """All numbers of each oscillator, and the clearances at which its free motion touches the stops as they are."""
    (size, middle), offset = _free_motion(q), sizes_of(q)["offset"]
    return stored_of(q) | {"b_right": size + middle - offset, "b_left": size - middle + offset}


def _free_motion(q: Linear) -> tuple[np.ndarray, np.ndarray]:
    """Amplitude of the gap and its middle, for each oscillator of a stack; NaN where there are none."""
    return modulus(gap_responses(q, steady_amplitudes(q))), dot(q.contact.normal, static_states(q))


def angular(scene: Scene) -> dict[str, np.ndarray]:
    """omega = 2 pi frequency of a sweep over the frequency: (n,) by its name."""
    if CYCLES.name not in scene.sweep or isinstance(scene.system, FunctionModel):
        return {}
    return {FREQUENCY.name: with_omega(scene.sweep)[FREQUENCY.name]}


def slabs(scene: Scene) -> Iterator[tuple[slice, ...]]:
    """Boxes of the keys of `depends_on` that are computed one after the other."""
    shape = [len(scene.sweep[key]) for key in depends_on(scene)]
    rows = max(1, SLAB // math.prod(shape[1:]))
    for first in range(0, shape[0], rows):
        yield slice(first, min(first + rows, shape[0])), *(slice(0, length) for length in shape[1:])
