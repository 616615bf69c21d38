"""Whether the multipliers that cross the unit circle between two points belong to the bifurcations found there."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.periodic.solution import NO_SPEED
from vibro_sweep.engine.continuation.branch_tests import FAR_OUTSIDE
from vibro_sweep.engine.impulses.pairs import ON_PAIR, ON_SQUARE, exchanged, keeps_side
from vibro_sweep.tables.bifurcations import BY_NAME

PRODUCT_ONE = 1e-6  # of a product of two multipliers: within it, it is 1
COMPLEX = 1e-9  # imaginary part of a multiplier that is not real
MEET = (2, 0, 1), (0, 2, 1)  # two real ones of one sign that become a pair, or the reverse: above, below, pairs


class Counts(NamedTuple):
    """Multipliers outside of the unit circle."""

    above: int  # real, > 1
    below: int  # real, < -1
    pairs: int  # complex
    on_circle: int  # to rounding: neither in nor out
    squares: np.ndarray  # |mu|^2 of those outside, in order


def counts_of(point: Point) -> Counts:
    mu = point.solution.multipliers
    squares = np.abs(mu) ** 2
    real = mu.imag == 0
    on = np.abs(squares - 1) < np.where(real, ON_SQUARE, ON_PAIR)
    out = (squares > 1) & ~on
    above, below, others = (
        int(np.sum(out & of_kind)) for of_kind in (real & (mu.real > 0), real & (mu.real < 0), ~real)
    )
    return Counts(above, below, others // 2, int(on.sum()), np.sort(squares[out]))


def explained(a: Point, b: Point, types: list[str]) -> bool:
    """Whether at most one bifurcation, or none, explains how the counts differ from a to b.

    A fold takes one multiplier through 1, a flip or pitchfork one through -1, a Neimark-Sacker point one pair. Two real
    ones of one sign may become a pair, or the reverse, which happens outside where all of them stay far from the
    circle. Without losses pairs move along the circle: nothing is known of them.
    """
    x, y = counts_of(a), counts_of(b)
    change = tuple(abs(np.subtract(y[:3], x[:3])).tolist())
    crossed = tuple(sum(BY_NAME[kind].crosses[i] for kind in types) for i in range(3))
    if x.on_circle != y.on_circle or a.solution.torus == 1.0:
        return all((one - other) % 2 == 0 for one, other in zip(change[:2], crossed[:2], strict=True))
    if exchanged(_parts(a), _parts(b)):  # a pair goes out and another one comes in: counts do not tell
        return False
    if change == crossed:
        return True
    met = change in MEET and not types
    return met and len(x.squares) == len(y.squares) and _far_outside(x.squares, y.squares)


def stands_alone(a: Point, b: Point, point: Point, kind: str) -> bool:
    """Whether a bifurcation between a and b explains how the multipliers outside differ from those at a and at b.

    Those that cross there are on the circle, and outside on one side. A pair that leaves, becomes two real ones, and
    comes back by a flip looks from a to b like a flip alone, but not at the flip.
    """
    x, at, y = counts_of(a), counts_of(point), counts_of(b)
    crossing = BY_NAME[kind].crosses
    if x.on_circle or y.on_circle or at.on_circle != np.dot(crossing, (1, 1, 2)) or a.solution.torus == 1.0:
        return True
    if crossing[2] and keeps_side(*map(_parts, (point, a, b))):
        return False
    for side in (x, y):
        more = np.subtract(side[:3], at[:3])
        changes = [tuple(np.abs(more - moved).tolist()) for moved in ((0, 0, 0), crossing)]
        if not any(change in ((0, 0, 0), *MEET) for change in changes):
            return False
    return True


def _parts(point: Point) -> np.ndarray:
    """(n, 2) real and imaginary parts of multipliers, as the compiled steps see them."""
    mu = point.solution.multipliers
    return np.stack([mu.real, mu.imag], axis=1)


def _far_outside(before: np.ndarray, behind: np.ndarray) -> bool:
    """Whether multipliers stay outside: all are far from the circle, or nearer to it than they move."""
    least = min(before[0], behind[0]) - 1
    return bool(least > FAR_OUTSIDE or np.abs(before - behind).max() < 0.5 * least)


def is_torus(point: Point) -> bool:
    """Whether two multipliers with product 1 are a complex pair; else it is a neutral saddle, or a pole at a graze.

    At the graze itself an undamped mode has such a pair for any parameter: nothing is born there.
    """
    s = point.solution
    mu = s.multipliers
    if np.any(s.pushes < NO_SPEED * s.family.linear.omega * s.size_of_gap):
        return False
    one, other = nearest_pair(mu)
    return abs(1 - one * other) < PRODUCT_ONE and abs(one.imag) > COMPLEX


def nearest_pair(mu: np.ndarray) -> tuple[complex, complex]:
    """The two multipliers whose product is nearest to 1, NaN where fewer than two are finite; beside a graze one may be
    infinite and another one 0."""
    finite = mu[np.isfinite(mu)]
    if len(finite) < 2:
        return complex(np.nan), complex(np.nan)
    i, j = np.triu_indices(len(finite), 1)
    k = np.argmin(np.abs(1 - finite[i] * finite[j]))
    return finite[i[k]], finite[j[k]]
