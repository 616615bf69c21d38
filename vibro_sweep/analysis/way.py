"""One way along a branch: steps that adapt, what they pass, and where the branch ends."""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.births import criticality
from vibro_sweep.analysis.periodic import orbit_of
from vibro_sweep.analysis.solution import Solution
from vibro_sweep.analysis.special import SpecialPoint, graze_at
from vibro_sweep.analysis.walk import Point, Walk
from vibro_sweep.model.linear import family_of

FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 1e-3, 0.05, 1e-11
STRAIGHT = 0.1  # radians between the tangents of neighbouring points, at most
MOST_POINTS = 20_000


@dataclass
class Event:
    """Something that a step from a to b passes: the type, a test that changes its sign there, its index if any."""

    type: str
    test: object
    index: int | None = None

    @property
    def ends(self) -> bool:
        return self.type in ("graze", "sticking", "limit")


class Way:
    """One way along a branch."""

    def __init__(self, walk: Walk, forwards: float, lo: float, hi: float, system):
        self.walk, self.system = walk, system
        self.bounds = lo, hi
        self.points: list[Point] = []
        self.special: list[SpecialPoint] = []
        self.closed = False
        first = walk.first(forwards)
        if first is None:
            raise ValueError("orbit: it cannot be corrected; at a fold start from an orbit beside it")
        self.points.append(first)

    def go(self) -> None:
        length = FIRST_STEP
        while len(self.points) < MOST_POINTS:
            a = self.points[-1]
            b = self.walk.step(a, length)
            turn = math.acos(min(1.0, a.tangent @ b.tangent)) if b is not None else math.inf
            if turn > STRAIGHT:
                length /= 2
                if length < SHORTEST_STEP:
                    break
                continue
            if self._pass(a, b, length):
                return
            if self._comes_back(a, b, length):
                self.closed = True
                self.special.append(self._at("closed", self.points[0], math.nan))
                return
            if turn < STRAIGHT / 3 and b.corrections <= 5:
                length = min(1.5 * length, LONGEST_STEP)
        self.special.append(self._at("failed", self.points[-1], math.nan))

    def _comes_back(self, a: Point, b: Point, length: float) -> bool:
        if len(self.points) < 10:
            return False
        offset = self.points[0].x - a.x
        K, T = self.walk.start.K, 2 * np.pi
        offset[:K] -= T * np.round(offset[:K].mean() / T) if K else 0.0
        along = offset @ a.tangent
        return 0 <= along <= length and float(np.linalg.norm(offset - along * a.tangent)) < 0.1 * length

    def _pass(self, a: Point, b: Point, length: float) -> bool:
        """Record what lies between a and b. True where the branch ends there."""
        ends = [event for event in self._events(a, b) if event.ends]
        located = [found for event in ends if (found := self._locate(event, a, b, length)) is not None]
        end = _earliest(located, length)
        last = end[2] if end else b
        reach = end[1] if end else length
        found = []
        events = self._events(a, last)
        birth = self._birth(a, last, reach) if any(event.type == "fold" for event in events) else None
        for event in events:
            if not event.ends and not (birth and event.type == "fold"):
                place = self._locate(event, a, last, reach)
                if place is not None and place[1] < (birth[0] if birth else reach):
                    found.append(place)
        for event, _, point, error in sorted(found, key=lambda item: item[1]):
            self.points.append(point)
            if event.type != "neimark_sacker" or _is_torus(point):
                self.special.append(self._at(event.type, point, error))
            if event.type in ("flip", "pitchfork"):
                self.special[-1] = replace(self.special[-1], criticality=criticality(self.special[-1]))
        if birth:
            self.special.append(birth[1])
            return True
        self.points.append(last)
        if end:
            if end[0].type == "limit":
                last.held = min(self.bounds, key=lambda limit: abs(limit - last.p))
            self.special.append(self._end(end[0], last, end[3]))
        return end is not None

    def _events(self, a: Point, b: Point) -> list[Event]:
        """What changes sign from a to b."""
        events = []
        lo, hi = self.bounds
        for limit, side in ((lo, -1), (hi, 1)):
            if (b.p - limit) * side > 0 >= (a.p - limit) * side:
                events.append(Event("limit", lambda point, limit=limit: point.p - limit))
        for i in range(self.walk.start.K):
            if a.solution.pushes[i] > 0 >= b.solution.pushes[i]:
                events.append(Event("graze", lambda point, i=i: point.solution.pushes[i], i))
            if a.releases[i] > 0 >= b.releases[i]:
                events.append(Event("sticking", lambda point, i=i: point.releases[i], i))
        if a.solution.margin > 0 >= b.solution.margin:
            most = 2 * abs(a.solution.margin) if math.isfinite(a.solution.margin) else 1.0
            events.append(Event("graze", lambda point: min(point.solution.margin, most)))
        if a.tangent[-1] * b.tangent[-1] < 0:
            events.append(Event("fold", lambda point: point.tangent[-1]))
        if self.walk.start.K:
            if a.reflection[0] * b.reflection[0] < 0:
                kind = "pitchfork" if self.walk.start.sigma == -1 else "flip"
                events.append(Event(kind, _reflection_test(a, b)))
            if np.all(b.solution.pushes > 0) and a.torus * b.torus < 0:
                events.append(Event("neimark_sacker", lambda point: point.torus))
        return events

    def _locate(self, event: Event, a: Point, b: Point, length: float):
        """(event, distance from a, point, error): where the test vanishes between a and b; None if it cannot be found.

        Located twice, on planes across the tangent at a and across the one at b; what the two differ by, and what
        rounding of the gap does to the parameter, is the error.
        """
        there = self._root(event, a, b, length)
        if there is None:
            return None
        distance, point = there
        back = self._root(event, b, a, (a.x - b.x) @ b.tangent)
        error = abs(back[1].p - point.p) if back is not None else math.nan
        rounding = 16 * np.finfo(float).eps * (abs(point.p) + point.sensitivity)
        return event, distance, point, float(4 * error + rounding)

    def _root(self, event: Event, a: Point, b: Point, length: float):
        seen: dict[float, Point] = {0.0: a}
        across = (b.x - a.x) @ a.tangent
        seen[across] = b

        def test(s: float) -> float:
            if s not in seen:
                near = min(seen, key=lambda other: abs(other - s))
                point = self.walk.step(a, s, seen[near].x)
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

    def _at(self, of_type: str, point: Point, error: float, **more) -> SpecialPoint:
        system = self.system.replace(**{self.walk.name: point.p})
        orbit = orbit_of(system, point.solution)
        return SpecialPoint(of_type, {self.walk.name: point.p}, orbit, point.solution.multipliers, error, **more)

    def _end(self, event: Event, point: Point, error: float) -> SpecialPoint:
        if event.type != "graze":
            return self._at(event.type, point, error)
        graze = graze_at(point.solution, self.walk.name, event.index)
        side = graze.touching.sides[graze.index]
        slope = abs(graze.distance_slope)
        if slope > 0:
            error += float(16 * np.finfo(float).eps * point.solution.size_of_gap / slope)
        impact = None
        if event.index is not None:
            impact = impact_index(point.solution, event.index)
        return self._at(
            "graze", point, error, stop=side, kind=graze.kind, impact=impact,
            direction=1 if graze.distance_slope > 0 else -1,
        )  # fmt: skip

    def _birth(self, a: Point, b: Point, length: float):
        """(distance from a, special point) where the branch of a doubled or asymmetric orbit is born between a and b.

        There the branch turns into itself: what tells its two halves apart changes sign as a whole, and the simpler
        orbit has a flip or a pitchfork. On the branch itself that point is singular, so it is located on the parent's.
        """
        for sigma in (1, -1):
            parts = [halves_apart(point.solution, sigma) for point in (a, b)]
            if parts[0] is None:
                continue
            sizes = [np.linalg.norm(part) for part in parts]
            if not parts[0] @ parts[1] < -0.5 * sizes[0] * sizes[1]:
                continue
            fraction = sizes[0] / sum(sizes)
            x = (1 - fraction) * a.x + fraction * b.x
            found = self._parent_point(x, sigma)
            if found is not None:
                return fraction * length, found
        return None

    def _parent_point(self, x: np.ndarray, sigma: int) -> SpecialPoint | None:
        w = self.walk
        system = self.system.replace(**{w.name: float(x[-1] * w.scale[-1])})
        whole = Solution(family_of(system), 1, w.start.halves, w.start.sides, x[:-1] * w.scale[:-1])
        parent = whole.part(2, sigma, alike=0.1)
        if parent is None:
            return None
        way = Way(Walk(parent, w.name, self.bounds[1] - self.bounds[0]), 1.0, *self.bounds, self.system)
        kind = "pitchfork" if sigma == -1 else "flip"
        reach = 1e-6
        while reach < 0.05:
            ends = [way.walk.step(way.points[0], sign * reach) for sign in (-1, 1)]
            if None not in ends and ends[0].reflection[0] * ends[1].reflection[0] < 0:
                test = _reflection_test(*ends)
                found = way._locate(Event(kind, test), *ends, 2 * reach)
                if found is None:
                    return None
                special = way._at(kind, found[2], found[3])
                return replace(special, criticality=criticality(special))
            reach *= 4
        return None


def halves_apart(solution: Solution, sigma: int) -> np.ndarray | None:
    """What tells the halves apart, as repetitions (sigma = 1) or mirror images (-1); None: their itineraries do."""
    whole = solution
    if whole.sigma != 1 or whole.K % 2 or whole.K == 0:
        return None
    half = whole.K // 2
    if any(a != sigma * b for a, b in zip(whole.sides[:half], whole.sides[half:], strict=True)):
        return None
    if whole.halves % 4 != (0 if sigma == 1 else 2) or (sigma == -1 and not whole.family.linear.symmetric):
        return None
    t, D, P = whole.times, whole.jumps, whole.equations.P
    omega, speed = whole.family.linear.omega, np.abs(D).max()
    return np.concatenate([(t[half:] - t[:half] - P / 2) * omega, (D[half:] - sigma * D[:half]) / speed])


def _reflection_test(a: Point, b: Point):
    size = max(a.reflection[1], b.reflection[1])
    return lambda point: point.reflection[0] * math.exp(point.reflection[1] - size)


def _earliest(located: list, length: float):
    """Of ends at the same place the impact that vanishes: behind it the motion passes the stop, which looks alike."""
    if not located:
        return None
    first = min(found[1] for found in located)
    same = [found for found in located if found[1] <= first + 1e-7 * length]
    return min(same, key=lambda found: (found[0].index is None, found[1]))


def impact_index(solution, index: int) -> int:
    """Index in `orbit.impacts` of an impact of a solution; of a symmetric orbit the one in its first half."""
    orbit = orbit_of(None, solution)
    t = orbit._whole[0]
    T = 2 * math.pi / solution.family.linear.omega
    length = orbit.period * T
    step = length / 2 if solution.sigma == -1 else length
    gaps = (t - solution.times[index]) / step
    return int(np.argmin(np.abs(gaps - np.round(gaps))[: solution.K]))


def _is_torus(point: Point) -> bool:
    """Whether the two multipliers with product 1 are a complex pair: else a neutral saddle."""
    mu = point.solution.multipliers
    i, j = np.triu_indices(len(mu), 1)
    k = np.argmin(np.abs(1 - mu[i] * mu[j]))
    return abs(mu[i[k]].imag) > 1e-9
