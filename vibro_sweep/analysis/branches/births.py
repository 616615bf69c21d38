"""The branch that is born at a pitchfork or flip: its orbits at a small amplitude."""

from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.branches.sizes import size_of
from vibro_sweep.analysis.continuation.first_point import followed_from, guess_of
from vibro_sweep.analysis.continuation.tracer import branch_through
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.solution import Solution

AMPLITUDE = 1e-3  # of a branch that is born, in the units of a walk
LARGER = (4.0, 16.0, 64.0)  # times as large: where the branch leaves nearly along the born orbits


def born(parent: Solution, name: str, sign: int) -> Solution | None:
    """A solution on the branch that is born at a pitchfork or flip of its parent, on one side of it.

    The critical direction (dt, dD) has J(-1) (dt, dD) = 0; in the second half of the born orbit it has the sign -1
    for the times, and -sigma for the impulses. The parameter is found with the solution: it moves like the square of
    the amplitude. Where it hardly moves, the born orbit is next to a fold, and rounding does not tell it from its
    neighbours: the amplitude is then larger. None where no orbit can be told.
    """
    K, rests = parent.K, len(parent.rests)
    size = 2 * K + rests
    twice = parent.repeated(2)
    walk, units = branch_through(twice, name, size_of(parent, name)), twice.units
    scale = np.concatenate([units[:K], units[2 * K : 3 * K], units[4 * K : 4 * K + rests]])
    critical = Linearised(parent).critical_direction(-1) / scale
    critical *= -np.copysign(1.0, critical[K : 2 * K].sum())  # a choice: which of two mirror images comes first
    dt, dD, de = critical[:K], critical[K : 2 * K], critical[2 * K :]
    change = np.concatenate([dt, -dt, dD, -parent.sigma * dD, de, -de])
    change /= np.linalg.norm(change)
    normal, rests = np.append(change[: 4 * K], [0.0, 0.0, 0.0]), np.array(twice.rests, int)
    normal[2 * K + rests] = change[4 * K :] - change[rests]  # walks measure lengths of rests
    for factor in (1.0, *LARGER):
        moved = twice.u.copy()
        moved[: 2 * size] += sign * AMPLITUDE * factor * change * units[: 2 * size]
        guess = guess_of(walk, replace(twice, u=moved))
        point = guess and walk.correct(guess, normal)
        if point is not None and is_steady(point.solution, name):
            return point.solution
    return None


def is_steady(solution: Solution, name: str) -> bool:
    """Whether Newton's method stands still at the solution, so that its branch can be followed from there; without
    impacts whether it is alone, and the parameter within its range."""
    if solution.K:
        return followed_from(solution, name, size_of(solution, name)) is not None
    try:
        EventEquations.of(solution)
    except (np.linalg.LinAlgError, ValueError):
        return False
    return True
