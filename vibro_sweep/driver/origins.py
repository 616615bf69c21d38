"""The orbits and special points with which a scene of branches or curves begins: `continue: from`."""

from concurrent.futures import Executor
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches import branch_arrays as branches
from vibro_sweep.analysis.branches.branch_arrays import special_point
from vibro_sweep.analysis.branches.branch_switching import switch
from vibro_sweep.analysis.branches.seeds import Seed, seed_of
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.curves import curve_arrays as curves
from vibro_sweep.analysis.curves.curve_arrays import point_of_codimension_two
from vibro_sweep.analysis.curves.curve_record import CurvePoint
from vibro_sweep.analysis.curves.curve_switching import switch as curves_through
from vibro_sweep.analysis.periodic.finding import periodic_orbit
from vibro_sweep.analysis.periodic.lcp import born_at_grazing
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.windows.members import solution_in
from vibro_sweep.analysis.windows.rows import Row
from vibro_sweep.analysis.windows.window_search import RowWindow, WindowSearch
from vibro_sweep.checks.refusals import cut, shown
from vibro_sweep.driver.joining import part_of
from vibro_sweep.driver.source_file import SourceError, run_id_of
from vibro_sweep.driver.windows import rows_in, search_of
from vibro_sweep.files.pieces import Pieces
from vibro_sweep.files.reading import sweep_in
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.other_words import own_name
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.scene import Continuation, parse_continuation, parse_scene
from vibro_sweep.tables.bifurcations import CURVES, WAYS
from vibro_sweep.tables.file_columns import CHART, SWEEP, WINDOWS
from vibro_sweep.tables.outcomes import ORBITS, named
from vibro_sweep.tables.parameters import CYCLES


class NoOrbitError(SourceError):
    """There is no orbit to begin with."""


class Source(NamedTuple):
    """The oscillator of a scene's branches or curves, and the run id of the file that they begin from, if any."""

    system: Oscillator
    run_id: str


def source_of(scene: Continuation) -> Source:
    """Raises ValueError where the file that a scene begins from is of another oscillator than the scene."""
    free = {name: lo for name, (lo, _) in scene.parameter.items()}
    if scene.origin == "sweep":
        with sweep_in(Path(scene.begin), computes=True) as data:
            if data.attrs.get("kind", SWEEP) != SWEEP:
                raise SourceError(f"continue.from.sweep: {scene.begin} holds {cut(str(data.attrs['kind']))}, no sweep")
            its_system = _rows(scene, data)[0].system
            run_id = run_id_of(data)
    elif scene.origin == "branches":
        with sweep_in(Path(scene.begin), computes=True) as data:
            its_system, names = _at_special(scene, data)
            run_id = run_id_of(data)
        free |= {name: getattr(its_system, name) for name in names}
    else:
        return Source(scene.system, "")
    _check_same(scene, its_system.replace(**free), scene.system.replace(**free))
    return Source(its_system, run_id)


def attributes_of(scene: Continuation, source: Source) -> dict[str, Any]:
    """Attributes of the file about the oscillator: all its numbers but those along which it is followed.

    A phase `grazing` that changes with what is followed is not one of them.
    """
    free = {own_name(name) for name in scene.parameter}
    others = {name: value for name, value in source.system.parameters().items() if name not in free}
    ends = [source.system.replace(**{name: end}) for name, limits in scene.parameter.items() for end in limits]
    held = {k: v for k, v in others.items() if k != "tau" or all(end.parameters()["tau"] == v for end in ends)}
    shown = {"picture_units": ", ".join(scene.picture_units)} if scene.picture_units else {}
    return {"parameters": list(scene.parameter)} | held | shown | ({"source": source.run_id} if source.run_id else {})


def seeds_of(scene: Continuation, file: Pieces, pool: Executor | None) -> list[Seed]:
    """The first orbits of a scene, those within its range; `file` keeps what it takes to find them.

    Raises NoOrbitError where there is none.
    """
    key, (lo, hi) = next(iter(scene.parameter.items()))
    if scene.origin == "sweep":
        orbits = _from_sweep(scene, key, file, pool)
    else:
        orbits = [orbit for orbit in _orbits(scene, key) if lo <= orbit._solution.family.free[key] <= hi]
    if not orbits:
        of = f" of {scene.begin}" if scene.origin in ("sweep", "branches") else ""
        raise NoOrbitError(f"continue.from.{scene.origin}: no orbit{of} with {key} in {lo:g} .. {hi:g}")
    return [seed_of(orbit.system, StartingOrbit("orbit", orbit._solution)) for orbit in orbits]


def _orbits(scene: Continuation, key: str) -> list[PeriodicOrbit]:
    if scene.origin == "state":
        return [_one(periodic_orbit(scene.system, scene.begin, scene.periods), scene)]
    if scene.origin == "itinerary":
        return [_one(periodic_orbit(scene.system, itinerary=scene.begin, periods=scene.periods), scene)]
    if scene.origin == "free":
        return [_one(periodic_orbit(scene.system, itinerary=""), scene)]
    if scene.origin == "grazing":
        return [born.orbit for born in born_at_grazing(scene.system, periods=scene.begin) if born.orbit.ok]
    return _from_branches(scene, key)


def _check_same(scene: Continuation, its_system: Oscillator, asked: Oscillator) -> None:
    """Raise ValueError where a file's oscillator is not that of the scene."""
    if its_system == asked:
        return
    here, there = ({"type": system.model.name, **system.numbers, **system.options} for system in (asked, its_system))
    for name in [*here, *there]:
        if here.get(name) != there.get(name):
            named = f"{name} = {shown(here.get(name))} in system, and {shown(there.get(name))} in {scene.begin}"
            raise SourceError(f"continue.from.{scene.origin}: {named}; branches belong to one oscillator")


def _rows(scene: Continuation, data: Sweep) -> list[Row]:
    """The row of a sweep along the first number; of a plane that at the scene's value of the other key.

    All rows of a plane whose keys are both followed. Raises ValueError.
    """
    rows = rows_in(data, next(iter(scene.parameter)))
    known = scene.system.parameters() | {CYCLES.name: scene.system.frequency}
    numbers = {name: value for name, value in known.items() if name not in scene.parameter}
    matching = [row for row in rows if all(numbers.get(name, value) == value for name, value in row.held.items())]
    if not matching:
        held = ", ".join(f"{name} = {numbers[name]!r}" for name in rows[0].held)
        raise SourceError(f"continue.from.sweep: {scene.begin} has no row with {held}")
    return matching


def _from_sweep(scene: Continuation, key: str, file: Pieces, pool: Executor | None) -> list[PeriodicOrbit]:
    """An orbit of each window of a sweep that reaches into the scene's range, near where it was found."""
    with sweep_in(Path(scene.begin), computes=True) as data:
        rows = _rows(scene, data)
    orbits = []
    for window in _chosen(scene, search_of(rows, file, pool)):
        lo, hi = np.clip(window.ends, *scene.parameter[key])
        value = float(np.clip(window.arrays["value"][window.arrays["branch_origin"]], lo, hi))
        system = window.system.replace(**{key: value})
        orbit = orbit_of(system, solution_in(window.arrays, value, system))
        if window.ends[0] <= value <= window.ends[1] and orbit.ok:
            orbits.append(orbit)
    return orbits


def _chosen(scene: Continuation, search: WindowSearch) -> list[RowWindow]:
    """The windows from which a scene begins, in the order of the sweep: all, or the largest within its range."""
    windows_found, (lo, hi) = search.found, next(iter(scene.parameter.values()))
    if scene.largest is None:
        return windows_found
    widths = np.array([np.ptp(np.clip(window.ends, lo, hi)) for window in windows_found])
    return [windows_found[w] for w in np.sort(np.argsort(-widths, kind="stable")[: scene.largest])]


def _one(orbit: PeriodicOrbit, scene: Continuation) -> PeriodicOrbit:
    if not orbit.ok:
        raise NoOrbitError(f"continue.from.{scene.origin}: no orbit was found; {named(ORBITS, orbit.status).text}")
    return orbit


def _from_branches(scene: Continuation, key: str) -> list[PeriodicOrbit]:
    """Beyond a special point in a file of branches or windows; along another number also from its own orbit."""
    special, (parameter, *_) = _special(scene)
    if isinstance(special, CurvePoint):
        return [special.orbit]
    if special.type not in WAYS and key == parameter:
        named = f"{scene.special} is a {special.type!r} in {scene.begin}, at which no other branch begins"
        raise SourceError(f"continue.from.special: {named}; one begins at {', '.join(WAYS)}")
    orbits = switch(special) if special.type in WAYS else []
    return orbits if key == parameter else [special.orbit, *orbits]


def specials_of(scene: Continuation, file: Pieces, pool: Executor | None) -> list[SpecialPoint]:
    """The special points at which curves begin: the ends of a sweep's windows, or one of a file.

    `file` keeps what it takes to find them. Raises ValueError where the point is of a type that has no curve.
    """
    if scene.origin == "branches":
        special, _ = _special(scene)
        if isinstance(special, CurvePoint):
            return curves_through(special)
        if special.type not in CURVES:
            named = f"{scene.special} is a {special.type!r} in {scene.begin}"
            raise SourceError(f"continue.from.special: {named}; it must be one of {', '.join(CURVES)}")
        return [special]
    with sweep_in(Path(scene.begin), computes=True) as data:
        rows = _rows(scene, data)
    key = next(iter(scene.parameter))
    chosen = _chosen(scene, search_of(rows, file, pool))
    return [special_point(one.arrays, end, key, one.system) for one in chosen for end in (0, 1)]


def _special(scene: Continuation) -> tuple[SpecialPoint, list[str]]:
    """The special point of `{branches: FILE, special: n}`, and the numbers that vary in that file."""
    with sweep_in(Path(scene.begin), computes=True) as data:
        system, names = _at_special(scene, data)
        kind = data.attrs["kind"]
        arrays = {name: data.values(name) for name in data.names}
    index = int(arrays["special_branch"][scene.special])
    place = scene.special - int(arrays["branch_special"][:index].sum())
    if kind == CHART:
        return point_of_codimension_two(part_of(arrays, curves.SHAPES, names, index), place, names, system), names
    return special_point(part_of(arrays, branches.SHAPES, names[:1], index), place, names[0], system), names


def _at_special(scene: Continuation, data: Sweep) -> tuple[Oscillator, list[str]]:
    """The oscillator at the scene's special point, and the numbers that vary in the file. Raises ValueError."""
    if data.attrs.get("kind", SWEEP) == SWEEP:
        raise SourceError(f"continue.from.branches: {scene.begin} holds no branches")
    count = data.sizes["special"]
    if scene.special >= count:
        allowed = f"< {count}, as {scene.begin} has no more special points"
        raise SourceError(f"continue.from.special: {scene.special} is not allowed; it must be {allowed}")
    parse = parse_scene if data.attrs["kind"] == WINDOWS else parse_continuation
    names = np.atleast_1d(data.attrs["parameters"]).tolist()
    values = data.values("special_value")[scene.special].tolist()
    system = parse(data.attrs["scene"]).system
    numbers = {name: data.attrs.get(name, value) for name, value in system.numbers.items() if isinstance(value, float)}
    return system.replace(**numbers | dict(zip(names, values, strict=True))), names
