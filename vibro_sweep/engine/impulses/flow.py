"""The oscillator's free flight as tables, in contact coordinates, for the kernels of flights.py.

State zeta = (y, y', cos(omega t + tau), sin(omega t + tau), 1) in contact coordinates y = T x (physics.md): y_1 is the
gap, and an impulse changes y_1' and nothing else. zeta' = B zeta.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.extremes import middle_weights
from vibro_sweep.engine.impulses.green import (
    MOST_CELLS,
    ResonanceError,
    TooStiffError,
    cells_needed,
    free_modes,
    has_free_gap,
)
from vibro_sweep.engine.impulses.tables import ORDER, REAL, exponential, power, taylor_rows
from vibro_sweep.model.linear import Keyed, Linear, amplitudes, forcing_period

DOUBLINGS = 18


class Coordinates(NamedTuple):
    """y = T x, x = inverse y."""

    T: np.ndarray  # (N, N)
    inverse: np.ndarray
    by_force: np.ndarray  # T M^-1: y'' by the force


def contact_coordinates(q: Linear) -> Coordinates:
    """T with first row n and other rows w_i, w_i M^-1 n = 0; the identity where n = e_1 and M is diagonal."""
    return _coordinates(Keyed(q, ("M", "along")))


@lru_cache(maxsize=16)
def _coordinates(key: Keyed) -> Coordinates:
    q = key.q
    N = len(q.along)
    direction = np.linalg.solve(q.M, q.along)
    T = np.eye(N)
    T[0] = q.along
    if np.count_nonzero(q.along[1:]) or np.count_nonzero(direction[1:]):
        T[1:] = np.linalg.qr(np.column_stack([direction, np.eye(N)]))[0].T[1:]
    return Coordinates(T, np.linalg.inv(T), T @ np.linalg.inv(q.M))


def steady_motion(q: Linear, t: float) -> np.ndarray:
    """(2N,) the part of (y, y') that the harmonic force drives, at the time t."""
    swing = contact_coordinates(q).T @ amplitudes(q) * np.exp(1j * (q.omega * t + q.tau))
    return np.concatenate([swing.real, -q.omega * swing.imag])


class Flow(NamedTuple):
    """Free flight of one oscillator in contact coordinates; n = 2N, m = n + 3."""

    B: np.ndarray  # (m, m)
    width: float  # of a cell
    powers: np.ndarray  # (DOUBLINGS, m, m): exp(B width 2^j)
    series: np.ndarray  # (ORDER + 1, m^2): B^k/k!
    rows: np.ndarray  # (ORDER + 1, m): the gap's Taylor coefficients
    middle: np.ndarray  # (m, MIDDLE): rows^T . middle_weights (extremes.py)
    rest: np.ndarray  # (m,): |rows|^T . its rest_weights
    omega: float
    tau: float
    spread: float  # between the fastest and the slowest decay, per unit time


def rates(q: Linear) -> np.ndarray:
    """B of zeta' = B zeta, (m, m)."""
    N = len(q.along)
    _, inverse, to_y = contact_coordinates(q)
    n = 2 * N
    B = np.zeros((n + 3, n + 3))
    B[:N, N:n] = np.eye(N)
    B[N:n, :N], B[N:n, N:n] = -to_y @ q.K @ inverse, -to_y @ q.C @ inverse
    B[N:n, n], B[N:n, n + 1], B[N:n, n + 2] = to_y @ q.cosine, to_y @ q.sine, to_y @ q.constant
    B[n, n + 1], B[n + 1, n] = -q.omega, q.omega
    return B


def flow(q: Linear) -> Flow:
    """Tables of the free flight. Raises TooStiffError."""
    B = rates(q)
    return _flow(q, B, np.eye(len(B))[0])


def held_flow(q: Linear) -> Flow:
    """Tables of the motion while the gap stays as it is; rows: of what the gap's free acceleration is then."""
    B = rates(q)
    N = len(q.along)
    held = B.copy()
    held[0], held[N] = 0.0, 0.0
    return _flow(q, held, B[N])


def _flow(q: Linear, B: np.ndarray, row: np.ndarray) -> Flow:
    n = len(B) - 3
    cells = 2 * cells_needed(q)
    if cells > MOST_CELLS:
        raise TooStiffError(f"a forcing period needs {cells} cells, at most {MOST_CELLS} are allowed")
    width = REAL(forcing_period(q)) / cells
    step = exponential(B.astype(REAL), width)
    powers = []
    with np.errstate(over="ignore", invalid="ignore"):  # beyond a bound of the parameter flights may grow
        for _ in range(DOUBLINGS):
            powers.append(step.astype(float))
            step = step @ step
    series = taylor_rows(B.astype(REAL), np.eye(len(B), dtype=REAL))
    rows = (row.astype(REAL) @ series).astype(float)
    middle, rest = middle_weights(float(width))
    decays = np.linalg.eigvals(B[:n, :n]).real
    return Flow(
        B,
        float(width),
        np.array(powers),
        series.astype(float).reshape(ORDER + 1, -1),
        rows,
        rows.T @ middle,
        np.abs(rows.T) @ rest,
        q.omega,
        float(q.tau),
        float(np.ptp(decays)),
    )


def closing(q: Linear, sigma: int, halves: int) -> np.ndarray:
    """(n, n + 1): from what a period adds to a zero state, and the gap, the state that repeats itself with sigma.

    The gap is used only where the contact sees a free mode. Raises ResonanceError.
    """
    N = len(q.along)
    n = 2 * N
    T, inverse, to_y = contact_coordinates(q)
    A = np.zeros((n, n), REAL)
    A[:N, N:] = np.eye(N)
    A[N:, :N], A[N:, N:] = -to_y @ q.K @ inverse, -to_y @ q.C @ inverse
    cells = cells_needed(q)
    half = power(exponential(A, REAL(forcing_period(q)) / 2 / cells), cells)
    matrix = (sigma * np.eye(n) - power(half, halves)).astype(float)
    result = np.zeros((n, n + 1))
    if sigma == 1 and has_free_gap(q):
        shapes, _ = free_modes(q)
        count = shapes.shape[1]
        momentum = np.block([[inverse.T @ q.C @ shapes], [inverse.T @ q.M @ shapes]])
        gauge = np.concatenate([T @ shapes, np.zeros_like(shapes)]).T
        gauge[0] = np.eye(n)[0]
        bordered = np.block([[matrix, momentum], [gauge, np.zeros((count, count))]])
        result[:] = np.linalg.inv(bordered)[:n, : n + 1]
        return result
    if np.linalg.cond(matrix) > 1e14:
        raise ResonanceError(f"an undamped mode repeats itself, with sign {sigma:+d}, after {halves} half periods")
    result[:, :n] = np.linalg.inv(matrix)
    return result
