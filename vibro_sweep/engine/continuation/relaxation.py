"""Stops that relax after a release by force: the contact after it is computed as that of a stop at rest.

The stop follows k s + c s' + p = 0 from its depth d at the release. After the time D its rest is exp(-k D/c) d without
a preload, less with one, which brings it to 0 at D = (c/k) ln(1 + k d/p). The next contact with it is that of a stop at
rest where D is longer than that, or than what takes exp(-k D/c) (1 + k/(c omega)) below rounding.
"""

import math

import numpy as np

from vibro_sweep.engine.continuation.moving_flow import OMEGA, law_at
from vibro_sweep.engine.simd.jit import small

DIGITS = 53 * math.log(2.0)


@small
def time_to_spare(f, c, place, b):
    """The least time between a release by force and the next touch of that stop, over what it has to be, less 1."""
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
    return least


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
