"""`vibro-sweep table`: what a file holds as rows of numbers with commas between them, in the units that are shown."""

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import cut
from vibro_sweep.cli.ragged_tables import itineraries
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.opening import open_file
from vibro_sweep.files.reading import open_whole, sweep_in
from vibro_sweep.results.declared_units import display_in, shown_dataset
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.tables.file_columns import CHART, SWEEP, WINDOWS
from vibro_sweep.tables.outcomes import NOT_COMPUTED
from vibro_sweep.tables.units import Display, shown_unit

OF_ROWS = {WINDOWS: "window", CHART: "point"}  # the dimension of the rows of a file; of branches their points


def table_of(path: Path, names: Sequence[str], display: Display | None) -> str:
    """The table of a file. Raises StoreError.

    Of a sweep a row for each orbit that is computed; of variables that have several numbers, as section points, a row
    for each of them, where they are named. Of branches and curves a row for each point, of windows for each window.
    """
    with open_file(path) as data:
        kind = data.attrs["kind"]
    try:
        if kind == SWEEP:
            with sweep_in(path, computes=False, display=display) as sweep:
                return _csv(_of_sweep(sweep, names))
        with open_whole(path) as data:
            shown = shown_dataset(data, display_in(data) if display is None else display)
            return _csv(_of_ragged(shown, OF_ROWS.get(kind, "point"), names))
    except ArgumentError as error:
        raise StoreError(f"{path}: {error}") from None


def _csv(rows: Iterator[Sequence[object]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def _of_sweep(sweep: Sweep, names: Sequence[str]) -> Iterator[Sequence[object]]:
    starts = "start" in sweep.dims("status")
    lead = (*sweep.keys, *(["start"] if starts else []))
    own = {name: sweep.dims(name)[len(lead) :] for name in sweep.names}
    chosen = list(names) or [name for name, dimensions in own.items() if not dimensions]
    for name in chosen:
        if name not in own:
            raise ArgumentError(f"--variable {cut(name)}: there are {', '.join(own)}")
    inner = {own[name] for name in chosen if own[name]}
    if len(inner) > 1:
        raise ArgumentError(f"--variable: {', '.join(chosen)} have different dimensions; name those of one kind")
    more = next(iter(inner), ())
    yield [
        *(_head(name, sweep.unit(name)) for name in lead),
        *more,
        *(_head(name, sweep.unit(name)) for name in chosen),
    ]
    axes = {name: sweep.data["start"].values if name == "start" else sweep.values(name) for name in lead}
    inner_axes = [sweep.data[name].values for name in more]
    values = {name: _in_words(sweep.values(name), sweep.data[name].attrs) for name in chosen}
    for place in np.argwhere(sweep.values("status") != NOT_COMPUTED):
        at = tuple(place.tolist())
        row = [axes[name][i] for name, i in zip(lead, at, strict=True)]
        for index in np.ndindex(*(len(axis) for axis in inner_axes)):
            numbers = [values[name][at + index if own[name] else at] for name in chosen]
            if not more or any(number == number for number in numbers):  # section points that there are not
                yield [*row, *(axis[i] for axis, i in zip(inner_axes, index, strict=True)), *numbers]


def _of_ragged(data: xarray.Dataset, dimension: str, names: Sequence[str]) -> Iterator[Sequence[object]]:
    known = [str(name) for name, variable in data.data_vars.items() if variable.dims[:1] == (dimension,)]
    chosen = list(names) or known
    for name in chosen:
        if name not in known:
            raise ArgumentError(f"--variable {cut(name)}: there are {', '.join(known)}")
    head, columns = [], []
    if dimension == "point":
        head, columns = ["branch"], [np.repeat(np.arange(data.sizes["branch"]), data["branch_row_size"].values)]
    for name in chosen:
        variable = data[name]
        values = _in_words(variable.values, variable.attrs).reshape(len(variable), -1)
        unit = variable.attrs.get("units")
        several = values.shape[1] > 1
        head += [_head(f"{name}_{i + 1}" if several else name, unit) for i in range(values.shape[1])]
        columns += list(values.T)
        if name in ("window_lower", "window_upper"):  # the special points at the ends
            head.append(f"{name}_type")
            columns.append(_in_words(data["special_type"].values, data["special_type"].attrs)[variable.values])
        elif name == "window_branch":
            head.append("impacts")
            columns.append(np.array(itineraries(data), object)[variable.values])
    yield head
    yield from zip(*columns, strict=True)


def _in_words(values: np.ndarray, attributes: Mapping[str, Any]) -> np.ndarray:
    """Codes as the words that they stand for; other numbers as they are."""
    if "flag_meanings" not in attributes:
        return values
    codes, words = np.atleast_1d(attributes["flag_values"]).tolist(), str(attributes["flag_meanings"]).split()
    known = dict(zip(codes, words, strict=False))
    return np.array([known.get(code, code) for code in values.ravel().tolist()], object).reshape(values.shape)


def _head(name: str, unit: str | None) -> str:
    return f"{name}{shown_unit(unit)}"
