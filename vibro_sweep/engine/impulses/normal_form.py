"""The normal form of a flip and of a Neimark-Sacker point, to third order and exact: no differences.

The invariant manifold of the critical multiplier is X(z) = (t_i, D_i, h_1)(z), and one period later X(f(z)):

    flip: f(z) = -z + c z^3        Neimark-Sacker: f(z) = mu z + c z^2 z*

The equations of the orbit (condensed.py) hold for X as power series in z and z*. At each order m, z^j z*^k, the unknown
coefficient satisfies M(mu^j mu*^k) X_m = -R_m, with R_m from the lower orders; at the resonant one psi gives c:

    c sigma psi.(closing rows of w) = -psi.R_m

(Kuznetsov, Elements of Applied Bifurcation Theory, 5.4; the parameterisation is that of Cabre, Fontich, de la Llave,
J. Differential Equations 218 (2005) 444.)
"""

import numpy as np

from vibro_sweep.engine.impulses.factors import factorise, square
from vibro_sweep.engine.impulses.locus import FLIP, TERMS, multiplier
from vibro_sweep.engine.impulses.plane import GAIN_HIGH, GAIN_LOW, OMEGA
from vibro_sweep.engine.impulses.turned import put_equations, solve
from vibro_sweep.engine.simd.jit import jit

POWERS = np.array([(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)])  # j, k of z^j z*^k
_PLACE = {tuple(power): place for place, power in enumerate(POWERS.tolist())}
PRODUCT = np.array([[_PLACE.get((a + c, b + d), -1) for c, d in POWERS.tolist()] for a, b in POWERS.tolist()])
MIRROR = np.array([_PLACE[k, j] for j, k in POWERS.tolist()])  # of the complex conjugate
LINEAR, SQUARE, MIXED, CUBE, RESONANT = 1, 3, 4, 6, 7


@jit
def times(a, b, out):
    """out = a b, to third order."""
    for i in range(TERMS):
        out[i] = 0.0
    for i in range(TERMS):
        for j in range(TERMS):
            if PRODUCT[i, j] >= 0:
                out[PRODUCT[i, j]] += a[i] * b[j]


@jit
def factor_of(mu, m):
    """mu^j mu*^k."""
    result = 1.0 + 0j
    for _ in range(POWERS[m, 0]):
        result *= mu
    for _ in range(POWERS[m, 1]):
        result *= mu.conjugate()
    return result


@jit
def residuals(f, c, place, b, mu):
    """b.left: the coefficients of all equations (S, TERMS), for the coefficients of X in b.series (S, TERMS).

    X has t_i, D_i, h_1 one after the other.
    """
    K, S = len(place.t), len(place.w)
    n = S - 2 * K
    N, omega = n // 2, f.numbers[OMEGA]
    X, left, jets = b.series, b.left, b.jets
    h, y, turned = b.states[0], b.states[1], b.states[2]
    power, other, delay = jets[0], jets[1], jets[2]
    for r in range(n):
        for m in range(TERMS):
            h[r, m] = X[2 * K + r, m]
        h[r, 0] = b.room.h[0, r]
    for i in range(K):
        gain = GAIN_HIGH if c.sides[i] > 0 else GAIN_LOW
        R1, e = f.numbers[gain], b.room.turns[i]
        # Re(Z e^{i phi}) with e^{i omega dt} = 1 + x + x^2/2 + x^3/6
        for m in range(TERMS):
            power[m], left[i, m], left[K + i, m] = 0.0, h[0, m], X[K + i, m] + R1 * h[N, m]
        left[K + i, 0] += place.D[i]
        power[0] = 1.0
        back = e.conjugate()
        gap, speed, gap_back, speed_back = f.Z[0] * e, f.Z[N] * e, f.Z[0].conjugate() * back, f.Z[N].conjugate() * back
        weight = 1.0 + 0j
        for k in range(4):
            sign = 1.0 if k % 2 == 0 else -1.0
            for m in range(TERMS):
                left[i, m] += 0.5 * (gap + sign * gap_back) * weight * power[m]
                left[K + i, m] += 0.5 * R1 * (speed + sign * speed_back) * weight * power[m]
            times(power, X[i], other)
            for m in range(TERMS):
                power[m] = other[m]
            weight *= 1j * omega / (k + 1)
        # the flight: E exp(A delay) (h + D e_v)
        following = i + 1 if i + 1 < K else 0
        for m in range(TERMS):
            delay[m] = X[following, m] * (1.0 if i + 1 < K else factor_of(mu, m)) - X[i, m]
            h[N, m] += X[K + i, m]
        h[N, 0] += place.D[i]
        delay[0] = 0.0
        for r in range(n):
            for m in range(TERMS):
                y[r, m] = h[r, m]
        constant, weight = 1.0, 1.0
        for k in range(1, 4):  # terms A^k delay^k/k! of (h, 1), added up in y
            for r in range(n):
                for m in range(TERMS):
                    turned[r, m] = 0.0
                    for q in range(n):
                        turned[r, m] += f.A[r, q] * h[q, m]
                turned[r, 0] += f.A[r, n] * constant
            constant = 0.0
            weight /= k
            for r in range(n):
                for m in range(TERMS):
                    h[r, m] = turned[r, m]
                for m in range(TERMS):
                    power[m] = h[r, m]
                for _ in range(k):
                    times(power, delay, other)
                    for m in range(TERMS):
                        power[m] = other[m]
                for m in range(TERMS):
                    y[r, m] += weight * power[m]
        for r in range(n):
            for m in range(TERMS):
                h[r, m] = 0.0
                for q in range(n):
                    h[r, m] += b.room.E[i, 0, r, q] * y[q, m]
            h[r, 0] += b.room.E[i, 0, r, n]
    for r in range(n):
        for m in range(1, TERMS):
            left[2 * K + r, m] = c.sigma * factor_of(mu, m) * X[2 * K + r, m] - h[r, m]


@jit
def solve_order(c, place, b, mu, m):
    """The coefficient of order m from its residual. False where mu^j mu*^k is a multiplier."""
    K, S = len(place.t), len(place.w)
    factor = factor_of(mu, m)
    put_equations(b.B, c, b.room.M, K, factor, -1)
    if square(factorise(b.B, S, b.order)) == 0.0:
        return False
    for i in range(S):
        b.w[i] = -b.left[i, m] / c.row_unit[i]
    solve(b.B, S, b.order, K, b.w, b.slope)
    set_order(c, place, b, m, b.w)
    return True


@jit
def set_order(c, place, b, m, w):
    """X_m from scaled (dt, dD, xi_1), and its mirror: dh_1 = xi_1 + h' dt_1."""
    K, S = len(place.t), len(place.w)
    for i in range(S):
        value = w[i] * c.unit[i]
        if i >= 2 * K:
            value += b.room.rate[0, i - 2 * K] * w[0] * c.unit[0]
        b.series[i, m] = value
        if MIRROR[m] != m:
            b.series[i, MIRROR[m]] = value.conjugate()


@jit
def coefficient(f, c, place, b):
    """For normalised w and psi, with z = psi.(closing rows of w); NaN where it is not defined.

    Flip: c z, which stays finite at the resonance 1:2. Neimark-Sacker: Re(c mu*) |z|^2.
    """
    K, S = len(place.t), len(place.w)
    mu = multiplier(c, place)
    for i in range(S):
        for m in range(TERMS):
            b.series[i, m] = 0.0
    set_order(c, place, b, LINEAR, place.w)
    if c.kind == FLIP:  # z alone
        for i in range(S):
            b.series[i, MIRROR[LINEAR]] = 0.0
    residuals(f, c, place, b, mu)
    if not solve_order(c, place, b, mu, SQUARE):
        return np.nan
    if c.kind == FLIP:
        for i in range(S):
            b.series[i, MIRROR[SQUARE]] = 0.0
    elif not solve_order(c, place, b, mu, MIXED):
        return np.nan
    residuals(f, c, place, b, mu)
    order = CUBE if c.kind == FLIP else RESONANT
    total, double = 0j, 0j
    for i in range(S):
        total += place.psi[i] * b.left[i, order] / c.row_unit[i]
        if i >= 2 * K:
            double += place.psi[i] * place.w[i]
    if c.kind == FLIP:
        return -c.sigma * total.real
    return (-c.sigma * total * double.conjugate() * mu.conjugate()).real
