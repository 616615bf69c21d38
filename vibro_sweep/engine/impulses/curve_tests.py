"""Tests along a bifurcation curve: zero at its points of codimension two."""

import math

import numpy as np

from vibro_sweep.engine.impulses.chatter import REACH
from vibro_sweep.engine.impulses.curve_certificate import certify
from vibro_sweep.engine.impulses.factors import factorise, square
from vibro_sweep.engine.impulses.locus import FLIP, FOLD, GRAZE, STICK, THETA, TORUS
from vibro_sweep.engine.impulses.normal_form import coefficient
from vibro_sweep.engine.impulses.plane import GAIN_HIGH, GAIN_LOW
from vibro_sweep.engine.impulses.turned import put_equations
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.variational.eigenvalues import eigenvalues

# of `Place.tests`; those that do not belong to a kind of curve are 1
PLUS, MINUS, DOUBLE, CUSP, PAIR, BARE_PLUS, BARE_MINUS, NORMAL, MARGIN, LENGTH, RESIDUAL, LAST, BEFORE = range(13)
# LAST, BEFORE: time from the last impact written out, and from the one before, to the end of the chatter, in units of
# the reach of its series
SIGNED = 8  # so many of them are zero at points of codimension two
TOUCHING = 1e-12  # margin, in parts of the size of the gap, that counts as zero


@jit
def determinant(c, place, b, mu, without):
    """Of M(mu), scaled; without: of the orbit without the grazing impact."""
    put_equations(b.matrix, c, b.room.M, len(place.t), mu, c.index if without else -1)
    return factorise(b.matrix, len(place.w), b.order)


@jit
def monodromy(f, c, place, b):
    """b.pair: what becomes of the state before the first impact in a period, of the orbit without the grazing impact.

    False where an impact has no speed.
    """
    K, n = len(place.t), len(place.h)
    N = n // 2
    for j in range(n):
        xi, y = b.re, b.im
        for r in range(n):
            xi[r] = 1.0 if r == j else 0.0
        for i in range(K):
            dt = dD = 0.0
            if not (c.kind == GRAZE and i == c.index):
                v, a = b.room.motion[i]
                if v == 0.0:
                    return False
                dt = -xi[0] / v
                dD = -f.numbers[GAIN_HIGH if c.sides[i] > 0 else GAIN_LOW] * (a * dt + xi[N])
            for r in range(n):
                y[r] = xi[r] - f.A[r, N] * place.D[i] * dt
            y[N] += dD
            for r in range(n):
                xi[r] = 0.0
                for k in range(n):
                    xi[r] += b.room.E[i, 0, r, k] * y[k]
        for r in range(n):
            b.pair[r, j] = c.sigma * xi[r] * c.unit[2 * K + j] / c.row_unit[2 * K + r]
    return True


@jit
def pair_test(f, c, place, b):
    """prod_{i<j} (1 - mu_i mu_j) of the multipliers but the critical one; of the orbit without the grazing impact.

    Zero where a pair passes the unit circle, and at a neutral saddle. 1 without losses.
    """
    n, image = len(place.h), b.pair
    if not monodromy(f, c, place, b):
        return 1.0
    re, im = b.re, b.im
    if not eigenvalues(image, n, re, im):
        return 1.0
    left = -1
    if c.kind == FOLD or c.kind == FLIP:
        mu, least = 1.0 if c.kind == FOLD else -1.0, np.inf
        for i in range(n):  # where mu is double, rounding makes a complex pair of it
            distance = math.hypot(re[i] - mu, im[i])
            if distance < least:
                left, least = i, distance
    x, y, u, v = 1.0, 0.0, 1.0, 0.0
    for i in range(n):
        if i != left:
            place.multipliers[i, 0], place.multipliers[i, 1] = re[i], im[i]
        u, v = u * re[i] - v * im[i], u * im[i] + v * re[i]
        for j in range(i):
            if i != left and j != left:
                p, q = 1.0 - re[i] * re[j] + im[i] * im[j], -re[i] * im[j] - im[i] * re[j]
                x, y = x * p - y * q, x * q + y * p
    return x if abs(math.hypot(u, v) - 1.0) > 1e-9 else 1.0


@jit
def examine(f, c, place, b):
    """Tests and certificate of a corrected point, for which `locus.assemble` has filled b; its new w and psi."""
    K, S = len(place.t), len(place.w)
    tests = place.tests
    for i in range(SIGNED):
        tests[i] = 1.0
    for i in range(len(place.h)):
        place.multipliers[i, 0] = place.multipliers[i, 1] = np.nan
    tests[MARGIN] = certify(f, c, place, b)
    if c.kind == STICK:
        end, reach = place.t[0] + f.P, b.tail.numbers[REACH]
        tests[LAST], tests[BEFORE] = (end - place.t[K - 1]) / reach, (end - place.t[K - 2]) / reach
        return
    if c.kind != GRAZE:
        size_w, size_psi, double, cusp = 0.0, 0.0, 0j, 0j
        for i in range(S):
            size_w += square(b.w[i])
            size_psi += square(b.psi[i])
        size_w, size_psi = math.sqrt(size_w), math.sqrt(size_psi)
        for i in range(S):
            place.w[i], place.psi[i] = b.w[i] / size_w, b.psi[i] / size_psi
            cusp += b.slope[i] * place.w[i] / (size_w * size_psi)
            if i >= 2 * K:
                double += place.w[i] * place.psi[i]
        if c.kind != TORUS:
            tests[DOUBLE] = double.real
        if c.kind == FOLD:
            tests[CUSP] = cusp.real
    if c.kind != FOLD:
        tests[PLUS] = determinant(c, place, b, 1.0, False)
    if c.kind != FLIP:
        tests[MINUS] = determinant(c, place, b, -1.0, False)
    if c.kind == GRAZE:
        tests[BARE_PLUS] = determinant(c, place, b, 1.0, True)
        tests[BARE_MINUS] = determinant(c, place, b, -1.0, True)
    if c.kind != TORUS and S - 2 * K > 2:
        tests[PAIR] = pair_test(f, c, place, b)
    if c.kind == FLIP or c.kind == TORUS:  # det M(1) takes away the pole where the orbit has the multiplier 1 as well
        tests[NORMAL] = coefficient(f, c, place, b) * tests[PLUS]


@jit
def passes(c, a, b):
    """Whether a margin changes its sign by more than rounding: where both stops are touched at once, it is zero."""
    touching = TOUCHING * c.row_unit[0]
    return (a > touching and b < -touching) or (a < -touching and b > touching)


@jit
def is_born(c, sign, a, b):
    """Whether what tells the two halves of the orbit apart (sign -1: a half from the other's mirror) changes its sign.

    A necessary condition, from the impulses alone; analysis/curves/ends.py looks closer.
    """
    half, touch = len(a.t) // 2, c.index if c.kind == GRAZE and len(a.t) % 2 == 1 else len(a.t)
    product, size_a, size_b = 0.0, 0.0, 0.0
    for k in range(half):  # a touch that only one half has does not count
        i, j = k + (1 if k >= touch else 0), k + half + (1 if k + half >= touch else 0)
        x, y = a.D[j] - sign * a.D[i], b.D[j] - sign * b.D[i]
        product += x * y
        size_a += x * x
        size_b += y * y
    least = (1e-9 * c.unit[len(a.t)]) ** 2  # an orbit taken twice has rounding there
    return min(size_a, size_b) > least and product < -0.5 * math.sqrt(size_a * size_b)


@jit
def happens(c, a, b):
    """Whether a test changes its sign between two points."""
    if (c.repeats and is_born(c, 1.0, a, b)) or (c.mirrors and is_born(c, -1.0, a, b)):
        return True
    for i in range(SIGNED):
        if (a.tests[i] > 0.0 > b.tests[i]) or (a.tests[i] < 0.0 < b.tests[i]):  # their product may underflow
            return True
    for i in range(len(a.t)):
        if a.D[i] * b.D[i] < 0.0 and not (c.kind >= GRAZE and i == c.index):
            return True
    if passes(c, a.tests[MARGIN], b.tests[MARGIN]):
        return True
    if c.kind == TORUS:
        for angle in (math.pi / 2, 2 * math.pi / 3):
            if (a.p[THETA] - angle) * (b.p[THETA] - angle) <= 0.0:
                return True
    return False
