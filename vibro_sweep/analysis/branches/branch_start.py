"""Where a run along a branch begins: beside a special point, so that it is met like any other one."""

import numpy as np

from vibro_sweep.analysis.branches.free_run import FreeBranch, FreePoint
from vibro_sweep.analysis.branches.split_contacts import set_apart
from vibro_sweep.analysis.continuation.first_point import beside_start, followed_from, start_of_branch
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import branch_through
from vibro_sweep.analysis.continuation.starting_orbit import keeps_symmetry
from vibro_sweep.analysis.periodic.joined_contacts import contacts_are_one
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.errors import ArgumentError, VibroSweepError

BESIDE = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8)  # in units of the curve; near the onset of sticking branches are short
FARTHER = (1e-3, 1e-2)  # beside a fold so flat that Newton's method stands still only there
NEAR = 1e-6  # of a test, relative to its own size, within which an orbit may be the special point itself
TOUCHES = 1e-12  # distance from a stop, relative to the gap, and the like of a speed, within which it may be zero
NARROW = 1e-6  # of the parameter's size: the least range that is a unit of a curve


class NoStartError(VibroSweepError, ValueError):
    """Newton's method stands still neither at an orbit nor beside it."""


def start_of_run(
    solution: Solution, name: str, lo: float, hi: float, stable: bool = False, step: float = 1.0
) -> Point | FreePoint:
    """This orbit as a point of its branch, towards larger parameters, or its neighbour within the bounds where it is a
    special point itself, or so nearly a fold that Newton's method does not stand still there. stable : only a stable
    one, so that a stable orbit and its neighbour lie on the same side of the special point; step : of the lengths of
    steps along the branch, a factor.

    Raises NoStartError where it does not beside it either; ValueError where no orbit beside a special point is real and
    within the bounds.
    """
    if solution.sigma == -1 and not keeps_symmetry(solution.family, name):
        solution = solution.whole()
    unit = max(hi - lo, NARROW * max(abs(lo), abs(hi)))
    together = contacts_are_one(solution)
    if solution.K:
        curve = branch_through(solution, name, unit, (lo, hi), step)
        first = None if together else start_of_branch(curve)
    else:
        curve = FreeBranch(solution, (name,), unit, ((lo, hi),), step)
        first = curve.at(solution.family.free[name], 1.0)
    if first is not None and not is_special(first):
        return first
    for length in BESIDE if first is not None else (*BESIDE, *FARTHER):
        for sign in (1, -1):
            if together:
                beside = set_apart(curve, sign * length)
            else:
                beside = beside_start(curve, sign * length) if solution.K else first and first.ahead(sign * length)
            if (
                beside is not None
                and lo <= beside.value <= hi
                and is_real(beside)
                and (is_stable(beside) or not stable)
            ):
                there = followed_from(beside.solution, name, unit, (lo, hi), step) if solution.K else beside
                if there is not None:
                    return there
    if first is None:
        raise NoStartError("orbit: Newton's method does not stand still at it")
    if not is_real(first, TOUCHES):
        raise ArgumentError(f"orbit: it is a special point, and no orbit beside it in {name} is real and in bounds")
    return first


def changes_rests(solution: Solution, name: str) -> bool:
    """Whether this parameter is the restitution of a stop on which the mass rests after one impact, as at R = 0."""
    resting = np.array(solution.sides)[list(solution.rests)]
    return bool(solution.rests) and bool(np.any(solution.family.derivative(name).contact.restitution(resting)))


def is_special(point: Point | FreePoint) -> bool:
    """Whether a test of this point is zero, to rounding or nearly so."""
    s = point.solution
    mu = s.multipliers
    zeros = [abs(point.rate), np.abs(mu + 1).min()]
    if len(mu) > 2 and point.solution.torus != 1.0:
        zeros.append(np.abs(1 - s.products).min())
    return min(zeros) < NEAR or not is_real(point, TOUCHES)


def is_real(point: Point | FreePoint, least: float = 0.0) -> bool:
    """Whether all impulses push and all flights stay inside, by more than the share `least`."""
    s = point.solution
    length = least * s.size_of_gap
    rests = not s.K or (bool(np.all(point.releases > 0)) and point.stays > 0 and point.relaxed > 0)
    return bool(np.all(s.pushes > s.family.linear.omega * length)) and s.stop_distance > length and rests


def is_stable(point: Point | FreePoint) -> bool:
    return bool(np.all(np.abs(point.solution.multipliers) < 1))
