"""The oscillator's free flight as tables, in contact coordinates, for the kernels of flights.py.

State zeta = (q, u, cos(omega t + tau), sin(omega t + tau), 1): q are contact coordinates (points/contact.py), of
which the first is the gap, and u1 = q1', uj = qj' - p_j q1': an impulse changes u_1 and nothing else.

    q' = W u,    W u = u + (0, p_2, p_3, ..) u_1,    zeta' = B zeta
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.extended import extended, identity
from vibro_sweep.engine.impulses.free_modes import (
    MOST_CELLS,
    ResonanceError,
    TooStiffError,
    cells_needed,
    free_modes,
    has_free_gap,
)
from vibro_sweep.engine.impulses.taylor_orders import ORDER, exponential, power, taylor_rows
from vibro_sweep.engine.points.contact import coordinates, push_of
from vibro_sweep.oscillator.linear import MATRICES, MOTION, STEP, Linear, amplitudes, forcing_period, memoised, stepped

DOUBLINGS = 18


class Coordinates(NamedTuple):
    """q = P x and u = U x', and back."""

    P: np.ndarray  # (N, N)
    P_back: np.ndarray
    U: np.ndarray
    U_back: np.ndarray
    by_force: np.ndarray  # U M^-1: u' by the force

    def of_masses(self, states: np.ndarray) -> np.ndarray:
        """(..., 2 N) contact coordinates (q, u) of states (x, x')."""
        n = len(self.P)
        return np.concatenate([states[..., :n] @ self.P.T, states[..., n : 2 * n] @ self.U.T], -1)

    def to_masses(self, states: np.ndarray) -> np.ndarray:
        """(..., 2 N) x1 v1 .. xN vN of contact coordinates (q, u)."""
        n = len(self.P)
        result = np.empty((*states.shape[:-1], 2 * n))
        result[..., ::2] = states[..., :n] @ self.P_back.T
        result[..., 1::2] = states[..., n : 2 * n] @ self.U_back.T
        return result


@memoised("M", "contact.normal")
def contact_coordinates(q: Linear) -> Coordinates:
    """The coordinates of the masses where n = e_1 and M is diagonal. Which mass is left out depends on n alone: what
    follows from the coordinates stays smooth along branches."""
    P, back = coordinates(q.contact.normal, int(np.argmax(np.abs(q.contact.normal))))
    push = push_of(q, P)
    W, inverse = (np.eye(len(P), dtype=push.dtype) for _ in range(2))
    W[1:, 0], inverse[1:, 0] = push[1:], 0.0 - push[1:]
    U = inverse @ P
    return Coordinates(P, back, U, back @ W, U @ np.linalg.inv(q.M))


def steady_motion(q: Linear, t: float) -> np.ndarray:
    """(2N,) the part of (q, u) that the harmonic force drives, at the time t."""
    to, swing = contact_coordinates(q), amplitudes(q) * np.exp(1j * (q.omega * t + q.tau))
    return np.concatenate([(to.P @ swing).real, -q.omega * (to.U @ swing).imag])


class Flow(NamedTuple):
    """Free flight of one oscillator in contact coordinates; n = 2N, m = n + 3."""

    B: np.ndarray  # (m, m)
    width: float  # of a cell
    powers: np.ndarray  # (DOUBLINGS, m, m): exp(B width 2^j)
    series: np.ndarray  # (ORDER + 1, m^2): B^k/k!
    omega: float
    tau: float
    spread: float  # between the fastest and the slowest decay, per unit time


def rates(q: Linear) -> np.ndarray:
    """B of zeta' = B zeta, (m, m)."""
    N = q.masses
    to = contact_coordinates(q)
    n = 2 * N
    A = free_rates(q)
    B = np.zeros((n + 3, n + 3), A.dtype)
    B[:n, :n] = A
    B[N:n, n], B[N:n, n + 1], B[N:n, n + 2] = (to.by_force @ force for force in (q.cosine, q.sine, q.constant))
    B[n, n + 1], B[n + 1, n] = -q.omega, q.omega
    return B


def rate_slopes(q: Linear, slope: Linear) -> np.ndarray:
    """Derivative of B, (m, m), where q changes by `slope`, by a complex step."""
    return rates(stepped(q, slope)).imag / STEP


def free_rates(q: Linear) -> np.ndarray:
    """The part of it that knows no force, (n, n)."""
    N = q.masses
    to = contact_coordinates(q)
    A = np.zeros((2 * N, 2 * N), to.U.dtype)
    A[:N, N:] = to.P @ to.U_back
    A[N:, :N], A[N:, N:] = -to.by_force @ q.K @ to.P_back, -to.by_force @ q.C @ to.U_back
    return A


@memoised(*MOTION, most=16)
def flow(q: Linear) -> Flow:
    """Tables of the free flight. Raises TooStiffError."""
    return _flow(q, rates(q))


@memoised(*MOTION, most=16)
def constrained_flow(q: Linear) -> Flow:
    """Tables of the motion while the gap stays as it is."""
    B = rates(q)
    B[0], B[q.masses] = 0.0, 0.0
    return _flow(q, B)


def contact_flow(q: Linear, side: int) -> Flow:
    """Tables of the motion in contact with a compliant stop (+1 high, -1 low)."""
    N, B = q.masses, rates(q)
    law, stop = q.contact.law(side), q.contact.stop(side)
    push = contact_coordinates(q).by_force[0] @ q.contact.normal  # 1/m_e
    B[N, 0] -= law.k * push
    B[N, N] -= law.c * push
    B[N, -1] -= (side * law.p - law.k * stop) * push
    return _flow(q, B, math.sqrt(law.k * push) + law.c * push)


def _flow(q: Linear, B: np.ndarray, rate: float = 0.0) -> Flow:
    """rate : beside those of the free flight, which cells are to resolve"""
    n = len(B) - 3
    cells = 2 * cells_needed(q)
    if cells > MOST_CELLS:
        raise TooStiffError(f"a forcing period needs {cells} cells, at most {MOST_CELLS} are allowed")
    cells += math.ceil(2 * rate * forcing_period(q))
    width = extended(forcing_period(q)) / cells
    step = exponential(extended(B), width)
    powers = []
    with np.errstate(over="ignore", invalid="ignore"):  # beyond a bound of the parameter flights may grow
        for _ in range(DOUBLINGS):
            powers.append(step.astype(float))
            step = step @ step
    series = taylor_rows(extended(B), identity(len(B)))
    decays = np.linalg.eigvals(B[:n, :n]).real
    return Flow(
        B,
        float(width),
        np.array(powers),
        series.astype(float).reshape(ORDER + 1, -1),
        q.omega,
        float(q.tau),
        float(np.ptp(decays)),
    )


@memoised(*MATRICES)
def closing(q: Linear, sigma: int, half_periods: int) -> np.ndarray:
    """(n, n + 1): from what a period adds to a zero state, and the gap, the state that repeats itself with sigma.

    The gap is used only where the contact sees a free mode. Raises ResonanceError.
    """
    N = q.masses
    n = 2 * N
    A = extended(free_rates(q))
    cells = cells_needed(q)
    half = power(exponential(A, extended(forcing_period(q)) / 2 / cells), cells)
    matrix = (sigma * np.eye(n) - power(half, half_periods)).astype(float)
    result = np.zeros((n, n + 1))
    if sigma == 1 and has_free_gap(q):
        momentum, gauge = _free_motion(q)
        count = len(gauge)
        gauge[0] = np.eye(n)[0]
        bordered = np.block([[matrix, momentum], [gauge, np.zeros((count, count))]])
        result[:] = np.linalg.inv(bordered)[:n, : n + 1]
        return result
    unit = np.repeat([1.0, q.omega], N)  # velocities over omega, so that the condition does not depend on units
    if np.linalg.cond(matrix * unit / unit[:, None]) > 1e14:
        raise ResonanceError(
            f"an undamped mode repeats itself, with sign {sigma:+d}, after {half_periods} half periods"
        )
    result[:, :n] = np.linalg.inv(matrix)
    return result


def _free_motion(q: Linear) -> tuple[np.ndarray, np.ndarray]:
    """Momenta (n, count) and places (count, n), by the state, of the free modes; first the one that the contact
    sees."""
    to, (shapes, _) = contact_coordinates(q), free_modes(q)
    momentum = np.block([[to.P_back.T @ q.C @ shapes], [to.U_back.T @ q.M @ shapes]])
    return momentum, np.concatenate([to.P @ shapes, np.zeros_like(shapes)]).T


def unseen_modes(q: Linear) -> np.ndarray:
    """(n, n) momenta times places of the free modes that the contact does not see."""
    momentum, places = _free_motion(q)
    seen = int(has_free_gap(q))
    return momentum[:, seen:] @ places[seen:]
