"""Whether a piece that an interrupted run has kept is what a worker returns: others can edit a part, checksums and all.

A piece that is not usable is computed again.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from vibro_sweep.analysis.branches import branch_arrays as branches
from vibro_sweep.analysis.branches import seeds
from vibro_sweep.analysis.curves import curve_arrays as curves
from vibro_sweep.tables.file_columns import CHART, WINDOWS, columns
from vibro_sweep.tables.outcomes import EDGES, REASONS
from vibro_sweep.tables.quantity import Quantity

Arrays = Mapping[str, np.ndarray]


def is_window(piece: Arrays) -> bool:
    """Whether a piece is a result of `window_of`: a branch, or the reason why there is none."""
    if set(piece) == {"reason"}:
        return piece["reason"].shape == () and 0 <= piece["reason"] < len(REASONS)
    return _fits(piece, branches.SHAPES, columns(WINDOWS, [], 0))


def is_branch(piece: Arrays) -> bool:
    """Whether a piece is a result of `compute_branch`."""
    shapes = branches.SHAPES | seeds.SHAPES | {"n m 2N": "section"}
    return _fits(piece, shapes, columns(WINDOWS, [], 0)) and seeds.fit_together(piece)


def is_curve(piece: Arrays) -> bool:
    """Whether a piece is a result of `compute_curve`; it is empty where there is no curve."""
    return not piece or (
        _fits(piece, curves.SHAPES | seeds.SHAPES, columns(CHART, [], 0)) and seeds.fit_together(piece)
    )


def is_probe(piece: Arrays) -> bool:
    """Whether a piece is a result of `probe`."""
    shapes = seeds.SHAPES | {"": "reason"}
    return _fits(piece, shapes, []) and 0 <= piece["reason"] < len(EDGES) and seeds.fit_together(piece)


def _fits(piece: Arrays, shapes: Mapping[str, str], known: Iterable[Quantity]) -> bool:
    """Whether a piece has these arrays and no others, of lengths that agree, and indices and codes that there are."""
    lengths = {"2": 2, "4": 4}
    names = {name: dimensions.split() for dimensions, words in shapes.items() for name in words.split()}
    if set(piece) != set(names):
        return False
    for name, dimensions in names.items():
        if piece[name].ndim != len(dimensions):
            return False
        for dimension, length in zip(dimensions, piece[name].shape, strict=True):
            if lengths.setdefault(dimension, length) != length:
                return False
    counts = {"point": lengths.get("n", 0), "special": lengths.get("s", 0)}
    return all(column.holds(piece[column.name], counts) for column in known if column.name in piece)
