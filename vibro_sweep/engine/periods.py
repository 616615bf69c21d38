"""Whether the section points of an orbit repeat themselves, after how many, and whether they have settled.

An orbit that still approaches a periodic one slowly and on a spiral comes near to itself after several periods before
it does so after the least one. So the distance of a point from the one d before it is followed along the record: where
it fades away like a geometric sequence, d is a period, however small the distance after a multiple of d is already;
and where the distance after the found period itself does not fade, the points only seem to repeat themselves.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.model import exponents

REPEAT = 1e-6  # section points this near to each other, relative to their size, are the same point
ROUNDING = 1e-10  # relative distance that rounding may leave of it, where motion forgets it
FADED = 0.7  # part of the last distance that may be left in the end
AS_NEAR = 2.0  # distance after d, in those after a multiple of d, at which both are as near
LEAST_WINDOW = 12  # points over which distances are averaged
WINDOWS = 5
NEAR = 1e-2  # relative distance below which an orbit approaches a periodic one as a linear map would
UNEVEN = 1.3  # by which the distance may rise from window to window all the same
NOT_CONVERGING = -1

sign_of = jit(exponents.sign_of)


@jit
def distance(section, size, n, p):
    """Between point n and the one p before it, relative to `size` (2 N,)."""
    largest = 0.0
    for i in range(section.shape[1]):
        largest = max(largest, abs(section[n, i] - section[n - p, i]) / size[i])
    return largest if largest == largest else np.inf


@inline
def is_further(section, size, n, p, limit):
    """Whether `distance` is certainly not below a limit; without a division, as a rule by the first number."""
    for i in range(section.shape[1]):
        if abs(section[n, i] - section[n - p, i]) > limit * size[i] * (1.0 + 2.0**-50):
            return True
    return False


@jit
def window_distance(section, size, p, window, m, windows, limit):
    """Mean distance of points from those p before them, in the m-th of so many windows along the record.

    Where it is above the limit: infinity, without looking at all of them.
    """
    first, total = p + m * (len(section) - p - window) // (windows - 1), 0.0
    for n in range(first, first + window):
        total += distance(section, size, n, p)
        if total > limit * window:
            return np.inf
    return total / window


@jit
def window_of(p):
    """Points of a window over which an orbit that nearly repeats itself after p comes through all of its phases."""
    return p * ((LEAST_WINDOW + p - 1) // p)


@jit
def repeats(section, size, p, o):
    """Whether all points are near to those p before them.

    o: the orbit, from which the compiler knows how many numbers a point has, and compares them at once.
    """
    for n in range(p, len(section)):  # from the beginning: where the orbit has not settled, the first point tells
        near = True
        for i in range(2 * len(o.c)):
            near &= abs(section[n, i] - section[n - p, i]) <= REPEAT * size[i]
        if not near:
            return False
    return True


@jit
def root_mean_square(section, size, p, first, window):
    """Of the differences of all numbers of so many points from those p before them. On a spiral that turns by a quarter
    from point to point it does not beat, as their largest does."""
    total = 0.0
    for n in range(first, first + window):
        for i in range(section.shape[1]):
            apart = (section[n, i] - section[n - p, i]) / size[i]
            total += apart * apart
    return math.sqrt(total / (window * section.shape[1]))


@jit
def fades_from(section, size, d, begin, window, after, strict):
    """Whether the distance after d points fades away from point `begin` on, as three windows tell.

    after: in the last of them. strict: like a geometric sequence; else also where it falls faster and faster.
    """
    before = root_mean_square(section, size, d, begin, window)
    between = root_mean_square(section, size, d, (begin + len(section) - window) // 2, window)
    if not before > between > after:
        return False
    limit = after - (after - between) ** 2 / ((after - between) - (between - before))
    return abs(limit) < FADED * after or (not strict and (limit < 0.0 or limit > after))


@jit
def fades(section, size, d, p, rounding):
    """Whether the distance after d points fades away; points nearly repeat themselves after p, a multiple of d.

    In all of the record, or in its second half: what fades fast at first may hide there what fades slowly. Where points
    are hardly nearer to each other after p than after d, nothing speaks for p.
    """
    window = min(window_of(p), len(section) - d)
    after = root_mean_square(section, size, d, len(section) - window, window)
    if after <= rounding:
        return True
    last = min(window, len(section) - p)
    if d < p and after <= AS_NEAR * root_mean_square(section, size, p, len(section) - last, last):
        return True
    if len(section) - d - window < window // 4:  # too few points to tell
        return d == p
    half, strict = max(d, len(section) // 2), d == p or after > REPEAT
    if fades_from(section, size, d, d, window, after, strict):
        return True
    return len(section) - half >= 2 * window and fades_from(section, size, d, half, window, after, strict)


@jit
def find_period(section, o, size, rounding):
    """Least period of the points, (n, 2 N), of an orbit, up to half of them; 0 if there is none.

    `NOT_CONVERGING` where points seem to repeat themselves but do not come nearer to doing so. size: scratch, (2 N,) or
    longer. rounding: distance that it may leave.
    """
    count, sizes, largest = len(section), o.largest, 0.0
    for i in range(section.shape[1]):
        largest = max(largest, sizes[i])
    for i in range(section.shape[1]):
        size[i] = max(sizes[i], 1e-3 * largest)
    for p in range(1, count // 2 + 1):
        if repeats(section, size, p, o):
            for d in range(1, p):
                if p % d == 0 and fades(section, size, d, p, rounding):
                    return d
            return p if fades(section, size, p, p, rounding) else NOT_CONVERGING
    return 0


@jit
def is_approaching(section, size):
    """Whether the points, without a period yet, approach one: near to those some number before, and ever nearer."""
    count = len(section)
    nearest, p = NEAR, 0
    for d in range(1, count // 2 - LEAST_WINDOW):
        if is_further(section, size, count - 1, d, nearest):
            continue
        here = distance(section, size, count - 1, d)
        if here < nearest:
            nearest, p = here, d
    if p == 0 or count - p - window_of(p) < WINDOWS:
        return False
    first = before = window_distance(section, size, p, window_of(p), 0, WINDOWS, NEAR)
    for m in range(1, WINDOWS):
        limit = min(NEAR, UNEVEN * before)
        after = window_distance(section, size, p, window_of(p), m, WINDOWS, limit)
        if before > limit or after > limit:
            return False
        before = after
    return before < 0.9 * first


@jit
def has_settled(period, section, o, size, rounding, spectrum, error):
    """Whether an orbit is on its attractor, and not on its way there.

    Without a period, one that contracts (lambda_1 is certainly below zero) is on its way, or its period is too long to
    be found; and one that repeats itself in the end, or comes steadily nearer to doing so, too.
    spectrum: NaN where unknown.
    """
    if period != 0:
        return True
    if sign_of(spectrum[0], error[0]) < 0:
        return False
    return find_period(section[-(len(section) // 4) :], o, size, rounding) <= 0 and not is_approaching(section, size)
