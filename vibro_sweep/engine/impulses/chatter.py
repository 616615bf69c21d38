"""The equations of an orbit at the onset of sticking: those of condensed.py with infinitely many impacts in one term.

The first "impact" of the orbit is the end of the chatter sequence, which has no impulse; the state h there and its time
give all later derivatives of the motion. What the impacts after the last one written out do to the state at the next
end, a time s later, is

    Q(s) = sum_m A^m e_v mu_m(s)/m!

with the power series mu_m(s) of chatter_series.py.
"""

import numpy as np

from vibro_sweep.engine.impulses.chatter_series import FACTORIAL, ORDERS, add, clear, first_order, next_order
from vibro_sweep.engine.impulses.plane import OMEGA
from vibro_sweep.engine.simd.jit import jit

REACH, NEXT = range(2)  # of `Tail.numbers`: the largest s of the series; s of the impact that follows
DECAYED = 1e-15  # relative size of the first term left out, at the largest s


@jit
def multiply_out(f, tail):
    """e_gap A^m, A^m e_v."""
    n, rows, columns = f.n, tail.rows, tail.columns
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
                for j in range(2):
                    rows[1 + j, m, c] += rows[1 + j, m - 1, r] * f.A[r, c] + rows[0, m - 1, r] * f.A_slopes[j, r, c]
    for m in range(1, ORDERS + 1):
        for r in range(n):
            for i in range(3):
                columns[i, m, r] = 0.0
            for c in range(n):
                columns[0, m, r] += f.A[r, c] * columns[0, m - 1, c]
                for j in range(2):
                    columns[1 + j, m, r] += f.A[r, c] * columns[1 + j, m - 1, c]
                    columns[1 + j, m, r] += f.A_slopes[j, r, c] * columns[0, m - 1, c]


@jit
def differentiate(f, t, h, rate, turn, tail):
    """y_m and gamma_m at the end of the sequence; turn: e^{i phi} there."""
    n, omega, rows, y, gamma = f.n, f.numbers[OMEGA], tail.rows, tail.y, tail.gamma
    for m in range(ORDERS + 2):
        clear(gamma[m])
        gamma[m, 0] = rows[0, m, n // 2]
        for j in range(2):
            gamma[m, n + 2 + j] = rows[1 + j, m, n // 2]
    power = (1j * omega) ** 3 * turn
    for m in range(3, ORDERS + 3):
        clear(y[m])
        y[m, 0], y[m, n + 1] = (f.Z[0] * power).real, (1j * omega * f.Z[0] * power).real
        for j in range(2):
            d_omega = f.number_slopes[j, OMEGA]
            y[m, n + 2 + j] = ((f.Z_slopes[j, 0] + f.Z[0] * d_omega * (1j * t + m / omega)) * power).real
        for r in range(n):
            y[m, 0] += rows[0, m - 1, r] * rate[r]
            y[m, 1 + r] = rows[0, m, r]
            for j in range(2):
                change = f.A_slopes[j, r, n]
                for c in range(n):
                    change += f.A_slopes[j, r, c] * h[c]
                y[m, n + 2 + j] += rows[1 + j, m - 1, r] * rate[r] + rows[0, m - 1, r] * change
        power *= 1j * omega


@jit
def sum_up(f, s, tail):
    """Q, p(s), and up to which s they hold."""
    n, nu, Q, columns = f.n, tail.nu, tail.Q, tail.columns
    V = n + 4
    for r in range(n):
        for v in range(V + 1):
            Q[r, v] = 0.0
    lowest = s * s
    for m in range(ORDERS + 1):
        mu, slope, power = tail.work[0], 0.0, lowest
        clear(mu)
        for l in range(min(ORDERS, ORDERS + 1 - m)):  # noqa: E741
            add(mu, power, nu[m, l])
            slope += (m + 2 + l) * power / s * nu[m, l, 0]
            power *= s
        lowest *= s
        for r in range(n):
            weight = columns[0, m, r] / FACTORIAL[m]
            for v in range(V):
                Q[r, v] += weight * mu[v]
            for j in range(2):
                Q[r, n + 2 + j] += columns[1 + j, m, r] / FACTORIAL[m] * mu[0]
            Q[r, V] += weight * slope
    following, power, reach = 0.0, s, np.inf
    for l in range(ORDERS):  # noqa: E741
        following += tail.power[1, l, 0] * power
        power *= s
        if l >= ORDERS - 4:
            size = max(abs(tail.d[l, 0] / tail.d[0, 0]), abs(tail.power[1, l, 0] / tail.power[1, 0, 0]))
            if size > 0.0:
                reach = min(reach, (DECAYED / size) ** (1.0 / l))
    tail.numbers[REACH], tail.numbers[NEXT] = reach, following


@jit
def add_chatter(f, side, sigma, unit, t, room, tail):
    """The equations of an orbit that chatters on `side` before its first impact: those of condensed.py, changed.

    The closure has Q; the gap at the first impact follows from that at the last, so its equation gives way to
    acceleration = 0, times the square of a unit of time.
    """
    K, n = len(t), f.n
    N, omega, F, M, Fp, Q = n // 2, f.numbers[OMEGA], room.F, room.M, room.Fp, tail.Q
    h, rate, turn, V = room.h[0], room.rate[0], room.turns[0], n + 4
    multiply_out(f, tail)
    differentiate(f, t[0], h, rate, turn, tail)
    first_order(f, side, tail)
    for l in range(1, ORDERS):  # noqa: E741
        next_order(f, side, l, tail)
    sum_up(f, t[0] + f.P - t[K - 1], tail)
    weight = unit * unit
    F[0] = weight * room.motion[0, 1]
    for c in range(len(F)):
        M[0, c] = 0.0
    M[0, 0] = -weight * (omega * omega * f.Z[N] * turn).real
    for r in range(n):
        M[0, 2 * K + r] = weight * f.A[N, r]
        M[0, 0] += weight * f.A[N, r] * rate[r]
    for j in range(2):
        d_omega = f.number_slopes[j, OMEGA]
        swing = omega * (f.Z_slopes[j, N] + 1j * t[0] * d_omega * f.Z[N]) + d_omega * f.Z[N]
        Fp[0, j] = weight * (f.A_slopes[j, N, n] + (1j * swing * turn).real)
        for c in range(n):
            Fp[0, j] += weight * f.A_slopes[j, N, c] * h[c]
    for r in range(n):
        row, moved, by_time = 2 * K + r, 0.0, Q[r, n + 1] + Q[r, V]
        F[row] -= sigma * Q[r, 0]
        for c in range(n):
            moved += f.A[r, c] * Q[c, 0]
            by_time += Q[r, 1 + c] * rate[c]
            M[row, 2 * K + c] -= sigma * Q[r, 1 + c]
        M[row, 0] -= sigma * (by_time - moved)
        M[row, K - 1] += sigma * Q[r, V]
        for j in range(2):
            Fp[row, j] -= sigma * (Q[r, n + 2 + j] + (Q[r, V] - moved) * f.P_slopes[j])
