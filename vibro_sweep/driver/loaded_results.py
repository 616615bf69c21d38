"""`vibro_sweep.load`: what `.save` and scenes of branches and curves wrote, as objects again."""

from functools import partial
from pathlib import Path

import numpy as np

from vibro_sweep.analysis.branches import branch_arrays
from vibro_sweep.analysis.branches.branch import Branch
from vibro_sweep.analysis.curves import curve_arrays
from vibro_sweep.analysis.curves.bifurcation_curve import BifurcationCurve
from vibro_sweep.analysis.periodic.orbit_file import load_orbit
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.windows.members import solution_in
from vibro_sweep.analysis.windows.unvisited import Unvisited
from vibro_sweep.analysis.windows.window import Window, Windows
from vibro_sweep.checks.arguments import names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import checked_path
from vibro_sweep.driver.any_file import first_bytes
from vibro_sweep.driver.joining import part_of
from vibro_sweep.driver.saved_results import ONE, Saved
from vibro_sweep.driver.source_file import computed_from
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.opening import PART
from vibro_sweep.files.reading import sweep_in
from vibro_sweep.results import ragged_dataset
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.scene import parse_continuation, parse_scene
from vibro_sweep.tables.file_columns import CHART, SWEEP, WINDOWS

HDF5 = (b"\x89HDF", PART)  # with which such files, and interrupted runs of 0.2, begin
Arrays = dict[str, np.ndarray]
Followed = Branch | BifurcationCurve


@names_its_arguments
def load(path: str | Path) -> PeriodicOrbit | Saved | list[Branch] | list[BifurcationCurve]:
    """What `.save` wrote, a PeriodicOrbit, Branch, BifurcationCurve or Windows; of the file of a scene of branches or
    curves a list of these.

    Raises ValueError for a sweep, which `open` gives, and for a file that is none of these; StoreError for one that
    cannot be read, or is damaged.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> path = vs.periodic_orbit(system, itinerary="R").save("orbit.json")
    >>> vs.load(path).itinerary
    'R'
    """
    path = checked_path("path", path)
    if not first_bytes(path).startswith(HDF5):
        return load_orbit(path)
    with computed_from(path), sweep_in(path, computes=True) as data:
        try:
            return _object_in(data)
        except (KeyError, IndexError, TypeError, ArithmeticError) as error:  # an edited file, whose checksums hold
            raise StoreError(f"{path} is damaged ({error})") from None


def _object_in(data: Sweep) -> Saved | list[Branch] | list[BifurcationCurve]:
    """What a file of branches, curves or windows holds, all of it computed: what is wrong with a file is told now."""
    kind = data.attrs.get("kind", SWEEP)
    if kind == SWEEP:
        raise ArgumentError("it holds a sweep, which `vibro_sweep.open` gives")
    arrays = {name: data.values(name) for name in data.names}
    if not np.isin(arrays["impact_side"], (1, -1)).all():
        raise ArgumentError("it is damaged: `impact_side` has other stops than 1 and -1")
    names = np.atleast_1d(data.attrs["parameters"]).tolist()
    if kind == WINDOWS:
        return _windows(data, arrays, names)
    loaded = _each(data, arrays, names)
    return loaded[0] if ONE in data.attrs and loaded else loaded


def _each(data: Sweep, arrays: Arrays, names: list[str]) -> list[Followed]:
    """The branches or curves of a file."""
    system = parse_continuation(data.attrs["scene"]).system
    numbers = {name: value for name, value in system.numbers.items() if isinstance(value, float)}
    system = system.replace(**{name: data.attrs.get(name, value) for name, value in numbers.items()})
    of_curves = data.attrs["kind"] == CHART
    result: list[Followed] = []
    for i in range(len(arrays["branch_period"])):
        part = part_of(arrays, (curve_arrays if of_curves else branch_arrays).SHAPES, names, i)
        there = system.replace(**dict(zip(names, np.reshape(part["value"], (-1, len(names)))[0].tolist(), strict=True)))
        if of_curves:
            result.append(curve_arrays.curve_of(part, (names[0], names[1]), there))
        else:
            result.append(branch_arrays.branch_of(part, names[0], there))
    return result


def _windows(data: Sweep, arrays: Arrays, names: list[str]) -> Windows:
    """The windows of a file."""
    system = parse_scene(data.attrs["scene"]).system
    chosen = {name: data.attrs[name] for name in system.described if name in data.attrs and name not in names}
    system, parameter = system.replace(**chosen), names[0]
    result = Windows()
    result.parameter = parameter
    first = np.append(0, np.cumsum(arrays["branch_row_size"]))
    for w, branch in enumerate(arrays["window_branch"].tolist()):
        part = part_of(arrays, branch_arrays.SHAPES, names[:1], branch)
        held = {name: float(arrays[name][first[branch]]) for name in names[1:]}
        there = system.replace(**held | {parameter: float(part["value"][part["branch_origin"]])})
        ends = (float(arrays[name][w]) for name in ("window_lo", "window_hi"))
        counts = (int(arrays[name][w]) for name in ("window_orbits", "window_other_attractor"))
        window = Window(parameter, *ends, held, *counts, part, there)
        _ = window.lower, window.upper, window.orbit  # a damaged one is refused here
        result.append(window)
    shape = data.attrs["sweep_shape"]
    result.window, result.reason = (arrays[name].reshape(shape) for name in ("orbit_window", "orbit_reason"))
    result.unvisited = [_unvisited(arrays, u, result) for u in range(len(arrays["unvisited_window"]))]
    attributes = {name: data.attrs[name] for name in ("sweep", "parameter", "sweep_shape", *chosen)}
    title = str(data.attrs["title"]).removeprefix("vibro_sweep: ")
    header = ragged_dataset.attributes_of(WINDOWS, title, data.attrs["scene"], attributes | {"parameters": names})
    columns = ragged_dataset.columns_in_file(WINDOWS, names, system)
    result._dataset = partial(ragged_dataset.dataset, header, columns, arrays)
    return result


def _unvisited(arrays: Arrays, u: int, windows: Windows) -> Unvisited:
    """A stretch of a window on which the sweep shows other attractors only."""
    w = int(arrays["unvisited_window"][u])
    lo, hi, values, at = (arrays[f"unvisited_{name}"][u].item() for name in ("lo", "hi", "values", "at"))
    system = windows[w]._system.replace(**{windows.parameter: at})
    orbit = PeriodicOrbit(system, "not_converged")
    if np.isfinite(arrays["unvisited_x1"][u]):
        orbit = orbit_of(system, solution_in(windows[w]._arrays, at, system))
    return Unvisited(w, lo, hi, values, at, orbit)
