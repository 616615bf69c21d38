"""The equations of a periodic orbit, condensed to its impacts and the state before the first of them.

Unknowns t_i, D_i (i = 1 .. K) and h_1 (plane.py); phi_i = omega t_i + tau, e_v adds 1 to the gap velocity:

    gap_i = stop_i      D_i + (1 + R_i) v_i = 0      h_{i+1} = E(t_{i+1} - t_i) (h_i + D_i e_v)      h_{K+1} = sigma h_1

In xi = dh - h' dt they are linearised, for a change that grows by mu from one period to the next, as

    v_i dt_i + xi_i[gap]        dD_i + (1 + R_i) (a_i dt_i + xi_i[v])        sigma mu xi_1 - xi_{K+1}
    xi_{i+1} = E_i y_i,   y_i = xi_i + e_v dD_i - A e_v D_i dt_i

M(mu) is their matrix for the columns (dt, dD, xi_1). The orbit has the multiplier mu where M(mu) w = 0; nothing is
singular at D = 0, a graze. psi^T M(mu) = 0 defines the adjoint vector, with which the derivative of a simple zero of
det M is psi^T dM w: for it lambda_i, the adjoint of xi_{i+1}, runs backwards through the flights,

    lambda_{i-1} = E_i^T lambda_i - psi[gap_i] e_gap - (1 + R_i) psi[v_i] e_v
"""

import cmath
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.plane import GAIN_HIGH, GAIN_LOW, HIGH, LOW, OMEGA, flight
from vibro_sweep.engine.simd.jit import jit


class Room(NamedTuple):
    """Of the equations with K impacts at one point; S = 2K + n."""

    h: np.ndarray  # (K + 1, n)
    rate: np.ndarray  # (K, n): h' before each impact
    motion: np.ndarray  # (K, 2): gap velocity and acceleration before each impact
    turns: np.ndarray  # (K,) complex: e^{i phi}
    E: np.ndarray  # (K, 3, n, n + 1): flights, and their derivatives by the parameters
    X: np.ndarray  # (K + 1, n, S): xi_i by (dt, dD, xi_1)
    Y: np.ndarray  # (K + 1, n, 2): xi_i by the parameters
    F: np.ndarray  # (S,): residual
    M: np.ndarray  # (S, S): M(0)
    Fp: np.ndarray  # (S, 2)
    vectors: np.ndarray  # (5, n) complex
    other: np.ndarray  # (3, n, n + 1)


def new_room(K: int, n: int) -> Room:
    S = 2 * K + n
    shapes = (K + 1, n), (K, n), (K, 2), K, (K, 3, n, n + 1), (K + 1, n, S), (K + 1, n, 2), S, (S, S), (S, 2)
    fields = [np.zeros(shape, complex if i == 3 else float) for i, shape in enumerate(shapes)]
    return Room(*fields, np.zeros((5, n), complex), np.zeros((3, n, n + 1)))


@jit
def reach(f, sides, t, D, i, room):
    """The motion before impact i, from the free part of its state in `room`, and what it leaves of the equations."""
    n, N, K, h = f.n, f.n // 2, len(t), room.h[i]
    stop, gain = (HIGH, GAIN_HIGH) if sides[i] > 0 else (LOW, GAIN_LOW)
    e = cmath.exp(1j * (f.numbers[OMEGA] * t[i] + f.tau))
    room.turns[i] = e
    for r in range(n):
        total = f.A[r, n]
        for c in range(n):
            total += f.A[r, c] * h[c]
        room.rate[i, r] = total
    v = h[N] + (f.Z[N] * e).real
    room.motion[i, 0], room.motion[i, 1] = v, room.rate[i, N] + (1j * f.numbers[OMEGA] * f.Z[N] * e).real
    room.F[i], room.F[K + i] = h[0] + (f.Z[0] * e).real - f.numbers[stop], D[i] + f.numbers[gain] * v


@jit
def equations(f, sides, sigma, t, D, room):
    """Fill `room`, whose h[0] is given, at the parameters to which f was moved."""
    K, n = len(t), f.n
    N, S = n // 2, 2 * K + n
    P = f.P
    X, Y, M, F, Fp = room.X, room.Y, room.M, room.F, room.Fp
    for r in range(n):
        for c in range(S):
            X[0, r, c] = 1.0 if c == 2 * K + r else 0.0
        Y[0, r, 0] = Y[0, r, 1] = 0.0
    for i in range(K):
        h, E = room.h[i], room.E[i]
        stop, gain = (HIGH, GAIN_HIGH) if sides[i] > 0 else (LOW, GAIN_LOW)
        reach(f, sides, t, D, i, room)
        R1, e, v, a = f.numbers[gain], room.turns[i], room.motion[i, 0], room.motion[i, 1]
        for c in range(S):
            M[i, c], M[K + i, c] = X[i, 0, c], R1 * X[i, N, c]
        M[i, i] += v
        M[K + i, i] += R1 * a
        M[K + i, K + i] += 1.0
        for j in range(2):
            turn = 1j * t[i] * f.number_slopes[j, OMEGA]
            Fp[i, j] = Y[i, 0, j] + ((f.Z_slopes[j, 0] + turn * f.Z[0]) * e).real - f.number_slopes[j, stop]
            Fp[K + i, j] = R1 * (Y[i, N, j] + ((f.Z_slopes[j, N] + turn * f.Z[N]) * e).real)
            Fp[K + i, j] += f.number_slopes[j, gain] * v
        flight(f, (t[i + 1] if i + 1 < K else t[0] + P) - t[i], E, room.other)
        for r in range(n):
            total, bend = E[0, r, n] + E[0, r, N] * D[i], 0.0
            for c in range(n):
                total += E[0, r, c] * h[c]
                bend += E[0, r, c] * f.A[c, N]
            room.h[i + 1, r] = total
            for c in range(S):
                total = 0.0
                for k in range(n):
                    total += E[0, r, k] * X[i, k, c]
                X[i + 1, r, c] = total
            X[i + 1, r, K + i] += E[0, r, N]
            X[i + 1, r, i] -= D[i] * bend
            for j in range(2):
                total = 0.0
                for k in range(n):
                    total += E[0, r, k] * Y[i, k, j]
                if f.moves[j] > 0:
                    total += E[1 + j, r, n] + E[1 + j, r, N] * D[i]
                    for k in range(n):
                        total += E[1 + j, r, k] * h[k]
                Y[i + 1, r, j] = total
    for r in range(n):
        F[2 * K + r] = sigma * room.h[0, r] - room.h[K, r]
        for c in range(S):
            M[2 * K + r, c] = -X[K, r, c]
        for j in range(2):
            Fp[2 * K + r, j] = -Y[K, r, j] - sigma * room.rate[0, r] * f.P_slopes[j]


@jit
def gradient(f, sides, D, t, room, w, psi, out):
    """out (S + 2,) = -psi^T dM w by (dt, dD, xi_1) and the parameters; complex."""
    K, n = len(t), f.n
    N, S, omega = n // 2, 2 * K + n, f.numbers[OMEGA]
    back, y, Ey, through, by_h = room.vectors
    for c in range(S + 2):
        out[c] = 0.0
    for r in range(n):
        back[r] = psi[2 * K + r]
    for i in range(K - 1, -1, -1):
        E, e, h = room.E[i], room.turns[i], room.h[i]
        gain = GAIN_HIGH if sides[i] > 0 else GAIN_LOW
        R1 = f.numbers[gain]
        dt, alpha, beta = w[i], psi[i], psi[K + i]
        xi_v = 0j
        for r in range(n):
            total = 0j
            for c in range(S):
                total += room.X[i, r, c] * w[c]
            if r == N:
                xi_v = total
                total += w[K + i]
            y[r] = total - D[i] * dt * f.A[r, N]
        for r in range(n):
            Ey[r] = through[r] = 0.0
            for c in range(n):
                Ey[r] += E[0, r, c] * y[c]
                through[r] += E[0, c, r] * back[c]
        by_length, by_D = 0j, 0j
        for r in range(n):
            total = 0j
            for c in range(n):
                total += f.A[r, c] * Ey[c]
            by_length -= back[r] * total
            by_D += through[r] * f.A[r, N]
            by_h[r] = R1 * beta * dt * f.A[N, r]
        by_h[N] += alpha * dt
        out[i] -= by_length
        out[i + 1 if i + 1 < K else 0] += by_length
        out[K + i] += dt * by_D
        swing = f.Z[N] * e
        out[i] += dt * (alpha * (1j * omega * swing).real - R1 * beta * omega * omega * swing.real)
        for r in range(n):
            out[i] += by_h[r] * room.rate[i, r]
        for j in range(2):
            d_omega = f.number_slopes[j, OMEGA]
            change = (f.Z_slopes[j, N] + 1j * t[i] * d_omega * f.Z[N]) * e
            bend = (1j * (omega * change + d_omega * swing)).real + f.A_slopes[j, N, n]
            for c in range(n):
                bend += f.A_slopes[j, N, c] * h[c]
            total = alpha * dt * change.real + R1 * beta * dt * bend
            total += beta * f.number_slopes[j, gain] * (room.motion[i, 1] * dt + xi_v)
            if i + 1 == K:
                total += by_length * f.P_slopes[j]
            for r in range(n):
                total += by_h[r] * room.Y[i, r, j]
                if f.moves[j] > 0:
                    total += D[i] * dt * through[r] * f.A_slopes[j, r, N]
                    for c in range(n):
                        total -= back[r] * E[1 + j, r, c] * y[c]
            out[S + j] += total
        for c in range(S):
            for r in range(n):
                out[c] += by_h[r] * room.X[i, r, c]
        for r in range(n):
            back[r] = through[r]
        back[0] -= alpha
        back[N] -= R1 * beta
    for c in range(S + 2):
        out[c] = -out[c]
