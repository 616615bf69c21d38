"""Compiled steps along a branch (engine/impulses/branch.py), from one place where something happens to the next."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.analysis.periodic.media import medium_of
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses import branch, places
from vibro_sweep.engine.impulses.flow import contact_coordinates
from vibro_sweep.engine.impulses.places import Place, Steps, new_place, new_record, new_work

AT_ONCE = 1024  # points of one call


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

    def __init__(self, first: Point, walk: Walk, bounds, origin: int, longest: float, shortest: float, straight: float):
        self.walk, self.bounds, self.origin = walk, bounds, origin
        K, n = walk.start.K, first.solution.states.shape[1] - 3
        scale = walk.scale
        self.steps = Steps(
            float(scale[0]), float(scale[K]), float(scale[-1]), longest, shortest, straight, *map(float, bounds)
        )
        self.sides, self.sigma = np.array(walk.start.sides, float), float(walk.start.sigma)
        self.a, self.b, self.first = (new_place(K, n) for _ in range(3))
        self.work, self.record = new_work(K, n), new_record(AT_ONCE, K, n)
        self.size = float(first.solution.size_of_gap)
        self.medium = self._medium(first.p)

    def _medium(self, p: float) -> np.ndarray | None:
        known = self.walk.media  # both ways begin at the same place
        if p not in known:
            walk = self.walk
            known[p] = medium_of(walk.family, walk.start.halves, walk.name, p, float(walk.scale[-1]))
        return known[p]

    def begin(self, first: Point, length: float) -> bool:
        """Stand at the first point. False where compiled steps cannot start."""
        if self.medium is None:
            return False
        K, a, scale = len(self.sides), self.a, self.walk.scale
        u = first.x[:-1] * scale[:-1]
        a.t[:], a.D[:], a.z[:] = u[:K], u[K : 2 * K], first.solution.states[:, :-3]
        tangent = first.tangent * scale
        a.tangent_t[:], a.tangent_jump[:] = tangent[:K], tangent[K : 2 * K]
        a.numbers[places.P], a.numbers[places.TANGENT] = first.p, tangent[-1]
        nothing = new_record(0, K, a.z.shape[1])  # no step is made
        if self._walk(1, nothing, True)[0] == branch.NO_START:
            return False
        a.numbers[places.LENGTH] = length
        for here, there in zip(a, self.first, strict=True):
            there[...] = here
        return True

    def _walk(self, passed: int, record, begins: bool) -> tuple[int, int, int]:
        """Reason, points recorded, corrections made."""
        return branch.walk(
            self.medium, self.sides, self.sigma, self.steps, self.size, float(self.origin), passed, self.first, self.a,
            self.b, record, self.work, begins,
        )  # fmt: skip

    def record_steps(self, passed: int) -> tuple[int, int, int]:
        """The compiled part of `run`: reason, points, corrections."""
        return self._walk(passed, self.record, False)

    def run(self, passed: int) -> tuple[int, Rows]:
        """Steps until something happens, or `AT_ONCE` points: the reason and the points before the step.

        NO_START: around the last point the oscillator is not to be had as polynomials of the parameter.
        """
        reason, count, _ = self.record_steps(passed)
        if reason == branch.FAR:
            self.medium = self._medium(float(self.a.numbers[places.P]))
            if self.medium is None:
                reason = branch.NO_START
        r = self.record
        numbers = r.numbers[:count].copy()
        p = numbers[:, places.P]
        state = self._masses(p, r.state[:count])
        t, D, motion = (values[:count].copy() for values in (r.t, r.D, r.motion))
        margin, residual = numbers[:, places.MARGIN], numbers[:, places.DEFECT_HERE] / self.size
        rows = Rows(p, t, D, np.zeros((count, 0)), motion, margin, residual, state)
        return reason, rows

    def _masses(self, p: np.ndarray, states: np.ndarray) -> np.ndarray:
        """x1 v1 .. xN vN from contact coordinates."""
        slope = self.walk.family.derivative(self.walk.name)
        if np.any(slope.M) or np.any(slope.along):
            values = [self.walk.family.replace(**{self.walk.name: value}).linear for value in p.tolist()]
            found = [contact_coordinates(q).to_masses(state) for q, state in zip(values, states, strict=True)]
            return np.reshape(found, states.shape)
        return contact_coordinates(self.walk.family.linear).to_masses(states)

    def accept(self, a: Point, b: Point) -> None:
        """Go on from b, after the step from a to b was looked at.

        Where signs have changed in compiled steps but not from point to point, rounding decides: the next step is to
        look for the change again.
        """
        past, numbers = self.a.numbers, self.b.numbers
        for i, change in ((places.TANGENT, a.tangent[-1] * b.tangent[-1]),
                          (places.REFLECTION, a.reflection[0] * b.reflection[0])):  # fmt: skip
            if past[i] * numbers[i] < 0 < change:
                numbers[i] *= -1
        self.work.past[:] = past
        self.work.past[places.LENGTH] = numbers[places.LENGTH]
        self.work.past_multipliers[:] = self.a.multipliers
        for here, there in zip(self.b, self.a, strict=True):
            there[...] = here

    def point(self, place: Place) -> Point | None:
        """The same point, corrected with the walk's own equations."""
        return self._corrected(place.t, place.D, float(place.numbers[places.P]), *_tangent(place))

    def point_of(self, rows: Rows) -> Point | None:
        """The last of recorded points, which lies before the place a."""
        return self._corrected(rows.t[-1], rows.D[-1], float(rows.p[-1]), *_tangent(self.a))

    def point_behind(self, rows: Rows) -> Point | None:
        """The last of two or more points; forwards is from the one before."""
        t, D, p = (values[-1] - values[-2] for values in (rows.t, rows.D, rows.p))
        return self._corrected(rows.t[-1], rows.D[-1], float(rows.p[-1]), np.concatenate([t, D]), float(p))

    def _corrected(self, t, D, p: float, tangent: np.ndarray, rate: float) -> Point | None:
        w, K = self.walk, len(self.sides)
        u = np.concatenate([t, D])
        if w.start.equations.free:
            e = w.equations(p)
            u, tangent = np.append(u, 0.0), np.append(tangent, 0.0)
            u[-1] = -np.mean(e.evaluate(w.start.sides, u)[0][:K])
        x = np.append(u, p) / w.scale
        direction = np.append(tangent, rate) / w.scale
        return w.correct(x, direction, direction)


def _tangent(place: Place) -> tuple[np.ndarray, float]:
    return np.concatenate([place.tangent_t, place.tangent_jump]), float(place.numbers[places.TANGENT])
