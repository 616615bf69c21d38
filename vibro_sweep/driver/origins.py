"""The orbits with which a scene of branches begins: `continue: from`."""

from pathlib import Path

import numpy as np

from vibro_sweep import store
from vibro_sweep.analysis.branches.flat import special_point
from vibro_sweep.analysis.branches.forest import Seed, seed_of
from vibro_sweep.analysis.branches.generations import WAYS
from vibro_sweep.analysis.branches.switching import switch
from vibro_sweep.analysis.periodic.finding import periodic_orbit
from vibro_sweep.analysis.periodic.lcp import born_at_grazing
from vibro_sweep.analysis.periodic.orbit import STATUS, PeriodicOrbit
from vibro_sweep.driver.windows import windows
from vibro_sweep.model.branch_file import WINDOWS
from vibro_sweep.scene import Continuation, parse_continuation, parse_scene
from vibro_sweep.store.joining import branch_of


def seeds_of(scene: Continuation) -> list[Seed]:
    """The first orbits of a scene, those within its range. Raises ValueError where there is none."""
    ((key, (lo, hi)),) = scene.along.items()
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
    with store.open(Path(scene.begin)) as data:
        if "kind" not in data.attrs:
            raise ValueError(f"continue.from.branches: {scene.begin} holds no branches")
        count = data.sizes["special"]
        if scene.special >= count:
            raise ValueError(f"continue.from.special: {scene.special} is not allowed; it must be < {count}")
        parse = parse_scene if data.attrs["kind"] == WINDOWS else parse_continuation
        parameter, *others = np.atleast_1d(data.attrs["parameters"]).tolist()
        system = parse(data.attrs["scene"]).system
        values = dict(zip(others, data["special_value"].values[scene.special, 1:].tolist(), strict=True))
        index = int(data["special_branch"][scene.special])
        arrays = {name: data[name].values for name in data.data_vars}
        flat = branch_of(arrays, parameter, index)
        place = scene.special - int(arrays["branch_special"][:index].sum())
    special = special_point(flat, place, parameter, system.replace(**values))
    found = switch(special) if special.type in WAYS else []
    return found if key == parameter else [special.orbit, *found]
