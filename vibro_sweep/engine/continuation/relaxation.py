"""Stops that relax after a release by force: the contact after it is computed as that of a stop at rest.

The stop follows k s + c s' + p = 0 from its depth d at the release. After the time D its rest is exp(-k D/c) d without
a preload, less with one, which brings it to 0 at D = (c/k) ln(1 + k d/p). The next contact with it is that of a stop at
rest where D is longer than that, or than what takes exp(-k D/c) (1 + k/(c omega)) below rounding.
"""

import cmath
import math

import numpy as np

from vibro_sweep.engine.continuation.moving_flow import OMEGA, expand_gap, law_at, shift
from vibro_sweep.engine.impulses.extremes import slope_of, value_of
from vibro_sweep.engine.simd.jit import small

DIGITS = 53 * math.log(2.0)
PER_TIME_CONSTANT, PER_CELL = 8.0, 4.0  # places at which the distance of mass and stop is looked at
HALVINGS = 40  # of such a step, in which it is least


@small
def time_to_spare(f, c, place, b):
    """The least time between a release by force and the next touch of that stop, over what it has to be, less 1; below
    0 too where the stop comes to the mass that has left it."""
    K, n, omega, least = len(place.x), f.A.shape[0], f.numbers[OMEGA], np.inf
    if f.by_force == 0:
        return least
    for i in range(K):
        law, depth = law_at(f, c.sides[i]), b.events[i].depth
        damping, preload = f.values[law + 1], f.values[law + 2]
        if c.rests[i] and damping > 0.0 and depth > 0.0:
            rate = f.values[law] / damping
            needed = DIGITS + math.log(1.0 + rate / omega)
            if preload > 0.0:
                needed = min(needed, math.log(1.0 + f.values[law] * depth / preload))
            time = (next_touch(f, c, place, i) - place.x[i, n] - place.x[i, n + 1]) / omega
            least = min(least, rate * time / needed - 1.0)
            least = min(least, least_distance(f, place, b, i, c.sides[i], min(needed / rate, b.events[i].length)))
    return least


@small
def least_distance(f, place, b, i, side, time):
    """The least of s - delta, over the depth at the release, where it has a minimum in this time before the mass comes
    out of the stop; inf: nowhere."""
    n, e, work, law, omega = f.A.shape[0], b.events[i], b.work[0], law_at(f, side), f.numbers[OMEGA]
    rate, preload = f.values[law] / f.values[law + 1], f.values[law + 2]
    rest = preload / f.values[law] if preload > 0.0 else 0.0
    y, cell, least, begin = work.flying[0], work.cell, np.inf, place.x[i, n] + place.x[i, n + 1]
    step = f.width / max(PER_CELL, PER_TIME_CONSTANT * rate * f.width)
    for r in range(n):
        y[r] = e.after[r]
    base, origin, closing = 0.0, 0.0, False  # base: where the cell begins
    while base < time:
        expand_gap(f, y, cmath.exp(1j * (begin + omega * base)), cell)
        if base == 0.0:
            origin, cell[1] = cell[0], -side * rate * (e.depth + rest)
        u = 0.0
        while u < min(f.width, time - base):
            to = min(u + step, f.width, time - base)
            if rate_apart(side, rate, e.depth + rest, cell, base, to) < 0.0:
                closing = True
            elif closing:
                closing, low, high = False, u, to
                for _ in range(HALVINGS):
                    middle = 0.5 * (low + high)
                    if rate_apart(side, rate, e.depth + rest, cell, base, middle) < 0.0:
                        low = middle
                    else:
                        high = middle
                place_of_stop = (e.depth + rest) * math.exp(-rate * (base + high)) - rest
                least = min(least, (place_of_stop - e.depth - side * (value_of(cell, high) - origin)) / e.depth)
            if e.depth + side * (value_of(cell, to) - origin) < 0.0:
                return least
            u = to
        shift(f, f.powers[0], y, work.flying[1])
        base += f.width
    return least


@small
def rate_apart(side, rate, scale, cell, base, u):
    """The rate of s - delta at the time u of the cell that begins at `base`."""
    return -rate * scale * math.exp(-rate * (base + u)) - side * slope_of(cell, u)


@small
def next_touch(f, c, place, i):
    """The phase of the next event on the stop of event i, which may be itself."""
    K, sign, turns = len(place.x), 1.0, 0.0
    for j in range(i + 1, i + 1 + 2 * K):
        if j % K == 0:
            sign, turns = sign * c.sigma, turns + 1.0
        if sign * c.sides[j % K] == c.sides[i]:
            return place.x[j % K, -2] + turns * math.pi * f.half_turns
    return np.inf
