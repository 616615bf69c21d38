"""The free modes of an oscillator, and how fine the tables of its flights have to be."""

import math

import numpy as np

from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.engine.impulses.taylor_orders import REACH
from vibro_sweep.oscillator.linear import MATRICES, Linear, forcing_period, memoised

MOST_CELLS = 1 << 17


class TooStiffError(VibroSweepError, ValueError):
    """The rates of the oscillator are too far apart for tables over its period."""


class ResonanceError(VibroSweepError, ValueError):
    """An undamped mode repeats itself after P: such orbits do not exist, or are not isolated."""


@memoised(*MATRICES)
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
        seen = q.contact.normal @ shapes
        rotation = np.linalg.qr(np.column_stack([seen, np.eye(len(seen))]))[0]
        shapes = shapes @ rotation
    seen = q.contact.normal @ shapes
    return shapes, np.where(np.abs(seen) > 1e-13 * np.abs(q.contact.normal) @ np.abs(shapes), seen, 0.0)


def turns(q: Linear) -> bool:
    """Whether masses may turn together, or move on: in a free mode that the contact does not see nothing holds them."""
    return bool(np.any(free_modes(q)[1] == 0.0))


def without_orbit(q: Linear) -> str:
    """The status of an oscillator whose equations of a periodic orbit are singular."""
    return "turning" if turns(q) else "resonance"


def has_free_gap(q: Linear) -> bool:
    """Whether the contact sees a free mode."""
    return bool(np.any(free_modes(q)[1]))


@memoised(*MATRICES)
def cells_needed(q: Linear) -> int:
    """Cells in half a forcing period."""
    inverse = np.linalg.inv(q.M)
    stiffness, damping = np.abs(inverse @ q.K), np.abs(inverse @ q.C)
    rate = math.sqrt(stiffness.sum(1).max()) or q.omega
    norm = max(rate, (stiffness / rate + damping).sum(1).max(), q.omega)
    return max(math.ceil(norm * forcing_period(q) / 2 / REACH), 4)


def checked_cells(q: Linear, half_periods: int) -> int:
    """Cells in so many half forcing periods. Raises TooStiffError."""
    cells = cells_needed(q) * half_periods
    if cells > MOST_CELLS:
        raise TooStiffError(
            f"tables over {half_periods} half periods need {cells} cells, at most {MOST_CELLS} are allowed"
        )
    return cells
