"""Datasets of branches, curves and windows: ragged arrays, laid out one after another (CF, 9.3.3)."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from vibro_sweep.checks.refusals import cut, shown
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.results.described import described
from vibro_sweep.tables.file_columns import OF_CONTACTS, OF_EDGES, OF_FIRST, OF_PARAMETER, RAGGED, RAGGED_KINDS, columns
from vibro_sweep.tables.quantity import Quantity
from vibro_sweep.tables.units import unit_in


def attributes_of(kind: str, title: str, scene: str, attributes: Mapping[str, Any]) -> dict[str, Any]:
    """The attributes of such a Dataset. scene : the YAML text that was computed; of windows that of the sweep"""
    return {"kind": kind, "title": f"vibro_sweep: {title}", "scene": scene, "sweep_dimensions": [], **attributes}


def columns_in_file(
    kind: str, parameters: list[str], system: Oscillator, more: tuple[Quantity, ...] = ()
) -> list[Quantity]:
    """All variables of a file, and more, in the units of a system."""
    of_each = {name: system.described[name].units for name in parameters}
    first, *others = of_each.values()
    common = {OF_FIRST: first, OF_PARAMETER: first if all(other == first for other in others) else "1"}

    def unit(column: Quantity) -> str:
        return unit_in(of_each.get(column.name) or common.get(column.units, column.units), system.units)

    return [replace(column, units=unit(column)) for column in (*columns(kind, parameters, system.masses), *more)]


def dataset(attributes: Mapping[str, Any], of: Iterable[Quantity], arrays: Mapping[str, np.ndarray]) -> xarray.Dataset:
    """The Dataset of columns, with their arrays by name."""
    return xarray.Dataset(
        {x.name: (x.dimensions, np.asarray(arrays[x.name], x.dtype), described(x, x.units)) for x in of},
        attrs=dict(attributes),
    )


def described_points(columns: Iterable[Quantity], points: xarray.Dataset) -> xarray.Dataset:
    """Points of a branch or a curve with the words and units of their columns."""
    for column in columns:
        if column.name in points.variables:
            points[column.name].attrs.update(described(column, column.units))
    return points


def check(data: xarray.Dataset) -> None:
    """Raise ValueError for branches, windows or curves that do not hold what such a Dataset must: columns, lengths,
    indices, codes."""
    kind = data.attrs.get("kind")
    if kind not in RAGGED_KINDS:
        raise ValueError(f"its kind {shown(kind)} is unknown")
    names = [str(name) for name in np.atleast_1d(data.attrs.get("parameters", []))]
    lengths = {str(name): size for name, size in data.sizes.items()}
    optional = (*OF_EDGES, *OF_CONTACTS)  # of curves of a plane, and of branches where contacts are observed
    for column in (*columns(kind, names, lengths.get("multiplier", 0) // 2), *optional):
        if column.name in data:
            _check_column(column, data[column.name].variable, lengths)
        elif column not in optional:
            raise ValueError(f"`{cut(column.name)}` is missing")
    for dimension, counts in RAGGED.items():
        if dimension in lengths and all(name in data for name in counts):
            numbers = np.prod([data[name].values.astype(np.int64) for name in counts], axis=0)
            if np.any(numbers < 0) or numbers.sum() != lengths[dimension]:
                raise ValueError(f"its variables do not fit together: {', '.join(counts)} and `{dimension}`")


def _check_column(column: Quantity, variable: xarray.Variable, lengths: Mapping[str, int]) -> None:
    if variable.dtype.kind not in "if":
        raise ValueError(f"`{column.name}` holds no numbers")
    if variable.dims != column.dimensions:
        raise ValueError(f"its variables do not fit together: `{column.name}` and its dimensions")
    limits = column.limits(lengths)
    if limits is None:
        return
    least, most = limits
    wrong = variable.values[~((variable.values >= least) & (variable.values <= most))]
    if wrong.size:
        raise ValueError(f"`{column.name}` has {wrong.flat[0]}; it must be from {least} to {most}")
