"""Branches, bifurcation curves and windows of Python as files, and back: `.save`, `.to_xarray`, `vibro_sweep.load`."""

import io
import json
import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np

from vibro_sweep import store
from vibro_sweep.analysis.branches import branch_arrays
from vibro_sweep.analysis.branches.branch import Branch
from vibro_sweep.analysis.curves import curve_arrays
from vibro_sweep.analysis.curves.bifurcation_curve import BifurcationCurve
from vibro_sweep.analysis.periodic.orbit_file import load_orbit
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.windows.members import solution_in
from vibro_sweep.analysis.windows.unvisited import Unvisited
from vibro_sweep.analysis.windows.window import Window, Windows
from vibro_sweep.driver.any_file import first_bytes
from vibro_sweep.driver.origins import Source, attributes_of
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.driver.source_file import computed_from
from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.bifurcations import CURVES
from vibro_sweep.model.branch_file import BRANCHES, CHART, SWEEP, WINDOWS, columns_of
from vibro_sweep.model.column import Column
from vibro_sweep.model.errors import ArgumentError
from vibro_sweep.model.files import ExistingFileError, checked_path, file_to_write
from vibro_sweep.model.linear import Family
from vibro_sweep.model.parameters import ParameterError
from vibro_sweep.model.state import state
from vibro_sweep.scene import Continuation, parse_continuation, parse_scene
from vibro_sweep.store import StoreError
from vibro_sweep.store.arrays import Contents
from vibro_sweep.store.joining import joined, part_of
from vibro_sweep.store.parts import new_run_id
from vibro_sweep.store.pieces import pieces
from vibro_sweep.store.ragged_files import Subject, image_of

if TYPE_CHECKING:
    import xarray

Saved = Branch | BifurcationCurve | Windows
HDF5 = (b"\x89HDF", b"\x89vibro_sweep")  # with which such files, and the parts of runs, begin
ONE = "saved"  # attribute of a file with a single branch or curve, which is not a list


class Held(NamedTuple):
    """What a file of a result holds."""

    subject: Subject
    columns: list[Column]
    arrays: dict[str, np.ndarray]


def dataset_of(result: Saved) -> "xarray.Dataset":
    """The Dataset that `open` gives of the file of a result."""
    from vibro_sweep.store import lazy

    held = held_by(result)
    image = image_of(held.subject, new_run_id(), json.dumps(provenance()), held.columns, held.arrays)
    with h5py.File(io.BytesIO(image)) as file:
        return lazy.dataset_of(file).load()


def save(result: Saved, path: str | Path) -> Path:
    """Write the file of a result. Raises ExistingFileError, StoreError."""
    path, held = file_to_write("path", path), held_by(result)
    if path.exists():
        raise ExistingFileError(path)
    with pieces(held.subject, path, "new", []) as file:
        file.finish(provenance(), held.columns, held.arrays)
    return path


def held_by(result: Saved) -> Held:
    """Raises ValueError for what no file can hold."""
    if isinstance(result, Windows):
        return Held(*result._held())
    system = result.special[0].orbit.system
    if isinstance(system, Family):
        raise ArgumentError("a result of a Family has no file: its numbers are those of a function")
    names = [result.parameter] if isinstance(result, Branch) else list(result.parameters)
    none = {"branch_parent": np.array([-1]), "branch_parent_special": np.array([-1]), "branch_generation": np.zeros(1)}
    if isinstance(result, BifurcationCurve):
        if result.type not in CURVES:
            raise ArgumentError("a curve of onsets of sticking has no file: its orbits have no finite list of impacts")
        arrays, kind, shapes, more = curve_arrays.arrays_of(result), CHART, curve_arrays.SHAPES, {}
    else:
        arrays = branch_arrays.arrays_of(result, result._start.family.numbers[result.parameter])
        kind, shapes = BRANCHES, branch_arrays.SHAPES
        sections = branch_arrays.sections_of(arrays, result.parameter, system)
        more = {f"section_{one}": sections[..., i].ravel() for i, one in enumerate(state(system.masses))}
        more["branch_sections"] = np.array([sections.shape[1]])
    scene = _scene_of(arrays, names, system)
    attributes = attributes_of(scene, Source(scene.system, "")) | {ONE: type(result).__name__}
    subject = Subject(kind, f"{type(result).__name__} in {', '.join(names)}", scene.to_yaml(), attributes)
    return Held(subject, columns_of(kind, names, system), joined([arrays], shapes, names, system.masses) | none | more)


def _scene_of(arrays: dict[str, np.ndarray], names: Sequence[str], system: AnyOscillator) -> Continuation:
    """The scene that follows the same orbits from the state of one of them."""
    value = np.reshape(arrays["value"], (-1, len(names)))
    at = int(arrays.get("branch_origin", len(value) // 2))
    there = system.replace(**dict(zip(names, value[at].tolist(), strict=True)))
    bounds = {name: _range(there, name, one) for name, one in zip(names, value.T, strict=True)}
    begin = tuple(arrays["state"][at].tolist())
    period = int(arrays["branch_period"])
    return Continuation("result", "", there, "state", begin, period, None, None, bounds, CURVES, (), 0)


def _range(system: AnyOscillator, name: str, values: np.ndarray) -> tuple[float, float]:
    """The least and the largest value, which a scene has apart: of equal ones a neighbour that is allowed is added."""
    lo, hi = float(values.min()), float(values.max())
    if lo < hi:
        return lo, hi
    below, above = math.nextafter(lo, -math.inf), math.nextafter(hi, math.inf)
    try:
        system.replace(**{name: below})
    except ParameterError:
        return lo, above
    return below, hi


def load(path: str | Path) -> PeriodicOrbit | Saved | list[Branch] | list[BifurcationCurve]:
    """What `.save` wrote, a PeriodicOrbit, Branch, BifurcationCurve or Windows; of the file of a scene of branches or
    curves a list of these.

    Raises ValueError for a sweep, which `open` gives, and for a file that is none of these; StoreError for one that
    cannot be read, or is damaged.
    """
    path = checked_path("path", path)
    if not first_bytes(path).startswith(HDF5):
        return load_orbit(path)
    with computed_from(path), store.contents(path) as data:
        try:
            return _object_in(data)
        except (KeyError, IndexError, TypeError, ArithmeticError) as error:  # an edited file, whose checksums hold
            raise StoreError(f"{path} is damaged ({error})") from None


def _object_in(data: Contents) -> Saved | list[Branch] | list[BifurcationCurve]:
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
    found = _each(data, arrays, names)
    return found[0] if ONE in data.attrs and found else found


def _each(data: Contents, arrays: dict[str, np.ndarray], names: list[str]) -> list[Any]:
    """The branches or curves of a file."""
    kind, system = data.attrs["kind"], parse_continuation(data.attrs["scene"]).system
    numbers = {name: value for name, value in system.numbers.items() if isinstance(value, float)}
    known = {name: data.attrs.get(name, value) for name, value in numbers.items()}  # of the point it began at
    found: list[Any] = []
    for i in range(len(arrays["branch_period"])):
        shapes = curve_arrays.SHAPES if kind == CHART else branch_arrays.SHAPES
        own = part_of(arrays, shapes, names, i)
        place = np.reshape(own["value"], (-1, len(names)))[0].tolist()
        there = system.replace(**known | dict(zip(names, place, strict=True)))
        parameters = (names[0], names[-1])
        curve = kind == CHART
        found.append(
            curve_arrays.curve_of(own, parameters, there) if curve else branch_arrays.branch_of(own, names[0], there)
        )
    return found


def _windows(data: Contents, arrays: dict[str, np.ndarray], names: list[str]) -> Windows:
    """The windows of a file."""
    scene = parse_scene(data.attrs["scene"])
    result = Windows()
    result.parameter = names[0]
    first = np.append(0, np.cumsum(arrays["branch_row_size"]))
    for w, branch in enumerate(arrays["window_branch"].tolist()):
        own = part_of(arrays, branch_arrays.SHAPES, names[:1], branch)
        held = {name: float(arrays[name][first[branch]]) for name in names[1:]}
        at = float(own["value"][own["branch_origin"]])
        system = scene.system.replace(**held | {names[0]: at})
        ends = (float(arrays[name][w]) for name in ("window_lo", "window_hi"))
        counts = (int(arrays[name][w]) for name in ("window_orbits", "window_other_attractor"))
        window = Window(names[0], *ends, held, *counts, own, system)
        _ = window.lower, window.upper, window.orbit
        result.append(window)
    shape = (*scene.shape, scene.n_starts)
    result.window, result.reason = (arrays[name].reshape(shape) for name in ("orbit_window", "orbit_reason"))
    result.unvisited = []
    for u, w in enumerate(arrays.get("unvisited_window", np.zeros(0, int)).tolist()):
        numbers = [arrays[f"unvisited_{name}"][u] for name in ("lo", "hi", "values", "at")]
        lo, hi, values, at = (one.item() for one in numbers)
        system = result[w]._system.replace(**{names[0]: at})
        known = bool(np.isfinite(arrays["unvisited_x1"][u]))
        found = orbit_of(system, solution_in(result[w]._arrays, at, system)) if known else None
        result.unvisited.append(Unvisited(w, lo, hi, values, at, found or PeriodicOrbit(system, "not_converged")))
    title = str(data.attrs["title"]).removeprefix("vibro_sweep: ")
    attributes = {"sweep": data.attrs.get("sweep", ""), "parameter": names[0], "parameters": names}
    subject = Subject(WINDOWS, title, data.attrs["scene"], attributes)
    result._held = partial(tuple, (subject, columns_of(WINDOWS, names, scene.system), arrays))
    return result
