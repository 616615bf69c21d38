"""Pairs of multipliers from point to point, as the compiled steps see them (engine/impulses/pairs.py)."""

from itertools import pairwise

import numpy as np

from vibro_sweep.analysis.branches.walk import Point, along
from vibro_sweep.engine.impulses import pairs


def coarse(before: Point | None, a: Point, b: Point) -> bool:
    """Whether a step is too long to tell if a pair of multipliers crosses the unit circle twice from a to b."""
    known = [point for point in (before, a, b) if point is not None]
    lengths = [along(x, y) for x, y in pairwise(known)]
    return pairs.coarse(_parts(before or a), _parts(a), _parts(b), lengths[0] if before else 0.0, lengths[-1])


def exchanged(a: Point, b: Point) -> bool:
    """Whether a pair goes out of the unit circle and another one comes in from a to b: counts do not tell."""
    return pairs.exchanged(_parts(a), _parts(b))


def keeps_side(point: Point, a: Point, b: Point) -> bool:
    """Whether a pair on the unit circle at a point lies on one side of it at a and at b."""
    return pairs.keeps_side(_parts(point), _parts(a), _parts(b))


def _parts(point: Point) -> np.ndarray:
    mu = point.solution.multipliers
    return np.stack([mu.real, mu.imag], axis=1)
