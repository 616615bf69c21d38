"""The state space of an oscillator, its free modes, and how fine its tables have to be."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.tables import REACH
from vibro_sweep.model.linear import Linear, forcing_period, remembered

MOST_CELLS = 1 << 17
MATRICES = ("M", "K", "C", "along", "omega")  # fields that move the free flight


class TooStiffError(ValueError):
    """The rates of the oscillator are too far apart for tables over its period."""


class ResonanceError(ValueError):
    """An undamped mode repeats itself after P: such orbits do not exist, or are not isolated."""


class Space(NamedTuple):
    """The state space z = (x, x') of an oscillator and the vectors of its contact."""

    A: np.ndarray  # (2N, 2N)
    e_g: np.ndarray  # (2N,)
    e_v: np.ndarray  # (2N,)
    effective_mass: float


@remembered(*MATRICES)
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


@remembered(*MATRICES)
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


@remembered(*MATRICES)
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
