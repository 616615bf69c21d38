"""Measured points over a diagram or a plane: columns of a CSV file, or of a caller's, by the names of numbers."""

import csv
import re
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from vibro_sweep.checks.file_names import checked_path, read_bytes
from vibro_sweep.checks.meant import meant
from vibro_sweep.checks.real import array_of
from vibro_sweep.checks.refusals import cut, not_allowed
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.units import ratio, unit_text

MOST = 10**7  # bytes of a file
STYLE = {"ls": "none", "marker": "o", "mfc": "none", "mec": "#c2187a", "mew": 0.9, "ms": 4.5, "zorder": 6}
_HEADED = re.compile(r"([\w*]+)\s*(?:\[(.*)\]|\((.*)\))?")  # frequency [Hz]


class Measured:
    """Columns by name, of one length; each with its unit where its head says one."""

    def __init__(
        self, name: str, columns: Mapping[str, np.ndarray], units: Mapping[str, str], wrong: Mapping[str, str]
    ):
        self.name, self.columns, self.units = name, columns, units
        self._wrong = wrong  # of columns that are no numbers, as remarks: the first that is none

    def __contains__(self, name: str) -> bool:
        return name in self.columns or (name in _OTHER and _OTHER[name] in self.columns)

    def values(self, name: str, unit: str | None) -> np.ndarray:
        """A column in the unit of the picture; omega from a frequency, and the other way round. Raises PlotError."""
        key = name if name in self.columns else _OTHER[name]
        if key in self._wrong:
            raise PlotError(f"points: {self.name}{self._wrong[key]} is not a number")
        values, written = self.columns[key], self.units.get(key)
        if key != name:  # numbers without a unit of their own are in cycles, or in radians, per unit of time
            values = values * (2 * np.pi if name == FREQUENCY.name else 1 / (2 * np.pi))
        elif written is not None and unit is not None:
            factor = ratio(written, unit)
            if factor is None:
                shown = unit_text(unit) or "no unit"
                raise PlotError(
                    f"points: {self.name} has {key} in {written}; it must be in {shown}, or a multiple of it"
                )
            values = values * factor
        return values


_OTHER = {FREQUENCY.name: CYCLES.name, CYCLES.name: FREQUENCY.name}


def measured(points: object) -> Measured:
    """The columns of a file's path, or of a mapping or table of columns. Raises PlotError."""
    if isinstance(points, (str, Path)):
        return _of_file(checked_path("points", points))
    try:
        items = [(str(head), column) for head, column in points.items()]
    except Exception:  # no table, or something that only looks like one
        text = not_allowed("points", points, "the path of a CSV file, or columns by their names")
        raise PlotError(text) from None
    columns, units = {}, {}
    for head, column in items:
        name, unit = _name_and_unit(head)
        if name in columns:
            raise PlotError(f"points: there are two columns {cut(name)}")
        values = array_of(column if not hasattr(column, "to_numpy") else column.to_numpy(), 1)
        if values is None:
            raise PlotError(f"points: the column {cut(name)} holds other things than numbers")
        columns[name] = values
        units |= {name: unit} if unit else {}
    return _checked("points", columns, units)


def _of_file(path: Path) -> Measured:
    raw = read_bytes(path, MOST + 1)
    if len(raw) > MOST:
        raise PlotError(f"points: {path} must be a file of {MOST:.0e} bytes at most")
    text = raw.decode("utf-8-sig", errors="replace")
    written = _from_head_on(text.splitlines())
    sample = next((line for line in written if line.strip()), "")
    delimiter = max(",;\t", key=sample.count)
    reader, rows, lines = csv.reader(written, delimiter=delimiter), [], []
    try:
        for row in reader:
            if any(map(str.strip, row)) and not (rows and row[0].lstrip().startswith("#")):
                rows.append(row)
                lines.append(reader.line_num)
    except csv.Error as error:
        raise PlotError(f"points: {path}: {error}") from None
    if len(rows) < 2:
        raise PlotError(f"points: {path} must have a line of names and a line for each point")
    names, units = zip(*map(_name_and_unit, rows[0]), strict=True)
    if twice := [name for name in names if name and names.count(name) > 1]:
        raise PlotError(f"points: {path} has two columns {cut(twice[0])}")
    numbers, wrong = np.full((len(rows) - 1, len(names)), np.nan), {}
    for i, row in enumerate(rows[1:]):
        if len(row) > len(names) and any(map(str.strip, row[len(names) :])):
            text = f"{len(row)} entries below {len(names)} names; numbers with decimal commas need ; between them"
            raise PlotError(f"points: {path}, line {lines[i + 1]}: {text}")
        for j, word in enumerate(row[: len(names)]):
            try:
                numbers[i, j] = float(word.replace(",", ".") if delimiter != "," else word)
            except ValueError:
                if word.strip():
                    wrong.setdefault(names[j], f", line {lines[i + 1]}: {cut(word)}")
    known = {name: unit for name, unit in zip(names, units, strict=True) if unit}
    return _checked(str(path), dict(zip(names, numbers.T, strict=True)), known, wrong)


def _from_head_on(lines: list[str]) -> list[str]:
    """The lines, those empty that stand before the names of columns: these are the first line without #, or the last
    one with it above numbers."""
    filled = [i for i, line in enumerate(lines) if line.strip()]
    without = next((n for n, i in enumerate(filled) if not lines[i].lstrip().startswith("#")), len(filled))
    numbers = without < len(filled) and re.match(r"\s*[-+.,\d]", lines[filled[without]])
    head = filled[without - 1 if numbers and without else without] if without < len(filled) else 0
    return ["" if i < head else line for i, line in enumerate(lines)]


def _name_and_unit(head: str) -> tuple[str, str]:
    match = _HEADED.fullmatch(head.strip().removeprefix("#").strip())
    return (match[1], match[2] or match[3] or "") if match else (head.strip(), "")


def _checked(
    name: str, columns: dict[str, np.ndarray], units: dict[str, str], wrong: Mapping[str, str] | None = None
) -> Measured:
    if len(columns) < 2 or len({len(values) for values in columns.values()}) > 1:
        raise PlotError(f"points: {name} must have two columns at least, of one length, with names as frequency and x1")
    if _OTHER.keys() <= columns.keys():
        raise PlotError(f"points: {name} must have one of the columns {' and '.join(_OTHER)}")
    return Measured(name, columns, units, wrong or {})


def check_drawn(points: Measured | None, axes: list[Any], names: Collection[str]) -> None:
    """Raise PlotError where measured points are given and no panel has axes for them; names : those that axes have."""
    if points is None or any(line.get_gid() == "measured" for ax in axes for line in ax.lines):
        return
    unknown = next((name for name in points.columns if name not in names), "")
    likely = meant(unknown, names)
    hint = f"; did you mean `{likely}` by {cut(unknown)}?" if likely and likely not in points.columns else ""
    columns = ", ".join(map(cut, points.columns))
    raise PlotError(f"points: {points.name} has the columns {columns}; axes here are {', '.join(names)}{hint}")


def draw_measured(ax: Any, points: Measured | None, x: tuple[str, str | None], y: tuple[str, str | None]) -> bool:
    """Mark the points in axes of two numbers, each a name and its unit, where there are columns of both. Whether there
    are."""
    if points is None or x[0] not in points or y[0] not in points:
        return False
    frame = ax.get_xlim(), ax.get_ylim()
    places = points.values(*x), points.values(*y)
    if not (np.isfinite(places).all(axis=0) & (min(frame[0]) <= places[0]) & (places[0] <= max(frame[0]))).any():
        ends = " to ".join(f"{end:.6g}" for end in frame[0])
        text = f"no point lies within the axis of {x[0]}, {ends} {unit_text(x[1])}".rstrip()
        raise PlotError(f"points: {points.name}: {text}")
    ax.plot(*places, label="measured", gid="measured", **STYLE)
    low, high = np.nanmin(places[1], initial=frame[1][0]), np.nanmax(places[1], initial=frame[1][1])
    room = 0.02 * (high - low)
    ax.set_xlim(frame[0])
    ax.set_ylim(low - room if low < frame[1][0] else frame[1][0], high + room if high > frame[1][1] else frame[1][1])
    return True
