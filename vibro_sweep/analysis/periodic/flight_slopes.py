"""How the states before the impacts move with a parameter of the flights, at fixed times and impulses.

With zeta' = B zeta (engine/impulses/flow.py) the derivative s of zeta obeys s' = B s + (dB/dp) zeta, so that both fly
together:

    (s, zeta)' = [[B, dB/dp], [0, B]] (s, zeta)

A flight begins with the derivative of the state before its impact and that of the forcing; where the period changes
too, the last one ends later. The cost grows like the number of impacts; sums over all impacts at each impact, as in
engine/impulses/equations.py, take seconds for a thousand of them.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.periodic.impulse_equations import Equations, closing, flow
from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.flow import DOUBLINGS, Flow, contact_coordinates
from vibro_sweep.engine.impulses.tables import exponential, taylor_rows
from vibro_sweep.model.contact import push_of
from vibro_sweep.model.linear import Linear


def state_slopes(e: Equations, u, states: np.ndarray) -> np.ndarray:
    """(K, n) derivatives by the parameter of the states (K, m) before the impacts of `Equations.fly`, at fixed u.

    Without free modes that the contact sees, and with R > 0 at all impacts.
    """
    f = flow(e.q)
    K, m = states.shape
    n, P_slope = m - 3, -e.P * e.slope.omega / e.q.omega
    t, both = u[:K], _flow_of_both(f, rate_slopes(e.q, e.slope))
    starts, ends, room = np.zeros((K, 2 * m)), np.empty((K, 2 * m)), flights.new_room(2 * m)
    turned = e.slope.omega * t + e.slope.tau
    starts[:, n], starts[:, n + 1] = -states[:, n + 1] * turned, states[:, n] * turned
    starts[:, m:] = states
    starts[:, m + n // 2] += u[K : 2 * K]
    flights.sample_flights(both, starts, t, np.arange(K), np.append(t[1:], t[0] + e.P), ends, room)
    added = ends[:, :n]
    added[-1] += (f.B @ ends[-1, m:])[:n] * P_slope
    E = np.empty((K, n, n))
    flights.flight_matrices(f, np.diff(np.append(t, t[0] + e.P)), E, flights.new_room(m))
    result = np.zeros((K + 1, n))
    for k in range(K):
        result[k + 1] = E[k] @ result[k] + added[k]
    result[0] = closing(e.q, e.sigma, e.halves)[:, :n] @ result[K]
    for k in range(K - 1):
        result[k + 1] = E[k] @ result[k] + added[k]
    return result[:K]


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


def _flow_of_both(f: Flow, dB: np.ndarray) -> Flow:
    """Tables of (s, zeta) in double precision: derivatives need no more digits. What looks for turning points is not
    among them."""
    m = len(f.B)
    B = np.block([[f.B, dB], [np.zeros((m, m)), f.B]])
    step = exponential(B, f.width).astype(float)
    powers = [step]
    with np.errstate(over="ignore", invalid="ignore"):  # as of a flow: flights may grow
        while len(powers) < DOUBLINGS:
            powers.append(powers[-1] @ powers[-1])
    series = taylor_rows(B, np.eye(2 * m)).reshape(-1, 4 * m * m)
    return f._replace(B=B, powers=np.array(powers), series=series)
