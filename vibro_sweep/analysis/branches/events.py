"""What happens between two points of a branch, and where: each test's zero, located from both sides."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.branches.special import NO_SPEED
from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.engine.impulses import branch

ON_CIRCLE = 1e-6  # distance from the unit circle within which a multiplier is on neither side
ROUNDED = np.finfo(float).eps  # relative to the coordinates of a point: nearer ones are the same


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
    """What changes sign from a, which is real, to b."""
    events = []
    for limit, side in zip(bounds, (-1, 1), strict=True):
        if (b.p - limit) * side > 0:
            events.append(Event("limit", _beyond(limit, side, a)))
    for i in range(walk.start.K):
        if b.solution.pushes[i] <= 0:
            events.append(Event("graze", _positive_at(a, lambda point, i=i: point.solution.pushes[i]), i))
        if a.releases[i] > 0 >= b.releases[i]:
            events.append(Event("sticking", lambda point, i=i: point.releases[i], i))
    if a.stays > 0 >= b.stays:
        events.append(Event("sticking", lambda point: min(point.stays, 1.0)))
    beyond = -branch.PASSED * b.solution.size_of_gap
    if b.solution.margin <= 0 < a.solution.margin or b.solution.margin < beyond:
        most = 2 * abs(a.solution.margin) if math.isfinite(a.solution.margin) else 1.0
        events.append(Event("graze", _positive_at(a, lambda point: min(point.solution.margin, most))))
    return events + _bifurcations(walk, a, b)


def _bifurcations(walk: Walk, a: Point, b: Point) -> list[Event]:
    events = []
    if a.tangent[-1] * b.tangent[-1] < 0:
        events.append(Event("fold", lambda point: point.tangent[-1]))
    if walk.start.K:
        if a.reflection[0] * b.reflection[0] < 0:
            kind = "pitchfork" if walk.start.sigma == -1 else "flip"
            events.append(Event(kind, reflection_test(a, b)))
        if np.all(b.solution.pushes > 0) and a.torus * b.torus < 0:
            events.append(Event("neimark_sacker", lambda point: point.torus))
    return events


def bifurcations(walk: Walk, a: Point, b: Point, length: float) -> list:
    """What lies between a and b and ends no branch, as `locate` gives it, in order.

    Also two of a kind, for which no test differs from a to b, if another one lies between them.
    """
    found = [place for event in _bifurcations(walk, a, b) if (place := locate(walk, event, a, b, length)) is not None]
    for event, _, c, _ in list(found):
        known = {event.type, *(other[0].type for other in found)}
        for x, y in ((a, c), (c, b)):
            for hidden in _bifurcations(walk, x, y):
                if hidden.type not in known:
                    place = locate(walk, hidden, x, y, float((y.x - x.x) @ x.tangent))
                    if place is not None:
                        found.append((hidden, float((place[2].x - a.x) @ a.tangent), *place[2:]))
    return sorted(found, key=lambda place: place[1])


def unexplained(walk: Walk, a: Point, b: Point, found: list) -> bool:
    """Whether more multipliers cross the unit circle from a to b than belong to the bifurcations found."""
    if not walk.start.K:
        return False
    sizes = [np.abs(point.solution.multipliers) for point in (a, b)]
    if any(np.abs(size - 1).min() < ON_CIRCLE for size in sizes):
        return False
    crossed = abs(int(np.sum(sizes[1] > 1)) - int(np.sum(sizes[0] > 1)))
    ones = sum(place[0].type != "neimark_sacker" for place in found)
    pairs = sum(place[0].type == "neimark_sacker" and is_torus(place[2]) for place in found)
    return crossed > ones + 2 * pairs or (crossed - ones) % 2 == 1


def is_torus(point: Point) -> bool:
    """Whether two multipliers with product 1 are a complex pair; else it is a neutral saddle, or a pole at a graze.

    At the graze itself an undamped mode has such a pair for any parameter: nothing is born there.
    """
    s = point.solution
    mu = s.multipliers
    if np.any(s.pushes < NO_SPEED * s.family.linear.omega * s.size_of_gap):
        return False
    i, j = np.triu_indices(len(mu), 1)
    k = np.argmin(np.abs(1 - mu[i] * mu[j]))
    return abs(1 - mu[i[k]] * mu[j[k]]) < ON_CIRCLE and abs(mu[i[k]].imag) > 1e-9


def _positive_at(inside: Point, value):
    """`value`, but positive at a point that is known to be inside, where rounding may say otherwise."""
    return lambda point: max(value(point), 1e-300) if point is inside else value(point)


def _beyond(limit: float, side: int, inside: Point):
    """How far a point is beyond a limit; `inside` counts as inside where rounding puts it beyond."""

    def test(point: Point) -> float:
        distance = side * (point.p - limit)
        return min(distance, 0.0) if point is inside else distance

    return test


def locate(walk: Walk, event: Event, a: Point, b: Point, length: float):
    """(event, distance from a, point, error): where the test vanishes between a and b; None if it cannot be found.

    Located twice, on planes across the tangent at a and across the one at b. The error is what rounding of the gap does
    to the parameter, and what the two differ by beyond that.
    """
    there = _root(walk, event, a, b, length)
    if there is None:
        return None
    distance, point = there
    back = _root(walk, event, b, a, (a.x - b.x) @ b.tangent)
    rounding = 16 * np.finfo(float).eps * (abs(point.p) + point.sensitivity)
    apart = abs(back[1].p - point.p) if back is not None else math.nan
    error = rounding if apart <= rounding else rounding + 4 * (apart - rounding)
    return event, distance, point, float(error)


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
