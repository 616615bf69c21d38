"""The equations of an orbit at the onset of sticking, and their solution impact by impact.

They are those of condensed.py, with the sum Q over infinitely many impacts in the closure (chatter.py). Impact 1 is the
end of the chatter sequence: it has no impulse, and since its gap follows from that at the last impact, acceleration = 0
stands in place of it. All other impacts are eliminated one after the other,

    dt_i = (F_i - xi_i[gap])/v_i      dD_i = F_{K+i} - (1 + R_i) (a_i dt_i + xi_i[v])
    xi_{i+1} = E_i (xi_i + e_v dD_i - A e_v D_i dt_i)

so that dt_1, xi_1 and both parameters are left. An impact that is nearly a graze keeps its dt_i among these unknowns,
for division by its speed would lose digits.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.chatter import sum_chatter
from vibro_sweep.engine.impulses.condensed import reach
from vibro_sweep.engine.impulses.factors import factorise, substitute
from vibro_sweep.engine.impulses.plane import GAIN_HIGH, GAIN_LOW, HIGH, LOW, OMEGA, flight
from vibro_sweep.engine.simd.jit import jit

FIXED, TIME, STATE = range(3)  # columns of an expression: what is known, dt_1, xi_1; parameters and slow dt_i follow
MOST_SLOW = 4
SLOW = 1e-5  # speed of an impact, in its unit, below which its time stays among the unknowns


class Steps(NamedTuple):
    """Expressions in the unknowns that are left; C = n + 4 + MOST_SLOW."""

    xi: np.ndarray  # (n, C)
    y: np.ndarray  # (n, C)
    times: np.ndarray  # (K, C): dt_i
    impulses: np.ndarray  # (K, C): dD_i
    rows: np.ndarray  # (C, C): equations
    matrix: np.ndarray  # (C, C)
    step: np.ndarray  # (C,)
    tangent: np.ndarray  # (C,)
    slow: np.ndarray  # (MOST_SLOW,) integers: impacts


def new_steps(K: int, n: int) -> Steps:
    C = n + 4 + MOST_SLOW
    shapes = (n, C), (n, C), (K, C), (K, C), (C, C), (C, C), C, C
    return Steps(*map(np.zeros, shapes), np.zeros(MOST_SLOW, np.int64))


@jit
def follow(f, sides, sigma, t, D, room):
    """The motion through all impacts: fills `room`, whose h[0] is given, but for derivatives; F without the tail."""
    K, n = len(t), f.n
    N = n // 2
    for i in range(K):
        h, E = room.h[i], room.E[i]
        reach(f, sides, t, D, i, room)
        flight(f, (t[i + 1] if i + 1 < K else t[0] + f.P) - t[i], E, room.other)
        for r in range(n):
            total = E[0, r, n] + E[0, r, N] * D[i]
            for c in range(n):
                total += E[0, r, c] * h[c]
            room.h[i + 1, r] = total
    for r in range(n):
        room.F[2 * K + r] = sigma * room.h[0, r] - room.h[K, r]


@jit
def add_tail(f, sides, sigma, t, room, tail):
    """What follows the last impact written out."""
    K, n = len(t), f.n
    s = t[0] + f.P - t[K - 1]
    sum_chatter(f, sides[0], t[0], room.rate[0], room.h[0], room.turns[0], s, tail)
    for r in range(n):
        room.F[2 * K + r] -= sigma * tail.Q[r, 0]


@jit
def change_of_motion(f, t, i, j, room):
    """Derivative by parameter j of the steady gap, velocity and acceleration at impact i, at a fixed time; A's too."""
    n = f.n
    N, omega, e = n // 2, f.numbers[OMEGA], room.turns[i]
    d_omega = f.number_slopes[j, OMEGA]
    turn = 1j * t[i] * d_omega
    gap = ((f.Z_slopes[j, 0] + turn * f.Z[0]) * e).real
    change = (f.Z_slopes[j, N] + turn * f.Z[N]) * e
    bend = (1j * (omega * change + d_omega * f.Z[N] * e)).real + f.A_slopes[j, N, n]
    for c in range(n):
        bend += f.A_slopes[j, N, c] * room.h[i, c]
    return gap, change.real, bend


@jit
def eliminate(f, c, place, b):
    """Expressions of all impacts, and the equations that are left, but that of the plane across the curve.

    How many columns there are; 0: too many impacts graze at once.
    """
    K, n = len(place.t), f.n
    N, room, s, D = n // 2, b.room, b.steps, place.D
    xi, y, F, count = s.xi, s.y, room.F, n + 4
    xi[:] = 0.0
    s.times[:] = 0.0
    s.rows[:] = 0.0
    for r in range(n):
        xi[r, STATE + r] = 1.0
    for i in range(K):
        time, impulse, E, h = s.times[i], s.impulses[i], room.E[i], room.h[i]
        stop, gain = (HIGH, GAIN_HIGH) if c.sides[i] > 0 else (LOW, GAIN_LOW)
        R1, v, a = f.numbers[gain], room.motion[i, 0], room.motion[i, 1]
        gap, speed = s.matrix[0], s.matrix[1]  # changes at a fixed time, less what Newton's method is to change
        for k in range(count):
            gap[k], speed[k] = xi[0, k], R1 * xi[N, k]
        gap[FIXED] -= F[i]
        speed[FIXED] -= F[K + i]
        for j in range(2):
            by_gap, by_speed, _ = change_of_motion(f, place.t, i, j, room)
            gap[STATE + n + j] += by_gap - f.number_slopes[j, stop]
            speed[STATE + n + j] += R1 * by_speed + f.number_slopes[j, gain] * v
        if i == 0:
            time[TIME] = 1.0
            for k in range(count):
                s.rows[1, k] = speed[k] + R1 * a * time[k]
                impulse[k] = 0.0
            impulse[FIXED] = D[0]
            s.rows[1, FIXED] += D[0]
        else:
            if abs(v) < SLOW * c.row_unit[K]:
                if count == n + 4 + MOST_SLOW:
                    return 0
                s.slow[count - n - 4] = i
                time[count], gap[count], speed[count] = 1.0, v, 0.0
                for k in range(count + 1):
                    s.rows[count - 2, k] = gap[k]
                count += 1
            else:
                for k in range(count):
                    time[k] = -gap[k] / v
            for k in range(count):
                impulse[k] = -speed[k] - R1 * a * time[k]
        for k in range(count):
            for r in range(n):
                y[r, k] = xi[r, k] - D[i] * f.A[r, N] * time[k]
            y[N, k] += impulse[k]
        for r in range(n):
            for k in range(count):
                total = 0.0
                for q in range(n):
                    total += E[0, r, q] * y[q, k]
                xi[r, k] = total
            for j in range(2):
                if f.moves[j] > 0:
                    xi[r, STATE + n + j] += E[1 + j, r, n] + E[1 + j, r, N] * D[i]
                    for q in range(n):
                        xi[r, STATE + n + j] += E[1 + j, r, q] * h[q]
    close(f, c, place, b, count)
    return count


@jit
def close(f, c, place, b, count):
    """Rows of the acceleration at the end of the chatter, and of the closure."""
    K, n = len(place.t), f.n
    N, room, s, Q = n // 2, b.room, b.steps, b.tail.Q
    omega, rate, rows, last = f.numbers[OMEGA], room.rate[0], s.rows, s.times[K - 1]
    V = n + 4
    rows[0, FIXED] = -room.motion[0, 1]
    rows[0, TIME] = -(omega * omega * f.Z[N] * room.turns[0]).real
    for r in range(n):
        rows[0, STATE + r] = f.A[N, r]
        rows[0, TIME] += f.A[N, r] * rate[r]
    for j in range(2):
        _, _, rows[0, STATE + n + j] = change_of_motion(f, place.t, 0, j, room)
    for r in range(n):
        row, moved, by_time = rows[2 + r], 0.0, Q[r, n + 1] + Q[r, V]
        for q in range(n):
            moved += f.A[r, q] * Q[q, 0]
            by_time += Q[r, 1 + q] * rate[q]
        row[FIXED] = -room.F[2 * K + r]
        row[TIME] = -c.sigma * (by_time - moved)
        for q in range(n):
            row[STATE + q] = -c.sigma * Q[r, 1 + q]
        row[STATE + r] += c.sigma
        for j in range(2):
            change = Q[r, n + 2 + j] + (rate[r] + Q[r, V] - moved) * f.P_slopes[j]
            row[STATE + n + j] = -c.sigma * change
        for k in range(count):
            row[k] += c.sigma * Q[r, V] * last[k] - s.xi[r, k]


@jit
def solve(f, c, place, row, b, tangent):
    """`b.step` and the tangent, scaled, from equations that `follow` and `add_tail` have set up; False: singular."""
    K, S, n = len(place.t), len(place.w), f.n
    s, count = b.steps, eliminate(f, c, place, b)
    if count == 0:
        return False
    size, a, plane = count - 1, s.matrix, s.rows[count - 2]
    for k in range(count):
        plane[k] = 0.0
        for i in range(K):
            plane[k] += row[i] * s.times[i, k] / c.unit[i] + row[K + i] * s.impulses[i, k] / c.unit[K + i]
    for j in range(2):
        plane[STATE + n + j] += row[S + j] / c.unit[S + j]
    for q in range(size):
        weight = 1.0 / c.row_unit[0]
        if q == 0:
            weight *= c.unit[0] * c.unit[0]
        elif q < 2 + n:
            weight = 1.0 / c.row_unit[K if q == 1 else 2 * K + q - 2]
        elif q == size - 1:
            weight = 1.0
        for k in range(1, count):
            a[q, k - 1] = s.rows[q, k] * weight * unit_of(c, K, n, s, k)
        s.step[q], s.tangent[q] = -s.rows[q, FIXED] * weight, 0.0
    s.tangent[size - 1] = 1.0
    if factorise(a, size, b.order) == 0.0:
        return False
    substitute(a, size, b.order, s.step)
    substitute(a, size, b.order, s.tangent)
    for j in range(n + 2):
        b.step[2 * K + j], tangent[2 * K + j] = s.step[1 + j], s.tangent[1 + j]
    for k in range(size):
        unit = unit_of(c, K, n, s, k + 1)
        s.step[k] *= unit
        s.tangent[k] *= unit
    for i in range(K):
        time, impulse = s.times[i, FIXED], s.impulses[i, FIXED]
        by_time = by_impulse = 0.0
        for k in range(size):
            time += s.times[i, 1 + k] * s.step[k]
            impulse += s.impulses[i, 1 + k] * s.step[k]
            by_time += s.times[i, 1 + k] * s.tangent[k]
            by_impulse += s.impulses[i, 1 + k] * s.tangent[k]
        b.step[i], b.step[K + i] = time / c.unit[i], impulse / c.unit[K + i]
        tangent[i], tangent[K + i] = by_time / c.unit[i], by_impulse / c.unit[K + i]
    return True


@jit
def unit_of(c, K, n, s, k):
    """Of the unknown in column k."""
    if k == TIME:
        return c.unit[0]
    if k < n + 4:
        return c.unit[2 * K + k - STATE]
    return c.unit[s.slow[k - n - 4]]
