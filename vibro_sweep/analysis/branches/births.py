"""The branch that is born at a pitchfork or flip: its orbits at a small amplitude."""

from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.branches.sizes import size_of
from vibro_sweep.analysis.continuation.first_point import followed_from, guess_of
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve, branch_through
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.solution import Solution

AMPLITUDE = 1e-3  # of a branch that is born, in the units of its curve
ROUNDED = 1e-9  # a part of a direction that is taken for zero
LARGER = (4.0, 16.0, 64.0)  # times as large: where the branch leaves nearly along the born orbits


def born(parent: Solution, name: str, sign: int) -> Solution | None:
    """A solution on the branch that is born at a pitchfork or flip of its parent, on one side of it.

    The critical direction w has J(-1) w = 0. The parameter is found with the solution: it moves like the square of the
    amplitude. Where it hardly moves, the born orbit is next to a fold, and rounding does not tell it from its
    neighbours: the amplitude is then larger. None where no orbit can be distinguished.
    """
    twice = parent.repeated(2)
    curve = branch_through(twice, name, size_of(parent, name))
    w = Linearised(parent).critical_direction(-1)
    change = repeated(parent, 2, w, -1.0)[1]
    size = np.linalg.norm(change / twice.units[: len(change)])
    w *= -np.copysign(1 / size, _first_image(parent, w))
    for factor in (1.0, *LARGER):
        solution = with_amplitude(curve, *repeated(parent, 2, sign * AMPLITUDE * factor * w, -1.0))
        if solution is not None and is_steady(solution, name):
            return solution
    return None


def _first_image(parent: Solution, w: np.ndarray) -> float:
    """A number whose sign says which of two mirror images comes first, whichever half of the parent is described.

    It is the change of all jumps or, where this is rounding, of the times on the left less those on the right.
    """
    scaled = w[: 2 * parent.K] / parent.units[: 2 * parent.K]
    times, jumps = np.split(scaled, 2)
    change = jumps.sum()
    return change if abs(change) > ROUNDED * np.abs(scaled).max() else -np.dot(parent.sides, times)


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


def repeated(parent: Solution, count: int, w: np.ndarray, mu: complex) -> tuple[Solution, np.ndarray]:
    """The orbit taken `count` times, moved by mu^k w and its conjugate in period k; and the change itself.

    w : of times, impulses and ends of rests (2K + rests,); impulses of a symmetric orbit change their sign in each half
    """
    dt, dD, de = np.split(w, [parent.K, 2 * parent.K])
    turns, signs = mu ** np.arange(count)[:, None], float(parent.sigma) ** np.arange(count)[:, None]
    change = np.concatenate([2 * part.real.ravel() for part in (turns * dt, signs * turns * dD, turns * de)])
    child = parent.repeated(count)
    return replace(child, u=child.u + change), change


def with_amplitude(curve: SolutionCurve, guess: Solution, change: np.ndarray) -> Solution | None:
    """The orbit near a guess with its amplitude in the direction `change`; the parameter is found with it."""
    change, K, rests = change / guess.units[: len(change)], guess.K, np.array(guess.rests, int)
    row = np.append(change[: 2 * K], [0.0, 0.0, 0.0])
    row[K + rests] = change[2 * K :] - change[rests]  # the unknowns of a curve are lengths of rests
    place = guess_of(curve, guess)
    point = place and curve.correct(place, row / np.linalg.norm(row))
    return point and point.solution
