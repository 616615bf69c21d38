"""Pairs of multipliers from point to point, as the compiled steps see them (engine/impulses/pairs.py)."""

import numpy as np

from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.engine.impulses import pairs


def exchanged(a: Point, b: Point) -> bool:
    """Whether a pair goes out of the unit circle and another one comes in from a to b: counts do not tell."""
    return pairs.exchanged(_parts(a), _parts(b))


def keeps_side(point: Point, a: Point, b: Point) -> bool:
    """Whether a pair on the unit circle at a point lies on one side of it at a and at b."""
    return pairs.keeps_side(_parts(point), _parts(a), _parts(b))


def _parts(point: Point) -> np.ndarray:
    mu = point.solution.multipliers
    return np.stack([mu.real, mu.imag], axis=1)
