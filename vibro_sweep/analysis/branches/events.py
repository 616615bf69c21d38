"""What happens between two points of a branch: its end, and bifurcations before it."""

import math

import numpy as np

from vibro_sweep.analysis.branches.locating import Event, locate
from vibro_sweep.analysis.branches.special import NO_SPEED
from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.engine.impulses import branch

ON_CIRCLE = 1e-6  # distance from the unit circle within which a multiplier is on neither side


def ends_between(walk: Walk, bounds, a: Point, b: Point) -> list[Event]:
    """What may end the branch on the way from a, which is real, to b."""
    events, K = [], walk.start.K
    for limit, side in zip(bounds, (-1, 1), strict=True):
        if (b.p - limit) * side > 0:
            events.append(Event("limit", _beyond(limit, side, a), unknown=(-1, limit)))
    for i in range(K):
        if b.solution.pushes[i] <= 0:
            test = _positive_at(a, lambda point, i=i: point.solution.pushes[i])
            events.append(Event("graze", test, i, unknown=(K + i, 0.0)))
        if a.releases[i] > 0 >= b.releases[i]:
            events.append(Event("sticking", lambda point, i=i: point.releases[i], i))
    if a.stays > 0 >= b.stays:
        events.append(Event("sticking", lambda point: min(point.stays, 1.0)))
    if b.solution.margin <= 0 < a.solution.margin or _passes(b):
        most = 2 * abs(a.solution.margin) if math.isfinite(a.solution.margin) else 1.0
        test = _positive_at(a, lambda point: min(point.solution.margin, most))
        events.append(Event("graze", test, touches=True))
    return events


def first_end(walk: Walk, events: list[Event], a: Point, b: Point, length: float):
    """The first of these events, as `locate` gives it; None where none is found.

    Behind an impact that vanishes, and often behind a limit, a flight passes its stop: where none does so at the first
    end that is found, that is not looked for.
    """
    located = []
    for event in sorted(events, key=lambda event: event.touches):
        if event.touches and located and not _passes(earliest(located, length)[2]):
            break
        found = locate(walk, event, a, b, length)
        if found is not None:
            located.append(found)
    return earliest(located, length) if located else None


def earliest(located: list, length: float):
    """Of ends at the same place the impact that vanishes: behind it the motion passes the stop, which looks alike."""
    first = min(found[1] for found in located)
    same = [found for found in located if found[1] <= first + 1e-7 * length]
    return min(same, key=lambda found: (found[0].index is None, found[1]))


def _passes(point: Point) -> bool:
    """Whether a flight is beyond its stop by more than rounding."""
    return bool(point.solution.margin < -branch.PASSED * point.solution.size_of_gap)


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


def reflection_test(a: Point, b: Point):
    size = max(a.reflection[1], b.reflection[1])
    return lambda point: point.reflection[0] * math.exp(point.reflection[1] - size)
