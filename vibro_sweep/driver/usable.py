"""Whether a piece that an interrupted run has kept is what a worker returns: others can edit a part, checksums and all.

A piece that is none is computed again.
"""

import json
from collections.abc import Iterable, Mapping

import numpy as np

from vibro_sweep.analysis.branches import flat as branches
from vibro_sweep.analysis.curves import flat as curves
from vibro_sweep.model.bifurcations import EDGES, REASONS
from vibro_sweep.model.branch_file import CHART, WINDOWS, Column, columns

Arrays = Mapping[str, np.ndarray]
TEXT = {"bytes": "beyond"}  # JSON


def is_window(piece: Arrays) -> bool:
    """Of `window_of`: a branch, or the reason why there is none."""
    if set(piece) == {"reason"}:
        return piece["reason"].shape == () and 0 <= piece["reason"] < len(REASONS)
    return _fits(piece, branches.SHAPES, columns(WINDOWS, [], 0))


def is_branch(piece: Arrays) -> bool:
    """Of `grow`."""
    shapes = branches.SHAPES | {"n m 2N": "section"} | TEXT
    return _fits(piece, shapes, columns(WINDOWS, [], 0)) and _rows(piece["beyond"], 7)


def is_curve(piece: Arrays) -> bool:
    """Of `trace`; it returns no more than `beyond` where there is no curve."""
    if set(piece) == {"beyond"}:
        return piece["beyond"].size == 0
    return _fits(piece, curves.SHAPES | TEXT, columns(CHART, [], 0)) and _rows(piece["beyond"], 11)


def is_probe(piece: Arrays) -> bool:
    """Of `probe`."""
    told = _json(piece["answer"]) if set(piece) == {"answer"} else None
    if not (isinstance(told, list) and len(told) == 2 and told[0] in list(EDGES)):
        return False
    return told[1] is None or (isinstance(told[1], list) and len(told[1]) == 10)


def _fits(piece: Arrays, shapes: Mapping[str, str], known: Iterable[Column]) -> bool:
    """Whether a piece has these arrays and no others, of lengths that agree, and indices and codes that there are."""
    lengths = {"2": 2}
    names = {name: dimensions.split() for dimensions, words in shapes.items() for name in words.split()}
    if set(piece) != set(names):
        return False
    for name, dimensions in names.items():
        if piece[name].ndim != len(dimensions):
            return False
        for dimension, length in zip(dimensions, piece[name].shape, strict=True):
            if lengths.setdefault(dimension, length) != length:
                return False
    counts = {"point": lengths["n"], "special": lengths["s"]}
    return all(column.holds(piece[column.name], counts) for column in known if column.name in piece)


def _rows(text: np.ndarray, length: int) -> bool:
    """Whether a JSON text is a list of lists of this length."""
    found = _json(text) if text.size else []
    return isinstance(found, list) and all(isinstance(row, list) and len(row) == length for row in found)


def _json(text: np.ndarray) -> object:
    try:
        return json.loads(text.tobytes().decode())
    except (ValueError, RecursionError):
        return None
