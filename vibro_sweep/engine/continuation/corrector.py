"""Newton's method for a point of a solution set on a plane, and the tangent there."""

import math

import numpy as np

from vibro_sweep.engine.continuation.chatter_tail import sum_tail
from vibro_sweep.engine.continuation.conditions import put_conditions
from vibro_sweep.engine.continuation.factors import factorise, substitute
from vibro_sweep.engine.continuation.problem import STICK, conditions, index_of, unknowns
from vibro_sweep.engine.continuation.reflections import put_last, reduce_row, take_apart
from vibro_sweep.engine.continuation.residual import eliminate, fly_through
from vibro_sweep.engine.simd.jit import jit


@jit
def assemble(f, c, place, b):
    """The last equations of a point, but the plane, at the parameters to which f was moved. False: singular."""
    work = b.work[0]
    fly_through(f, c, place, b)
    if c.kind == STICK:
        sum_tail(f, c, place, b)
    work.sign = eliminate(f, c, place, b, False)
    if work.sign == 0.0:
        return False
    put_last(c, b, f.A.shape[0])
    return put_conditions(f, c, place, b)


@jit
def put_plane(f, c, b, row):
    """The plane through the point across `row`: dphi (K,), dD (K,), parameters in their units, theta."""
    n, K, k, work = f.A.shape[0], len(b.events), conditions(c), b.work[0]
    for i in range(K):
        rows = b.events[i].rows
        for r in range(n):
            rows[k, r] = 0.0
        rows[k, n], rows[k, n + 1] = row[i], row[K + i]
    for j in range(3):
        work.row_p[k, j] = row[2 * K + j]
    work.row_left[k] = 0.0
    reduce_row(c, b, n, k)
    work.ends[n + k, n + unknowns(c) + 1] = 1.0


@jit
def solve_on_plane(f, c, b, row):
    """`events.changes` and `work.step_p`: Newton's change on the plane, and the tangent. False: singular.

    Where the condition leaves a single point, there is no plane and no tangent.
    """
    n, m, work = f.A.shape[0], unknowns(c), b.work[0]
    along = conditions(c) < m
    if along:
        put_plane(f, c, b, row)
    size = n + m
    for r in range(size):
        for j in range(size):
            work.system[r, j] = work.ends[r, j]
    if not abs(factorise(work.system, size, work.order)) > 0.0:
        return False
    for s in range(2 if along else 1):
        for j in range(size):
            work.null[j] = work.ends[j, size + s]
        substitute(work.system, size, work.order, work.null)
        for j in range(3):
            work.step_p[s, j] = 0.0
        for j in range(m):
            work.step_p[s, index_of(c, j)] = work.null[n + j]
        take_apart(f, c, b, s, work.null, work.step_p[s], s == 0)
    return True


@jit
def newton_step(f, c, place, row, b):
    """One correction of `place` on the plane across `row`, at the parameters to which f was moved. Its size, or NaN.

    place.tangent becomes the tangent, row.tangent = 1.
    """
    n, work = f.A.shape[0], b.work[0]
    if not (assemble(f, c, place, b) and solve_on_plane(f, c, b, row)):
        return np.nan
    change = 0.0
    for j in range(3):
        change = max(change, abs(work.step_p[0, j]))
    for i in range(len(b.events)):
        x = b.events[i].changes[0]
        change = max(change, abs(x[n]), abs(x[n + 1]))
    if not change <= 1.0:
        return np.nan
    if conditions(c) < unknowns(c):
        take_tangent(f, place, b)
    for i in range(len(b.events)):
        e = b.events[i]
        for r in range(n + 2):
            place.x[i, r] -= e.changes[0, r]
        for r in range(n):
            place.x[i, r] -= e.rate[r] * e.changes[0, n]
    for j in range(3):
        place.p[j] -= work.step_p[0, j] * (c.unit[j] if j < 2 else 1.0)
    return change


@jit
def take_tangent(f, place, b):
    """place.tangent from the second of the changes: of y, phi, D."""
    n = f.A.shape[0]
    for i in range(len(b.events)):
        e = b.events[i]
        for r in range(n + 2):
            place.tangent[i, r] = e.changes[1, r]
        for r in range(n):
            place.tangent[i, r] += e.rate[r] * e.changes[1, n]
    for j in range(3):
        place.tangent_p[j] = b.work[0].step_p[1, j]


@jit
def move(c, place, tangent, tangent_p, length):
    """Add `length` times a tangent."""
    for i in range(len(place.x)):
        for r in range(place.x.shape[1]):
            place.x[i, r] += length * tangent[i, r]
    for j in range(3):
        place.p[j] += length * tangent_p[j] * (c.unit[j] if j < 2 else 1.0)


@jit
def in_order(f, c, place):
    """Whether the events follow one another."""
    K, n = len(place.x), f.A.shape[0]
    for i in range(K):
        end = place.x[i, n] + (max(place.x[i, n + 1], 0.0) if c.rests[i] else 0.0)
        if not (place.x[i + 1, n] if i + 1 < K else place.x[0, n] + math.pi * f.half_turns) > end:
            return False
    return True
