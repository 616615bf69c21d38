"""The first contact with a stop, certified.

Within a cell x1 is its Taylor polynomial (remainder below rounding), so the gap to a stop is a polynomial g too.
From any point where g > 0 a parabola with the smallest possible second derivative stays below g, hence the first root
of the parabola is never beyond the first root of g: stepping from root to root cannot pass a contact, however brief.

Claim. Let m = ROUNDING * (g(0) + |c_1| u + |c_2| u^2) be the rounding of the evaluation of g at u. A contact after
which g falls below -m is never missed; where g stays above m no contact is reported. In between the flight is within
rounding of a graze, and either answer is right. On a simple root the steps converge cubically; near a graze, where
Newton's method crawls, the parabola is exact to third order and decides in a few steps.
"""

import math

import numpy as np

from vibro_sweep.kernels.flight import ORDER
from vibro_sweep.kernels.jit import jit

ROUNDING = 4.0 * 2.0**-52
STEPS = 200


@jit
def parabola_root(gap, rate, curve):
    """First d > 0 with gap + rate d + curve d^2/2 = 0, for gap >= 0; infinite where there is none."""
    square = rate * rate - 2.0 * curve * gap
    if square < 0.0:
        return np.inf
    root = math.sqrt(square)
    if rate < 0.0:
        return 2.0 * gap / (root - rate)
    if curve < 0.0:
        return (rate + root) / -curve
    return np.inf


@jit
def first_contact(c, gap, side, third, start, rest):
    """First u in (start, rest] at which x1 has moved by `gap` >= 0 towards the stop on `side` (+1, -1); infinite if
    none.

    c: Taylor coefficients of x1 at u = 0; gap 0 is a mass that just leaves the stop. third: bound on |d3 x1/du3| up to
    `rest`. start: the motion up to there is known to be free.
    """
    u = start
    for _ in range(STEPS):
        # Horner's scheme for p = sum c_n u^(n-1), p' and p''/2: x1 - c_0 = u p keeps its digits when u is tiny
        p, dp, ddp = c[ORDER - 1], 0.0, 0.0
        for n in range(ORDER - 2, 0, -1):
            ddp = ddp * u + dp
            dp = dp * u + p
            p = p * u + c[n]
        g = gap - side * (u * p)
        rate = -side * (p + u * dp)
        curve = -2.0 * side * (dp + u * ddp)
        if u > 0.0 and g <= ROUNDING * (gap + u * (abs(c[1]) + u * abs(c[2]))):
            if rate < 0.0:
                return u
            g = max(g, 0.0)
        left = rest - u
        d = parabola_root(g, rate, curve - third * left / 3.0)
        if d >= left:
            return np.inf
        reach = min(left, 1.25 * d)
        change = third * reach / 3.0
        d = min(parabola_root(g, rate, curve - change), reach)
        latest = parabola_root(g, rate, curve + change)
        u += d
        if latest <= reach and latest - d <= 2.0**-52 * u:
            return u
    return u
