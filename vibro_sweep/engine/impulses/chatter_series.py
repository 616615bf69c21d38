"""The end of a chatter sequence at the onset of sticking, as power series: infinitely many impacts in one term.

The sequence ends at T with gap = stop, velocity and acceleration 0. Seen backwards from T, the free motion through that
state has the gap stop + sum_m y_m (-s)^m/m!, m >= 3, and one impulse changes the gap by gamma_m u^m/m!. An impact at
T - s is followed by one at T - p(s), and its impulse is D(s). With mu_m(s) = sum over all later impacts of D s_k^m,

    mu_m(s) = D(p) p^m + mu_m(p)
    sum_m y_m (-s)^m/m!         = sum_k D_k gamma(s_k - s)                        the gap is at its stop
    sum_m y_m (-s)^(m-1)/(m-1)! = sum_k D_k gamma'(s_k - s) + D(s) R/(1 + R)      restitution

p, D and mu_m are power series in s, solved order by order: p = s pi(s), D = s^2 d(s), mu_m = s^(m+2) nu_m(s), and
pi(0) = phi with phi^2 (2 + phi) = R (1 + 2 phi) (orbits.md). Each number is followed by its derivatives: by the state
at T, by T, and by the two parameters.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.plane import GAIN_HIGH, GAIN_LOW
from vibro_sweep.engine.simd.jit import jit

ORDERS = 16  # of the series
FACTORIAL = np.array([math.factorial(m) for m in range(ORDERS + 4)], float)
CHOOSE = np.array([[math.comb(m, j) * (-1.0) ** (m - j) for j in range(ORDERS + 2)] for m in range(ORDERS + 2)])


class Tail(NamedTuple):
    """V = n + 4: a number, its derivatives by h (n), by the time and by both parameters."""

    rows: np.ndarray  # (3, ORDERS + 3, n): e_gap A^m, and its derivatives by the parameters
    columns: np.ndarray  # (3, ORDERS + 1, n): A^m e_v
    y: np.ndarray  # (ORDERS + 3, V)
    gamma: np.ndarray  # (ORDERS + 2, V)
    power: np.ndarray  # (ORDERS + 3, ORDERS, V): coefficients of pi^k
    nu: np.ndarray  # (ORDERS + 1, ORDERS, V)
    d: np.ndarray  # (ORDERS, V)
    work: np.ndarray  # (12, V)
    Q: np.ndarray  # (n, V + 1): the last column is the derivative by s
    numbers: np.ndarray  # (2,): see chatter.py


def new_tail(n: int) -> Tail:
    V, L = n + 4, ORDERS
    shapes = (3, L + 3, n), (3, L + 1, n), (L + 3, V), (L + 2, V), (L + 3, L, V), (L + 1, L, V), (L, V), (12, V)
    return Tail(*map(np.zeros, shapes), np.zeros((n, V + 1)), np.zeros(2))


@jit
def add(out, factor, a):
    for v in range(len(out)):
        out[v] += factor * a[v]


@jit
def add_product(out, factor, a, b):
    for v in range(1, len(out)):
        out[v] += factor * (a[0] * b[v] + a[v] * b[0])
    out[0] += factor * a[0] * b[0]


@jit
def divide(out, a):
    out[0] /= a[0]
    for v in range(1, len(out)):
        out[v] = (out[v] - out[0] * a[v]) / a[0]


@jit
def clear(out):
    for v in range(len(out)):
        out[v] = 0.0


@jit
def take_power(tail, k, j):
    """Coefficient j of pi^k, from those before (Miller)."""
    power = tail.power
    out = power[k, j]
    clear(out)
    for i in range(1, j + 1):
        add_product(out, (k * i - j + i) / j, power[1, i], power[k, j - i])
    divide(out, power[1, 0])


@jit
def later_impacts(tail, m, l, out):  # noqa: E741
    """out = coefficient l of pi^(m + 2) (d + nu_m)(s pi), as far as d_i and nu_m,i are known: i < l."""
    clear(out)
    for i in range(l):
        add_product(out, 1.0, tail.d[i], tail.power[i + m + 2, l - i])
        add_product(out, 1.0, tail.nu[m, i], tail.power[i + m + 2, l - i])


@jit
def first_order(f, side, tail):
    """phi, d_0 and nu_m,0."""
    gain = GAIN_HIGH if side > 0 else GAIN_LOW
    n, power, d, nu, w = f.n, tail.power, tail.d, tail.nu, tail.work
    R, phi = f.numbers[gain] - 1.0, 1.0
    for _ in range(60):
        step = (phi * phi * (2.0 + phi) - R * (1.0 + 2.0 * phi)) / (3.0 * phi * phi + 4.0 * phi - 2.0 * R)
        phi -= step
        if not abs(step) > 1e-16 * phi:
            break
    clear(power[1, 0])
    power[1, 0, 0] = phi
    for j in range(2):
        change = f.number_slopes[j, gain] * (1.0 + 2.0 * phi)
        power[1, 0, n + 2 + j] = change / (3.0 * phi * phi + 4.0 * phi - 2.0 * R)
    for k in range(2, ORDERS + 3):
        clear(power[k, 0])
        add_product(power[k, 0], 1.0, power[k - 1, 0], power[1, 0])
    for m in range(ORDERS + 1):
        clear(nu[m, 0])
        add(nu[m, 0], 1.0, power[m + 2, 0])
        clear(w[0])
        add(w[0], -1.0, power[m + 2, 0])
        w[0, 0] += 1.0
        divide(nu[m, 0], w[0])
    clear(w[0])
    add(w[0], 6.0, nu[0, 0])
    add(w[0], -6.0, nu[1, 0])
    clear(d[0])
    add(d[0], 1.0, tail.y[3])
    divide(d[0], w[0])
    for m in range(ORDERS + 1):
        clear(w[0])
        add_product(w[0], 1.0, nu[m, 0], d[0])
        for v in range(n + 4):
            nu[m, 0, v] = w[0, v]


@jit
def next_order(f, side, l, tail):  # noqa: E741
    """pi_l, d_l and nu_m,l from those of lower order."""
    gain = GAIN_HIGH if side > 0 else GAIN_LOW
    n, power, d, nu, w = f.n, tail.power, tail.d, tail.nu, tail.work
    gap, speed, kept, one = w[0], w[1], w[2], w[3]
    # nu_m,l = b_m + alpha_m d_l + beta_m pi_l for m = 0, 1
    clear(power[1, l])
    for m in range(2):
        alpha, beta, b = w[4 + m], w[6 + m], w[8 + m]
        take_power(tail, m + 2, l)
        later_impacts(tail, m, l, b)
        clear(one)
        add(one, -1.0, power[l + m + 2, 0])
        one[0] += 1.0
        divide(b, one)
        clear(alpha)
        add(alpha, 1.0, power[l + m + 2, 0])
        divide(alpha, one)
        clear(beta)
        add_product(beta, m + 2.0, power[m + 1, 0], d[0])
        add_product(beta, m + 2.0, power[m + 1, 0], nu[m, 0])
        divide(beta, one)
    sign = -1.0 if l % 2 == 0 else 1.0
    clear(gap)
    clear(speed)
    add(gap, sign / FACTORIAL[l + 3], tail.y[l + 3])
    add(speed, -sign / FACTORIAL[l + 2], tail.y[l + 3])
    for m in range(2, l + 2):
        for j in range(m + 1):
            add_product(gap, -CHOOSE[m, j] / FACTORIAL[m], tail.gamma[m], nu[j, l - m + 1])
            if j < m:
                add_product(speed, -CHOOSE[m - 1, j] / FACTORIAL[m - 1], tail.gamma[m], nu[j, l - m + 1])
    # two equations: (alpha_1 - alpha_0) d + (beta_1 - beta_0) pi = gap, (R/(1 + R) + alpha_0) d + beta_0 pi = speed
    add(gap, 1.0, w[8])
    add(gap, -1.0, w[9])
    add(speed, -1.0, w[8])
    add(w[5], -1.0, w[4])
    add(w[7], -1.0, w[6])
    clear(kept)
    kept[0] = 1.0 - 1.0 / f.numbers[gain]
    for j in range(2):
        kept[n + 2 + j] = f.number_slopes[j, gain] / f.numbers[gain] ** 2
    add(kept, 1.0, w[4])
    clear(one)
    add_product(one, 1.0, w[5], w[6])
    add_product(one, -1.0, w[7], kept)
    clear(d[l])
    add_product(d[l], 1.0, gap, w[6])
    add_product(d[l], -1.0, speed, w[7])
    divide(d[l], one)
    add_product(power[1, l], 1.0, speed, w[5])
    add_product(power[1, l], -1.0, gap, kept)
    divide(power[1, l], one)
    for k in range(2, ORDERS + 3 - l):
        take_power(tail, k, l)
    for m in range(ORDERS + 1 - l):
        later_impacts(tail, m, l, nu[m, l])
        add_product(nu[m, l], 1.0, d[l], power[l + m + 2, 0])
        clear(one)
        add(one, -1.0, power[l + m + 2, 0])
        one[0] += 1.0
        divide(nu[m, l], one)
