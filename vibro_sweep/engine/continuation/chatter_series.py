"""The end of a chatter sequence at the onset of sticking, as power series: infinitely many impacts in one term.

The sequence ends at T with gap = stop, velocity and acceleration 0. Seen backwards from T, the free motion through that
state has the gap stop + sum_m y_m (-s)^m/m!, m >= 3, and one impulse changes the gap by gamma_m u^m/m!. An impact at
T - s is followed by one at T - p(s), and its impulse is D(s). With mu_m(s) = sum over all later impacts of D s_k^m,

    mu_m(s) = D(p) p^m + mu_m(p)
    sum_m y_m (-s)^m/m!         = sum_k D_k gamma(s_k - s)                        the gap is at its stop
    sum_m y_m (-s)^(m-1)/(m-1)! = sum_k D_k gamma'(s_k - s) + D(s) R/(1 + R)      restitution

p, D and mu_m are power series in s, solved order by order: p = s pi(s), D = s^2 d(s), mu_m = s^(m+2) nu_m(s), and
pi(0) = phi with phi^2 (2 + phi) = R (1 + 2 phi) (docs/evidence.md). At each order l two linear
equations give d_l and pi_l, since pi^k and nu_m are linear in them:

    (pi^k)_l = .. + k phi^(k-1) pi_l      nu_m,l = .. + alpha_m d_l + beta_m pi_l
    nu_1,l - nu_0,l = ..                  R/(1 + R) d_l + nu_0,l = ..

Derivatives by the state at T, by T, and by the two parameters satisfy the same equations with other right sides. They
are for Newton's method, which needs fewer orders of them.
"""

import math
from functools import cache

import numpy as np

from vibro_sweep.engine.continuation.moving_flow import ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW
from vibro_sweep.engine.simd.jit import small
from vibro_sweep.engine.simd.memory import record

ORDERS = 16  # of the series
SLOPES = 8  # orders of its derivatives: what is left out is at most 3e-8 of them
FACTORIAL = np.array([math.factorial(m) for m in range(ORDERS + 4)], float)
_CHOOSE = [[math.comb(m, j) * (-1.0) ** (m - j) for j in range(ORDERS + 2)] for m in range(ORDERS + 2)]
GAP = np.array(_CHOOSE) / FACTORIAL[: ORDERS + 2, None]  # of (s_k - s)^m/m!, powers of s_k
SPEED = np.vstack([np.zeros(ORDERS + 2), GAP[:-1]])  # of its derivative


@cache
def tail_of(masses: int) -> np.dtype:
    """W = n + 3 derivatives: by h (n), by the time and by both parameters; they stand behind their numbers."""
    n = 2 * masses
    W = n + 3
    return record([
        ("rows", float, (3, ORDERS + 3, n)),  # e_gap A^m, and its derivatives by the parameters
        ("columns", float, (3, ORDERS + 1, n)),  # A^m e_v
        ("y", float, (ORDERS + 3,)),
        ("y_slopes", float, (ORDERS + 3, W)),
        ("gamma", float, (ORDERS + 2,)),
        ("gamma_slopes", float, (ORDERS + 2, W)),
        ("power", float, (ORDERS, ORDERS + 3)),  # [l, k] is coefficient l of pi^k
        ("power_slopes", float, (SLOPES, ORDERS + 3, W)),
        ("nu", float, (ORDERS, ORDERS + 1)),  # [l, m] is coefficient l of nu_m
        ("nu_slopes", float, (SLOPES, ORDERS + 1, W)),
        ("d", float, (ORDERS,)),
        ("d_slopes", float, (SLOPES, W)),
        ("kept_slopes", float, (W,)),  # of R/(1 + R)
        ("sides", float, (3, W)),  # right sides
        ("Q", float, (n, W + 2)),  # the number, its derivatives, and that by s
        ("numbers", float, 2),  # see chatter_sum.py
        ("by_end", float, (n,)),  # see chatter_tail.py
    ])  # fmt: skip


@small
def start(f, side, tail):
    """phi, its powers, d_0 and nu_m,0, and their derivatives."""
    one_plus_R = ONE_PLUS_R_HIGH if side > 0 else ONE_PLUS_R_LOW
    n, power, nu, d = f.A.shape[0], tail.power, tail.nu, tail.d
    W, R, phi = n + 3, f.numbers[one_plus_R] - 1.0, 1.0
    for _ in range(60):
        step = (phi * phi * (2.0 + phi) - R * (1.0 + 2.0 * phi)) / (3.0 * phi * phi + 4.0 * phi - 2.0 * R)
        phi -= step
        if not abs(step) > 1e-16 * phi:
            break
    power[0, 0] = 1.0
    for k in range(1, ORDERS + 3):
        power[0, k] = power[0, k - 1] * phi
    # nu_m,0 = phi^(m+2)/(1 - phi^(m+2)) d_0
    rest, other = power[0, 2] / (1.0 - power[0, 2]), power[0, 3] / (1.0 - power[0, 3])
    d[0] = tail.y[3] / (6.0 * (rest - other))
    for m in range(ORDERS + 1):
        nu[0, m] = d[0] * power[0, m + 2] / (1.0 - power[0, m + 2])
    for v in range(W):
        by_R = f.number_slopes[v - n - 1, one_plus_R] if v > n else 0.0
        by_phi = by_R * (1.0 + 2.0 * phi) / (3.0 * phi * phi + 4.0 * phi - 2.0 * R)
        tail.kept_slopes[v] = by_R / f.numbers[one_plus_R] ** 2
        for k in range(1, SLOPES + 3):
            tail.power_slopes[0, k, v] = k * power[0, k - 1] * by_phi
        change = 2.0 * phi * by_phi / (1.0 - power[0, 2]) ** 2 - 3.0 * power[0, 2] * by_phi / (1.0 - power[0, 3]) ** 2
        tail.d_slopes[0, v] = (tail.y_slopes[3, v] / 6.0 - d[0] * change) / (rest - other)
        for m in range(SLOPES + 1):
            q = power[0, m + 2]
            turn = d[0] * tail.power_slopes[0, m + 2, v] / (1.0 - q)
            tail.nu_slopes[0, m, v] = (tail.d_slopes[0, v] * q + turn) / (1.0 - q)


@small
def shares(tail, l, m):  # noqa: E741
    """alpha_m and beta_m at order l."""
    power = tail.power[0]
    left = 1.0 - power[l + m + 2]
    return power[l + m + 2] / left, (m + 2) * power[m + 1] * (tail.d[0] + tail.nu[0, m]) / left


@small
def solve_two(kept, tail, l, gap, speed):  # noqa: E741
    """d_l and pi_l from both equations."""
    alpha, beta = shares(tail, l, 0)
    other_alpha, other_beta = shares(tail, l, 1)
    a, b, c = other_alpha - alpha, other_beta - beta, kept + alpha
    determinant = a * beta - b * c
    return (gap * beta - speed * b) / determinant, (speed * a - gap * c) / determinant


@small
def next_order(kept, l, tail):  # noqa: E741
    """pi_l, d_l, their powers and nu_m,l from those of lower order; kept: R/(1 + R)."""
    power, nu, d = tail.power, tail.nu, tail.d
    highest, most = ORDERS + 3 - l, ORDERS + 1 - l
    for k in range(highest):
        power[l, k] = 0.0
    for m in range(most):
        nu[l, m] = 0.0
    for i in range(1, l):  # Miller's rule for powers of a series
        factor = power[i, 1] / (l * power[0, 1])
        for k in range(2, highest):
            power[l, k] += (k * i - l + i) * factor * power[l - i, k]
    for i in range(l):
        for m in range(most):
            nu[l, m] += (d[i] + nu[i, m]) * power[l - i, i + m + 2]
    for m in range(most):
        nu[l, m] /= 1.0 - power[0, l + m + 2]
    sign = -1.0 if l % 2 == 0 else 1.0
    gap = sign / FACTORIAL[l + 3] * tail.y[l + 3] + nu[l, 0] - nu[l, 1]
    speed = -sign / FACTORIAL[l + 2] * tail.y[l + 3] - nu[l, 0]
    for m in range(2, l + 2):
        moved = moving = 0.0
        for j in range(m + 1):
            moved += GAP[m, j] * nu[l - m + 1, j]
            moving += SPEED[m, j] * nu[l - m + 1, j]
        gap -= tail.gamma[m] * moved
        speed -= tail.gamma[m] * moving
    d[l], power[l, 1] = solve_two(kept, tail, l, gap, speed)
    for k in range(2, highest):
        power[l, k] += k * power[0, k - 1] * power[l, 1]
    for m in range(most):
        alpha, beta = shares(tail, l, m)
        nu[l, m] += alpha * d[l] + beta * power[l, 1]


@small
def next_slopes(kept, W, l, tail):  # noqa: E741
    """The derivatives of what `next_order` has computed."""
    power, nu, d = tail.power, tail.nu, tail.d
    powers, nus, ds, sides = tail.power_slopes, tail.nu_slopes, tail.d_slopes, tail.sides
    highest, most, gap, speed, moved = SLOPES + 3 - l, SLOPES + 1 - l, sides[0], sides[1], sides[2]
    for k in range(2, highest):  # d(pi^k) = k pi^(k-1) dpi
        for v in range(W):
            powers[l, k, v] = 0.0
        for i in range(l):
            for v in range(W):
                powers[l, k, v] += k * power[l - i, k - 1] * powers[i, 1, v]
    for m in range(most):
        left = 1.0 - power[0, l + m + 2]
        for v in range(W):
            nus[l, m, v] = (d[l] + nu[l, m]) * powers[0, l + m + 2, v] / left
        for i in range(l):
            later, both = power[l - i, i + m + 2] / left, (d[i] + nu[i, m]) / left
            for v in range(W):
                nus[l, m, v] += (ds[i, v] + nus[i, m, v]) * later + both * powers[l - i, i + m + 2, v]
    sign = -1.0 if l % 2 == 0 else 1.0
    for v in range(W):
        gap[v] = sign / FACTORIAL[l + 3] * tail.y_slopes[l + 3, v] + nus[l, 0, v] - nus[l, 1, v]
        speed[v] = -sign / FACTORIAL[l + 2] * tail.y_slopes[l + 3, v] - nus[l, 0, v] - d[l] * tail.kept_slopes[v]
    for m in range(2, l + 2):
        for factors, side in ((GAP, gap), (SPEED, speed)):
            total = 0.0
            for v in range(W):
                moved[v] = 0.0
            for j in range(m + 1):
                total += factors[m, j] * nu[l - m + 1, j]
                for v in range(W):
                    moved[v] += factors[m, j] * nus[l - m + 1, j, v]
            for v in range(W):
                side[v] -= tail.gamma_slopes[m, v] * total + tail.gamma[m] * moved[v]
    for v in range(W):
        ds[l, v], powers[l, 1, v] = solve_two(kept, tail, l, gap[v], speed[v])
    for k in range(2, highest):
        for v in range(W):
            powers[l, k, v] += k * power[0, k - 1] * powers[l, 1, v]
    for m in range(most):
        alpha, beta = shares(tail, l, m)
        for v in range(W):
            nus[l, m, v] += alpha * ds[l, v] + beta * powers[l, 1, v]
