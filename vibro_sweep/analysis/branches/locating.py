"""Where an event lies between two points of a branch.

Most ends of a branch are where one unknown has a given value: the impulse of an impact is zero, or the parameter is at
its limit. Newton's method finds them at once, on the plane on which the unknown has this value. It also finds where a
flight touches a stop, as the impact without impulse that appears there. All other events are zeros of a test, which are
searched for along the branch.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.special import inserted
from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.branch_tests import PASSED

ROUNDED = np.finfo(float).eps  # relative to the coordinates of a point: nearer ones are the same
MOST_TRIES = 100
SHARES = (-1, 1, 2)  # of a small step: so far beside a zero points round differently
NEARBY, LEAST = 1e-9, 1e-12  # that step, of the step in which the zero is, and in units of a walk
SHAKEN = 1e-10  # in units of a walk: so far from them Newton's method begins
OF_TESTS = 2.5  # times what rounding of the equations does, where rounding of a test comes to it
TIMES = 6.0  # the largest difference between what they say
BESIDE = 1e-6  # of a step: so far from its zero a test says how steep it is, and not how it rounds
SAME_TURN = 1e-4  # of omega t: a turning point of a flight this near to another is the same
TOUCHES = 1e-9  # of the gap: at most so far from its stop a flight that touches it may be by rounding
WITHIN = 1e-9  # of a step, by which rounding may put an event before its beginning or behind its end


@dataclass
class Event:
    """Something that a step from a to b passes: the type, and a test that changes its sign there.

    index : of the impact that it belongs to, if any
    unknown : where it is the place at which an unknown has a value: index of the unknown, and the value
    touches : whether a flight touches a stop there
    """

    type: str
    test: Callable[[Point], float]
    index: int | None = None
    unknown: tuple[int, float] | None = None
    touches: bool = False


def locate(walk: Walk, event: Event, a: Point, b: Point, length: float):
    """(event, distance from a, point, error): where the event lies between a and b; None if it cannot be found.

    The error is what rounding of the equations does to the parameter. Of the zero of a test it is at least several
    times the difference between this zero and what points beside it say, which round differently.
    """
    found = None
    if event.unknown is not None:
        found = _at_value(walk, event.unknown, a, b)
    elif event.touches:
        found = _at_touch(walk, a, b)
    if found is not None:
        point, error = found
        distance = float((point.x - a.x) @ a.tangent)
        if -WITHIN * length <= distance <= (1 + WITHIN) * length:
            return event, distance, point, error
    return _at_zero(walk, event, a, b, length)


def _at_value(walk: Walk, unknown: tuple[int, float], a: Point, b: Point) -> tuple[Point, float] | None:
    """The point where an unknown has a value, and the error of its parameter."""
    index, value = unknown[0], unknown[1] / walk.unit  # other unknowns have the value 0
    before, behind = a.x[index] - value, b.x[index] - value
    if not before * behind < 0:
        return None
    guess, normal = walk.with_value(walk.between(a, b, before / (before - behind)), index, value), np.zeros(len(a.x))
    normal[index] = 1.0
    point = walk.correct(guess, normal, a.tangent)
    return None if point is None else (point, point.rounding(normal))


def _at_touch(walk: Walk, a: Point, b: Point) -> tuple[Point, float] | None:
    """The point where the flight that passes its stop at b touches it, and the error of its parameter."""
    before, behind = a.solution.margin, b.solution.margin
    if not (behind < 0 < before < math.inf) or (walk.start.is_free and walk.start.K == 0):
        return None
    touching, index = inserted(b.solution)
    new = [index, walk.start.K + index]  # places of the impact's time and impulse
    guess = walk.with_touch(walk.between(a, b, before / (before - behind)), touching, index)
    normal = np.zeros(len(a.x) + 2)
    normal[new[1] + 1] = 1.0
    found = walk.with_impact(touching).correct(guess, normal, np.insert(a.tangent, new, 0.0))
    if found is None:
        return None
    point = walk.correct(walk.without_touch(found.guess, index), a.tangent, a.tangent)
    if point is None or not _touches(point.solution, float(found.solution.times[index])):
        return None
    return point, found.rounding(normal)


def _touches(s: Solution, time: float) -> bool:
    """Whether no flight passes its stop, and one touches it: the one at this time, whose own distance is rounding."""
    distance, nearest, _ = s.nearest
    P, size = s.P, s.size_of_gap
    apart = (nearest - time + P / 2) % P - P / 2
    same = abs(apart) * s.family.linear.omega < SAME_TURN
    return abs(distance) <= (TOUCHES if same else PASSED) * size


class _Seen(NamedTuple):
    """A point at a distance from a, along the tangent there, and the test."""

    s: float
    point: Point
    test: float


def _at_zero(walk: Walk, event: Event, a: Point, b: Point, length: float):
    """`locate` of a test that changes its sign."""
    seen = [_Seen(0.0, a, event.test(a)), _Seen(float((b.x - a.x) @ a.tangent), b, event.test(b))]
    found = _zero(walk, event.test, seen)
    if found is None:
        return None
    s, point, _ = found
    beside = [one for one in seen if abs(one.s - s) > BESIDE * abs(seen[1].s)]
    near = min(beside, key=lambda one: abs(one.s - s), default=found)
    slope = (near.test - found.test) / (near.s - s) if near is not found else 0.0
    error = OF_TESTS * point.rounding(point.tangent)
    if slope != 0:
        scatter = _scatter(walk, event, a, found, max(NEARBY * abs(seen[1].s), LEAST), slope)
        error = max(error, TIMES * scatter)  # not their sum: most errors are then the same from whichever start
    return event, abs(s) if length > 0 else s, point, float(error)


def _scatter(walk: Walk, event: Event, a: Point, found: _Seen, step: float, slope: float) -> float:
    """By how much rounding moves the parameter of a zero: what points beside it say, which round differently.

    Each says p - test dp/dtest; a straight line through these takes away what the slope is wrong. The plane on which
    points are found may hold the parameter itself, as in narrow bounds: then rounding is in the test alone.
    """
    rate = found.point.tangent[-1] * walk.unit / slope
    said = [(0, -found.test * rate)]
    shaken = SHAKEN * np.random.default_rng(0).standard_normal((len(SHARES), len(a.x)))
    for share, change in zip(SHARES, shaken, strict=True):
        point = walk.step(a, found.s + share * step, walk.shaken(found.point.guess, change))
        if point is not None:
            said.append((share, point.p - found.point.p - event.test(point) * rate))
    shares, apart = np.array(said).reshape(-1, 2).T
    line = np.polyval(np.polyfit(shares, apart, 1), [*shares, 0.0]) if len(said) > 2 else 0.0
    return float(np.abs(np.append(apart, 0.0) - line).max())


def zero_between(walk: Walk, test: Callable[[Point], float], a: Point, b: Point) -> Point | None:
    """The point of a branch between a and b where a test vanishes, which has different signs there."""
    seen = [_Seen(0.0, a, test(a)), _Seen(float((b.x - a.x) @ a.tangent), b, test(b))]
    found = _zero(walk, test, seen)
    return None if found is None else found.point


def _zero(walk: Walk, test: Callable[[Point], float], seen: list[_Seen]) -> _Seen | None:
    """The point of a branch where a test vanishes, between the two of `seen`, which all others are added to.

    Inverse quadratic interpolation, and halves of the interval where steps do not shrink (as Brent, Algorithms for
    Minimization without Derivatives, chapter 4).
    """
    low, high = sorted(seen, key=lambda one: one.s)
    if low.test * high.test > 0:
        return None
    last = before = high.s - low.s
    while len(seen) < MOST_TRIES:
        best = min(low, high, key=lambda one: abs(one.test))
        if best.test == 0:
            return best
        s = _interpolated(seen[-3:], low, high)
        if not (low.s < s < high.s and abs(s - best.s) < abs(before) / 2):
            s = (low.s + high.s) / 2
        last, before = s - best.s, last
        near = min(low, high, key=lambda one: abs(one.s - s))
        if abs(s - near.s) <= ROUNDED * np.abs(near.point.x).max():
            return near
        point = walk.step(seen[0].point, s, near.point.guess)
        if point is None:
            return None
        seen.append(_Seen(s, point, test(point)))
        low, high = (seen[-1], high) if seen[-1].test * low.test > 0 else (low, seen[-1])
    return None


def _interpolated(last: list[_Seen], low: _Seen, high: _Seen) -> float:
    """Where the parabola s(test) through the last three points vanishes, or the straight line; NaN where none does."""
    one = next((one for one in last if one is not low and one is not high), None)
    (a, fa), (b, fb) = (low.s, low.test), (high.s, high.test)
    if one is None or one.test in (fa, fb):
        return a - fa * (b - a) / (fb - fa)
    c, fc = one.s, one.test
    return (
        a * fb * fc / (fa - fb) / (fa - fc) + b * fa * fc / (fb - fa) / (fb - fc) + c * fa * fb / (fc - fa) / (fc - fb)
    )
