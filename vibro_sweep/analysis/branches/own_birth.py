"""Where the branch of a doubled or asymmetric orbit is born: there it turns into itself.

The difference of the two halves of its orbits changes its sign as a whole, and the simpler orbit has a flip or a
pitchfork. On the branch itself that point is singular, so it is located on the parent's.
"""

from collections.abc import Iterator

import numpy as np

from vibro_sweep.analysis.branches.branch_events import locate, test_of
from vibro_sweep.analysis.branches.crossings import counts_of
from vibro_sweep.analysis.continuation.events import Event, LocatedEvent
from vibro_sweep.analysis.continuation.first_point import followed_from
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.pairs import ON_SQUARE
from vibro_sweep.tables.bifurcations import name_of

BEFORE = 0.02, 0.1, 0.4  # of the way to a birth, beside which a multiplier is 1 to rounding
NEAR = 0.1  # in scaled units: a birth that rounding beside it may hide
LANDS = 0.3  # of the difference of the halves before a step, at its end
APART = 4.0  # times its rounding: so far a point lies from a birth at least, to be distinguished from it


def own_birth(curve: SolutionCurve, a: Point, b: Point) -> LocatedEvent | None:
    """The birth between a and b, located on the parent's branch; None without one."""
    for sigma, share in turns(a.solution, b.solution):
        found = _on_parent(curve, curve.between(a, b, share).solution, sigma)
        if found is not None:
            return found._replace(share=share)
    return None


def turns(one: Solution, other: Solution) -> Iterator[tuple[int, float]]:
    """The births between two solutions: sigma of the parent, and the share at which the difference of the halves turns
    round."""
    for sigma in (1, -1):
        parts = [halves_apart(solution, sigma) for solution in (one, other)]
        if any(part is None for part in parts):
            continue
        sizes = [float(np.linalg.norm(part)) for part in parts]
        if parts[0] @ parts[1] < -0.5 * sizes[0] * sizes[1]:
            yield sigma, sizes[0] / sum(sizes)


def before_birth(curve: SolutionCurve, a: Point, distance: float, parent: Point) -> Point | None:
    """A point before a birth at which fewer multipliers are 1; None where a is too near to the birth.

    Beside the birth rounding moves a point along its branch. The tangent turns with the multipliers above 1: where it
    does not, its sign is rounding.
    """
    most = _ones(parent.solution.multipliers**2) - 1
    for share in BEFORE:
        point = curve.step(a, (1 - share) * distance)
        if point is None or abs(point.value - parent.value) < APART * point.rounding:
            continue
        if _ones(point.solution.multipliers) <= most:
            turned = (counts_of(point).above - counts_of(a).above) % 2 == 1
            if turned == (a.rate * point.rate < 0):
                return point
    return None


def over_birth(curve: SolutionCurve, a: Point) -> tuple[Point, Point] | None:
    """The point beyond the birth to which a leads, and the parent; None where it leads to none within `NEAR`."""
    ahead = curve.moved(a, 1.0)  # at the distance 1, with the parameter of the point
    ahead.hold(a.value)
    for sigma in (1, -1):
        here, there = (halves_apart(solution, sigma) for solution in (a.solution, ahead.solution))
        if here is None or not here @ (there - here) < 0:
            continue
        distance = float(here @ here / (here @ (here - there)))
        b = curve.step(a, 2 * distance) if distance < NEAR else None
        birth = None if b is None else own_birth(curve, a, b)
        if birth is not None:
            return b, birth.place
    return None


def lands_on_birth(curve: SolutionCurve, a: Point, b: Point) -> Point | None:
    """The point beyond the birth to which a leads, where rounding does not tell b from the birth."""
    for sigma in (1, -1):
        parts = [halves_apart(point.solution, sigma) for point in (a, b)]
        if all(part is not None for part in parts) and np.linalg.norm(parts[1]) < LANDS * np.linalg.norm(parts[0]):
            over = over_birth(curve, a)
            if over is not None and abs(b.value - over[1].value) < APART * b.rounding:
                return over[0]
    return None


def _ones(multipliers: np.ndarray) -> int:
    return int(np.sum(np.abs(multipliers - 1) < ON_SQUARE))


def _on_parent(curve: SolutionCurve, whole: Solution, sigma: int) -> LocatedEvent | None:
    parent = whole.part(2, sigma, alike=0.1)
    if parent is None:
        return None
    first = followed_from(parent, curve.names[0], curve.unit[0])
    kind, reach = name_of("flip", sigma), 1e-6
    while kind and first is not None and reach < 0.05:
        event, ends = Event(kind, test_of("minus")), [first.curve.step(first, sign * reach) for sign in (-1, 1)]
        if None not in ends and event.test(ends[0]) * event.test(ends[1]) < 0:
            return locate(first.curve, event, *ends)
        reach *= 4
    return None


def halves_apart(solution: Solution, sigma: int) -> np.ndarray | None:
    """The difference of the halves, as repetitions (sigma = 1) or mirror images (-1); None: their itineraries do, or
    the oscillator does, which may be symmetric at one value of the parameter only."""
    if not may_be_born(solution, sigma):
        return None
    half, t, D, P = solution.K // 2, solution.times, solution.jumps, solution.P
    omega, speed = solution.family.linear.omega, np.abs(D).max()
    return np.concatenate([(t[half:] - t[:half] - P / 2) * omega, (D[half:] - sigma * D[:half]) / speed])


def may_be_born(whole: Solution, sigma: int) -> bool:
    """Whether itineraries allow that the halves become repetitions (sigma = 1) or mirror images (-1) of each other."""
    if whole.sigma != 1 or whole.K % 2 or whole.K == 0:
        return False
    half = whole.K // 2
    if any(a != sigma * b for a, b in zip(whole.sides[:half], whole.sides[half:], strict=True)):
        return False
    return whole.half_periods % 4 == (0 if sigma == 1 else 2) and (sigma == 1 or whole.family.linear.symmetric)
