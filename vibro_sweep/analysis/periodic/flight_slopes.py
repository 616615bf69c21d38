"""How rates in contact coordinates change with a number (engine/impulses/flow.py)."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.flow import contact_coordinates
from vibro_sweep.model.contact import push_of
from vibro_sweep.model.linear import Linear


class Slopes(NamedTuple):
    """Derivatives of `contact_coordinates` (engine/impulses/flow.py) by a number."""

    P: np.ndarray  # (N, N)
    P_back: np.ndarray
    U: np.ndarray
    U_back: np.ndarray
    by_force: np.ndarray


def coordinate_slopes(q: Linear, slope: Linear) -> Slopes:
    N = len(q.along)
    to = contact_coordinates(q)
    inverse = np.linalg.inv(q.M)
    d_inverse = -inverse @ slope.M @ inverse
    P, dP = to.P, np.zeros((N, N))
    dP[0] = slope.along
    d_back = -to.P_back @ dP @ to.P_back
    W, dW = np.eye(N), np.zeros((N, N))
    towards, seen = inverse @ q.along, q.along @ inverse @ q.along
    d_towards = d_inverse @ q.along + inverse @ slope.along
    d_seen = slope.along @ towards + q.along @ d_towards
    push = push_of(q, P)
    W[1:, 0] = push[1:]
    dW[1:, 0] = ((dP @ towards + P @ d_towards) / seen - push * d_seen / seen)[1:]
    dU = -dW @ P + (2 * np.eye(N) - W) @ dP  # the inverse of W is 2 - W
    return Slopes(dP, d_back, dU, d_back @ W + to.P_back @ dW, dU @ inverse + to.U @ d_inverse)


def rate_slopes(q: Linear, slope: Linear) -> np.ndarray:
    """Derivative of B, (m, m), where q changes by `slope`."""
    N = len(q.along)
    n = 2 * N
    to, d = contact_coordinates(q), coordinate_slopes(q, slope)
    dB = np.zeros((n + 3, n + 3))
    dB[:N, N:n] = d.P @ to.U_back + to.P @ d.U_back
    for columns, matrix, change, back, d_back in (
        (slice(N), q.K, slope.K, to.P_back, d.P_back),
        (slice(N, n), q.C, slope.C, to.U_back, d.U_back),
    ):
        dB[N:n, columns] = -(d.by_force @ matrix @ back + to.by_force @ (change @ back + matrix @ d_back))
    for column, name in ((n, "cosine"), (n + 1, "sine"), (n + 2, "constant")):
        dB[N:n, column] = d.by_force @ getattr(q, name) + to.by_force @ getattr(slope, name)
    dB[n, n + 1], dB[n + 1, n] = -slope.omega, slope.omega
    return dB
