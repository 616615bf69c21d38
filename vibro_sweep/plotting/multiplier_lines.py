"""What may be joined by a line along a branch: one multiplier, and the distance of one turning point from its stop."""

import numpy as np

from vibro_sweep.plotting.ragged import RaggedFile

JUMP = 3.0  # times steeper than the steps before and behind it a step is where another turning point is the nearest
SMALL = 0.02  # of the range: smaller changes are joined however steep they are


def multipliers(file: RaggedFile) -> np.ndarray:
    """(points, 2N) moduli of the multipliers: each column is one multiplier along the whole of a branch.

    Files have multipliers by falling modulus. From point to point each goes on as the one that has changed least,
    relative to its size, of all ways to pair them.
    """
    from scipy.optimize import linear_sum_assignment

    mu = file["multiplier_re"] + 1j * file["multiplier_im"]
    first = np.append(0, np.cumsum(file["branch_row_size"]))
    for i in np.setdiff1d(np.arange(1, len(mu)), first):
        before, here = mu[i - 1], mu[i]
        size = np.maximum(np.abs(before)[:, None], np.abs(here))
        change = np.abs(before[:, None] - here) / np.where(size > 0, size, 1.0)
        if np.all(np.isfinite(change)):
            mu[i] = here[linear_sum_assignment(change)[1]]
    return np.abs(mu)


def at_circle(moduli: np.ndarray, bifurcates: bool) -> float:
    """The modulus at a special point that is drawn: where a multiplier is on the unit circle, this one."""
    return moduli[np.argmin(np.abs(moduli - 1))] if bifurcates else moduli.max()


def margins(file: RaggedFile, states: list[str]) -> np.ndarray:
    """(points,) which points may be joined with the next one of their branch: where both margins are of one turning
    point.

    At a graze where an impact vanishes, the distance is that of the impact. Elsewhere turning points come and go in
    pairs, and the distance jumps: it then changes by far more, in relation to the step, than before and behind.
    """
    stop_distance, sizes = file["stop_distance"], file["branch_row_size"]
    coordinates = np.column_stack([file[name] for name in (*file.parameters, *states)])
    scale = np.ptp(coordinates, axis=0)
    result = np.zeros(len(stop_distance), bool)
    finite = stop_distance[np.isfinite(stop_distance)]
    small = SMALL * np.ptp(finite) if finite.size else 0.0
    ends = np.cumsum(sizes)
    for begin, end in zip(ends - sizes, ends, strict=True):
        m = stop_distance[begin:end]
        steps = np.linalg.norm(np.diff(coordinates[begin:end], axis=0) / np.where(scale > 0, scale, 1.0), axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            change = np.abs(np.diff(m))
            slope = np.where(np.isfinite(change), change / steps, np.nan)
        around = np.fmax(np.append(np.nan, slope[:-1]), np.append(slope[1:], np.nan))
        result[begin : end - 1] = np.isfinite(change) & ((change <= small) | ~(slope > JUMP * around))
    vanishes = file["special_point"][file["special_impact"] >= 0]
    vanishes = vanishes[vanishes >= 0]
    result[vanishes] = False
    result[vanishes[vanishes > 0] - 1] = False
    return result
