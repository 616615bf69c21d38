"""The first contact with a stop, certified.

Within a cell x1 is its Taylor polynomial (remainder below rounding), so the gap to a stop is a polynomial g too.

From any point where g > 0 a parabola with the smallest possible second derivative stays below g, hence its first root
is never beyond the first root of g, and stepping from root to root cannot pass a contact, however brief. On a simple
root the steps converge cubically; near a graze, where Newton's method crawls, the parabola is exact to third order and
decides in a few steps. (Faster, where g is known to fall all the way to the root: `strike.descend`.)

Claim. Let m = ROUNDING * (g(0) + sum |c_n| u^n) be the rounding of the evaluation of g at u. A contact after which g
falls below -m is never missed; where g stays above m no contact is reported. In between the flight is within rounding
of a graze, and either answer is right. NaN, "it cannot be told", takes two near grazes that all but merge within a
cell; no flight of an oscillator has been seen to do that. Along an orbit g itself is known to rounding only: from one
section to the next, to 8 units in the last place of the largest term of x1.
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
    """First u in (start, rest] at which x1 has moved by `gap` >= 0 towards the stop on `side` (+1 or -1).

    Infinite if there is none, NaN if `STEPS` steps do not tell. c: Taylor coefficients of x1 at u = 0; gap 0 is a mass
    that just leaves the stop. third: bound on the third derivative up to `rest`. start: the motion up to there is known
    to be free.
    """
    u, length = start, rest - start
    for _ in range(STEPS):
        # Horner's scheme for p = sum c_n u^(n-1), p' and p''/2: x1 - c_0 = u p keeps its digits when u is tiny
        p, dp, ddp, size = c[ORDER - 1], 0.0, 0.0, abs(c[ORDER - 1])
        for n in range(ORDER - 2, 0, -1):
            ddp = ddp * u + dp
            dp = dp * u + p
            p = p * u + c[n]
            size = size * u + abs(c[n])
        g = gap - side * (u * p)
        rate = -side * (p + u * dp)
        curve = -2.0 * side * (dp + u * ddp)
        if u > 0.0 and g <= ROUNDING * (gap + u * size):
            if rate < 0.0:
                return u
            g = max(g, 0.0)
        length = min(length, rest - u)
        d = parabola_root(g, rate, curve - third * length / 3.0)
        while d < 0.25 * length and length > 2.0**-52 * rest:  # the bound is needed no further than the root
            length = max(2.0 * d, 0.25 * length if d == 0.0 else 0.0)
            d = parabola_root(g, rate, curve - third * length / 3.0)
        if d >= length:
            u += length
            if u >= rest:
                return np.inf
            length *= 2.0
            continue
        latest = parabola_root(g, rate, curve + third * length / 3.0)
        u += d
        if latest <= length and latest - d <= 2.0**-52 * u:
            return u
    return np.nan
