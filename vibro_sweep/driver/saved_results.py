"""Branches, bifurcation curves and windows of Python as files: `.save` and `.to_xarray`."""

import math
import secrets
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.branches import branch_arrays
from vibro_sweep.analysis.branches.branch import Branch
from vibro_sweep.analysis.curves import curve_arrays
from vibro_sweep.analysis.curves.bifurcation_curve import BifurcationCurve
from vibro_sweep.analysis.windows.window import Windows
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import ExistingFileError, file_to_write
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.driver.joining import joined
from vibro_sweep.driver.origins import Source, attributes_of
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.files.making import make
from vibro_sweep.files.subject import about_run, check_outputs
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.results import ragged_dataset
from vibro_sweep.scene import Continuation
from vibro_sweep.tables.bifurcations import CURVES
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.file_columns import BRANCHES, CHART, OF_CONTACTS
from vibro_sweep.tables.observables import ALONG_BRANCHES

if TYPE_CHECKING:
    import xarray

Saved = Branch | BifurcationCurve | Windows
ONE = "saved"  # attribute of a file with a single branch or curve, which is not a list


def dataset_of(result: Saved) -> "xarray.Dataset":
    """The Dataset that `open` gives of the file of a result."""
    data = _dataset(result)
    return data.assign_attrs(about_run(data.attrs, provenance(), secrets.token_hex(16)))


def save(result: Saved, path: str | Path) -> Path:
    """Write the file of a result. Raises ExistingFileError, StoreError."""
    path, data = file_to_write("path", path), dataset_of(result)
    if path.exists():
        raise ExistingFileError(path)
    check_outputs(path, "new", ())
    make(path, data)
    return path


def _dataset(result: Saved) -> "xarray.Dataset":
    """Raises ValueError for what no file can hold."""
    if isinstance(result, Windows):
        return result._dataset()
    system = result.special[0].orbit.system
    if isinstance(system, Family):
        raise ArgumentError("a result of a Family has no file: its numbers are those of a function")
    names = [result.parameter] if isinstance(result, Branch) else list(result.parameters)
    none = {"branch_parent": np.array([-1]), "branch_parent_special": np.array([-1]), "branch_generation": np.zeros(1)}
    if isinstance(result, BifurcationCurve):
        if result.type not in CURVES:
            raise ArgumentError("a curve of onsets of sticking has no file: its orbits have no finite list of impacts")
        arrays, kind, shapes, more = curve_arrays.arrays_of(result), CHART, curve_arrays.SHAPES, {}
        contacts = False
    else:
        arrays = branch_arrays.arrays_of(result, result._start.family.free[result.parameter])
        kind, shapes = BRANCHES, branch_arrays.SHAPES
        sections = branch_arrays.sections_of(arrays, result.parameter, system)
        more = {f"section_{coordinate}": sections[..., i].ravel() for i, coordinate in enumerate(state(system.masses))}
        more["branch_sections"] = np.array([sections.shape[1]])
        contacts = OF_CONTACTS[0].name in arrays
    scene = _scene_of(arrays, names, system, ALONG_BRANCHES if contacts else ())
    attributes = attributes_of(scene, Source(scene.system, "")) | {ONE: type(result).__name__}
    title = f"{type(result).__name__} in {', '.join(names)}"
    header = ragged_dataset.attributes_of(kind, title, scene.to_yaml(), attributes)
    columns_of_result = joined([arrays], shapes, names, system.masses) | none | more
    more_columns = OF_CONTACTS if contacts else ()
    columns = ragged_dataset.columns_in_file(kind, names, system, more_columns)
    return ragged_dataset.dataset(header, columns, columns_of_result)


def _scene_of(
    arrays: dict[str, np.ndarray], names: Sequence[str], system: Oscillator, observe: tuple[str, ...]
) -> Continuation:
    """The scene that follows the same orbits from the state of one of them."""
    value = np.reshape(arrays["value"], (-1, len(names)))
    at = int(arrays.get("branch_origin", len(value) // 2))
    there = system.replace(**dict(zip(names, value[at].tolist(), strict=True)))
    bounds = {name: _range(there, name, entries) for name, entries in zip(names, value.T, strict=True)}
    begin = tuple(arrays["state"][at].tolist())
    period = int(arrays["branch_period"])
    return Continuation("result", there, "state", begin, period, None, None, bounds, CURVES, (), 0, observe)


def _range(system: Oscillator, name: str, values: np.ndarray) -> tuple[float, float]:
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
