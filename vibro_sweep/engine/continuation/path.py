"""Along a branch or a curve: how far steps may go, what is recorded, and whether it leaves its bounds or comes back."""

import cmath
import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.continuation.flight_tables import flight
from vibro_sweep.engine.continuation.lasting_event import state_within
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.continuation.problem import index_of, unknowns
from vibro_sweep.engine.continuation.residual import approach, leave
from vibro_sweep.engine.continuation.workspace import TEST, Place, new_place
from vibro_sweep.engine.simd.jit import small

CAUTION = 0.1  # of the height to which a parameter rises between two points: what a cubic may be wrong by


class Record(NamedTuple):
    """Points, in order."""

    x: np.ndarray  # (most, K, n + 2)
    motion: np.ndarray  # (most, K, 2)
    p: np.ndarray  # (most, 3)
    tests: np.ndarray  # (most, len(TEST))
    omega: np.ndarray  # (most,): of the force
    phase: np.ndarray  # (most,) at which states are asked for
    state: np.ndarray  # (most, n) before an impact there, in contact coordinates


class Path(NamedTuple):
    """The parameters of stepping, in the units of the problem, and the points that are passed."""

    longest: float
    shortest: float
    straight: float  # radians between neighbouring tangents
    bounds: np.ndarray  # (2, 2): ends of both parameters
    counts: np.ndarray  # (3,) integers: points before this call; points and corrections of this call
    first: Place
    a: Place  # where the last step began
    record: Record
    past: Place  # the point before a
    before: np.ndarray  # (1,) the distance from there to a; 0 where it is not known


def new_path(most: int, K: int, n: int, longest: float, shortest: float, straight: float, bounds) -> Path:
    """most: points of one call."""
    shapes = (most, K, n + 2), (most, K, 2), (most, 3), (most, len(TEST)), most, most, (most, n)
    record, counts = Record(*map(np.zeros, shapes)), np.zeros(3, np.int64)
    first, a, past = (new_place(K, n) for _ in range(3))
    return Path(longest, shortest, straight, bounds, counts, first, a, record, past, np.zeros(1))


@small
def copy_place(a, b):
    """b <- a."""
    K, width = a.x.shape
    for i in range(K):
        for r in range(width):
            b.x[i, r], b.tangent[i, r], b.v[i, r] = a.x[i, r], a.tangent[i, r], a.v[i, r]
    for i in range(K + 1):
        for r in range(width):
            b.w[i, r] = a.w[i, r]
    for j in range(3):
        b.p[j], b.tangent_p[j] = a.p[j], a.tangent_p[j]
    for j in range(len(TEST)):
        b.tests[j] = a.tests[j]
    for r in range(width - 2):
        b.multipliers[r, 0], b.multipliers[r, 1] = a.multipliers[r, 0], a.multipliers[r, 1]


@small
def remember(path, a, length):
    """Keep a as the point before the next one, at this distance."""
    copy_place(a, path.past)
    path.before[0] = length


@small
def go_back(path, length):
    """Take back the step before, where it is one of this call. Half the length of the step to be made shorter."""
    if path.counts[1] > 0 and path.before[0] > 0.0:
        copy_place(path.past, path.a)
        length = path.before[0]
        path.counts[1] -= 1
        path.before[0] = 0.0
    return 0.5 * length


@small
def keep(place, b, omega, record, count):
    record.omega[count] = omega
    K, width = place.x.shape
    for i in range(K):
        for r in range(width):
            record.x[count, i, r] = place.x[i, r]
        for j in range(2):
            record.motion[count, i, j] = b.events[i].motion[j]
    for j in range(3):
        record.p[count, j] = place.p[j]
    for j in range(len(TEST)):
        record.tests[count, j] = place.tests[j]


@small
def state_at(f, c, x, phase, b, state):
    """The state (n,) of an orbit x (K, n + 2) at a phase, before an impact there."""
    n, K, length, work = f.A.shape[0], len(x), math.pi * f.half_turns, b.work[0]
    E = work.E
    turns = math.ceil((phase - x[0, n]) / length) - 1.0
    s = phase - turns * length  # in (phi_1, phi_1 + length]
    i = K - 1
    while i > 0 and not x[i, n] < s:
        i -= 1
    e, delay, turn = b.events[i], max(s - x[i, n], 0.0), cmath.exp(1j * s)
    sign = 1.0 if c.sigma > 0.0 or turns % 2.0 == 0.0 else -1.0
    approach(f, x[i], e)
    if c.rests[i] and delay < x[i, n + 1]:
        state_within(f, c.compliant, c.sides[i], x[i], delay, e, work, state)
        for r in range(n):
            state[r] *= sign
        return
    leave(f, c, i, x[i], e, work)
    flight(f, (delay - (x[i, n + 1] if c.rests[i] else 0.0)) / f.numbers[OMEGA], E, work.other)
    for r in range(n):
        total = (f.Z[r] * turn).real
        for j in range(n + 1):
            total += E[0, r, j] * e.after[j]
        state[r] = sign * total


@small
def outside(path, place):
    for j in range(2):
        if not path.bounds[j, 0] <= place.p[j] <= path.bounds[j, 1]:
            return True
    return False


@small
def offset(c, a, b, k):
    """Unknown k of those over which distances are measured, from a to b: phases, jumps, parameters, theta."""
    K, n = len(a.x), a.x.shape[1] - 2
    if k < K:
        return b.x[k, n] - a.x[k, n]
    if k < 2 * K:
        return b.x[k - K, n + 1] - a.x[k - K, n + 1]
    k = index_of(c, k - 2 * K)
    return (b.p[k] - a.p[k]) / (c.unit[k] if k < 2 else 1.0)


@small
def rate(c, a, k):
    """The same of the tangent."""
    K, n = len(a.x), a.x.shape[1] - 2
    if k < K:
        return a.tangent[k, n]
    if k < 2 * K:
        return a.tangent[k - K, n + 1]
    return a.tangent_p[index_of(c, k - 2 * K)]


@small
def measured(c, a):
    """The number of unknowns by which distances are measured."""
    return 2 * len(a.x) + unknowns(c)


@small
def bulges(path, c, a, b):
    """Whether a parameter leaves its bounds between a and b and returns: by the cubic through both with tangents."""
    length = 0.0
    for k in range(measured(c, a)):
        length += offset(c, a, b, k) ** 2
    length = math.sqrt(length)
    for j in range(2):
        rise, fall = length * c.unit[j] * a.tangent_p[j], length * c.unit[j] * b.tangent_p[j]
        if rise * fall < 0.0:
            step = b.p[j] - a.p[j]
            bend, twist = 3.0 * step - 2.0 * rise - fall, rise + fall - 2.0 * step
            # rise + 2 bend u + 3 twist u^2 = 0: the zero between 0 and 1, where the ends differ in sign
            u = -rise / (bend + math.copysign(math.sqrt(max(bend * bend - 3.0 * twist * rise, 0.0)), -rise))
            top = a.p[j] + u * (rise + u * (bend + u * twist))
            slack = CAUTION * (top - max(a.p[j], b.p[j]) if rise > 0.0 else top - min(a.p[j], b.p[j]))
            if not path.bounds[j, 0] < top + slack < path.bounds[j, 1]:
                return True
    return False


@small
def comes_back(c, a, first, length):
    """Whether the step from a passes the first point; phases count modulo the forcing period."""
    K, shift = len(a.x), 0.0
    for i in range(K):
        shift += offset(c, a, first, i) / K
    shift = 2.0 * math.pi * math.floor(shift / (2.0 * math.pi) + 0.5)
    along, size = 0.0, 0.0
    for k in range(measured(c, a)):
        away = offset(c, a, first, k) - (shift if k < K else 0.0)
        along += away * rate(c, a, k)
        size += away * away
    return 0.0 <= along <= length and size - along * along < 0.01 * length * length
