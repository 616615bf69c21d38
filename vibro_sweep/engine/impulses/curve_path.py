"""Along a bifurcation curve: how far steps may go, what is recorded, and whether it leaves its box or comes back."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.locus import TESTS, THETA, TORUS, Place, new_place, size_of
from vibro_sweep.engine.simd.jit import jit

CAUTION = 0.1  # of the height to which a parameter rises between two points: what a cubic may be wrong by


class Record(NamedTuple):
    """Points, in order."""

    t: np.ndarray  # (most, K)
    D: np.ndarray  # (most, K)
    motion: np.ndarray  # (most, K, 2)
    p: np.ndarray  # (most, 3)
    tests: np.ndarray  # (most, TESTS)
    h: np.ndarray  # (most, n)


class Path(NamedTuple):
    """How to step, in the units of the curve, and what is passed."""

    longest: float
    shortest: float
    straight: float  # radians between neighbouring tangents
    box: np.ndarray  # (2, 2): ends of both parameters
    counts: np.ndarray  # (3,) integers: points of the curve before this call; points and corrections of this call
    first: Place  # of the curve
    a: Place  # where the last step began
    record: Record
    past: np.ndarray  # (n, 2) multipliers of the point before a
    before: np.ndarray  # (1,) the distance from there to a; 0 where it is not known


def new_path(most: int, K: int, n: int, longest: float, shortest: float, straight: float, box) -> Path:
    """most: points of one call."""
    record = Record(*map(np.zeros, [(most, K), (most, K), (most, K, 2), (most, 3), (most, TESTS), (most, n)]))
    places, past = (new_place(K, n), new_place(K, n)), (np.zeros((n, 2)), np.zeros(1))
    return Path(longest, shortest, straight, box, np.zeros(3, np.int64), *places, record, *past)


@jit
def copy_place(a, b):
    """b <- a."""
    for i in range(len(a.t)):
        b.t[i], b.D[i] = a.t[i], a.D[i]
    for i in range(len(a.h)):
        b.h[i] = a.h[i]
    for i in range(3):
        b.p[i] = a.p[i]
    for i in range(len(a.w)):
        b.w[i], b.psi[i] = a.w[i], a.psi[i]
    for i in range(len(a.tangent)):
        b.tangent[i] = a.tangent[i]
    for i in range(len(a.tests)):
        b.tests[i] = a.tests[i]
    for i in range(len(a.h)):
        b.multipliers[i, 0], b.multipliers[i, 1] = a.multipliers[i, 0], a.multipliers[i, 1]


@jit
def remember(path, a, length):
    """Keep a as the point before the next one, at this distance."""
    for i in range(len(a.h)):
        path.past[i, 0], path.past[i, 1] = a.multipliers[i, 0], a.multipliers[i, 1]
    path.before[0] = length


@jit
def keep(place, b, record, count):
    for i in range(len(place.t)):
        record.t[count, i], record.D[count, i] = place.t[i], place.D[i]
        for j in range(2):
            record.motion[count, i, j] = b.room.motion[i, j]
    for j in range(3):
        record.p[count, j] = place.p[j]
    for j in range(len(place.tests)):
        record.tests[count, j] = place.tests[j]
    for j in range(len(place.h)):
        record.h[count, j] = place.h[j]


@jit
def outside(path, place):
    for j in range(2):
        if not path.box[j, 0] <= place.p[j] <= path.box[j, 1]:
            return True
    return False


@jit
def bulges(path, c, a, b):
    """Whether a parameter leaves the box between a and b, to return: by the cubic through both with their tangents."""
    S, length = len(a.w), 0.0
    for j in range(2):
        length += ((b.p[j] - a.p[j]) / c.unit[S + j]) ** 2
    for i in range(len(a.t)):
        length += ((b.t[i] - a.t[i]) / c.unit[i]) ** 2 + ((b.D[i] - a.D[i]) / c.unit[len(a.t) + i]) ** 2
    if c.kind == TORUS:
        length += (b.p[THETA] - a.p[THETA]) ** 2
    length = math.sqrt(length)
    for j in range(2):
        rise, fall = length * c.unit[S + j] * a.tangent[S + j], length * c.unit[S + j] * b.tangent[S + j]
        if rise * fall < 0.0:
            step = b.p[j] - a.p[j]
            bend, twist = 3.0 * step - 2.0 * rise - fall, rise + fall - 2.0 * step
            # rise + 2 bend u + 3 twist u^2 = 0: the zero between 0 and 1, where the ends differ in sign
            u = -rise / (bend + math.copysign(math.sqrt(max(bend * bend - 3.0 * twist * rise, 0.0)), -rise))
            top = a.p[j] + u * (rise + u * (bend + u * twist))
            slack = CAUTION * (top - max(a.p[j], b.p[j]) if rise > 0.0 else top - min(a.p[j], b.p[j]))
            if not path.box[j, 0] < top + slack < path.box[j, 1]:
                return True
    return False


@jit
def comes_back(c, a, first, length):
    """Whether the step from a passes the first point; times count modulo the forcing period."""
    K, S = len(a.t), len(a.w)
    shift = 0.0
    for i in range(K):
        shift += (first.t[i] - a.t[i]) / c.unit[i] / K
    shift = 2.0 * math.pi * math.floor(shift / (2.0 * math.pi) + 0.5)
    along, size = 0.0, 0.0
    for j in range(size_of(c, a)):
        if j < K:
            offset = (first.t[j] - a.t[j]) / c.unit[j] - shift
        elif j < 2 * K:
            offset = (first.D[j - K] - a.D[j - K]) / c.unit[j]
        elif j < S:
            continue
        else:
            offset = (first.p[j - S] - a.p[j - S]) / c.unit[j]
        along += offset * a.tangent[j]
        size += offset * offset
    return 0.0 <= along <= length and size - along * along < 0.01 * length * length
