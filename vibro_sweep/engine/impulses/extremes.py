"""Turning points of the gap on one cell of a flight, where it is a Taylor polynomial; certified by bounds."""

import math

import numpy as np

from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit

OVERLAP = 1.0 + 1e-9  # of cells, or a turning point between two of them could be lost to both
AT_REST = 2.0**-60  # of the distance from the stops: a gap that changes by less on a cell stays as it is
MIDDLE = 4  # value in the middle of a cell, and what three derivatives there change up to its ends


def middle_weights(width: float) -> tuple[np.ndarray, np.ndarray]:
    """(ORDER + 1, MIDDLE) and (ORDER + 1,): what the gap's Taylor coefficients c_k say about the middle r of a cell.

    gap(r + r x) = p_0 + p_1 x + p_2 x^2 + p_3 x^3 + ..., |x| <= 1: p_j = sum_k c_k weight_kj; and what follows is
    bounded, sum_k |c_k| weight_k >= r^4/24 max |fourth derivative|.
    """
    r, orders = 0.5 * OVERLAP * width, range(ORDER + 1)
    middle = [[math.comb(k, j) * r**k for j in range(MIDDLE)] for k in orders]
    rest = [math.comb(k, MIDDLE) * (2 * r) ** (k - MIDDLE) * r**MIDDLE if k >= MIDDLE else 0.0 for k in orders]
    return np.array(middle), np.array(rest)


@jit
def turns_near(value, slope, curve, jerk, rest, low, high, nearest):
    """Whether a turning point of the gap on a cell may be nearer to its stop than `nearest`, by the cell's middle.

    value, slope, curve, jerk: p_0 .. p_3 of `middle_weights`, rest: the bound. No where the slope exceeds all that the
    cell can take from it, or the cell is farther from both stops.
    """
    by_slope, by_curve, by_jerk = abs(slope), abs(curve), abs(jerk)
    if by_slope > 2.0 * by_curve + 3.0 * by_jerk + 4.0 * rest:
        return False
    change = by_slope + by_curve + by_jerk + rest
    return min(high - value, value - low) - change <= nearest


@jit
def value_of(c, u):
    p = c[ORDER]
    for n in range(ORDER - 1, -1, -1):
        p = p * u + c[n]
    return p


@jit
def slope_of(c, u):
    p = ORDER * c[ORDER]
    for n in range(ORDER - 1, 0, -1):
        p = p * u + n * c[n]
    return p


@jit
def curve_of(c, u):
    p = ORDER * (ORDER - 1) * c[ORDER]
    for n in range(ORDER - 1, 1, -1):
        p = p * u + n * (n - 1) * c[n]
    return p


@jit
def turning_point(c, a, b):
    """The zero of p' in [a, b], where p' is monotone and changes sign: bisection and Newton's method."""
    fa = slope_of(c, a)
    u = 0.5 * (a + b)
    for _ in range(100):
        f = slope_of(c, u)
        if f == 0.0:
            return u
        if (f > 0.0) == (fa > 0.0):
            a = u
        else:
            b = u
        d = curve_of(c, u)
        new = u - f / d if d != 0.0 else 0.5 * (a + b)
        if not (a < new < b):
            new = 0.5 * (a + b)
        if abs(new - u) <= 1e-16 * b:
            return new
        u = new
    return u


PIECES = 64  # intervals waiting in the subdivision of a cell


@jit
def extremes_of_cell(c, length, low, high, nearest, waiting):
    """Lower `nearest` (distance, u, side) to the least distance of a turning point of p on (0, length) from its stop.

    A maximum is compared with `high`, a minimum with `low`. Certified: an interval is left only where |p'| or |p''|
    exceeds a bound of what its change can be. An inflection that cannot be distinguished from a turning point counts as
    one. True if `nearest` was lowered.
    """
    bound, third, power = 0.0, 0.0, 1.0
    for n in range(1, ORDER + 1):
        bound += abs(c[n]) * power * length
        if n >= 3:
            third += n * (n - 1) * (n - 2) * abs(c[n]) * power / (length * length)
        power *= length
    if high - c[0] - bound > nearest[0] and c[0] - bound - low > nearest[0]:
        return False
    room = min(high - c[0], c[0] - low)
    if bound <= AT_REST * room:  # all derivatives are zero, or rounding
        if not room < nearest[0]:
            return False
        nearest[0], nearest[1], nearest[2] = room, 0.0, 1.0 if high - c[0] < c[0] - low else -1.0
        return True
    found = False
    waiting[0, 0], waiting[0, 1] = 0.0, length
    count = 1
    while count > 0:
        count -= 1
        a, b = waiting[count, 0], waiting[count, 1]
        middle, r = 0.5 * (a + b), 0.5 * (b - a)
        slope, curve = slope_of(c, middle), curve_of(c, middle)
        if abs(slope) > abs(curve) * r + 0.5 * third * r * r:
            continue
        monotone = abs(curve) > third * r
        if not monotone and r > 1e-9 * length and count < PIECES - 2:
            waiting[count, 0], waiting[count, 1] = a, middle
            waiting[count + 1, 0], waiting[count + 1, 1] = middle, b
            count += 2
            continue
        u = middle
        if monotone:
            if (high - c[0] if curve < 0.0 else c[0] - low) - bound >= nearest[0]:
                continue
            fa, fb = slope_of(c, a), slope_of(c, b)
            if not ((fa > 0.0 and fb <= 0.0) or (fa < 0.0 and fb >= 0.0)):
                continue
            u = turning_point(c, a, b)
        p = value_of(c, u)
        side = 1.0 if curve < 0.0 else -1.0
        distance = high - p if side > 0.0 else p - low
        if not monotone:
            side = 1.0 if high - p < p - low else -1.0
            distance = min(high - p, p - low)
        if distance < nearest[0]:
            nearest[0], nearest[1], nearest[2] = distance, u, side
            found = True
    return found
