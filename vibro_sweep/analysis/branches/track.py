"""Compiled steps along a branch (engine/continuation/stepper.py), from one event to the next."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.analysis.continuation.tracer import NoPlaneError, copied, copy
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.path import Path
from vibro_sweep.engine.continuation.workspace import BRANCH_TESTS, TEST, Place, new_place
from vibro_sweep.engine.impulses.flow import contact_coordinates


class Rows(NamedTuple):
    """Points of a branch."""

    p: np.ndarray  # (points,)
    t: np.ndarray  # (points, K)
    D: np.ndarray  # (points, K)
    ends: np.ndarray  # (points, rests)
    motion: np.ndarray  # (points, K, 2): gap velocity and acceleration before each impact
    margin: np.ndarray  # (points,)
    residual: np.ndarray  # (points,)
    state: np.ndarray  # (points, 2N): x1 v1 .. xN vN at t = 0


def join(parts: list[Rows]) -> Rows:
    return Rows(*(np.concatenate(values) for values in zip(*parts, strict=True)))


def row_of(p: float, s: Solution, frame: tuple[int, int]) -> Rows:
    """A point alone."""
    state = PeriodicOrbit(s.family, "ok", s, frame).state
    t, D, motion = s.times, s.jumps, s.motion[:, :2] if s.K else np.zeros((0, 2))
    values = p, t, D, s.ends, motion, s.margin, s.change, state
    return Rows(*(np.array([value], float) for value in values))


class Track:
    """Steps one way along a branch from its first point."""

    def __init__(self, first: Point, walk: Walk, bounds, origin: int, length: float, steps: tuple[float, float, float]):
        """origin : forcing periods, at which states are recorded
        length : of the first step
        steps : longest and shortest length, and radians between tangents of neighbouring points
        """
        self.walk, self.tracer, self.origin = walk, walk.tracer, origin
        self.path: Path = self.tracer.path._replace(
            longest=steps[0], shortest=steps[1], straight=steps[2], box=np.array([bounds, (-np.inf, np.inf)], float)
        )
        self.b = new_place(len(walk.start.sides), self.tracer.n)
        copy(first.guess, self.a)
        self.a.tests[TEST.length] = length
        self.path.before[0] = 0.0
        copy(self.a, self.path.first)

    @property
    def a(self) -> Place:
        """Where the last step began."""
        return self.path.a

    def record_steps(self, passed: int) -> tuple[int, int, int]:
        """The compiled part of `run`: reason, points, corrections; passed: points of the branch so far."""
        path = self.path
        path.counts[0] = passed
        return int(self._do(stepper.WALK)), int(path.counts[1]), int(path.counts[2])

    def _do(self, task: int) -> float:
        w = self.tracer
        return stepper.at(task, w.planes, w.problem, self.path, self.b, np.zeros(2 * w.K + 3), w.bench)

    def run(self, passed: int) -> tuple[int, Rows]:
        """Steps until something happens, or as many points as one call records: the reason and the points before the
        step. FAILED too where around the last point the oscillator is not to be had as polynomials of the parameter."""
        reason, count, _ = self.record_steps(passed)
        r, units, n = self.path.record, self.tracer.units, self.tracer.n
        p, x = r.p[:count, 0].copy(), r.x[:count]
        tau = np.array([self.walk.tau(value) for value in p.tolist()])
        r.phase[:count] = 2 * np.pi * self.origin + tau
        self._do(stepper.STATES)
        if reason == stepper.FAR:
            try:
                self.tracer.recentre(self.a)
            except NoPlaneError:
                reason = stepper.FAILED
        omega = r.omega[:count] * units.rate
        t = (x[..., n] - tau[:, None]) / omega[:, None]
        motion = r.motion[:count] * units.speed * [1.0, units.rate]
        state = self._masses(p, r.state[:count] * self.tracer.state_units)
        margin, residual = r.tests[:count, TEST.margin] * units.length, r.tests[:count, TEST.residual].copy()
        rests = self.tracer.problem.rests
        D = np.where(rests, -motion[..., 0], x[..., n + 1] * units.speed)
        ends = (t + x[..., n + 1] / omega[:, None])[:, rests]
        rows = Rows(p, t, D, ends, motion, margin, residual, state)
        return reason, rows

    def _masses(self, p: np.ndarray, states: np.ndarray) -> np.ndarray:
        """x1 v1 .. xN vN from contact coordinates."""
        slope = self.walk.family.derivative(self.walk.name)
        if np.any(slope.M) or np.any(slope.along):
            values = self.walk.oscillators(p)
            found = [contact_coordinates(q).to_masses(state) for q, state in zip(values, states, strict=True)]
            return np.reshape(found, states.shape)
        return contact_coordinates(self.walk.family.linear).to_masses(states)

    def accept(self, a: Point, b: Point) -> None:
        """Go on from b, after the step from a to b was looked at.

        Where signs have changed in compiled steps but not from point to point, rounding decides: the next step is to
        look for the change again.
        """
        for i in BRANCH_TESTS:
            if self.a.tests[i] * self.b.tests[i] < 0 < a.guess.tests[i] * b.guess.tests[i]:
                self.b.tests[i] *= -1
        copy(self.b, self.a)

    def point(self, place: Place) -> Point | None:
        """The same point, corrected with the oscillator itself."""
        return self.walk.correct(copied(place), self.tracer.direction(place))

    def point_of(self, rows: Rows) -> Point | None:
        """The last of recorded points, which lies before the place a."""
        return self._corrected(rows, self.tracer.direction(self.a))

    def point_behind(self, rows: Rows) -> Point | None:
        """The last of two or more points; forwards is from the one before."""
        change = [self.walk.of(self._solution(rows, i)) for i in (-2, -1)]
        direction = Point(self.walk, change[1]).x - Point(self.walk, change[0]).x
        return self._corrected(rows, direction / np.linalg.norm(direction))

    def _corrected(self, rows: Rows, direction: np.ndarray) -> Point | None:
        guess = self.walk.of(self._solution(rows, -1))
        return guess and self.walk.correct(guess, direction)

    def _solution(self, rows: Rows, i: int) -> Solution:
        s, walk = self.walk.start, self.walk
        family = walk.family.replace(**{walk.name: float(rows.p[i])})
        u = np.concatenate([rows.t[i], rows.D[i], rows.ends[i]])
        return Solution(family, s.sigma, s.halves, s.sides, u, 0.0, s.rests)
