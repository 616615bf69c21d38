"""The first point of a branch or a curve: an orbit as a guess, null vectors and tangent where there are none yet."""

import numpy as np

from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve, branch_through
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import conditions, is_critical, unknowns
from vibro_sweep.engine.continuation.workspace import THETA, Place, new_place

SLOW = 1e-5  # impulse, relative to the largest, of an impact that is next to a graze
STILL = 1e-5  # in units of a branch: an orbit that Newton's method takes farther off is another one


def first_place(curve: SolutionCurve, row: np.ndarray | None = None) -> Point | None:
    """The point of the curve at `start`, or near it on the plane across `row`; None where it is not isolated."""
    place = guess_of(curve)
    return place and converge(curve, place, row)


def start_of_branch(curve: SolutionCurve) -> Point | None:
    """The orbit itself as a point of its branch, towards larger parameters.

    None where Newton's method fails, or leads to another orbit, as at a fold to that from which it was born.
    """
    guess = guess_of(curve)
    point = guess and (curve.correct(guess, curve.axis(0)) or _across(curve, guess))
    if point is None or np.abs(curve.difference(guess, point)).max() > STILL:
        return None
    point.hold(guess.value)
    return point


def _across(curve: SolutionCurve, guess: Point) -> Point | None:
    """The start on the plane across its tangent, where impacts are so slow that the parameter hardly tells them."""
    speeds = np.abs(curve.orbit.jumps)
    row = first_direction(curve, guess) if speeds.min() < SLOW * speeds.max() else None
    return None if row is None else curve.correct(guess, np.copysign(1.0, row[-3]) * row)


def followed_from(
    solution: Solution, name: str, unit: float, bounds=(-np.inf, np.inf), step: float = 1.0
) -> Point | None:
    """`start_of_branch` of an orbit in this parameter; None also where the oscillator does not allow steps."""
    try:
        return start_of_branch(branch_through(solution, name, unit, bounds, step))
    except ValueError:
        return None


def beside_start(curve: SolutionCurve, length: float) -> Point | None:
    """The point of a branch at a distance from the orbit that it goes through, also where that is a fold."""
    guess = guess_of(curve)
    row = guess and first_direction(curve, guess)
    return None if row is None else curve.correct(curve.moved(guess, length), row)


def guess_of(curve: SolutionCurve, solution: Solution | None = None) -> Point | None:
    """The start, or another orbit of its branch, as it is; None where the oscillator has no forced motion."""
    s, place = solution or curve.orbit, Point(curve, new_place(curve.K, curve.n))
    q = s.family.linear
    tau = curve.tau if solution is None else curve.tau_at(s.family.free[curve.names[0]])
    place.phases[:], place.jumps[:] = q.omega * s.times + tau, s.jumps / curve.units.speed
    rests = list(s.rests)
    place.jumps[rests] = q.omega * (s.ends - s.times[rests])
    place.p[: len(curve.names)] = [s.family.free[name] for name in curve.names]
    place.p[THETA] = curve.start.theta
    if not curve.move_to(place):
        return None
    states = s.states[: curve.K, : curve.n] if curve.start.state is None else curve.start.state[None]
    steady = (curve.planes[0]["Z"] * np.exp(1j * place.phases[:, None])).real
    place.x[:, : curve.n] = states / curve.state_units - steady
    if curve.start.state is not None:
        curve.run_task(stepper.FOLLOW, place)
    return place


def converge(curve: SolutionCurve, place: Place, row: np.ndarray | None = None) -> Point | None:
    """The point of the curve near a guess without a tangent."""
    if not curve.move_to(place):
        return None
    if is_critical(curve.problem):
        _take_null_vectors(curve, place)
    if row is None:
        is_single = conditions(curve.problem) == unknowns(curve.problem)
        row = place.direction if is_single else first_direction(curve, place)
    return None if row is None else curve.correct(place, row)


def _take_null_vectors(curve: SolutionCurve, place: Place) -> None:
    """v and w of the critical multiplier, at a place that has none."""
    place.v[:], place.w[:] = 0.0, 0.0
    for _ in range(2):  # with any border, then with what that gives
        curve.run_task(stepper.ASSEMBLE, place)
        for here, found in ((place.v, curve.workspace.events["v"]), (place.w, curve.workspace.trial)):
            here[:] = found / np.linalg.norm(found)


def first_direction(curve: SolutionCurve, place: Place) -> np.ndarray | None:
    """The tangent at a place to which the oscillator was moved; it is kept there."""
    if not curve.run_task(stepper.ASSEMBLE, place):
        return None
    n, size = curve.n, curve.n + unknowns(curve.problem)
    null = np.linalg.svd(curve.workspace.work[0]["ends"][: size - 1, :size])[2][-1]
    change, events = curve.taken_apart(place, null[:n], null[n:]), curve.workspace.events
    length = np.linalg.norm(change)
    place.tangent[:] = events["changes"][:, 1]
    place.tangent[:, :n] += events["rate"] * place.tangent[:, n, None]
    place.tangent[:] /= length
    place.tangent_p[:] = change[-3:] / length
    return change / length
