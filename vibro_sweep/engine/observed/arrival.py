"""Whether an orbit has arrived where it goes, told from its section points; if not, how far it has to go, and how fast.

On the way to a periodic orbit the differences d_n = x_{n+p} - x_n of the points obey, once faster ones have died out,
one recurrence with two numbers, the same for every coordinate,

    d_{n+2p} = a d_{n+p} + b d_n,

since the derivatives of p periods, taken from different points of the orbit, are similar matrices. The roots of
z^2 = a z + b are their two multipliers of largest modulus: they say how fast the orbit goes there. The sum of all
differences to come says how far it is. Chaos obeys no such recurrence; on a torus |z| is 1. Where two modes fade away
side by side, `two_modes.py` has four numbers.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.observed.two_modes import (
    RESIDUAL,
    approaches_by_two_modes,
    fade_by_two_modes,
    look_for_two_modes,
)
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.tables import exponents
from vibro_sweep.tables.exponents import ARRIVED

REPEAT = 1e-6  # section points this near to each other, relative to their size, are the same point
ROUNDING = 1e-10  # relative distance that rounding may leave of it, where motion forgets it
STILL = 1e-12  # relative difference over many periods below which none is told from rounding
LEAST_SIZE = 1e-3  # of a coordinate, in the size of the largest one
LIKE, SURE = 1e-2, 10.0  # residual up to which differences obey the recurrence, and by how many |z| is to be below 1
ALIKE, SURELY = 1e-3, 30.0  # the same where nothing better is looked for, and of long periods, which tori nearly have
NEAR = 1e-2  # the last point, relative to its size, to the one a long period before
BETTER = 0.3  # residual of a longer period, in that of a shorter one, with which it counts
CLEAR = 1e-7  # residual of a recurrence beside which no second mode is seen
WORTH_A_LOOK, LOOKED_AT = 0.1, 4  # residual of so many of the last differences with which all are looked at
LONG_LOOKS = 8  # at longer ones: where more of them are near, they are multiples of one that is none
SHORT = 32  # period up to which all are looked at, as far as an eighth of the points
LAST = 12  # differences at the end, at least, that are compared with rounding
MOST_FITTED = 512  # points, the last ones: fewer do not tell a torus from a spiral, more of them tell no more
LEAST_FITTED = 4  # points beyond three periods for a recurrence
PARALLEL = 1e-10  # of two neighbouring differences: they are taken as parallel, and b as 0

sign_of = jit(exponents.sign_of)


class Sums(NamedTuple):
    """Of products of three differences, each a period after the other: `before`, `here` and `after`."""

    hh: float
    bb: float
    hb: float
    ha: float
    ba: float
    aa: float


class Recurrence(NamedTuple):
    """d_{n+2p} = a d_{n+p} + b d_n; its residual, in parts of the differences; |z|."""

    a: float
    b: float
    residual: float
    z: float


@jit
def set_scale(scale, largest, T):
    """What numbers of a point are multiplied by, (2 N,): one over the size of each coordinate. With velocities over
    omega, which have the unit of a place, no size is much less than the greatest."""
    omega, greatest = 2.0 * math.pi / T, 0.0
    for i in range(0, len(scale), 2):
        greatest = max(greatest, largest[i], largest[i + 1] / omega)
    greatest = greatest if greatest > 0.0 else 1.0
    for i in range(0, len(scale), 2):
        scale[i] = 1.0 / max(largest[i], LEAST_SIZE * greatest)
        scale[i + 1] = 1.0 / max(largest[i + 1], LEAST_SIZE * greatest * omega)


@jit
def sums(section, scale, p, first):
    """Sums of products of differences over p periods, from point `first` of the section (n, 2 N) on."""
    hh = bb = hb = ha = ba = aa = 0.0
    for n in range(first, len(section) - 3 * p):
        for i in range(section.shape[1]):
            before = (section[n + p, i] - section[n, i]) * scale[i]
            here = (section[n + 2 * p, i] - section[n + p, i]) * scale[i]
            after = (section[n + 3 * p, i] - section[n + 2 * p, i]) * scale[i]
            hh += here * here
            bb += before * before
            hb += here * before
            ha += here * after
            ba += before * after
            aa += after * after
    return Sums(hh, bb, hb, ha, ba, aa)


@jit
def solved(s, h, b):
    """The two numbers whose products with d_{n+p} and d_n are nearest to differences with which the sums are h, b."""
    area = s.hh * s.bb - s.hb * s.hb
    if area > PARALLEL * s.hh * s.bb:
        return (h * s.bb - b * s.hb) / area, (b * s.hh - h * s.hb) / area
    return h / s.hh, 0.0


@jit
def roughly(section, scale, p, first):
    """The residual of the recurrence by the sums alone, to 1e-8; 1 without a difference."""
    s = sums(section, scale, p, first)
    if not (s.hh > 0.0 and s.aa > 0.0):
        return 1.0
    a, b = solved(s, s.ha, s.ba)
    return math.sqrt(max(0.0, 1.0 - (a * s.ha + b * s.ba) / s.aa))


@jit
def recurrence(section, scale, p, first):
    """The recurrence of differences over p periods by least squares, from point `first` of the section (n, 2 N) on.

    The residual has what rounding may hide in it: a drift has z = 1 but for that.
    """
    first = max(first, len(section) - 3 * p - MOST_FITTED)
    s = sums(section, scale, p, first)
    if not (s.hh > 0.0 and s.aa > 0.0):
        return Recurrence(0.0, 0.0, 1.0, 0.0)
    a, b = solved(s, s.ha, s.ba)
    h = before = left = 0.0  # of what is left, by which the two numbers get their last digits
    for n in range(first, len(section) - 3 * p):
        for i in range(section.shape[1]):
            here, there = section[n + 2 * p, i] - section[n + p, i], section[n + p, i] - section[n, i]
            rest = (section[n + 3 * p, i] - section[n + 2 * p, i] - a * here - b * there) * scale[i]
            h += here * scale[i] * rest
            before += there * scale[i] * rest
            left += rest * rest
    more = solved(s, h, before)
    a, b = a + more[0], b + more[1]
    square = 0.25 * a * a + b
    z = 0.5 * abs(a) + math.sqrt(square) if square >= 0.0 else math.sqrt(-b)
    return Recurrence(a, b, math.sqrt(left / s.aa) + ROUNDING, z)


@jit
def goes_there(r, surely=False):
    """Whether differences fade away as those of an orbit do that approaches a periodic one."""
    like, sure = (ALIKE, SURELY) if surely else (LIKE, SURE)
    return r.residual <= like and r.z < 1.0 - sure * r.residual


@jit
def second_half(section, p):
    """The first point of the later half of the differences: the faster ones have died out there as far as anywhere."""
    return max(0, (len(section) - 3 * p) // 2)


@jit
def distance_to_go(section, scale, p, r, last):
    """What is left of the way, in parts of the sizes, at any of so many last points: all differences to come.

    With z^2 = a z + b it is ((a + b) d_n + b d_{n-p})/(1 - a - b), where d_n is the last difference.
    """
    farthest = 0.0
    for n in range(len(section) - last, len(section)):
        for i in range(section.shape[1]):
            here, before = section[n, i] - section[n - p, i], section[n - p, i] - section[n - 2 * p, i]
            way = ((r.a + r.b) * here + r.b * before) / (1.0 - r.a - r.b)
            farthest = max(farthest, abs(way) * scale[i])
    return farthest


@jit
def last_difference(section, scale, p):
    """Root mean square of the differences over p periods at the last points."""
    count, total = min(max(p, LAST), len(section) - p), 0.0
    for n in range(len(section) - count, len(section)):
        for i in range(section.shape[1]):
            total += ((section[n, i] - section[n - p, i]) * scale[i]) ** 2
    return math.sqrt(total / (count * section.shape[1]))


@jit
def repeats(section, scale, p, o):
    """Whether all points are near to those p before them.

    o: the orbit, from which the compiler knows how many numbers a point has, and compares them at once.
    """
    for n in range(p, len(section)):  # from the beginning: where the orbit has not arrived, the first point tells
        near = True
        for i in range(2 * len(o.c)):
            near &= abs(section[n, i] - section[n - p, i]) * scale[i] <= REPEAT
        if not near:
            return False
    return True


@jit
def least_period(section, scale, p, rounding, fit):
    """The least period of points that repeat themselves after p: on a spiral a multiple of it may do so first."""
    for d in range(1, p):
        if p % d == 0 and 3 * d + LEAST_FITTED <= len(section):
            if last_difference(section, scale, d) <= rounding:
                return d
            if goes_there(recurrence(section, scale, d, second_half(section, d))):
                return d
            if fade_by_two_modes(section, scale, d, RESIDUAL, fit):
                return d
    return p


@jit
def many_periods(section, p):
    """So many times p periods that three of them are most of the section: the longer the periods over which differences
    are taken, the slower a motion they tell from rounding."""
    return p * max(1, len(section) // 4 // p)


@jit
def keep_approach(section, scale, p, r, found):
    """Keep how far it is to the approached period, and how fast the orbit goes, by the recurrence over p periods."""
    found.approached_distance = distance_to_go(section, scale, p, r, found.approached_period)
    found.approached_factor = math.exp(math.log(r.z) / p)


@jit
def look_at_repeating(section, scale, p, rounding, fit, found):
    """Points that repeat themselves after p: their least period, and whether the orbit has arrived there."""
    least = least_period(section, scale, p, rounding, fit)
    long = many_periods(section, least)
    too_few = 3 * long + LEAST_FITTED > len(section)
    if too_few or last_difference(section, scale, long) <= STILL:
        found.period = least
        return
    r = recurrence(section, scale, long, second_half(section, long))
    if goes_there(r):
        found.approached_period = least
        keep_approach(section, scale, long, r, found)
    elif last_difference(section, scale, least) <= rounding:
        found.period = least
        return
    elif not approaches_by_two_modes(section, scale, least, RESIDUAL, fit, found):
        return
    if found.approached_distance <= ARRIVED:
        found.period, found.approached_period = least, 0


@jit
def nothing_known(found):
    """Neither a period nor one that is approached."""
    found.period = found.approached_period = 0
    found.approached_distance = found.approached_factor = np.nan


@jit
def is_near(section, scale, p):
    """Whether the last point is near to the one p before it."""
    last = len(section) - 1
    for i in range(section.shape[1]):
        if not abs(section[last, i] - section[last - p, i]) * scale[i] <= NEAR:
            return False
    return True


@jit
def is_worth_a_look(section, scale, p):
    """Whether the last points do not say already that the orbit does not approach one with the period p."""
    return roughly(section, scale, p, max(0, len(section) - 3 * p - LOOKED_AT)) <= WORTH_A_LOOK


@jit
def arrives_at_the_end(last, scale, rounding, o, fit, found):
    """Whether the last points of a record have a period that all of them have not: then that is approached, and the
    orbit is there."""
    for p in range(1, len(last) // 2 + 1):
        if repeats(last, scale, p, o):
            look_at_repeating(last, scale, p, rounding, fit, found)
            period = found.period
            nothing_known(found)
            if period > 0:
                found.approached_period, found.approached_distance = period, 0.0
            return period > 0
    return False


@jit
def look(section, o, scale, rounding, fit, found):
    """Set of `found` the period of the points, (n, 2 N); or the period that they approach, how far it is to there, and
    by how much that shrinks in a forcing period; or none.

    rounding : distance that it may leave between points that repeat themselves
    fit : room for `two_modes.py`
    """
    nothing_known(found)
    for p in range(1, len(section) // 2 + 1):
        if repeats(section, scale, p, o):
            look_at_repeating(section, scale, p, rounding, fit, found)
            return
    if arrives_at_the_end(section[-(len(section) // 4) :], scale, rounding, o, fit, found):
        return
    best, left = Recurrence(0.0, 0.0, LIKE / BETTER, 0.0), LONG_LOOKS
    for p in range(1, (len(section) - LEAST_FITTED) // 3 + 1):
        long = p > min(SHORT, len(section) // 8)
        if long:
            if not is_near(section, scale, p):
                continue
            left -= 1
            if left < 0:
                break
        if not is_worth_a_look(section, scale, p):
            continue
        r = recurrence(section, scale, p, 0 if long else second_half(section, p))
        if long and not goes_there(r, long):
            continue
        flips = p == 2 * found.approached_period and best.a < 0.0 and not goes_there(best)
        if r.residual < BETTER * best.residual or (flips and goes_there(r)):
            best, found.approached_period = r, p
        if goes_there(best, True):
            break
    if best.residual > CLEAR and look_for_two_modes(section, scale, BETTER * best.residual, fit, found):
        return
    if not goes_there(best):
        nothing_known(found)
        return
    keep_approach(section, scale, found.approached_period, best, found)
    long = many_periods(section, found.approached_period)
    r = recurrence(section, scale, long, second_half(section, long))
    if goes_there(r):  # it says the same to more digits
        keep_approach(section, scale, long, r, found)


@jit
def is_under_way(found):
    """Whether an orbit without a period is still on its way to one: it approaches one; or it contracts, as lambda_1
    says that is certainly below zero."""
    if found.period > 0 or found.approached_period > 0:
        return found.period == 0
    return sign_of(found.lyapunov[0], found.lyapunov_error[0]) < 0
