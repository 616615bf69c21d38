"""One way along a branch: steps that adapt, what they pass, and where the branch ends."""

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from vibro_sweep.analysis import torus
from vibro_sweep.analysis.births import criticality, doubled
from vibro_sweep.analysis.events import Event, earliest, events_between, locate, reflection_test
from vibro_sweep.analysis.periodic import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.solution import Solution
from vibro_sweep.analysis.special import SpecialPoint, graze_at
from vibro_sweep.analysis.track import Rows, Track, join
from vibro_sweep.analysis.walk import Point, Walk
from vibro_sweep.engine.impulses import branch, places
from vibro_sweep.model.linear import family_of

FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 1e-3, 0.05, 1e-11
STRAIGHT = 0.1  # radians between the tangents of neighbouring points, at most
MOST_POINTS = 20_000


class Way:
    """One way along a branch."""

    def __init__(self, walk: Walk, forwards: float, lo: float, hi: float, system, progress=None):
        self.walk, self.system = walk, system
        self.bounds, self.progress = (lo, hi), progress
        self.special: list[SpecialPoint] = []
        self.closed = False
        self.rows: list[Rows] = []
        first = walk.first(forwards)
        if first is None:
            raise ValueError("orbit: it cannot be corrected; at a fold start from an orbit beside it")
        self.first = first

    @cached_property
    def frame(self) -> tuple[int, int]:
        """The first impact and the forcing periods before it, for all points of the branch."""
        return orbit_of(self.system, self.first.solution)._canonical_frame

    @property
    def points(self) -> Rows:
        return join(self.rows)

    def go(self) -> None:
        """To the branch's end: by compiled steps where they can be, that is with impacts."""
        self._add(self.first)
        start, steps = self.walk.start, (LONGEST_STEP, SHORTEST_STEP, STRAIGHT)
        compiled = start.K > 0 and not start.rests
        track = Track(self.first, self.walk, self.bounds, self.frame[1], *steps) if compiled else None
        if track is not None and track.begin(self.first, FIRST_STEP):
            self._run(track)
        else:
            self._step(self.first, 1)

    def _run(self, track: Track) -> None:
        a, passed = self.first, 1
        while passed < MOST_POINTS:
            reason, rows = track.run(passed)
            passed += len(rows.p)
            self.rows.append(rows)
            self._tell(passed, track.a.numbers[places.P])
            if reason in (branch.FULL, branch.FAR):
                continue
            a, b = track.point(track.a), track.point(track.b)
            if reason == branch.NO_START and a is not None:
                self._step(a, passed)
                return
            if reason == branch.FAILED or a is None or b is None:
                break
            if reason == branch.CLOSED:
                self._close()
                return
            if self._pass(a, b, float((b.x - a.x) @ a.tangent)):
                return
            track.accept()
        self.special.append(self._at("failed", a or self.first, math.nan))

    def _step(self, a: Point, passed: int) -> None:
        """The same in Python: for orbits without impacts or with rests, and where compiled steps cannot go."""
        length = FIRST_STEP
        while passed < MOST_POINTS and length >= SHORTEST_STEP:
            b = self.walk.step(a, length)
            turn = math.acos(min(1.0, a.tangent @ b.tangent)) if b is not None else math.inf
            if turn > STRAIGHT:
                length /= 2
                continue
            if self._pass(a, b, length):
                return
            if passed >= branch.EARLY and self._comes_back(a, length):
                self._close()
                return
            if turn < STRAIGHT / 3 and b.corrections <= 5:
                length = min(1.5 * length, LONGEST_STEP)
            a, passed = b, passed + 1
            self._tell(passed, a.p)
        self.special.append(self._at("failed", a, math.nan))

    def _tell(self, passed: int, value: float) -> None:
        if self.progress is not None:
            self.progress(passed, float(value))

    def _close(self) -> None:
        self.closed = True
        self.special.append(self._at("closed", self.first, math.nan))

    def _add(self, point: Point) -> None:
        self._add_solution(point.p, point.solution)

    def _add_solution(self, p: float, s: Solution) -> None:
        system = self.system.replace(**{self.walk.name: p})
        state = PeriodicOrbit(system, "ok", s, self.frame).state
        t, D, motion = s.times, s.jumps, s.motion[:, :2] if s.K else np.zeros((0, 2))
        values = p, t, D, s.ends, motion, s.margin, s.change, state
        self.rows.append(Rows(*(np.array([value], float) for value in values)))

    def _comes_back(self, a: Point, length: float) -> bool:
        offset = self.first.x - a.x
        K, T = self.walk.start.K, 2 * np.pi
        offset[:K] -= T * np.round(offset[:K].mean() / T) if K else 0.0
        along = offset @ a.tangent
        return 0 <= along <= length and float(np.linalg.norm(offset - along * a.tangent)) < 0.1 * length

    def _pass(self, a: Point, b: Point, length: float) -> bool:
        """Record what lies between a and b. True where the branch ends there."""
        ends = [event for event in events_between(self.walk, self.bounds, a, b) if event.ends]
        located = [found for event in ends if (found := locate(self.walk, event, a, b, length)) is not None]
        end = earliest(located, length)
        last = end[2] if end else b
        reach = end[1] if end else length
        found = []
        events = events_between(self.walk, self.bounds, a, last)
        birth = self._birth(a, last, reach) if any(event.type == "fold" for event in events) else None
        for event in events:
            if not event.ends and not (birth and event.type == "fold"):
                place = locate(self.walk, event, a, last, reach)
                if place is not None and place[1] < (birth[0] if birth else reach):
                    found.append(place)
        for event, _, point, error in sorted(found, key=lambda item: item[1]):
            self._add(point)
            if event.type == "neimark_sacker" and not _is_torus(point):
                continue
            special = self._at(event.type, point, error)
            if event.type in ("flip", "pitchfork"):
                special = replace(special, criticality=criticality(special))
            elif event.type == "neimark_sacker":
                special = replace(special, criticality=torus.criticality(point.solution))
            self.special.append(special)
        if birth:
            self._add_solution(birth[1].parameters[self.walk.name], doubled(birth[1].orbit._solution))
            self.special.append(birth[1])
            return True
        if end and end[0].type == "limit":
            last.held = min(self.bounds, key=lambda limit: abs(limit - last.p))
        self._add(last)
        if end:
            self.special.append(self._end(end[0], last, end[3]))
        return end is not None

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
        u = x[:-1] * w.scale[:-1]
        whole = Solution(family_of(system), 1, w.start.halves, w.start.sides, u, 0.0, w.start.rests)
        parent = whole.part(2, sigma, alike=0.1)
        if parent is None:
            return None
        way = Way(Walk(parent, w.name, self.bounds[1] - self.bounds[0]), 1.0, *self.bounds, self.system)
        kind = "pitchfork" if sigma == -1 else "flip"
        reach = 1e-6
        while reach < 0.05:
            ends = [way.walk.step(way.first, sign * reach) for sign in (-1, 1)]
            if None not in ends and ends[0].reflection[0] * ends[1].reflection[0] < 0:
                test = reflection_test(*ends)
                found = locate(way.walk, Event(kind, test), *ends, 2 * reach)
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
