"""Where to look between two points of a branch for what their tests do not show."""

import math
from itertools import pairwise

import numpy as np

from vibro_sweep.analysis.branches.branch_events import is_outside, passes_stop, tests_between
from vibro_sweep.analysis.branches.crossings import counts_of, explained, is_torus, stands_alone
from vibro_sweep.analysis.continuation.events import LocatedEvent, Test
from vibro_sweep.analysis.continuation.point import Point, along
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.engine.continuation.between_points import FARTHER
from vibro_sweep.tables.bifurcations import BY_NAME

SHARES = (0.5, 0.4, 0.6, 0.3)  # of the way to the next point, where the first lies on a bifurcation by chance
APART = 1e-9  # share of a step: bifurcations that are nearer to each other are not separated
CLOSE = 1e-6  # share of a step: so near to an end of the branch
NEARER = 1e-3  # times: so much the distance from a stop has fallen where it may have been zero on the way
ON_THE_WAY = (0.5, 0.9, 0.99)  # shares of a step
MOST_LOOKS = 8  # for one extremum


def hidden_between(
    curve: SolutionCurve, bounds, a: Point, b: Point, found: list[LocatedEvent], beside: tuple
) -> Point | None:
    """A point between a and b that divides what their tests do not distinguish; None if nothing is hidden.

    found : bifurcations between a and b, in order
    beside : the points before a and behind b, None where they are not known
    """
    length = along(a, b)
    for one in found:
        if along(a, one.place) < (1 - CLOSE) * length and is_outside(curve, bounds, one.place):
            return one.place
    cuts = [a]
    for one, other in pairwise(found):
        at, next_at = along(a, one.place), along(a, other.place)
        if next_at - at > APART * length:
            cuts.append(curve.step(a, (at + next_at) / 2, one.place))
            if cuts[-1] is None:
                return None
    cuts.append(b)
    for x, y in pairwise(cuts):
        inside = [
            one
            for one in found
            if 0 < curve.difference(x, one.place) @ a.direction < curve.difference(x, y) @ a.direction
        ]
        if not _are_all(curve, x, y, inside):
            return y if y is not b else x if x is not a else _middle(curve, a, b, found)
    places = [a, *(one.place for one in found), b]
    for look in (_divided, _touched, _turned):
        point = look(curve, places, found, beside)
        if point is not None:
            return point
    return _beyond_stop(curve, a, b)


def _are_all(curve: SolutionCurve, a: Point, b: Point, found: list[LocatedEvent]) -> bool:
    """Whether nothing but these bifurcations, at one place, lies between a and b, as far as a and b tell."""
    at = [(one.event.type, one.place) for one in found if any(BY_NAME[one.event.type].crosses)]
    crossed = [(kind, point) for kind, point in at if not BY_NAME[kind].crosses[2] or is_torus(point)]
    if not explained(a, b, [kind for kind, _ in crossed]):
        return False
    if len(crossed) == 1 and not stands_alone(a, b, crossed[0][1], crossed[0][0]):
        return False
    types = {one.event.type for one in found}
    return all((test(a) * test(b) < 0) == (kind in types) for kind, test in tests_between(curve, a, b, scaled=True))


def _middle(curve: SolutionCurve, a: Point, b: Point, found: list[LocatedEvent]) -> Point | None:
    """A point on the longer side of what was found, with no multiplier on the circle by chance."""
    length = along(a, b)
    at = along(a, found[0].place) if found else 0.0
    low, high = (at, length) if at < length / 2 else (0.0, at)
    for share in SHARES:
        point = curve.step(a, low + share * (high - low))
        if point is not None and counts_of(point).on_circle <= counts_of(a).on_circle:
            return point
    return None


def _divided(curve: SolutionCurve, places: list[Point], found: list[LocatedEvent], beside: tuple) -> Point | None:
    """A point beside a bifurcation at which another test has the other sign than before and behind it."""
    for one, a, c, b in zip(found, places, places[1:], places[2:], strict=False):
        for kind, test in tests_between(curve, a, b, scaled=True):
            if kind != one.event.type and test(a) * test(c) < 0 and test(c) * test(b) < 0:
                return _with_sign(curve, test, c, b)
    return None


def _with_sign(curve: SolutionCurve, test: Test, c: Point, b: Point) -> Point | None:
    """A point between c and b at which the test has the sign that it has at c."""
    length = along(c, b)
    for k in range(1, 40):
        point = curve.step(c, length * 0.5**k)
        if point is None or test(point) * test(c) > 0:
            return point
    return None


def _touched(curve: SolutionCurve, places: list[Point], found: list[LocatedEvent], beside: tuple) -> Point | None:
    """A point between the first and the last of `places` at which a test has changed its sign, to change it again."""
    a, b = places[0], places[-1]
    K, pushing = curve.K, (a.solution.pushes > 0) & ~curve.problem.rests
    types = {one.event.type for one in found}
    tests = [test for kind, test in tests_between(curve, a, b, scaled=True) if kind not in types]
    tests += [lambda point: point.stop_distance]
    seen = [point for point in (beside[0], *places, beside[1]) if point is not None]
    for test in tests:
        for triple in zip(seen, seen[1:], seen[2:], strict=False):
            point = _beyond_extremum(curve, test, a, b, triple)
            if point is not None:
                return point
    length = along(a, b)
    slopes = [-curve.problem.sides * point.direction[K : 2 * K] for point in (a, b)]
    for i in np.flatnonzero(pushing & (slopes[0] < 0) & (slopes[1] > 0) & (b.solution.pushes > 0)):
        middle = curve.step(a, length * _least(a, b, K + i))
        if middle is not None:
            point = _beyond_extremum(curve, lambda point, i=i: point.solution.pushes[i], a, b, (a, middle, b))
            if point is not None:
                return point
    return None


def _turned(curve: SolutionCurve, places: list[Point], found: list[LocatedEvent], beside: tuple) -> Point | None:
    """A point at which the parameter goes the other way than at both ends, as the cubic through them says."""
    a, b = places[0], places[-1]
    if a.rate * b.rate <= 0 or any(one.event.type == "fold" for one in found):
        return None
    slope = _slope_between(a, b, 2 * curve.K)
    (at,) = slope.deriv().roots if slope.order == 2 else (math.nan,)
    if not (0 < at < 1 and slope(at) * a.rate < 0):
        return None
    point = curve.step(a, along(a, b) * at)
    return point if point is not None and point.rate * a.rate < 0 else None


def _beyond_stop(curve: SolutionCurve, a: Point, b: Point) -> Point | None:
    """A point beyond a stop on the way to one where the motion touches it once more, as where an orbit of several
    periods meets the graze of one of a single period: the distance may have been zero before."""
    if not b.stop_distance < NEARER * a.stop_distance < math.inf:
        return None
    points = (curve.step(a, share * along(a, b), b) for share in ON_THE_WAY)
    return next((point for point in points if point is not None and passes_stop(point)), None)


def _least(a: Point, b: Point, i: int) -> float:
    """The share between two points at which the cubic of one unknown has its extremum; its slopes differ in sign."""
    roots = _slope_between(a, b, i).roots
    inside = [root.real for root in roots if abs(root.imag) < 1e-12 and 0 < root.real < 1]
    return min(inside, default=0.5, key=lambda root: abs(root - 0.5))


def _slope_between(a: Point, b: Point, i: int) -> np.poly1d:
    """The slope of the cubic of one unknown, over the share of the way from a to b."""
    change = a.curve.difference(a, b)
    length, rise = float(np.linalg.norm(change)), change[i]
    p, q = a.direction[i] * length, b.direction[i] * length
    return np.poly1d([3 * (p + q - 2 * rise), 2 * (3 * rise - 2 * p - q), p])


def _beyond_extremum(curve: SolutionCurve, test: Test, a: Point, b: Point, triple) -> Point | None:
    """The extremum of a test near the middle one of three points, if it lies between a and b with another sign."""
    seen = [(along(a, point), test(point)) for point in triple]
    middle, length = triple[1], along(a, b)
    for _ in range(MOST_LOOKS):
        (r, x), (s, y), (t, z) = seen
        at = extremum(s - r, t - s, x, y, z)
        if at is None:
            return None
        at = _apart(s + at, (r, s, t))
        point = curve.step(a, at, middle)
        if point is None:
            return None
        value = test(point)
        if value * y < 0:
            return point if 0 < at < length else None
        if abs(value) < abs(y):
            seen = [(s, y), (at, value), (t, z)] if at > s else [(r, x), (at, value), (s, y)]
            middle = point
        else:
            seen = [(r, x), (s, y), (at, value)] if at > s else [(at, value), (s, y), (t, z)]
    return None


def extremum(before: float, behind: float, x: float, y: float, z: float) -> float | None:
    """The place where the parabola through three values is nearest to zero, from the middle one; None where a number
    with these values hardly vanishes twice near that (`dips` of engine/continuation/branch_tests.py)."""
    if y < 0:
        x, y, z = -x, -y, -z
    if not (0 < y <= x and 0 < z and math.isfinite(x + z) and before > 0 < behind):
        return None
    left, right = (y - x) / before, (z - y) / behind
    slope, curve = (left * behind + right * before) / (before + behind), (right - left) / (before + behind)
    if z < y:
        may_vanish = -slope < 2 * curve * behind and slope * slope > 4 * curve * y
    else:
        may_vanish = slope * slope > curve * y or min(x, z) > FARTHER * y
    return -slope / (2 * curve) if may_vanish else None


def _apart(at: float, seen: tuple[float, float, float]) -> float:
    """`at`, but not nearer to the middle one than a hundredth of the interval."""
    r, s, t = seen
    least = 0.01 * (t - s if at > s else s - r)
    return s + math.copysign(max(abs(at - s), least), at - s)
