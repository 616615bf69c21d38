"""The orbits and special points with which a scene of branches or curves begins: `continue: from`."""

from pathlib import Path
from typing import Any

import numpy as np

from vibro_sweep import store
from vibro_sweep.analysis.branches.flat import special_point
from vibro_sweep.analysis.branches.forest import Seed, seed_of
from vibro_sweep.analysis.branches.generations import WAYS
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.branches.switching import switch
from vibro_sweep.analysis.curves.flat import point_of_codimension_two
from vibro_sweep.analysis.curves.switching import switch as curves_through
from vibro_sweep.analysis.curves.way import CurvePoint
from vibro_sweep.analysis.periodic.finding import periodic_orbit
from vibro_sweep.analysis.periodic.lcp import born_at_grazing
from vibro_sweep.analysis.periodic.orbit import STATUS, PeriodicOrbit
from vibro_sweep.driver.windows import windows
from vibro_sweep.model.bifurcations import CURVES
from vibro_sweep.model.branch_file import CHART, WINDOWS
from vibro_sweep.scene import Continuation, parse_continuation, parse_scene
from vibro_sweep.store.joining import branch_of, curve_of


def seeds_of(scene: Continuation) -> list[Seed]:
    """The first orbits of a scene, those within its range. Raises ValueError where there is none."""
    key, (lo, hi) = next(iter(scene.along.items()))
    orbits = [orbit for orbit in _orbits(scene, key) if lo <= orbit._solution.family.numbers[key] <= hi]
    if not orbits:
        raise ValueError(f"continue.from.{scene.origin}: no orbit with {key} in {lo:g} .. {hi:g}")
    return [seed_of(orbit) for orbit in orbits]


def _orbits(scene: Continuation, key: str) -> list[PeriodicOrbit]:
    if scene.origin == "state":
        return [_one(periodic_orbit(scene.system, scene.begin, scene.periods), scene)]
    if scene.origin == "itinerary":
        return [_one(periodic_orbit(scene.system, itinerary=scene.begin, periods=scene.periods), scene)]
    if scene.origin == "free":
        return [_one(periodic_orbit(scene.system, itinerary=""), scene)]
    if scene.origin == "grazing":
        return [born.orbit for born in born_at_grazing(scene.system, periods=scene.begin)]
    if scene.origin == "sweep":
        return [window.orbit for window in windows(scene.begin, key)]
    return _from_branches(scene, key)


def _one(orbit: PeriodicOrbit, scene: Continuation) -> PeriodicOrbit:
    if not orbit.ok:
        raise ValueError(f"continue.from.{scene.origin}: no orbit was found; {STATUS[orbit.status]}")
    return orbit


def _from_branches(scene: Continuation, key: str) -> list[PeriodicOrbit]:
    """Beyond a special point in a file of branches or windows; along another number also from its own orbit."""
    special, (parameter, *_) = _special(scene)
    if isinstance(special, CurvePoint):
        return [special.orbit]
    found = switch(special) if special.type in WAYS else []
    return found if key == parameter else [special.orbit, *found]


def specials_of(scene: Continuation) -> list[SpecialPoint]:
    """Where curves begin: at the ends of a sweep's windows, or at a special point of a file.

    Raises ValueError where the sweep's oscillator is another one, or the point is of a type that has no curve.
    """
    if scene.origin == "branches":
        special, _ = _special(scene)
        if isinstance(special, CurvePoint):
            return curves_through(special)
        if special.type not in CURVES:
            raise ValueError(f"continue.from.special: {special.type!r} is not allowed; it must be {', '.join(CURVES)}")
        return [special]
    found = [end for one in windows(scene.begin, next(iter(scene.along))) for end in (one.lower, one.upper)]
    for special in found:
        check_numbers(scene, special.orbit.system, ())
    return found


def numbers_of(scene: Continuation) -> dict[str, Any]:
    """What the file says of the oscillator: all its numbers but those along which it is followed.

    They are those of the scene's `system`; from a special point of a file, those of that point. A phase `grazing` that
    changes with what is followed is none of them.
    """
    system = _special(scene)[0].orbit.system if scene.origin == "branches" else scene.system
    found = {name: value for name, value in system.parameters().items() if name not in scene.along}
    ends = [system.replace(**{name: end}) for name, limits in scene.along.items() for end in limits]
    return {k: v for k, v in found.items() if k != "tau" or all(end.parameters()["tau"] == v for end in ends)}


def _special(scene: Continuation) -> tuple[SpecialPoint, list[str]]:
    """The special point of `{branches: FILE, special: n}`, and the numbers that vary in that file."""
    with store.open(Path(scene.begin)) as data:
        if "kind" not in data.attrs:
            raise ValueError(f"continue.from.branches: {scene.begin} holds no branches")
        count, kind = data.sizes["special"], data.attrs["kind"]
        if scene.special >= count:
            raise ValueError(f"continue.from.special: {scene.special} is not allowed; it must be < {count}")
        parse = parse_scene if kind == WINDOWS else parse_continuation
        names = np.atleast_1d(data.attrs["parameters"]).tolist()
        system = parse(data.attrs["scene"]).system
        known = {name: value for name, value in system.parameters().items() if name in data.attrs and name != "tau"}
        changed = {name: float(data.attrs[name]) for name, value in known.items() if value != data.attrs[name]}
        index = int(data["special_branch"][scene.special])
        values = dict(zip(names, data["special_value"].values[scene.special].tolist(), strict=True))
        arrays = {name: data[name].values for name in data.data_vars}
    place = scene.special - int(arrays["branch_special"][:index].sum())
    system = system.replace(**changed | values)
    if kind == CHART:
        found: SpecialPoint = point_of_codimension_two(curve_of(arrays, names, index), place, names, system)
    else:
        found = special_point(branch_of(arrays, names[0], index), place, names[0], system)
    check_numbers(scene, found.orbit.system, names)
    return found, names


def check_numbers(scene: Continuation, system, free) -> None:
    """Raise ValueError where `system` of a file differs from the scene's in a number that is not followed, nor free."""
    ours = scene.system.numbers
    for name, value in system.numbers.items():
        if name not in scene.along and name not in free and ours.get(name) != value:
            raise ValueError(f"system.{name}: {ours.get(name)!r} is not allowed; it is {value!r} in {scene.begin}")
