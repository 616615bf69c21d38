"""One way along a branch: steps that adapt, what they pass, and where the branch ends."""

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from vibro_sweep.analysis.branches import torus
from vibro_sweep.analysis.branches.births import criticality, doubled
from vibro_sweep.analysis.branches.events import (
    bifurcations,
    ends_between,
    first_end,
    is_torus,
    reflection_test,
    unexplained,
)
from vibro_sweep.analysis.branches.locating import Event, locate
from vibro_sweep.analysis.branches.special import SpecialPoint, graze_at, is_free
from vibro_sweep.analysis.branches.track import Rows, Track, join
from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses import branch, places
from vibro_sweep.model.linear import family_of

# The first step is not AMPLITUDE of births.py: from an orbit that was just born it would end at the birth itself, where
# the branch has no tangent, and pass it unseen.
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 6e-4, 0.05, 1e-11
STRAIGHT = 0.1  # radians between the tangents of neighbouring points, at most
MOST_POINTS = 20_000
BEFORE = 1e-6  # share of the way to a graze
HALVINGS = 8  # of a step in which more multipliers cross the unit circle than bifurcations are found


class Way:
    """One way along a branch."""

    through = True  # bifurcations; else the way ends at the first
    first_step = FIRST_STEP

    def __init__(self, walk: Walk, forwards: float, lo: float, hi: float, system, progress=None):
        """walk : of `start_of_walk`, or another one that has a first point."""
        self.walk, self.system = walk, system
        self.bounds, self.progress = (lo, hi), progress
        self.special: list[SpecialPoint] = []
        self.closed = False
        self.rows: list[Rows] = []
        self.first = walk.first(forwards)

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
        if track is not None and track.begin(self.first, self.first_step):
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
        length = self.first_step
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
        self.rows.append(row_of(p, s, self.frame))

    def _comes_back(self, a: Point, length: float) -> bool:
        offset = self.first.x - a.x
        K, T = self.walk.start.K, 2 * np.pi
        offset[:K] -= T * np.round(offset[:K].mean() / T) if K else 0.0
        along = offset @ a.tangent
        return 0 <= along <= length and float(np.linalg.norm(offset - along * a.tangent)) < 0.1 * length

    def _pass(self, a: Point, b: Point, length: float, halvings: int = HALVINGS) -> bool:
        """Record what lies between a and b, and b. True where the branch ends there."""
        ends = ends_between(self.walk, self.bounds, a, b)
        end = first_end(self.walk, ends, a, b, length)
        if ends and end is None:  # what follows is no motion
            self.special.append(self._at("failed", a, math.nan))
            return True
        last = end[2] if end else b
        reach = end[1] if end else length
        birth = self._birth(a, last, reach) if a.tangent[-1] * last.tangent[-1] < 0 else None
        found = bifurcations(self.walk, a, last, reach)
        before = self._before_graze(a, end) if end and end[0].type == "graze" and end[0].index is not None else None
        if before is not None:
            known = {place[0].type for place in found}
            found += [place for place in bifurcations(self.walk, a, before, reach) if place[0].type not in known]
            found.sort(key=lambda place: place[1])
        if not birth and halvings and unexplained(self.walk, a, before or last, found):
            c = self.walk.step(a, reach / 2)
            if c is not None:
                rest = float((b.x - c.x) @ c.tangent)
                return self._pass(a, c, reach / 2, halvings - 1) or self._pass(c, b, rest, halvings - 1)
        if birth:
            found = [place for place in found if place[0].type != "fold" and place[1] < birth[0]]
        for event, _, point, error in found:
            self._add(point)
            if event.type == "neimark_sacker" and not is_torus(point):
                continue
            special = self._at(event.type, point, error)
            if event.type in ("flip", "pitchfork"):
                special = replace(special, criticality=criticality(special))
            elif event.type == "neimark_sacker":
                special = replace(special, criticality=torus.criticality(point.solution))
            self.special.append(special)
            if not self.through:
                return True
        if birth:
            self._add_solution(birth[1].parameters[self.walk.name], doubled(birth[1].orbit._solution))
            self.special.append(birth[1])
            return True
        if end and end[0].type == "limit":
            last.hold(min(self.bounds, key=lambda limit: abs(limit - last.p)))
        self._add(last)
        if end:
            self.special.append(self._end(end[0], last, end[3]))
        return end is not None

    def _before_graze(self, a: Point, end) -> Point | None:
        """A point just before an impact vanishes: there multipliers have a pole, and tests made of them no sign."""
        _, reach, graze, _ = end
        return self.walk.step(a, (1 - BEFORE) * reach, graze.x)

    def _at(self, of_type: str, point: Point, error: float, **more) -> SpecialPoint:
        system = self.system.replace(**{self.walk.name: point.p})
        orbit = orbit_of(system, point.solution)
        return SpecialPoint(of_type, {self.walk.name: point.p}, orbit, point.solution.multipliers, error, **more)

    def _end(self, event: Event, point: Point, error: float) -> SpecialPoint:
        if event.type != "graze":
            return self._at(event.type, point, error)
        index = event.index
        if index is not None and is_free(point.solution):
            index = orbit_of(None, point.solution)._canonical_frame[0] % point.solution.K
        graze = graze_at(point.solution, self.walk.name, index)
        side = graze.touching.sides[graze.index]
        slope = abs(graze.distance_slope)
        if slope > 0:
            error += float(16 * np.finfo(float).eps * point.solution.size_of_gap / slope)
        impact = None
        if index is not None:
            side, impact = stop_and_impact(point.solution, index)
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
        walk = Walk(parent, w.name, self.bounds[1] - self.bounds[0])
        if walk.first(1.0) is None:
            return None
        way = Way(walk, 1.0, *self.bounds, self.system)
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


def row_of(p: float, s: Solution, frame: tuple[int, int]) -> Rows:
    """A point alone."""
    state = PeriodicOrbit(s.family, "ok", s, frame).state
    t, D, motion = s.times, s.jumps, s.motion[:, :2] if s.K else np.zeros((0, 2))
    values = p, t, D, s.ends, motion, s.margin, s.change, state
    return Rows(*(np.array([value], float) for value in values))


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


def stop_and_impact(solution: Solution, index: int) -> tuple[int, int]:
    """Stop and index, in `orbit.impacts`, of an impact of a solution; of a symmetric orbit, of its first half."""
    first, _ = orbit_of(None, solution)._canonical_frame
    impact, sides = (index - first) % solution.K, solution.whole().sides
    return sides[(impact + first) % len(sides)], impact
