"""The normal form of a flip and of a Neimark-Sacker point, to third order and exact: no differences.

The invariant manifold of the critical multiplier is X(z) = (phi_i, D_i, y_1)(z), and one period later X(f(z)):

    flip: f(z) = -z + c z^3        Neimark-Sacker: f(z) = mu z + c z^2 z*

The equations of the orbit (residual.py) hold for X as power series in z and z*. At each order m, z^j z*^k, the unknown
coefficient satisfies J(mu^j mu*^k) X_m = -R_m, with R_m from the lower orders; at the resonant one w gives c:

    c sigma w.(closing rows of v) = -w.R_m

(Kuznetsov, Elements of Applied Bifurcation Theory, 5.4; the parameterisation is that of Cabre, Fontich, de la Llave,
J. Differential Equations 218 (2005) 444.)
"""

import numpy as np

from vibro_sweep.engine.continuation.conditions import expand, multiplier, put_matrix
from vibro_sweep.engine.continuation.factors import factorise, square, substitute
from vibro_sweep.engine.continuation.lasting_series import last_series
from vibro_sweep.engine.continuation.moving_flow import OMEGA, ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW
from vibro_sweep.engine.continuation.power_series import MIRROR, POWERS, grow, put_wave, steady
from vibro_sweep.engine.continuation.problem import FLIP
from vibro_sweep.engine.continuation.reflections import take_down
from vibro_sweep.engine.continuation.workspace import TERMS
from vibro_sweep.engine.simd.jit import small

LINEAR, SQUARE, MIXED, CUBE, RESONANT, OPPOSITE = 1, 3, 4, 6, 7, 9  # places of z, z^2, z z*, z^3, z^2 z*, z*^3


@small
def factor_of(mu, m):
    """mu^j mu*^k."""
    result = 1.0 + 0j
    for _ in range(POWERS[m, 0]):
        result *= mu
    for _ in range(POWERS[m, 1]):
        result *= mu.conjugate()
    return result


@small
def meet(f, one_plus_R, e, D, series, y, jets, left):
    """left (2, TERMS): rows 1 and 2 of an impact, for the state y (n, TERMS) before it at its own phase."""
    N, R1 = f.A.shape[0] // 2, f.numbers[one_plus_R]
    put_wave(e.turn, series[0], jets)
    for m in range(TERMS):
        left[0, m] = y[0, m] + steady(f.Z[0], jets[3], jets[4], m)
        left[1, m] = series[1, m] + R1 * (y[N, m] + steady(f.Z[N], jets[3], jets[4], m))
    left[1, 0] += D


@small
def fly_series(f, e, delay, y, landing, turned, jets):
    """y becomes E exp(A delay/omega) (y, 1), all power series.

    landing, turned : room like y
    """
    n = f.A.shape[0]
    for m in range(TERMS):
        y[n, m] = 1.0 if m == 0 else 0.0
    grow(f.A, n, n + 1, 1.0 / f.numbers[OMEGA], delay, y, landing, turned, jets)
    for m in range(TERMS):
        for r in range(n + 1):
            landing[r, m] = y[r, m]
        for r in range(n):
            y[r, m] = 0.0
            for q in range(n + 1):
                y[r, m] += e.E[0, r, q] * landing[q, m]


@small
def residuals(f, c, place, b, mu):
    """`left` of the events and `closing`: coefficients of all equations, for those of X in `series` and `first`."""
    K, n = len(place.x), f.A.shape[0]
    N = n // 2
    work = b.work[0]
    y, landing, turned = work.states[0], work.states[1], work.states[2]
    delay = work.jets[2]
    for r in range(n):
        for m in range(TERMS):
            y[r, m] = work.first[r, m]
        y[r, 0] = place.x[0, r]
    for i in range(K):
        e, following = b.events[i], b.events[i + 1 if i + 1 < K else 0]
        one_plus_R, D = ONE_PLUS_R_HIGH if c.sides[i] > 0 else ONE_PLUS_R_LOW, place.x[i, n + 1]
        for m in range(TERMS):
            delay[m] = following.series[0, m] * (1.0 if i + 1 < K else factor_of(mu, m)) - e.series[0, m]
        if c.rests[i]:
            last_series(f, c.compliant, c.sides[i], place.x[i], e, y, work)
            for m in range(TERMS):
                delay[m] -= e.series[1, m]
        else:
            meet(f, one_plus_R, e, D, e.series, y, work.jets, e.left)
            for m in range(TERMS):
                y[N, m] += e.series[1, m]
            y[N, 0] += D
        delay[0] = 0.0
        fly_series(f, e, delay, y, landing, turned, work.jets)
    for r in range(n):
        for m in range(1, TERMS):
            work.closing[r, m] = c.sigma * factor_of(mu, m) * work.first[r, m] - y[r, m]


@small
def solve_order(f, c, place, b, mu, m):
    """The coefficient of order m from its residual. False where mu^j mu*^k is a multiplier."""
    K, n, work, rows = len(place.x), f.A.shape[0], b.work[0], b.trial
    factor = factor_of(mu, m)
    put_matrix(c, b, n, factor, work.border)
    if not square(factorise(work.border, n, work.order)) > 0.0:
        return False
    for i in range(K + 1):
        for r in range(n + 2):
            rows[i, r] = 0.0
        if i < K:
            rows[i, 0], rows[i, 1] = -b.events[i].left[0, m], -b.events[i].left[1, m]
    for r in range(n):
        rows[K - 1, 2 + r] = -work.closing[r, m]
    take_down(b, n, rows, True, work.right)
    substitute(work.border, n, work.order, work.right)
    expand(c, b, n, factor, work.right)
    set_order(f, b, m)
    return True


@small
def set_order(f, b, m):
    """X_m from (xi, dphi, dD) in `events.v`, and its mirror: dy_1 = xi_1 + y' dphi_1."""
    n, first = f.A.shape[0], b.work[0].first
    for i in range(len(b.events)):
        series = b.events[i].series
        for k in range(2):
            value = b.events[i].v[n + k]
            series[k, m] = value
            if MIRROR[m] != m:
                series[k, MIRROR[m]] = value.conjugate()
    e = b.events[0]
    for r in range(n):
        value = e.v[r] + e.rate[r] * e.v[n]
        first[r, m] = value
        if MIRROR[m] != m:
            first[r, MIRROR[m]] = value.conjugate()


@small
def clear_mirror(f, b, m):
    """Clear the terms of conj(z): for a flip, power series are of z alone."""
    for i in range(len(b.events)):
        b.events[i].series[0, MIRROR[m]] = b.events[i].series[1, MIRROR[m]] = 0.0
    for r in range(f.A.shape[0]):
        b.work[0].first[r, MIRROR[m]] = 0.0


@small
def coefficient(f, c, place, b):
    """The coefficient for the v and w of `place`, with z = w.(closing rows of v); NaN where it is not defined.

    Flip: c z, which stays finite at the resonance 1:2. Neimark-Sacker: Re(c mu*) |z|^2.
    """
    K, n, mu = len(place.x), f.A.shape[0], multiplier(c, place)
    for i in range(K):
        for r in range(n + 2):
            b.events[i].v[r] = place.v[i, r]
        for k in range(2):
            for m in range(TERMS):
                b.events[i].series[k, m] = 0.0
    for r in range(n):
        for m in range(TERMS):
            b.work[0].first[r, m] = 0.0
    set_order(f, b, LINEAR)
    if c.kind == FLIP:
        clear_mirror(f, b, LINEAR)
    residuals(f, c, place, b, mu)
    if not solve_order(f, c, place, b, mu, SQUARE):
        return np.nan
    if c.kind == FLIP:
        clear_mirror(f, b, SQUARE)
    elif not solve_order(f, c, place, b, mu, MIXED):
        return np.nan
    residuals(f, c, place, b, mu)
    order = CUBE if c.kind == FLIP else RESONANT
    total, double = 0j, 0j
    for i in range(K):
        total += place.w[i, 0] * b.events[i].left[0, order] + place.w[i, 1] * b.events[i].left[1, order]
    for r in range(n):
        total += place.w[K - 1, 2 + r] * b.work[0].closing[r, order]
        double += place.w[K - 1, 2 + r] * place.v[0, r]
    if c.kind == FLIP:
        return -c.sigma * total.real
    return (-c.sigma * total * double.conjugate() * mu.conjugate()).real
