"""The first contact with a stop, certified.

Within a cell x1 is its Taylor polynomial (remainder below rounding), so the gap to a stop is a polynomial g too. The
gap to a stop that M1 is just leaving begins with a zero of some order n (1 after an impact, 2 or more after a rest);
divided by u^n it has the other zeros alone, and is positive at u = 0 like every other gap (`set_gap`).

From any point where g > 0 a parabola with the smallest possible second derivative stays below g, hence its first root
is never beyond the first root of g, and stepping from root to root cannot pass a contact, however brief. On a simple
root the steps converge cubically; near a graze, where Newton's method crawls, the parabola is exact to third order and
decides in a few steps. (Faster, where g is known to fall all the way to the root: `strike.descend`.)

Claim. Let m = ROUNDING * (g(0) + sum |c_n| u^n) be the rounding of the evaluation of g at u. A contact after which g
falls below -m is never missed; where g stays above m no contact is reported. In between the flight is within rounding
of a graze, and either answer is right. NaN, "it cannot be decided", takes two near grazes that all but merge within a
cell; no flight of an oscillator has been seen to do that. Along an orbit g itself is known to rounding only: from one
section to the next, to 8 units in the last place of the largest term of x1.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER

ROUNDING = 4.0 * 2.0**-52
STEPS = 2000  # where the gap has a root of fourth order, its parabolas come nearer by a small part at a time


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
def set_gap(g, c, gap, side, n):
    """Taylor coefficients g of the gap to the stop on `side` (+1 or -1) along the flight c of x1.

    gap: its value at u = 0. n: order of its zero there, which is divided out; 0 if M1 is not on that stop.
    """
    for m in range(ORDER):
        g[m] = -side * c[m + n] if m + n < ORDER else 0.0
    if n == 0:
        g[0] = gap


@jit
def certified_contact(g, third, rest):
    """`first_contact`, to a few roundings of g."""
    u, length = 0.0, rest
    for _ in range(STEPS):
        # Horner's scheme for p = sum g_n u^(n-1), p' and p''/2: what g has lost so far keeps its digits when u is tiny
        p, dp, ddp, size = g[ORDER - 1], 0.0, 0.0, abs(g[ORDER - 1])
        for n in range(ORDER - 2, 0, -1):
            ddp = ddp * u + dp
            dp = dp * u + p
            p = p * u + g[n]
            size = size * u + abs(g[n])
        gap = g[0] + u * p
        rate = p + u * dp
        curve = 2.0 * (dp + u * ddp)
        if u > 0.0 and gap <= ROUNDING * (g[0] + u * size):
            if rate < 0.0:
                return u
            gap = max(gap, 0.0)
        length = min(length, rest - u)
        d = parabola_root(gap, rate, curve - third * length / 3.0)
        while d < 0.25 * length and length > 2.0**-52 * rest:  # the bound is needed no further than the root
            length = max(2.0 * d, 0.25 * length if d == 0.0 else 0.0)
            d = parabola_root(gap, rate, curve - third * length / 3.0)
        if d >= length:
            u += length
            if u >= rest:
                return np.inf
            length *= 2.0
            continue
        latest = parabola_root(gap, rate, curve + third * length / 3.0)
        u += d
        if latest <= length and latest - d <= 2.0**-52 * u:
            return u
    return np.nan


@jit
def first_contact(g, third, rest):
    """First root in (0, rest] of the polynomial g (Taylor coefficients), with g(0) > 0.

    Infinite if there is none, NaN if `STEPS` steps do not tell. third: bound on the third derivative up to `rest`. It
    ends with a step of Newton's method: roundings add up in many short flights that follow each other.
    """
    root = certified_contact(g, third, rest)
    if not 0.0 < root < np.inf:
        return root
    p, dp, ddp = g[ORDER - 1], 0.0, 0.0
    for n in range(ORDER - 2, 0, -1):
        ddp = ddp * root + dp
        dp = dp * root + p
        p = p * root + g[n]
    rate, curve = p + root * dp, 2.0 * (dp + root * ddp)
    step = -(g[0] + root * p) / rate if rate < 0.0 else 0.0
    # near a root of higher order the slope changes on the way, and rounding of g would lead past the contact
    is_simple = abs(curve * step) <= 0.5 * abs(rate)
    return root + step if is_simple and 0.0 < root + step <= rest else root


@jit
def size_at(c, u):
    """The sum of the sizes of the terms of the polynomial c at u."""
    size = 0.0
    for n in range(ORDER - 1, -1, -1):
        size = size * u + abs(c[n])
    return size
