"""Tests along a bifurcation curve: zero at its points of codimension two."""

import math

import numpy as np

from vibro_sweep.engine.continuation.between_points import changes_sign, dips
from vibro_sweep.engine.continuation.certificate import certify
from vibro_sweep.engine.continuation.chatter_sum import REACH
from vibro_sweep.engine.continuation.conditions import keep_null_vectors
from vibro_sweep.engine.continuation.factors import factorise, solve_rows
from vibro_sweep.engine.continuation.lasting import corner_of, factor_of_grazes, has_losses, has_rests, is_watched
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.continuation.normal_form import coefficient
from vibro_sweep.engine.continuation.problem import FLIP, FOLD, GRAZE, STICK, TORUS, is_critical
from vibro_sweep.engine.continuation.residual import eliminate
from vibro_sweep.engine.continuation.workspace import CURVE_TESTS, TEST, THETA
from vibro_sweep.engine.simd.jit import small
from vibro_sweep.engine.variational.eigenvalues import eigenvalues

LATEST, EARLIEST = 0.9, 0.4  # of the tests `last` and `before`, where another number of impacts is to be written out
NEAR_STRONG = 0.05  # theta from 0 or pi: the resonance 1:1 or 1:2
TOUCHING = 1e-12  # stop_distance, in parts of the size of the gap, that counts as zero


@small
def determinant(c, b, n, mu):
    """The determinant of G(mu), with the sign of what was eliminated."""
    work, X = b.work[0], 2 * n + 2
    for r in range(n):
        for j in range(n):
            work.matrix[r, j] = c.sigma * mu * work.last[r, j] + work.last[r, X + j]
    return work.sign * factorise(work.matrix, n, work.order)


@small
def eigenvalues_of(c, b, n):
    """Multipliers, real parts in `work.re` and imaginary ones in `work.im`: eigenvalues of -sigma ahead^-1 behind."""
    work, X = b.work[0], 2 * n + 2
    for r in range(n):
        for j in range(n):
            work.image[r, j], work.image[r, n + j] = work.last[r, j], -c.sigma * work.last[r, X + j]
    if not solve_rows(work.image, n, 2 * n):
        return False
    for r in range(n):
        for j in range(n):
            work.matrix[r, j] = work.image[r, n + j]
    return eigenvalues(work.matrix, n, work.re, work.im)


@small
def pair_test(c, place, b, n):
    """prod_{i<j} (1 - mu_i mu_j) of the multipliers but the critical one.

    Zero where a pair passes the unit circle, and at a neutral saddle. 1 without losses.
    """
    if not eigenvalues_of(c, b, n):
        return 1.0
    re, im, left = b.work[0].re, b.work[0].im, -1
    if c.kind == FOLD or c.kind == FLIP:
        mu, least = 1.0 if c.kind == FOLD else -1.0, math.inf
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


@small
def examine_curve(f, c, place, b):
    """Tests and certificate of a corrected point, for which `assemble` has filled b; its new v and w. False: singular.

    Of a graze, those of the orbit without the impact come from a second elimination, in which it is only watched.
    """
    n, tests = f.A.shape[0], place.tests
    for i in CURVE_TESTS:
        tests[i] = 1.0
    for r in range(n):
        place.multipliers[r, 0] = place.multipliers[r, 1] = np.nan
    tests[TEST.stop_distance] = certify(f, c, place, b)
    tests[TEST.hold] = np.inf
    for i in range(len(b.events)):
        if c.rests[i]:
            tests[TEST.hold] = min(tests[TEST.hold], b.events[i].hold)
    if c.kind == STICK:
        K, reach = len(place.x), b.tail[0].numbers[REACH] * f.numbers[OMEGA]
        end = place.x[0, n] + math.pi * f.half_turns
        tests[TEST.last], tests[TEST.before] = (end - place.x[K - 1, n]) / reach, (end - place.x[K - 2, n]) / reach
        return True
    grazes = factor_of_grazes(f, c, place)
    if is_critical(c):
        examine_null_vectors(f, c, place, b, n, grazes)
    # where nothing jumps at the graze this is the orbit without the contact
    watched = is_watched(f, c, c.index) and corner_of(f, c, c.index) == 0.0
    if c.kind != FOLD and not watched:
        tests[TEST.plus] = determinant(c, b, n, 1.0) / grazes
    if c.kind != FLIP and not watched:
        tests[TEST.minus] = determinant(c, b, n, -1.0) / grazes
    if (c.kind == TORUS or (c.kind == FLIP and has_losses(f, c))) and not has_rests(c):
        # det G(1) takes away the pole where the orbit has the multiplier 1 as well
        tests[TEST.normal] = coefficient(f, c, place, b) * tests[TEST.plus]
    if c.kind == GRAZE:
        b.work[0].sign = eliminate(f, c, place, b, True)
        if b.work[0].sign == 0.0:
            return False
        tests[TEST.bare_plus] = determinant(c, b, n, 1.0)
        tests[TEST.bare_minus] = determinant(c, b, n, -1.0)
    if c.kind != TORUS and n > 2:
        tests[TEST.pair] = pair_test(c, place, b, n)
    return True


@small
def examine_null_vectors(f, c, place, b, n, grazes):
    """Tests for a double mu, and of a fold for a cusp. Without losses multipliers are pairs mu, 1/mu, and mu is double
    all along the curve.

    Where a contact has no length s, w is zero but for its own equation: the first has the factor s, the second s^2.
    """
    K, double, cusp = len(b.events), 0j, 0j
    scale_v, scale_w = keep_null_vectors(place, b, n)
    for i in range(K):
        e = b.events[i]
        for r in range(n + 2):
            cusp += e.slopes[r] * e.v[r]
    for r in range(n):
        double += place.w[K - 1, 2 + r] * place.v[0, r]
    if c.kind != TORUS:
        place.tests[TEST.double] = double.real / grazes if has_losses(f, c) else np.nan
    if c.kind == FOLD:
        place.tests[TEST.cusp] = (cusp * scale_v * scale_v * scale_w).real / (grazes * grazes)


@small
def passes(a, b):
    """Whether a distance changes its sign by more than rounding: where both stops are touched at once, it is zero."""
    return (a > TOUCHING and b < -TOUCHING) or (a < -TOUCHING and b > TOUCHING)


@small
def is_born(c, sign, a, b):
    """Whether the difference of the two halves of the orbit (sign -1: a half from the other's mirror) changes its sign.

    A necessary condition, from the jumps alone; analysis/curves/ends.py looks closer.
    """
    K, D = len(a.x), a.x.shape[1] - 1
    half, touch = K // 2, c.index if c.kind == GRAZE and K % 2 == 1 else K
    product, size_a, size_b = 0.0, 0.0, 0.0
    for k in range(half):  # a touch that only one half has does not count
        i, j = k + (1 if k >= touch else 0), k + half + (1 if k + half >= touch else 0)
        x, y = a.x[j, D] - sign * a.x[i, D], b.x[j, D] - sign * b.x[i, D]
        product += x * y
        size_a += x * x
        size_b += y * y
    return min(size_a, size_b) > 1e-18 and product < -0.5 * math.sqrt(size_a * size_b)  # else one orbit taken twice


@small
def passes_birth(c, a, b):
    """Whether the orbits of the curve may be born between two points: from orbits of half the period, or symmetric
    ones."""
    return (c.repeats and is_born(c, 1.0, a, b)) or (c.mirrors and is_born(c, -1.0, a, b))


@small
def happens_on_curve(c, a, b):
    """Whether a test changes its sign between two points, or a pair comes near to 1 or -1."""
    if passes_birth(c, a, b):
        return True
    for i in (*CURVE_TESTS, TEST.hold, TEST.relaxed):
        if changes_sign(a.tests[i], b.tests[i]):
            return True
    D = a.x.shape[1] - 1
    for i in range(len(a.x)):
        if a.x[i, D] * b.x[i, D] < 0.0 and not (c.kind >= GRAZE and i == c.index):
            return True
    if passes(a.tests[TEST.stop_distance], b.tests[TEST.stop_distance]):
        return True
    if c.kind == TORUS:
        for angle in (math.pi / 2, 2 * math.pi / 3):
            if (a.p[THETA] - angle) * (b.p[THETA] - angle) <= 0.0:
                return True
        return not NEAR_STRONG < b.p[THETA] < math.pi - NEAR_STRONG
    return False


@small
def touches_on_curve(path, a, b):
    """Whether a test may vanish twice beside a, which lies between the point before it and b."""
    x, y, z = path.past.tests, a.tests, b.tests
    for i in (*CURVE_TESTS, TEST.stop_distance):
        if dips(x[i], y[i], z[i], path.before[0], z[TEST.length]):
            return True
    return False


@small
def overflows(c, place):
    """Whether more or fewer impacts of a chatter sequence are to be written out."""
    return c.kind == STICK and (place.tests[TEST.last] > LATEST or place.tests[TEST.before] < EARLIEST)
