"""Where an event lies between two points of a branch.

Most ends of a branch are where one unknown has a given value: the impulse of an impact is zero, or the parameter is at
its limit. Newton's method finds them at once, on the plane on which the unknown has this value. It also finds where a
flight touches a stop, as the impact without impulse that appears there. All other events are zeros of a test, which are
searched for along the branch.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.branches.special import inserted
from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.engine.impulses import branch

ROUNDED = np.finfo(float).eps  # relative to the coordinates of a point: nearer ones are the same
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

    The error is what rounding of the gap does to the parameter. The zero of a test is located once more, on planes
    across the tangent at b; where the two differ by more than rounding, that counts too.
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
    there = _root(walk, event, a, b, length)
    if there is None:
        return None
    distance, point = there
    back = _root(walk, event, b, a, (a.x - b.x) @ b.tangent)
    rounding = _rounding(point, point.tangent)
    apart = abs(back[1].p - point.p) if back is not None else math.nan
    error = rounding if apart <= rounding else rounding + 4 * (apart - rounding)
    return event, distance, point, float(error)


def _rounding(point: Point, normal: np.ndarray) -> float:
    """What rounding of the gap does to the parameter of a point that was found on the plane with this normal."""
    return float(16 * np.finfo(float).eps * (abs(point.p) + point.sensitivity(normal)))


def _between(a: Point, b: Point, share: float) -> np.ndarray:
    """Coordinates on the cubic through a and b with their tangents."""
    rest, length = 1 - share, np.linalg.norm(b.x - a.x)
    bend = share * rest * length * (rest * a.tangent - share * b.tangent)
    return rest**2 * (1 + 2 * share) * a.x + share**2 * (1 + 2 * rest) * b.x + bend


def _at_value(walk: Walk, unknown: tuple[int, float], a: Point, b: Point) -> tuple[Point, float] | None:
    """The point where an unknown has a value, and the error of its parameter."""
    index, value = unknown[0], unknown[1] / walk.scale[unknown[0]]
    before, behind = a.x[index] - value, b.x[index] - value
    if not before * behind < 0:
        return None
    guess, normal = _between(a, b, before / (before - behind)), np.zeros(len(a.x))
    guess[index], normal[index] = value, 1.0
    point = walk.correct(guess, normal, a.tangent)
    return None if point is None else (point, _rounding(point, normal))


def _at_touch(walk: Walk, a: Point, b: Point) -> tuple[Point, float] | None:
    """The point where the flight that passes its stop at b touches it, and the error of its parameter."""
    before, behind = a.solution.margin, b.solution.margin
    if not (behind < 0 < before < math.inf) or walk.start.equations.free:
        return None
    touching, index = inserted(b.solution)
    new = [index, walk.start.K + index]  # places of the impact's time and impulse
    guess = np.insert(_between(a, b, before / (before - behind)), new, [touching.times[index] / walk.scale[0], 0.0])
    normal = np.zeros(len(guess))
    normal[new[1] + 1] = 1.0
    found = walk.with_impact(touching, index).correct(guess, normal, np.insert(a.tangent, new, 0.0))
    if found is None:
        return None
    point = walk.correct(np.delete(found.x, [new[0], new[1] + 1]), a.tangent, a.tangent)
    if point is None or abs(point.solution.margin) > branch.PASSED * point.solution.size_of_gap:
        return None
    return point, _rounding(found, normal)


def _root(walk: Walk, event: Event, a: Point, b: Point, length: float):
    seen: dict[float, Point] = {0.0: a}
    across = (b.x - a.x) @ a.tangent
    seen[across] = b

    def test(s: float) -> float:
        if s not in seen:
            near = min(seen, key=lambda other: abs(other - s))
            if abs(near - s) <= ROUNDED * np.abs(seen[near].x).max():
                seen[s] = seen[near]
                return 0.0
            point = walk.step(a, s, seen[near].x)
            if point is None:
                raise ArithmeticError
            seen[s] = point
        return float(event.test(seen[s]))

    try:
        if test(0.0) * test(across) > 0:
            return None
        s = brentq(test, 0.0, across, xtol=1e-17, rtol=1e-15, maxiter=100)
        test(s)
    except (ArithmeticError, RuntimeError):
        return None
    return abs(s) if length > 0 else s, seen[s]
