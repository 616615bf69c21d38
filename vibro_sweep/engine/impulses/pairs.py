"""Pairs of multipliers from point to point of a branch: what they do at the unit circle that tests and counts miss."""

import numpy as np

from vibro_sweep.engine.simd.jit import jit

ON_SQUARE = 1e-6  # of |mu|^2: a multiplier that near to the unit circle is on neither side
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
def bend(past, a, b, before, length):
    """Whether steps are too long to tell if a pair of multipliers crosses the unit circle twice between two points: the
    second lies farther from where it was heading at the first, on the outside of a bend, than from the circle.

    past : multipliers of the point before a, at the distance `before`, or 0.0 where it is not known
    """
    if before == 0.0:
        return False
    for i in range(len(past)):
        re, im = a.multipliers[i, 0], a.multipliers[i, 1]
        j, k = most_alike(past, re, im), most_alike(b.multipliers, re, im)
        if im > 0.0 and past[j, 1] > 0.0 and b.multipliers[k, 1] > 0.0:
            x, y, z = beside_circle(past, j), beside_circle(a.multipliers, i), beside_circle(b.multipliers, k)
            side = 1.0 if y > 0.0 else -1.0
            if side * z > 0.0 and side * (z - y - (y - x) * length / before) > BENT * min(side * y, side * z):
                return True
    return False


@jit
def exchanged(here, there):
    """Whether a pair goes out of the unit circle and another one comes in between two points: counts do not tell."""
    out = back = False
    for i in range(len(here)):
        re, im = here[i, 0], here[i, 1]
        k = most_alike(there, re, im)
        if im > 0.0 and there[k, 1] > 0.0:
            y, z = beside_circle(here, i), beside_circle(there, k)
            out = out or y < -ON_SQUARE < ON_SQUARE < z
            back = back or z < -ON_SQUARE < ON_SQUARE < y
    return out and back
