"""Pairs of multipliers from point to point, as the compiled steps of engine/impulses/pairs.py see them."""

import numpy as np

from vibro_sweep.analysis.branches.walk import Point
from vibro_sweep.engine.impulses.pairs import BENT, ON_SQUARE


def bend(before: Point, a: Point, b: Point) -> bool:
    """Whether steps are too long to tell if a pair of multipliers crosses the unit circle twice from a to b."""
    y, x, z = beside_circle(a, before, b)
    one, other = (float((q.x - p.x) @ p.tangent) for p, q in ((before, a), (a, b)))
    side = np.sign(y)
    away = side * (z - y - (y - x) * other / one)  # from where it was heading
    return bool(np.any((side * z > 0) & (away > BENT * np.minimum(side * y, side * z))))


def exchanged(a: Point, b: Point) -> bool:
    """Whether a pair goes out of the unit circle and another one comes in from a to b: counts do not tell."""
    y, z = beside_circle(a, b)
    out, back = ((p < -ON_SQUARE) & (q > ON_SQUARE) for p, q in ((y, z), (z, y)))
    return bool(np.any(out) and np.any(back))


def beside_circle(point: Point, *others: Point) -> np.ndarray:
    """(points, pairs): (|mu|^2 - 1)/(|mu|^2 + 1) of the pairs of a point and of those most alike at other points; zero
    on the unit circle. Only of those that are pairs at all of them."""
    mu = point.solution.multipliers
    here = mu[mu.imag > 0]
    known = [other.solution.multipliers for other in others]
    if not len(here) or not all(map(len, known)):
        return np.zeros((1 + len(others), 0))
    found = np.array([here, *(there[np.abs(there - here[:, None]).argmin(axis=1)] for there in known)])
    square = np.abs(found[:, np.all(found.imag > 0, axis=0)]) ** 2
    return (square - 1) / (square + 1)
