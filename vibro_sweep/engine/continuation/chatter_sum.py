"""The end of an orbit at the onset of sticking: infinitely many impacts in one term.

The first "impact" of the orbit is the end of the chatter sequence, which has no impulse; the state h there and its time
give all later derivatives of the motion. What the impacts after the last one written out do to the state at the next
end, a time s later, is

    Q(s) = sum_m A^m e_v mu_m(s)/m!

with the power series mu_m(s) of chatter_series.py.
"""

import numpy as np

from vibro_sweep.engine.continuation.chatter_series import FACTORIAL, ORDERS, SLOPES, next_order, next_slopes, start
from vibro_sweep.engine.continuation.moving_flow import OMEGA, ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW
from vibro_sweep.engine.simd.jit import small

REACH, NEXT = range(2)  # of `numbers`: the largest s of the series; s of the impact that follows
DECAYED = 1e-15  # relative size of the first term left out, at the largest s


@small
def multiply_out(f, tail):
    """e_gap A^m, A^m e_v."""
    n, rows, columns = f.A.shape[0], tail.rows, tail.columns
    for r in range(n):
        for i in range(3):
            rows[i, 0, r] = columns[i, 0, r] = 0.0
    rows[0, 0, 0] = columns[0, 0, n // 2] = 1.0
    for m in range(1, ORDERS + 3):
        for c in range(n):
            for i in range(3):
                rows[i, m, c] = 0.0
            for r in range(n):
                rows[0, m, c] += rows[0, m - 1, r] * f.A[r, c]
                for j in range(f.parameters):
                    if f.moves[j] > 0:
                        change = rows[1 + j, m - 1, r] * f.A[r, c] + rows[0, m - 1, r] * f.A_slopes[j, r, c]
                        rows[1 + j, m, c] += change
    for m in range(1, ORDERS + 1):
        for r in range(n):
            for i in range(3):
                columns[i, m, r] = 0.0
            for c in range(n):
                columns[0, m, r] += f.A[r, c] * columns[0, m - 1, c]
                for j in range(f.parameters):
                    if f.moves[j] > 0:
                        columns[1 + j, m, r] += f.A[r, c] * columns[1 + j, m - 1, c]
                        columns[1 + j, m, r] += f.A_slopes[j, r, c] * columns[0, m - 1, c]


@small
def differentiate(f, t, h, rate, turn, tail):
    """y_m and gamma_m at the end of the sequence; turn: e^{i phi} there."""
    n, omega, rows, y, slopes = f.A.shape[0], f.numbers[OMEGA], tail.rows, tail.y, tail.y_slopes
    for m in range(ORDERS + 2):
        tail.gamma[m] = rows[0, m, n // 2]
        for j in range(f.parameters):
            tail.gamma_slopes[m, n + 1 + j] = rows[1 + j, m, n // 2]
    power = (1j * omega) ** 3 * turn
    for m in range(3, ORDERS + 3):
        y[m], slopes[m, n] = (f.Z[0] * power).real, (1j * omega * f.Z[0] * power).real
        for j in range(f.parameters):
            d_omega = f.number_slopes[j, OMEGA]
            slopes[m, n + 1 + j] = ((f.Z_slopes[j, 0] + f.Z[0] * d_omega * (1j * t + m / omega)) * power).real
        for r in range(n):
            y[m] += rows[0, m - 1, r] * rate[r]
            slopes[m, r] = rows[0, m, r]
            for j in range(f.parameters):
                change = f.A_slopes[j, r, n]
                for c in range(n):
                    change += f.A_slopes[j, r, c] * h[c]
                slopes[m, n + 1 + j] += rows[1 + j, m - 1, r] * rate[r] + rows[0, m - 1, r] * change
        power *= 1j * omega


@small
def sum_up(f, s, tail):
    """Q, p(s), and up to which s they hold."""
    n, nu, Q, columns, slopes = f.A.shape[0], tail.nu, tail.Q, tail.columns, tail.sides[0]
    W = n + 3
    for r in range(n):
        for v in range(W + 2):
            Q[r, v] = 0.0
    lowest = s * s
    for m in range(ORDERS + 1):
        mu, by_s, power = 0.0, 0.0, lowest
        for v in range(W):
            slopes[v] = 0.0
        for l in range(min(ORDERS, ORDERS + 1 - m)):  # noqa: E741
            mu += power * nu[l, m]
            by_s += (m + 2 + l) * power / s * nu[l, m]
            if l + m <= SLOPES and l < SLOPES:
                for v in range(W):
                    slopes[v] += power * tail.nu_slopes[l, m, v]
            power *= s
        lowest *= s
        for r in range(n):
            weight = columns[0, m, r] / FACTORIAL[m]
            Q[r, 0] += weight * mu
            for v in range(W):
                Q[r, 1 + v] += weight * slopes[v]
            for j in range(f.parameters):
                Q[r, n + 2 + j] += columns[1 + j, m, r] / FACTORIAL[m] * mu
            Q[r, W + 1] += weight * by_s
    following, power, reach = 0.0, s, np.inf
    for l in range(ORDERS):  # noqa: E741
        following += tail.power[l, 1] * power
        power *= s
        if l >= ORDERS - 4:
            size = max(abs(tail.d[l] / tail.d[0]), abs(tail.power[l, 1] / tail.power[0, 1]))
            if size > 0.0:
                reach = min(reach, (DECAYED / size) ** (1.0 / l))
    tail.numbers[REACH], tail.numbers[NEXT] = reach, following


@small
def sum_chatter(f, side, t, rate, h, turn, s, tail):
    """Fill `tail` for a sequence on `side` that ends at t in the state h, with h' = rate and e^{i phi} = turn.

    s: time from the last impact written out to the next end.
    """
    multiply_out(f, tail)
    differentiate(f, t, h, rate, turn, tail)
    start(f, side, tail)
    kept = 1.0 - 1.0 / f.numbers[ONE_PLUS_R_HIGH if side > 0 else ONE_PLUS_R_LOW]
    for l in range(1, ORDERS):  # noqa: E741
        next_order(kept, l, tail)
        if l < SLOPES:
            next_slopes(kept, f.A.shape[0] + 3, l, tail)
    sum_up(f, s, tail)
