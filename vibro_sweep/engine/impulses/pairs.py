"""Pairs of multipliers from point to point of a branch: what they do at the unit circle that tests and counts miss.

Multipliers of a point are (n, 2): real and imaginary parts, NaN where they are not known.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import exported, jit

ON_SQUARE = 1e-6  # of mu^2: a real multiplier that near to the unit circle is on neither side
ON_PAIR = 1e-9  # of |mu|^2 of a pair, which rounding moves by less than two real ones that are about to meet
BENT = 1.0  # times the distance of multipliers from the unit circle


@jit
def beside_circle(mu, i):
    """(|mu|^2 - 1)/(|mu|^2 + 1): zero on the unit circle, finite at poles."""
    size = mu[i, 0] ** 2 + mu[i, 1] ** 2
    return (size - 1.0) / (size + 1.0)


@jit
def most_alike(mu, re, im):
    """The index of the multiplier that is nearest to another one."""
    least, found = np.inf, 0
    for i in range(len(mu)):
        away = (mu[i, 0] - re) ** 2 + (mu[i, 1] - im) ** 2
        if away < least:
            least, found = away, i
    return found


@jit
def mixed(here, there, i, k):
    """Whether the pair k, which of those there is most like the pair i here, is more like another one here; and one of
    these two is nearer to the unit circle than to the other, so that in passing it may be pushed across and back."""
    j = most_alike(here, there[k, 0], there[k, 1])
    if j == i or not here[j, 1] > 0.0:
        return False
    apart = math.hypot(here[j, 0] - here[i, 0], here[j, 1] - here[i, 1])
    return min(abs(beside_circle(here, i)), abs(beside_circle(here, j))) < apart


@exported
def coarse(past, here, there, before, length):
    """Whether a step is too long to tell if a pair of multipliers crosses the unit circle twice from here to there: two
    pairs are mixed up, or one lies farther from where it was heading here, on the outside of a bend, than from the
    circle.

    past : multipliers of the point before, at the distance `before` from here, or 0.0 where it is not known
    """
    for i in range(len(here)):
        re, im = here[i, 0], here[i, 1]
        k = most_alike(there, re, im)
        if not (im > 0.0 and there[k, 1] > 0.0):
            continue
        if mixed(here, there, i, k):
            return True
        j = most_alike(past, re, im)
        if before > 0.0 and past[j, 1] > 0.0:
            x, y, z = beside_circle(past, j), beside_circle(here, i), beside_circle(there, k)
            side = 1.0 if y > 0.0 else -1.0
            if side * z > 0.0 and side * (z - y - (y - x) * length / before) > BENT * min(side * y, side * z):
                return True
    return False


@exported
def exchanged(here, there):
    """Whether a pair goes out of the unit circle and another one comes in between two points: counts do not tell."""
    out = back = False
    for i in range(len(here)):
        re, im = here[i, 0], here[i, 1]
        k = most_alike(there, re, im)
        if im > 0.0 and there[k, 1] > 0.0:
            y, z = beside_circle(here, i), beside_circle(there, k)
            out = out or y < -ON_PAIR < ON_PAIR < z
            back = back or z < -ON_PAIR < ON_PAIR < y
    return out and back


@exported
def keeps_side(here, one, other):
    """Whether a pair on the unit circle here lies on one side of it at both of two points."""
    for i in range(len(here)):
        re, im = here[i, 0], here[i, 1]
        j, k = most_alike(one, re, im), most_alike(other, re, im)
        if im > 0.0 and one[j, 1] > 0.0 and other[k, 1] > 0.0 and abs(beside_circle(here, i)) < ON_PAIR:
            if beside_circle(one, j) * beside_circle(other, k) > 0.0:
                return True
    return False
