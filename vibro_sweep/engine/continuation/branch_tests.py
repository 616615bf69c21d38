"""Tests along a branch: zero at its special points; and what happens between two of its points."""

import math

import numpy as np

from vibro_sweep.engine.continuation.between_points import changes_sign, dips, turns_back
from vibro_sweep.engine.continuation.certificate import certify
from vibro_sweep.engine.continuation.curve_tests import determinant, eigenvalues_of, passes_birth
from vibro_sweep.engine.continuation.lasting import factor_of_grazes, sign_of_events, speed_before
from vibro_sweep.engine.continuation.moving_flow import OMEGA, ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW
from vibro_sweep.engine.continuation.workspace import BRANCH_TESTS, TEST
from vibro_sweep.engine.impulses.pairs import ON_PAIR, ON_SQUARE, exchanged
from vibro_sweep.engine.simd.jit import noinline, small

PASSED = 1e-13  # distance beyond a stop, in units of the gap, which rounding does not explain
ZERO = ON_SQUARE**2, ON_PAIR**2  # of |1 + mu|^2 and |1 - mu_i mu_j|^2: what no point of a branch comes to by chance
FAR_OUTSIDE = 0.5  # of |mu|^2 - 1: multipliers from there on do not reach the circle within a step and go back


@small
def examine_branch(f, c, place, b):
    """Tests and certificate of a corrected point of a branch, for which `assemble` has filled b."""
    n, x, work = f.A.shape[0], place.tests, b.work[0]
    x[TEST.rate], x[TEST.stop_distance] = place.tangent_p[0], certify(f, c, place, b)
    x[TEST.release] = x[TEST.hold] = x[TEST.away] = np.inf
    x[TEST.pair] = x[TEST.reflected] = x[TEST.crossing] = 1.0
    x[TEST.below] = x[TEST.pairs] = x[TEST.on_circle] = 0.0
    x[TEST.above] = -1.0
    for i in range(len(b.events)):
        if c.rests[i]:
            x[TEST.hold] = min(x[TEST.hold], b.events[i].hold, speed_before(c, i, b.events[i]))
        elif f.numbers[ONE_PLUS_R_HIGH if c.sides[i] > 0 else ONE_PLUS_R_LOW] == 1.0:
            after = b.events[i].motion[1] + f.numbers[OMEGA] * b.events[i].bend[n // 2]
            x[TEST.release] = min(x[TEST.release], -c.sides[i] * after)
    x[TEST.minus] = determinant(c, b, n, -1.0)
    grazes = factor_of_grazes(f, c, place)
    x[TEST.rate] /= grazes
    x[TEST.minus] /= grazes
    for i in range(n):
        place.multipliers[i, 0] = place.multipliers[i, 1] = np.nan
    if not eigenvalues_of(c, b, n):
        return
    x[TEST.above], squares = 0.0, 1.0
    for i in range(n):
        re, im = work.re[i], work.im[i]
        place.multipliers[i, 0], place.multipliers[i, 1] = re, im
        size = re * re + im * im
        squares *= 1.0 + size
        if abs(size - 1.0) < (ON_SQUARE if im == 0.0 else ON_PAIR):
            x[TEST.on_circle] += 1.0
        elif size > 1.0:
            x[TEST.away] = min(x[TEST.away], size - 1.0)
            if im != 0.0:
                x[TEST.pairs] += 0.5
            else:
                x[TEST.above if re > 0.0 else TEST.below] += 1.0
    take_products(work.re, work.im, math.sqrt(squares), x[TEST.on_circle] > 0.0, x)


@noinline
def take_products(re, im, root, without_zeros, x):
    """The tests `reflected`, `pair` and `crossing`; where multipliers are on the circle, without factors that are zero
    at all points.

    `pair` is zero at a Neimark-Sacker point, and at a neutral saddle; 1 without losses.
    """
    X, Y, p, q, u, v = 1.0, 0.0, 1.0, 0.0, 1.0, 0.0
    n = len(re)
    for i in range(n):
        u, v = u * re[i] - v * im[i], u * im[i] + v * re[i]
        r, s = 1.0 + re[i], im[i]
        if not without_zeros or r * r + s * s > ZERO[0]:
            p, q = p * r - q * s, p * s + q * r
        for j in range(i):
            r, s = 1.0 - re[i] * re[j] + im[i] * im[j], -re[i] * im[j] - im[i] * re[j]
            if not without_zeros or r * r + s * s > ZERO[1]:
                X, Y = X * r - Y * s, X * s + Y * r
    x[TEST.reflected] = p / root
    if n > 2 and abs(math.hypot(u, v) - 1.0) > 1e-9:
        x[TEST.pair], x[TEST.crossing] = X, X / root ** (n - 1)


@small
def counts_differ(x, y):
    """Whether multipliers cross the unit circle between two points, as far as counts tell.

    Two real ones of one sign that become a pair, or the reverse, do so outside of it where all are far from it.
    """
    if x[TEST.above] < 0.0 or y[TEST.above] < 0.0:
        return False
    above, below, pairs = y[TEST.above] - x[TEST.above], y[TEST.below] - x[TEST.below], y[TEST.pairs] - x[TEST.pairs]
    if x[TEST.on_circle] != y[TEST.on_circle]:
        return True
    if above == 0.0 and below == 0.0 and pairs == 0.0:
        return False
    collide = above + below + 2.0 * pairs == 0.0 and above % 2.0 == 0.0 and below % 2.0 == 0.0
    return not (collide and min(x[TEST.away], y[TEST.away]) > FAR_OUTSIDE)


@small
def crosses_over(c, a, b):
    """Whether b lies on another branch than a, as far as tests tell: where an offset unfolds a pitchfork, two run close
    beside each other.

    sign(dp/ds) (-1)^(number of multipliers > 1) prod_i sign(D_i) is the same all along a branch: two of the three
    change at folds, and at grazes; at a birth the first alone. Where the last is not known the step must be shorter.
    """
    x, y = a.tests, b.tests
    if x[TEST.above] < 0.0 or y[TEST.above] < 0.0 or x[TEST.on_circle] > 0.0 or y[TEST.on_circle] > 0.0:
        return False
    sign, crossed = sign_of_events(c, b), (x[TEST.above] + y[TEST.above]) % 2.0 != 0.0
    if sign == 0.0:
        return True
    turns = a.tangent_p[0] * b.tangent_p[0] < 0.0
    return turns != (crossed != (sign < 0.0)) and not passes_birth(c, a, b)


@small
def happens_on_branch(c, a, b):
    """Whether a test changes its sign between two points, multipliers cross the unit circle, or b is out of the stops;
    or whether something may do so twice."""
    x, y, D = a.tests, b.tests, a.x.shape[1] - 1
    for i in (TEST.release, TEST.hold, TEST.relaxed):
        if x[i] > 0.0 >= y[i]:
            return True
    for i in range(len(a.x)):
        side = 1.0 if c.rests[i] else -c.sides[i]
        here, there = side * a.x[i, D], side * b.x[i, D]
        if not there > 0.0 or turns_back(here, side * a.tangent[i, D], there, side * b.tangent[i, D], y[TEST.length]):
            return True
    if x[TEST.stop_distance] > 0.0 >= y[TEST.stop_distance] or y[TEST.stop_distance] < -PASSED:
        return True
    if counts_differ(x, y) or exchanged(a.multipliers, b.multipliers):
        return True
    for i in BRANCH_TESTS:
        if changes_sign(x[i], y[i]):
            return True
    return False


@small
def touches_on_branch(path, a, b):
    """Whether what is watched may vanish twice beside a, which lies between the point before it and b."""
    before, x, y, z = path.before[0], path.past.tests, a.tests, b.tests
    if before == 0.0:
        return False
    for i in (TEST.rate, TEST.stop_distance, TEST.reflected, TEST.crossing):
        if dips(x[i], y[i], z[i], before, z[TEST.length]):
            return True
    return False
