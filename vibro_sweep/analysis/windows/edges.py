"""Edges of the regions of a plane: pairs of neighbouring points whose orbits have different periods, and curves that
pass between the two."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import Arrays
from vibro_sweep.tables.bifurcations import BY_NAME, CURVES

SLACK = 0.25  # of a cell: curves are drawn by chords


class Plane(NamedTuple):
    """A sweep over two numbers: values by rising order, (n,) and (m,); period, 0 where there is none, (n, m)."""

    values: tuple[np.ndarray, np.ndarray]
    period: np.ndarray


class Edges(NamedTuple):
    """places : (edges, 2, 2) indices of both points, that with the smaller value first
    periods : (edges, 2) of both
    """

    places: np.ndarray
    periods: np.ndarray

    @property
    def axis(self) -> np.ndarray:
        """(edges,) 0 or 1, along which the points are neighbours."""
        return np.argmax(np.diff(self.places, axis=1)[:, 0], axis=1)


def ends_of(plane: Plane, edges: Edges) -> np.ndarray:
    """(edges, 2, 2) both numbers at the two points of each edge."""
    return np.stack([values[edges.places[..., j]] for j, values in enumerate(plane.values)], axis=-1)


def edges_of(plane: Plane) -> Edges:
    """All edges of a plane, those along the first number first."""
    found = []
    for axis, step in enumerate(np.eye(2, dtype=int)):
        first = np.argwhere(np.diff(plane.period, axis=axis))
        found.append(np.stack([first, first + step], axis=1))
    places = np.concatenate(found)
    return Edges(places, plane.period[places[..., 0], places[..., 1]])


def passing(plane: Plane, edges: Edges, arrays: Arrays) -> np.ndarray:
    """Indices of the edges between whose points a curve passes that can be their reason.

    It has no unstable multiplier there but its own, and the period of one of the two orbits; of a flip the doubled one
    as well.
    """
    period, at = int(arrays["branch_period"]), arrays["value"]
    own = [period, 2 * period] if BY_NAME[CURVES[int(arrays["branch_type"])]].beyond == "doubled" else [period]
    able = np.isin(edges.periods, own).any(axis=1)
    bounds = arrays["unstable"] == 0
    pieces = np.flatnonzero(bounds[:-1] | bounds[1:])
    result = []
    for axis in (0, 1):
        across, along = plane.values[1 - axis], plane.values[axis]
        wanted = np.flatnonzero(able & (edges.axis == axis))
        places = edges.places[wanted]
        if not len(wanted) or not len(pieces):
            continue
        crossed: dict[int, list[float]] = {}
        for i in pieces.tolist():
            (u, level), (v, other) = ((at[k, axis], at[k, 1 - axis]) for k in (i, i + 1))
            lo, hi = np.searchsorted(across, sorted((level, other)))
            for line in range(lo, hi):
                crossed.setdefault(line, []).append(u + (v - u) * (across[line] - level) / (other - level))
        lines = places[:, 0, 1 - axis].tolist()
        for edge, line, (start, end) in zip(wanted.tolist(), lines, along[places[..., axis]], strict=True):
            where = (np.array(crossed.get(line, ())) - start) / (end - start)
            if np.any((where >= -SLACK) & (where <= 1 + SLACK)):
                result.append(edge)
    return np.array(result, int)
