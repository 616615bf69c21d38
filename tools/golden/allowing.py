"""What a record keeps of the tables of a case: numbers as long as they mean something, each with its allowance."""

import numpy as np
from golden import units
from golden.kept_numbers import Table, inputs_of, with_inputs

MEANINGLESS = 1e-6  # part of its size by which a number may lie from its record at most
WIDER = 1e-9  # of its size, the least allowance where processors differ


def result_of(record: dict, computed, rows: dict[str, int], moves: int, rng) -> dict:
    """Words and tables, as many rows of each as `rows` says at most; `computed` gives them for a record.

    moves : how many of the numbers of the oscillator and its state are moved at most
    """
    words, tables = computed(record)
    beside = list(_beside(record, computed, moves, rng))
    least = WIDER if "wider" in record else units.LEAST
    return {
        "words": {name: word for name, word in words.items() if all(other[name] == word for other, _ in beside)},
        "tables": {
            name: _kept(table, [other[name] for _, other in beside if name in other], rows[name], least)
            for name, table in tables.items()
        },
    }


def _beside(record: dict, computed, moves: int, rng):
    """What is computed for some of the oscillators beside; left out those that are refused, such as R > 1."""
    moved = list(units.moved_inputs(inputs_of(record)))
    for k in rng.permutation(len(moved))[:moves]:
        try:
            yield computed(with_inputs(record, moved[k]))
        except ValueError:
            continue


def _kept(table: Table, beside: list[Table], most: int, least: float) -> dict:
    """The first rows, up to one of which a number moves far where the oscillator is moved."""
    lengths = [len(table.rows), *(len(other.rows) for other in beside)]
    count = min(*lengths, most)
    rows, scale = table.rows[:count], np.broadcast_to(table.scale, table.rows.shape)[:count]
    finite = np.isfinite(rows)
    values = np.where(finite, rows, 0.0)
    allowed = units.allowances(values, [_moved(rows, other.rows[:count]) for other in beside], scale)
    allowed = np.maximum(allowed, least * scale)
    meant = np.all(allowed <= MEANINGLESS * scale, axis=1)
    count = int(np.argmin(meant)) if not meant.all() else count
    return {
        "rows": rows[:count].tolist(),
        "allowed": [[_upwards(one) for one in row] for row in allowed[:count]],
        "whole": set(lengths) == {count},
    }


def _moved(rows: np.ndarray, other: np.ndarray) -> np.ndarray:
    """`other`, with 0 where both are the same infinity or no number, and NaN where one of them is."""
    same = (rows == other) | (np.isnan(rows) & np.isnan(other))
    values = np.where(np.isfinite(rows) & np.isfinite(other), other, np.nan)
    return np.where(same & ~np.isfinite(rows), 0.0, values)


def _upwards(number: float) -> float:
    """Two digits of a number, not below it."""
    return float(f"{1.05 * number:.1e}")
