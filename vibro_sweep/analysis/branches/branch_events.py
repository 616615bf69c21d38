"""What happens between two points of a branch: its end, and bifurcations before it."""

import math

import numpy as np

from vibro_sweep.analysis.continuation.events import Event, LocatedEvent, Test
from vibro_sweep.analysis.continuation.point import Point, along
from vibro_sweep.analysis.continuation.rounding import rounding_error
from vibro_sweep.analysis.continuation.secant import error_of, root
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.periodic.solution import NO_SPEED
from vibro_sweep.engine.continuation.branch_tests import PASSED
from vibro_sweep.engine.continuation.workspace import NAMES
from vibro_sweep.engine.impulses.pairs import ON_PAIR, ON_SQUARE
from vibro_sweep.tables.bifurcations import TYPES

ROUNDED = 1e-9  # of a step, by which rounding may put an event behind its end


def _stays(point: Point) -> float:
    return min(point.stays, 1.0)


SPLIT = Event("split", _stays)


def ends_between(curve: SolutionCurve, bounds, a: Point, b: Point) -> list[Event]:
    """The events that may end the branch from a, which is real, to b."""
    events = []
    for boundary, side in zip(bounds, (-1, 1), strict=True):
        if (b.value - boundary) * side > 0:
            events.append(Event("boundary", _beyond(boundary, side, a), boundary=boundary))
    for i in range(curve.K):
        if b.presses[i] <= 0:
            test = _positive_at(a, lambda point, i=i: point.presses[i])
            events.append(Event("graze", test, impact=i))
        if a.releases[i] > 0 >= b.releases[i]:
            events.append(Event("sticking", lambda point, i=i: point.releases[i]))
    if a.stays > 0 >= b.stays:
        events.append(SPLIT if np.any(curve.orbit.contacts) else Event("sticking", _stays))
    if a.relaxed > 0 >= b.relaxed:
        events.append(Event("unrelaxed", lambda point: min(point.relaxed, 1.0)))
    if b.stop_distance <= 0 < a.stop_distance or passes_stop(b):
        most = 2 * abs(a.stop_distance) if math.isfinite(a.stop_distance) else 1.0
        test = _positive_at(a, lambda point: min(point.stop_distance, most))
        events.append(Event("graze", test, touches=True))
    return events


def first_end(curve: SolutionCurve, events: list[Event], a: Point, b: Point) -> LocatedEvent | None:
    """The first of these events; None where none is found.

    Behind an impact that vanishes, and often behind a boundary, a flight passes its stop: where none does so at the
    first end that is found, that is not looked for.
    """
    located = []
    for event in sorted(events, key=lambda event: event.touches):
        if event.touches and located and not passes_stop(earliest(located).place):
            break
        found = locate(curve, event, a, b)
        if found is not None:
            located.append(found)
    return earliest(located) if located else None


def earliest(located: list[LocatedEvent]) -> LocatedEvent:
    """The first of located ends; of several at one place the impact that vanishes: behind it the motion passes the
    stop, which looks alike."""
    first = min(found.share for found in located)
    same = [found for found in located if found.share <= first + 1e-7]
    return min(same, key=lambda found: (found.event.impact is None, found.share))


def passes_stop(point: Point) -> bool:
    """Whether a flight is beyond its stop by more than rounding."""
    return bool(point.stop_distance < -PASSED * point.solution.size_of_gap)


def bifurcations(curve: SolutionCurve, a: Point, b: Point) -> list[LocatedEvent]:
    """The events between a and b that do not end the branch, as far as tests differ, in order."""
    found = []
    for name, test in tests_between(curve, a, b):
        if np.sign(test(a)) * np.sign(test(b)) < 0 and (place := locate(curve, Event(name, test), a, b)) is not None:
            found.append(place)
    return sorted(found, key=lambda one: one.share)


def locate(curve: SolutionCurve, event: Event, a: Point, b: Point) -> LocatedEvent | None:
    """The event located between a and b; None if it cannot be found."""
    point = None if event.boundary is None else curve.at_value(a, b, 0, event.boundary)
    if point is not None and 0 <= along(a, point) <= (1 + ROUNDED) * along(a, b):
        point.hold(event.boundary)
        return LocatedEvent(event, along(a, point) / along(a, b), point, 0.0)
    size = max(abs(event.test(a)), abs(event.test(b)))
    if size == 0:
        return None

    def test(point: Point) -> float:
        return event.test(point) / size

    found = root(curve, a, b, test)
    if found is None and event.impact is not None:
        found = _vanishing(curve, event.impact, a, b)
    if found is None:
        return None
    share, point = found
    if event.boundary is not None:
        point.hold(event.boundary)
    if event.impact is not None:  # one of the unknowns has a value: no test rounds
        point.touch(event.impact)
        error = rounding_error(curve, point, np.eye(1, 2 * curve.K + 3, curve.K + event.impact)[0])
    else:
        error = error_of(curve, a, b, test, share, point)
    return None if error is None else LocatedEvent(event, along(a, point) / along(a, b), point, error)


def _vanishing(curve: SolutionCurve, impact: int, a: Point, b: Point) -> tuple[float, Point] | None:
    """As of `root`, with the impact held at 0: just beside it rounding can keep Newton's method from an end."""
    before, behind = a.presses[impact], b.presses[impact]
    guess = curve.between(a, b, before / (before - behind))
    guess.jumps[impact] = 0.0
    point = curve.correct(guess, np.eye(1, 2 * curve.K + 3, curve.K + impact)[0])
    inside = point is not None and 0 <= along(a, point) <= along(a, b)
    return (along(a, point) / along(a, b), point) if inside else None


def tests_between(curve: SolutionCurve, a: Point, b: Point, scaled: bool = False) -> list[tuple[str, Test]]:
    """The types of the table that orbits of this branch may have between a and b, with their tests.

    scaled : all of a size that poles of multipliers do not change, to tell where they are nearest to zero
    """
    found = []
    for one in TYPES:
        if one.test and one.sigma in (0, curve.orbit.sigma):
            test = test_of(one.test)
            if one.test == "pair":
                test = torus_test(a, b) if scaled or np.all(b.solution.pushes > 0) else None
            elif one.test == "minus" and scaled:
                test = reflected
            if test is not None:
                found.append((one.name, test))
    return found


def test_of(name: str) -> Test:
    """The test as the engine computes it at each point (engine/continuation/branch_tests.py)."""
    index = NAMES.index(name)
    return lambda point: float(point.tests[index])


def is_outside(curve: SolutionCurve, bounds, point: Point) -> bool:
    """Whether a point lies beyond an end of its branch by more than rounding."""
    s = point.solution
    slow = -NO_SPEED * s.family.linear.omega * s.size_of_gap
    return not bounds[0] <= point.value <= bounds[1] or passes_stop(point) or bool(np.any(s.pushes < slow))


def _positive_at(inside: Point, value):
    """`value`, but positive at a point that is known to be inside, where rounding may say otherwise."""
    return lambda point: max(value(point), 1e-300) if point is inside else value(point)


def _beyond(boundary: float, side: int, inside: Point):
    """The distance of a point beyond a boundary; `inside` counts as inside where rounding puts it beyond."""

    def test(point: Point) -> float:
        distance = side * (point.value - boundary)
        return min(distance, 0.0) if point is inside else distance

    return test


def reflected(point: Point) -> float:
    """prod_i (1 + mu_i)/(1 + |mu_i|^2)^(1/2), of infinite ones 1 or -1, without factors that are zero at all points."""
    mu = point.solution.multipliers
    known = np.isfinite(mu)
    factors, sizes = np.where(known, 1 + mu, np.sign(mu.real)), np.where(known, np.hypot(1, np.abs(mu)), 1.0)
    return float(np.prod(factors[np.abs(factors) > ON_SQUARE]).real / np.prod(sizes))


def torus_test(a: Point, b: Point) -> Test | None:
    """prod_{i<j} (1 - mu_i mu_j)/prod_i (1 + |mu_i|^2)^((n - 1)/2), zero at a Neimark-Sacker point and at a neutral
    saddle, without poles; None without losses.

    Without factors that are zero both at a and at b, to rounding, as of a mode without losses that the contact does not
    see.
    """
    if len(a.solution.multipliers) < 3 or a.solution.torus == 1.0 or b.solution.torus == 1.0:
        return None
    left_out = min(int(np.sum(np.abs(1 - point.solution.products) < ON_PAIR)) for point in (a, b))

    def test(point: Point) -> float:
        factors, mu = 1 - point.solution.products, point.solution.multipliers
        with np.errstate(invalid="ignore"):  # of an infinite multiplier
            product = np.prod(factors[np.argsort(np.abs(factors))[left_out:]] if left_out else factors).real
        return float(product / np.prod(np.hypot(1, np.abs(mu))) ** (len(mu) - 1))

    return test
