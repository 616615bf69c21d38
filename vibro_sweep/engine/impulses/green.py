"""The periodic Green function gamma_sigma: the gap's response to a unit impulse repeated every P with sign sigma.

    gamma_sigma(s) = e_g^T E(s) w,   w = (1 - sigma E(P))^-1 e_v,   0 < s <= P
    gamma_sigma(s - P) = sigma gamma_sigma(s)

with z = (x, x'), E(s) = exp(A s), e_g = (n, 0), e_v = (0, m_e M^-1 n), m_e = 1/(n.M^-1 n). Any damping, critical or
not. It is kept as Taylor polynomials on cells of equal width; they are built in extended precision, by doubling, so
that long periods add no rounding.

Free modes (K singular): a free mode that the contact sees has no periodic response to impulses of one sign. Then
gamma_1 is the response to the impulses less their mean force, with gamma_1(0) = 0, and the gap has one unknown constant
more, with the balance of momentum as its equation (equations.py).
"""

import math
from functools import lru_cache, wraps
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.extended import extended, identity, zeros
from vibro_sweep.engine.impulses.tables import (
    ORDER,
    REACH,
    exponential,
    nodes,
    power,
    solve_refined,
    taylor_rows,
)
from vibro_sweep.model.linear import Linear, forcing_period

MOST_CELLS = 1 << 17


class TooStiffError(ValueError):
    """The rates of the oscillator are too far apart for tables over its period."""


class ResonanceError(ValueError):
    """An undamped mode repeats itself after P: such orbits do not exist, or are not isolated."""


class Train(NamedTuple):
    """gamma_ratio, as the kernels read it. For multipliers mu, ratio = sigma/mu."""

    coefficients: np.ndarray  # (cells, ORDER + 1)
    slopes: np.ndarray  # (cells, ORDER + 1): derivative by a parameter at fixed s; (0, ORDER + 1) where it is zero
    width: float
    P: float
    P_slope: float
    ratio: float
    jumps: np.ndarray  # (4,): gamma^(n)(0+) - gamma^(n)(0-)
    jump_slopes: np.ndarray  # (4,)


class Space(NamedTuple):
    """The state space z = (x, x') of an oscillator and the vectors of its contact."""

    A: np.ndarray  # (2N, 2N)
    e_g: np.ndarray  # (2N,)
    e_v: np.ndarray  # (2N,)
    effective_mass: float


def by_matrices(function):
    """Remember the last results for equal M, K, C, n, omega."""
    known: dict = {}

    @wraps(function)
    def remembered(q: Linear):
        key = q.M.tobytes(), q.K.tobytes(), q.C.tobytes(), q.along.tobytes(), float(q.omega)
        if key not in known:
            if len(known) >= 64:
                known.clear()
            known[key] = function(q)
        return known[key]

    return remembered


@by_matrices
def space(q: Linear) -> Space:
    """z' = A z + ...; n.z_x is the gap, an impulse of gap velocity D changes z by D e_v."""
    N = len(q.along)
    inverse = np.linalg.inv(q.M)
    A = np.block([[np.zeros((N, N)), np.eye(N)], [-inverse @ q.K, -inverse @ q.C]])
    direction = inverse @ q.along
    effective_mass = 1 / (q.along @ direction)
    zero = np.zeros(N)
    e_v = np.concatenate([zero, direction * effective_mass])
    return Space(A, np.concatenate([q.along, zero]), e_v, effective_mass)


def space_slopes(q: Linear, slope: Linear) -> Space:
    """Derivatives of `space`."""
    N = len(q.along)
    inverse = np.linalg.inv(q.M)
    d_inverse = -inverse @ slope.M @ inverse
    zero = np.zeros((N, N))
    rows = [-d_inverse @ matrix - inverse @ change for matrix, change in ((q.K, slope.K), (q.C, slope.C))]
    direction = inverse @ q.along
    d_direction = d_inverse @ q.along + inverse @ slope.along
    effective_mass = 1 / (q.along @ direction)
    d_mass = -(effective_mass**2) * (slope.along @ direction + q.along @ d_direction)
    e_v = np.concatenate([zero[0], d_direction * effective_mass + direction * d_mass])
    return Space(np.block([[zero, zero], rows]), np.concatenate([slope.along, zero[0]]), e_v, d_mass)


@by_matrices
def free_modes(q: Linear) -> tuple[np.ndarray, np.ndarray]:
    """Shapes of the free modes (N, count), the one that the contact sees first, and what the contact sees of each.

    Raises LinAlgError where a mass is not positive, which a step along a branch may try.
    """
    if not np.all(np.diag(q.M) > 0):
        raise np.linalg.LinAlgError("M is not positive definite")
    scale = np.sqrt(np.diag(q.M))
    _, sizes, rows = np.linalg.svd(q.K / np.outer(scale, scale))
    shapes = (rows[sizes <= 1e-13 * max(sizes[0], q.omega**2)] / scale).T
    if shapes.shape[1] > 1:
        seen = q.along @ shapes
        rotation = np.linalg.qr(np.column_stack([seen, np.eye(len(seen))]))[0]
        shapes = shapes @ rotation
    seen = q.along @ shapes
    return shapes, np.where(np.abs(seen) > 1e-13 * np.abs(q.along) @ np.abs(shapes), seen, 0.0)


def has_free_gap(q: Linear) -> bool:
    """Whether the contact sees a free mode."""
    return bool(np.any(free_modes(q)[1]))


@by_matrices
def cells_needed(q: Linear) -> int:
    """Cells in half a forcing period."""
    A = space(q).A
    N = len(q.along)
    rate = math.sqrt(np.abs(A[N:, :N]).sum(1).max()) or q.omega
    scale = np.repeat([1.0, 1 / rate], N)
    norm = max(np.abs(A * scale[:, None] / scale).sum(1).max(), q.omega)
    return max(math.ceil(norm * forcing_period(q) / 2 / REACH), 4)


def checked_cells(q: Linear, halves: int) -> int:
    """Cells in so many half forcing periods. Raises TooStiffError."""
    cells = cells_needed(q) * halves
    if cells > MOST_CELLS:
        raise TooStiffError(f"tables over {halves} half periods need {cells} cells, at most {MOST_CELLS} are allowed")
    return cells


def _regular(matrix: np.ndarray) -> bool:
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return False
    return bool(np.abs(matrix).sum(1).max() * np.abs(inverse).sum(1).max() < 1e14)


def _bordered(q: Linear, s: Space, matrix: np.ndarray) -> np.ndarray:
    """1 - E(P), bordered for the free modes: on the left their momenta, on the right gamma(0) = 0."""
    shapes, seen = free_modes(q)
    left = np.concatenate([q.C @ shapes, q.M @ shapes])
    right = np.concatenate([shapes, np.zeros_like(shapes)]).T
    if np.any(seen):
        right[0] = s.e_g
    n, size = len(matrix), len(matrix) + len(right)
    result = zeros((size, size))
    result[:n, :n], result[:n, n:], result[n:, :n] = matrix, left, right
    return result


def train(q: Linear, ratio: float, halves: int, slope: Linear | None = None) -> Train:
    """gamma_ratio over P = halves T/2, and its derivative where q changes by `slope`.

    Raises TooStiffError, ResonanceError.
    """
    arrays = [q.M, q.K, q.C, q.along, q.omega]
    changes = [getattr(slope, name) for name in ("M", "K", "C", "along", "omega")] if slope is not None else []
    if not any(np.any(change) for change in changes):
        changes = []
    return _train(*(_Frozen(value) for value in arrays), ratio, halves, tuple(map(_Frozen, changes)))


class _Frozen:
    """An array as a key."""

    def __init__(self, value):
        self.value = np.asarray(value, float)
        self.key = (self.value.shape, self.value.tobytes())

    def __hash__(self):
        return hash(self.key)

    def __eq__(self, other):
        return self.key == other.key


def _partial(arrays) -> Linear:
    M, K, C, along, omega = arrays
    nothing = np.zeros(len(along))
    return Linear(M, K, C, along, nothing, nothing, nothing, float(omega), 0.0, 0.0, 0.0, 0.0, 0.0)


@lru_cache(maxsize=256)
def _train(M, K, C, along, omega, ratio, halves, changes) -> Train:
    q = _partial([value.value for value in (M, K, C, along, omega)])
    slope = _partial([value.value for value in changes]) if changes else None
    cells = checked_cells(q, halves)
    s = space(q)
    ds = space_slopes(q, slope) if slope is not None else None
    n = len(s.e_g)
    P = forcing_period(q) / 2 * halves
    dP = -P * slope.omega / q.omega if slope is not None else 0.0
    width = extended(P) / cells
    free = int(ratio == 1 and has_free_gap(q))
    # z, then the constant force -e_v/P of impulses that balance, then the derivative of both
    size = n + free
    A = zeros((size * (1 + (ds is not None)),) * 2)
    A[:n, :n] = s.A
    if free:
        A[:n, n] = -s.e_v / extended(P)
    if ds is not None:
        A[size:, size:] = A[:size, :size]
        A[size : size + n, :n] = ds.A
        if free:
            A[size : size + n, n] = -ds.e_v / extended(P) + s.e_v * extended(dP) / extended(P) ** 2
    E = exponential(A, width)
    EP = power(E, cells)
    matrix = identity(n) - extended(ratio) * EP[:n, :n]
    singular = ratio == 1 and free_modes(q)[0].shape[1] > 0
    system = _bordered(q, s, matrix) if singular else matrix
    if not _regular(system.astype(float)):
        raise ResonanceError(f"an undamped mode repeats itself, with sign {ratio:+g}, after {halves} half periods")
    right = s.e_v + EP[:n, n] if free else extended(s.e_v)
    extra = zeros(len(system) - n)
    w = solve_refined(system, np.concatenate([right, extra]))[:n]
    start = np.concatenate([w, np.ones(free)])
    row = extended(np.concatenate([s.e_g, np.zeros(free)]))
    jumps, jump_slopes = _jumps(s), np.zeros(4)
    slopes = np.zeros((0, ORDER + 1))
    if ds is not None:
        moved = EP[size : size + n, :size] @ start + dP * (A[:n, :size] @ EP[:size, :size] @ start)
        extra = zeros(len(system) - n)
        if free:
            extra[0] = -(ds.e_g @ w)
        dw = solve_refined(system, np.concatenate([ds.e_v + ratio * moved, extra]))[:n]
        both = np.concatenate([start, dw, np.zeros(free)])
        d_row = np.concatenate([ds.e_g, np.zeros(free), row])
        table = nodes(E, both, cells)
        slopes = np.ascontiguousarray((table @ taylor_rows(A, d_row).T).astype(float))
        jump_slopes = _jump_slopes(s, ds)
        table = table[:, :size]
    else:
        table = nodes(E, start, cells)
    coefficients = table @ taylor_rows(A[:size, :size], row).T
    coefficients = np.ascontiguousarray(coefficients.astype(float))
    return Train(coefficients, slopes, float(width), P, float(dP), float(ratio), jumps, jump_slopes)


def _jumps(s: Space) -> np.ndarray:
    """e_g^T A^n e_v for n = 0 .. 3: a unit impulse leaves the gap, and adds 1 to its velocity."""
    values, vector = [], s.e_v
    for _ in range(4):
        values.append(s.e_g @ vector)
        vector = s.A @ vector
    return np.array(values)


def _jump_slopes(s: Space, ds: Space) -> np.ndarray:
    values, vector, change = [], s.e_v, ds.e_v
    for _ in range(4):
        values.append(ds.e_g @ vector + s.e_g @ change)
        vector, change = s.A @ vector, ds.A @ vector + s.A @ change
    return np.array(values)
