"""What happens between two points of a branch, and where: each test's zero, located from both sides."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.walk import Point, Walk


@dataclass
class Event:
    """Something that a step from a to b passes: the type, a test that changes its sign there, its index if any."""

    type: str
    test: object
    index: int | None = None

    @property
    def ends(self) -> bool:
        return self.type in ("graze", "sticking", "limit")


def events_between(walk: Walk, bounds, a: Point, b: Point) -> list[Event]:
    """What changes sign from a to b."""
    events = []
    for limit, side in zip(bounds, (-1, 1), strict=True):
        if (b.p - limit) * side > 0:
            events.append(Event("limit", _beyond(limit, side, a)))
    for i in range(walk.start.K):
        if a.solution.pushes[i] > 0 >= b.solution.pushes[i]:
            events.append(Event("graze", lambda point, i=i: point.solution.pushes[i], i))
        if a.releases[i] > 0 >= b.releases[i]:
            events.append(Event("sticking", lambda point, i=i: point.releases[i], i))
    if a.stays > 0 >= b.stays:
        events.append(Event("sticking", lambda point: min(point.stays, 1.0)))
    if a.solution.margin > 0 >= b.solution.margin:
        most = 2 * abs(a.solution.margin) if math.isfinite(a.solution.margin) else 1.0
        events.append(Event("graze", lambda point: min(point.solution.margin, most)))
    if a.tangent[-1] * b.tangent[-1] < 0:
        events.append(Event("fold", lambda point: point.tangent[-1]))
    if walk.start.K:
        if a.reflection[0] * b.reflection[0] < 0:
            kind = "pitchfork" if walk.start.sigma == -1 else "flip"
            events.append(Event(kind, reflection_test(a, b)))
        if np.all(b.solution.pushes > 0) and a.torus * b.torus < 0:
            events.append(Event("neimark_sacker", lambda point: point.torus))
    return events


def _beyond(limit: float, side: int, inside: Point):
    """How far a point is beyond a limit; `inside` counts as inside where rounding puts it beyond."""

    def test(point: Point) -> float:
        distance = side * (point.p - limit)
        return min(distance, 0.0) if point is inside else distance

    return test


def locate(walk: Walk, event: Event, a: Point, b: Point, length: float):
    """(event, distance from a, point, error): where the test vanishes between a and b; None if it cannot be found.

    Located twice, on planes across the tangent at a and across the one at b; what the two differ by, and what
    rounding of the gap does to the parameter, is the error.
    """
    there = _root(walk, event, a, b, length)
    if there is None:
        return None
    distance, point = there
    back = _root(walk, event, b, a, (a.x - b.x) @ b.tangent)
    error = abs(back[1].p - point.p) if back is not None else math.nan
    rounding = 16 * np.finfo(float).eps * (abs(point.p) + point.sensitivity)
    return event, distance, point, float(4 * error + rounding)


def _root(walk: Walk, event: Event, a: Point, b: Point, length: float):
    seen: dict[float, Point] = {0.0: a}
    across = (b.x - a.x) @ a.tangent
    seen[across] = b

    def test(s: float) -> float:
        if s not in seen:
            near = min(seen, key=lambda other: abs(other - s))
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


def reflection_test(a: Point, b: Point):
    size = max(a.reflection[1], b.reflection[1])
    return lambda point: point.reflection[0] * math.exp(point.reflection[1] - size)


def earliest(located: list, length: float):
    """Of ends at the same place the impact that vanishes: behind it the motion passes the stop, which looks alike."""
    if not located:
        return None
    first = min(found[1] for found in located)
    same = [found for found in located if found[1] <= first + 1e-7 * length]
    return min(same, key=lambda found: (found[0].index is None, found[1]))
