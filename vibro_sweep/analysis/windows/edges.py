"""Edges of the regions of a plane: pairs of neighbouring points whose orbits have different periods, and curves that
pass between the two."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.flat import Flat
from vibro_sweep.model.bifurcations import BY_NAME, CURVES

SLACK = 0.25  # of a cell: curves are drawn by chords


class Plane(NamedTuple):
    """A sweep over two numbers: values by rising order, (n,) and (m,); period, 0 where there is none, (n, m)."""

    values: tuple[np.ndarray, np.ndarray]
    period: np.ndarray


class Edges(NamedTuple):
    """place : (edges, 2) indices of the point with the smaller value
    axis : (edges,) 0 or 1, along which the other one lies
    periods : (edges, 2) of both
    """

    place: np.ndarray
    axis: np.ndarray
    periods: np.ndarray


def ends_of(plane: Plane, edges: Edges) -> tuple[np.ndarray, np.ndarray]:
    """(edges, 2) twice: both numbers at the two points of each edge."""
    other = edges.place.copy()
    other[np.arange(len(other)), edges.axis] += 1
    one, other = (np.column_stack([plane.values[j][at[:, j]] for j in (0, 1)]) for at in (edges.place, other))
    return one, other


def edges_of(plane: Plane) -> Edges:
    """All edges of a plane, those along the first number first."""
    found = []
    for axis in (0, 1):
        one, other = (np.take(plane.period, range(a, plane.period.shape[axis] - 1 + a), axis) for a in (0, 1))
        place = np.argwhere(one != other)
        found.append((place, np.full(len(place), axis), np.column_stack([one[one != other], other[one != other]])))
    return Edges(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def passing(plane: Plane, edges: Edges, flat: Flat) -> np.ndarray:
    """Indices of the edges between whose points a curve passes that can be their reason.

    It has no unstable multiplier there but its own, and the period of one of the two orbits; of a flip the doubled one
    as well.
    """
    period, at = int(flat["branch_period"]), flat["value"]
    own = [period, 2 * period] if BY_NAME[CURVES[int(flat["branch_type"])]].beyond == "doubled" else [period]
    able = np.isin(edges.periods, own).any(axis=1)
    bounds = flat["unstable"] == 0
    pieces = np.flatnonzero(bounds[:-1] | bounds[1:])
    result = []
    for axis in (0, 1):
        across, along = plane.values[1 - axis], plane.values[axis]
        wanted = np.flatnonzero(able & (edges.axis == axis))
        if not len(wanted) or not len(pieces):
            continue
        crossed: dict[int, list[float]] = {}
        for i in pieces.tolist():
            (u, level), (v, other) = ((at[k, axis], at[k, 1 - axis]) for k in (i, i + 1))
            lo, hi = np.searchsorted(across, sorted((level, other)))
            for line in range(lo, hi):
                crossed.setdefault(line, []).append(u + (v - u) * (across[line] - level) / (other - level))
        lines, starts = edges.place[wanted, 1 - axis], along[edges.place[wanted, axis]]
        size = along[edges.place[wanted, axis] + 1] - starts
        for edge, line, start, length in zip(wanted.tolist(), lines.tolist(), starts, size, strict=True):
            where = (np.array(crossed.get(line, ())) - start) / length
            if np.any((where >= -SLACK) & (where <= 1 + SLACK)):
                result.append(edge)
    return np.array(result, int)
