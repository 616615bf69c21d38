"""Conditions on a periodic orbit: scalar rows with their gradients, which make a bifurcation curve of its equations.

    graze, onset of sticking: D_i = 0        critical multiplier mu = 1, -1, e^{i theta}: g = 0

with g of the bordered G(mu) (residual.py), which is zero where G(mu) is singular (all G(mu) are where a contact without
preload has no length s: there the condition is g/s = 0):

    [G b; c 0] (v, g) = (0, 1)        w.G + g' c = 0, w.b = 1        dg = -w.(dJ) v

The derivative dJ is that of all equations (second_derivative.py), for v and w over all of their unknowns and rows. The
borders are the null vectors of the last point. For a pair, g is complex and theta one unknown more. The graze of a
contact without preload is that of the orbit without it: its turning point is watched, and gap_i = stop_i.
"""

import cmath
import math

import numpy as np

from vibro_sweep.engine.continuation.factors import factorise, square, substitute, substitute_transposed
from vibro_sweep.engine.continuation.lasting import factor_of_grazes, is_watched, turns_at_graze
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA
from vibro_sweep.engine.continuation.problem import FOLD, ORBIT, TORUS, conditions, is_critical
from vibro_sweep.engine.continuation.reflections import (
    clear_sides,
    reduce_row,
    substitute_back,
    take_down,
    take_up,
)
from vibro_sweep.engine.continuation.second_derivative import differentiate
from vibro_sweep.engine.continuation.workspace import THETA
from vibro_sweep.engine.simd.jit import small


@small
def multiplier(c, place):
    """mu of the curve."""
    if c.kind == TORUS:
        return cmath.exp(1j * place.p[THETA])
    return (1.0 if c.kind == FOLD else -1.0) + 0j


@small
def put_matrix(c, b, n, mu, out):
    """G(mu)."""
    last, X = b.work[0].last, 2 * n + 2
    for r in range(n):
        for j in range(n):
            out[r, j] = c.sigma * mu * last[r, j] + last[r, X + j]


@small
def expand(c, b, n, mu, first):
    """`events.v` from xi_1 and the right sides in `events.sides`, for what grows by mu from period to period."""
    K, after = len(b.events), b.work[0].side
    for r in range(n):
        after[r] = c.sigma * mu * first[r]
    for i in range(K - 1, -1, -1):
        e = b.events[i]
        for r in range(n + 2):
            e.v[r] = e.sides[r]
        if i + 1 < K:
            substitute_back(e, n, b.events[i + 1].v, first, e.v)
        else:
            substitute_back(e, n, after, first, e.v)


@small
def null_vectors(c, place, b, n, mu):
    """v and w in `events`, bordered by those of `place`, and g. NaN where the bordered matrix is singular."""
    work = b.work[0]
    G, v, w, size = work.border, work.right, work.left, 0.0
    put_matrix(c, b, n, mu, G)
    take_down(b, n, place.w, False, w)
    for r in range(n):
        v[r] = place.v[0, r].conjugate()
        size += square(w[r])
    for r in range(n):
        G[r, n] = w[r].conjugate() if size > 0.0 else 1.0
        G[n, r] = v[r] if size > 0.0 else 1.0
        v[r] = w[r] = 0.0
    G[n, n] = 0.0
    if not square(factorise(G, n + 1, work.order)) > 0.0:
        return complex(np.nan, 0.0)
    side = work.side
    for r in range(n + 1):
        side[r] = 1.0 if r == n else 0.0
    substitute_transposed(G, n + 1, work.order, side)
    for r in range(n):
        w[r] = side[r]
    for r in range(n + 1):
        side[r] = 1.0 if r == n else 0.0
    substitute(G, n + 1, work.order, side)
    for r in range(n):
        v[r] = side[r]
    g = side[n]
    clear_sides(b)
    expand(c, b, n, mu, v)
    take_up(b, n, w, b.trial)
    for i in range(len(b.events)):
        e = b.events[i]
        for r in range(n + 2):
            e.w[r] = b.trial[i, r]
    return g


@small
def keep_null_vectors(place, b, n):
    """v and w of `place` become those in `events`, of length 1 and turned as those before; returns both lengths."""
    K, size_v, size_w, turn_v, turn_w = len(b.events), 0.0, 0.0, 0j, 0j
    for i in range(K + 1):
        for r in range(n + 2):
            size_w += square(b.trial[i, r])
            turn_w += b.trial[i, r] * place.w[i, r].conjugate()
            if i < K:
                size_v += square(b.events[i].v[r])
                turn_v += b.events[i].v[r] * place.v[i, r].conjugate()
    size_v, size_w = math.sqrt(size_v), math.sqrt(size_w)
    scale_v, scale_w = turned(turn_v) / size_v, turned(turn_w) / size_w
    for i in range(K + 1):
        for r in range(n + 2):
            place.w[i, r] = b.trial[i, r] * scale_w
            if i < K:
                place.v[i, r] = b.events[i].v[r] * scale_v
    return scale_v, scale_w


@small
def turned(product):
    """The number of size 1 that turns a vector with this product with another one to it."""
    size = math.sqrt(square(product))
    return product.conjugate() / size if size > 0.0 else 1.0 + 0j


@small
def put_conditions(f, c, place, b):
    """The scalar rows of the curve's conditions, with what they leave. False where they are singular."""
    n, work = f.A.shape[0], b.work[0]
    for k in range(conditions(c)):
        work.row_left[k] = 0.0
        for j in range(3):
            work.row_p[k, j] = 0.0
        for i in range(len(b.events)):
            rows = b.events[i].rows
            for r in range(n + 2):
                rows[k, r] = 0.0
    if c.kind == ORBIT:
        return True
    if is_watched(f, c, c.index):
        e, stop = b.events[c.index], HIGH if c.sides[c.index] > 0 else LOW
        e.rows[0, 0], e.rows[0, n] = 1.0, e.motion[0] / f.numbers[OMEGA]
        work.row_left[0] = e.gap - f.numbers[stop]
        for j in range(c.parameters):
            work.row_p[0, j] = ((f.Z_slopes[j, 0] * e.turn).real - f.number_slopes[j, stop]) * c.unit[j]
        reduce_row(c, b, n, 0)
        return True
    if not is_critical(c):
        b.events[c.index].rows[0, n + 1], work.row_left[0] = 1.0, place.x[c.index, n + 1]
        reduce_row(c, b, n, 0)
        return True
    mu = multiplier(c, place)
    g = null_vectors(c, place, b, n, mu)
    if not square(g) < np.inf:
        return False
    differentiate(f, c, place, b, mu)
    K, turn, grazes = len(b.events), 0j, factor_of_grazes(f, c, place)
    for r in range(n):  # theta turns the closure alone
        turn -= b.events[K - 1].w[2 + r] * b.events[0].v[r]
    turn *= c.sigma * 1j * mu
    for k in range(conditions(c)):
        unit = 1.0 + 0j if k == 0 else -1j  # the imaginary part is the real one of -1j g
        work.row_left[k] = (unit * (g - work.defect)).real / grazes
        for i in range(K):
            e = b.events[i]
            for r in range(n + 2):
                e.rows[k, r] = -(unit * e.slopes[r]).real / grazes
            if c.rests[i] and turns_at_graze(f, c.compliant, c.sides[i]):
                e.rows[k, n + 1] -= work.row_left[k] / place.x[i, n + 1]
        for j in range(c.parameters):
            work.row_p[k, j] = -(unit * work.slopes_p[j]).real * c.unit[j] / grazes
        work.row_p[k, THETA] = (unit * turn).real / grazes
        reduce_row(c, b, n, k)
    return True
