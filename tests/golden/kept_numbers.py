"""Numbers of a case, in tables, as they are kept in its record: each with how far it may lie from there.

A case gives `words`, which have to be the same, and `tables` of numbers, of which the record has the first rows.
"""

from typing import NamedTuple

import numpy as np

from golden import units


class Table(NamedTuple):
    """rows : (n, m). scale : the size of each number, an array of a shape that broadcasts to rows"""

    rows: np.ndarray
    scale: np.ndarray


def sizes(rows: np.ndarray, kinds: str) -> np.ndarray:
    """The largest finite number in the columns of the same kind, (m,), for the letters `kinds` of the m columns."""
    finite = np.where(np.isfinite(rows), np.abs(rows), 0.0)
    largest = finite.max(axis=0, initial=0.0)
    letters = np.array(list(kinds))
    return np.array([largest[letters == letter].max() for letter in letters])


def table(rows, kinds: str) -> Table:
    """Numbers whose size is the largest of their kind."""
    rows = np.asarray(rows, float).reshape(-1, len(kinds))
    return Table(rows, sizes(rows, kinds))


def inputs_of(record: dict) -> dict:
    """The numbers that a case is computed from: the oscillator and its state, or states."""
    return record["system"] | {name: record[name] for name in ("state", "states") if name in record}


def with_inputs(record: dict, inputs: dict) -> dict:
    """The case beside `record` that has these numbers."""
    inputs = dict(inputs)
    states = {name: inputs.pop(name) for name in ("state", "states") if name in inputs}
    return record | states | {"system": inputs}


def differences(stored: dict, words: dict, tables: dict[str, Table]) -> list[str]:
    """Between what a record has and what is computed now, in words; none: []."""
    changed = [name for name, was in stored["words"].items() if words[name] != was]
    lines = [f"{name}: {stored['words'][name]!r}, now {words[name]!r}" for name in changed]
    for name, kept in stored["tables"].items():
        lines += _of_table(name, kept, tables[name].rows) if name in tables else [f"{name}: none now"]
    return lines


def _of_table(name: str, kept: dict, now: np.ndarray) -> list[str]:
    count = len(kept["rows"])
    if len(now) < count or (kept["whole"] and len(now) != count):
        return [f"{name}: {count} rows{'' if kept['whole'] else ' or more'}, now {len(now)}"]
    was, now = np.asarray(kept["rows"], float), now[:count]
    if was.size and was.shape != now.shape:
        return [f"{name}: {was.shape[1]} columns, now {now.shape[1]}"]
    allowed = np.broadcast_to(np.asarray(kept["allowed"], float), was.shape)
    different = units.apart(was, now, allowed)
    if not len(different):
        return []
    row, column = np.unravel_index(different[0], was.shape)
    at = int(row), int(column)
    return [
        f"{name}: {len(different)} numbers of {was.size}, first in row {row}, column {column}:"
        f" {float(was[at])!r}, now {float(now[at])!r}, allowed {allowed[at]:.1e}"
    ]


def count(record: dict) -> int:
    """How many numbers a record has."""
    return sum(np.size(kept["rows"]) for kept in record["result"]["tables"].values())
