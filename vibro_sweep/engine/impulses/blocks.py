"""The equations of a periodic orbit with the states before its impacts as further unknowns: the cost grows like K.

    gap(z_i) = stop_i        D_i + (1 + R_i) v(z_i) = 0
    z_{i+1} = flight(z_i + D_i e_v; t_i, t_{i+1})        z_{K+1} = sigma z_1

Newton's changes are (dt_i, dD_i, xi_i) with dz_i = xi_i + z'_i dt_i, so that only neighbours are coupled:

    v_i dt_i + e_g.xi_i        dD_i + (1 + R_i) (a_i dt_i + e_v.xi_i)
    xi_{i+1} = E_i (xi_i + e_v dD_i - A e_v D_i dt_i)

Impact by impact, reflections eliminate xi_i, dt_i and dD_i; xi_1 and the parameter's change stay to the end, where
`ahead` and `behind` are left of xi_{K+1} and xi_1. The multipliers mu are the roots of det(sigma mu ahead + behind).
Reflections keep all digits at any growth, and nothing is singular at D = 0.
"""

import math
from functools import cache

import numpy as np

from vibro_sweep.engine.impulses.elimination import solve
from vibro_sweep.engine.impulses.extremes import PIECES
from vibro_sweep.engine.impulses.medium import (
    GAIN_HIGH,
    GAIN_LOW,
    HIGH,
    LOW,
    OMEGA,
    PERIOD,
    TAU,
    flight_matrix,
    flight_slope,
    set_phase,
)
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.memory import put, record, row


@cache
def room_of(masses: int) -> np.dtype:
    """Room for the elimination. A panel has columns for xi_i (n), dt_i, dD_i, xi_{i+1} (n), xi_1 (n), dp, F."""
    n, m = 2 * masses, 2 * masses + 3
    wide = 3 * n + 4
    return record([
        ("panel", float, (2 * n + 2, wide)),
        ("change", float, n),
        ("E", float, (n, m)),
        ("zeta", float, (4, m)),
        ("ahead", float, (n, n)),
        ("behind", float, (n, n)),
        ("last", float, (n, 2)),  # columns of dp and F at the end
        ("row", float, wide),
        ("end", float, (n + 1, n + 3)),
        ("matrix", float, (n, n)),
        ("pair", float, (n, 2 * n)),
        ("re", float, n),
        ("im", float, n),
        ("cell", float, ORDER + 1),
        ("nearest", float, 3),
        ("waiting", float, (PIECES, 2)),
    ])  # fmt: skip


@cache
def strike_of(masses: int) -> np.dtype:
    """What is kept of each impact."""
    n = 2 * masses
    return record([
        ("kept", float, (n + 2, 3 * n + 4)),  # what was eliminated, an upper triangle in front
        ("rate", float, n),  # z' before it
        ("motion", float, 2),  # gap velocity and acceleration before it
    ])  # fmt: skip


@jit
def reflect(panel, columns):
    """Reflections that make the first columns an upper triangle. Sign of its determinant; 0.0 where it is singular.

    What is left below the triangle is rounding.
    """
    rows, sign = len(panel), 1.0
    for c in range(columns):
        size = 0.0
        for r in range(c, rows):
            size += panel[r, c] * panel[r, c]
        if not size > 0.0:
            return 0.0
        first = panel[c, c]
        diagonal = -math.copysign(math.sqrt(size), first)
        if diagonal < 0.0:
            sign = -sign
        panel[c, c] = first - diagonal
        total = panel[c, c] * row(panel, c)
        for r in range(c + 1, rows):
            total = total + panel[r, c] * row(panel, r)
        total = total * (1.0 / (size - first * diagonal))
        for r in range(c, rows):
            put(panel, r, row(panel, r) - panel[r, c] * total)
        panel[c, c] = diagonal
    return sign


@jit
def eliminate(f, sides, sigma, t, D, z, room, strikes):
    """Fill `room` with the eliminated equations at the parameter to which f was moved; sign of the determinant's part.

    t, D: (K,); z: (K, n).
    """
    K, n, m = len(t), room.E.shape[0], room.E.shape[1]
    N = n // 2
    P, d_omega, d_tau = f.numbers[PERIOD], f.number_slopes[OMEGA], f.number_slopes[TAU]
    turning = f.moves > 0 or d_omega != 0.0 or d_tau != 0.0
    A, B = n, 2 * n + 2  # columns of dt_i and of xi_1
    p, F = 3 * n + 2, 3 * n + 3
    panel = room.panel
    for r in range(n):  # xi_i - xi_1 = 0 at the first impact
        put(panel, r, 0.0)
        panel[r, r], panel[r, B + r] = 1.0, -1.0
    sign = 1.0
    for i in range(K):
        high = sides[i] > 0
        stop, d_stop = f.numbers[HIGH if high else LOW], f.number_slopes[HIGH if high else LOW]
        gain, d_gain = f.numbers[GAIN_HIGH if high else GAIN_LOW], f.number_slopes[GAIN_HIGH if high else GAIN_LOW]
        zeta, slope = room.zeta[0], room.zeta[1]
        for j in range(n):
            zeta[j] = z[i, j]
        set_phase(f, zeta, t[i])
        for r in range(n):
            total = 0.0
            for j in range(m):
                total += f.B[r, j] * zeta[j]
            strikes[i].rate[r] = total
        v, a = zeta[N], strikes[i].rate[N]
        strikes[i].motion[0], strikes[i].motion[1] = v, a
        length = (t[i + 1] if i + 1 < K else t[0] + P) - t[i]
        flight_matrix(f, length, room.E)
        E = room.E
        for r in range(n, 2 * n + 2):
            put(panel, r, 0.0)
        panel[n, 0], panel[n, A], panel[n, p], panel[n, F] = 1.0, v, -d_stop, zeta[0] - stop
        panel[n + 1, N], panel[n + 1, A], panel[n + 1, A + 1] = gain, gain * a, 1.0
        panel[n + 1, p], panel[n + 1, F] = d_gain * v, D[i] + gain * v
        zeta[N] += D[i]
        for r in range(n):
            line = n + 2 + r
            jump, end = 0.0, 0.0
            for j in range(n):
                panel[line, j] = -E[r, j]
                jump += E[r, j] * f.B[j, N]
            for j in range(m):
                end += E[r, j] * zeta[j]
            panel[line, A], panel[line, A + 1] = D[i] * jump, -E[r, N]
            panel[line, n + 2 + r] = 1.0
            panel[line, F] = (z[i + 1, r] if i + 1 < K else sigma * z[0, r]) - end
            if i + 1 == K:
                panel[line, p] = -sigma * strikes[0].rate[r] * f.number_slopes[PERIOD]
        if turning:
            turn = d_omega * t[i] + d_tau
            for j in range(m):
                slope[j] = 0.0
            slope[n], slope[n + 1] = -turn * zeta[n + 1], turn * zeta[n]
            if f.moves > 0:
                flight_slope(f, length, zeta, slope, room.change, room.zeta[2:])
                for r in range(n):
                    panel[n + 2 + r, p] -= room.change[r]
            else:
                for r in range(n):
                    panel[n + 2 + r, p] -= E[r, n] * slope[n] + E[r, n + 1] * slope[n + 1]
        sign *= reflect(panel, n + 2)
        for r in range(n + 2):
            put(strikes[i].kept, r, row(panel, r))
        for r in range(n):
            for j in range(n):
                panel[r, j] = panel[n + 2 + r, n + 2 + j]
            panel[r, A] = panel[r, A + 1] = 0.0
            for j in range(n):
                panel[r, n + 2 + j] = 0.0
            for j in range(B, 3 * n + 4):
                panel[r, j] = panel[n + 2 + r, j]
    for r in range(n):
        for j in range(n):
            room.ahead[r, j], room.behind[r, j] = panel[r, j], panel[r, B + j]
        room.last[r, 0], room.last[r, 1] = panel[r, p], panel[r, F]
    return sign


@jit
def finish(sigma, row_t, row_jump, row_p, room, strikes, scale_p, dt, dD, dz, dp):
    """Solve for the changes with one equation more, row.(dt, dD, dp) = 0, and for the tangent, row.tangent = 1.

    dt, dD: (2, K), dz: (2, K, n) and dp: (2,) receive both, Newton's change first. False where it is singular.
    scale_p: unit of the parameter. `eliminate` comes first.
    """
    K, n = dz.shape[1], room.E.shape[0]
    A, B, p, F = n, 2 * n + 2, 3 * n + 2, 3 * n + 3
    row, end = room.row, room.end
    for j in range(3 * n + 4):
        row[j] = 0.0
    row[p] = row_p
    for i in range(K):  # the row is eliminated too; it is no part of the reflections, which would fill it
        kept = strikes[i].kept
        row[A], row[A + 1] = row_t[i], row_jump[i]
        for c in range(n + 2):
            factor = row[c] / kept[c, c]
            for j in range(c + 1, 3 * n + 4):
                row[j] -= factor * kept[c, j]
        for j in range(n):
            row[j], row[n + 2 + j] = row[n + 2 + j], 0.0
    for r in range(n):
        for j in range(n):
            end[r, j] = sigma * room.ahead[r, j] + room.behind[r, j]
        end[r, n], end[r, n + 1], end[r, n + 2] = room.last[r, 0] * scale_p, room.last[r, 1], 0.0
    for j in range(n):
        end[n, j] = sigma * row[j] + row[B + j]
    end[n, n], end[n, n + 1], end[n, n + 2] = row[p] * scale_p, row[F], 1.0
    if not solve(end):
        return False
    for s in range(2):
        dp[s] = end[n, n + 1 + s] * scale_p
        for k in range(K - 1, -1, -1):
            kept = strikes[k].kept
            for r in range(n + 1, -1, -1):
                total = kept[r, F] if s == 0 else 0.0
                total -= kept[r, p] * dp[s]
                for j in range(n):
                    after = dz[s, k + 1, j] if k + 1 < K else sigma * end[j, n + 1 + s]
                    total -= kept[r, n + 2 + j] * after + kept[r, B + j] * end[j, n + 1 + s]
                if r < A + 1:
                    total -= kept[r, A + 1] * dD[s, k]
                if r < A:
                    total -= kept[r, A] * dt[s, k]
                for j in range(r + 1, n):
                    total -= kept[r, j] * dz[s, k, j]
                total /= kept[r, r]
                if r == A + 1:
                    dD[s, k] = total
                elif r == A:
                    dt[s, k] = total
                else:
                    dz[s, k, r] = total
        for k in range(K):
            for j in range(n):
                dz[s, k, j] += strikes[k].rate[j] * dt[s, k]
    return True
