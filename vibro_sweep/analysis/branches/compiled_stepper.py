"""Compiled steps along a branch (engine/continuation/stepper.py), from one event to the next."""

from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.continuation.first_point import guess_of
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.recorded import Rows, rows_of
from vibro_sweep.analysis.continuation.solution_curve import NoPlaneError, copy
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.workspace import BRANCH_TESTS, TEST, Place, new_place
from vibro_sweep.engine.impulses.flow import contact_coordinates


def row_of(p: float, s: Solution, frame: tuple[int, int]) -> Rows:
    """A single point as `Rows`."""
    state = PeriodicOrbit(s.family, "ok", s, frame).state
    t, D, motion = s.times, s.jumps, s.motion[:, :2] if s.K else np.zeros((0, 2))
    values = p, t, D, s.ends, motion, s.stop_distance, s.change, state
    return Rows(*(np.array([value], float) for value in values))


class CompiledStepper:
    """Compiled steps in one direction along a branch from its first point."""

    def __init__(self, first: Point, origin: int, length: float):
        """origin : forcing periods, at which states are recorded; length : of the first step"""
        self.curve, self.path, self.origin = first.curve, first.curve.path, origin
        self.b = new_place(self.curve.K, self.curve.n)
        copy(first, self.a)
        self.a.tests[TEST.length] = length
        self.path.before[0] = 0.0
        copy(self.a, self.path.first)

    @property
    def a(self) -> Place:
        """The place where the last step began."""
        return self.path.a

    def record_steps(self, passed: int) -> tuple[int, int, int]:
        """The compiled part of `run`: reason, points, corrections; passed: points of the branch so far."""
        self.path.counts[0] = passed
        return self.curve.take_steps(self.b), int(self.path.counts[1]), int(self.path.counts[2])

    def run(self, passed: int) -> tuple[int, Rows]:
        """Steps until something happens, or as many points as one call records: the reason and the points before the
        step. FAILED too where around the last point the oscillator is not to be had as polynomials of the parameter."""
        reason, count, _ = self.record_steps(passed)
        r, w = type(self.path.record)(*(values[:count] for values in self.path.record)), self.curve
        tau = np.array([w.tau_at(value) for value in r.p[:, 0].tolist()])
        r.phase[:] = 2 * np.pi * self.origin + tau
        w.run_task(stepper.STATES, self.b)
        if reason == stepper.FAR:
            try:
                w.recentre(self.a)
            except NoPlaneError:
                reason = stepper.FAILED
        state = self._masses(r.p[:, 0], r.state * w.state_units)
        return reason, rows_of(w, r.x, r.motion, r.p[:, 0], r.tests, r.omega, tau, state)

    def _masses(self, p: np.ndarray, states: np.ndarray) -> np.ndarray:
        """x1 v1 .. xN vN from contact coordinates."""
        of, (slope,) = self.curve.oscillators, self.curve.oscillators.slopes
        if np.any(slope.M) or np.any(slope.contact.normal):
            values = [of.at([value]).linear for value in p.tolist()]
            found = [contact_coordinates(q).to_masses(state) for q, state in zip(values, states, strict=True)]
            return np.reshape(found, states.shape)
        return contact_coordinates(of.family.linear).to_masses(states)

    def accept(self, a: Point, b: Point) -> None:
        """Go on from b, after the step from a to b was looked at.

        Where signs have changed in compiled steps but not from point to point, rounding decides: the next step is to
        look for the change again.
        """
        for i in BRANCH_TESTS:
            if self.a.tests[i] * self.b.tests[i] < 0 < a.tests[i] * b.tests[i]:
                self.b.tests[i] *= -1
        copy(self.b, self.a)

    def point(self, place: Place) -> Point | None:
        """The same point, corrected with the oscillator itself."""
        return self.curve.correct(place, place.direction)

    def point_of(self, rows: Rows) -> Point | None:
        """The last of recorded points, which lies before the place a."""
        guess = self._guess(rows, -1)
        return guess and self.curve.correct(guess, self.a.direction)

    def point_behind(self, rows: Rows) -> Point | None:
        """The last of two or more points; forwards is from the one before. None where one is no orbit any more."""
        before, last = self._guess(rows, -2), self._guess(rows, -1)
        return before and last and self.curve.correct(last, self.curve.unit_row(self.curve.difference(before, last)))

    def _guess(self, rows: Rows, i: int) -> Point | None:
        family, u = self.curve.oscillators.at(rows.p[i : i + 1 or None]), [rows.t[i], rows.D[i], rows.ends[i]]
        return guess_of(self.curve, replace(self.curve.orbit, family=family, u=np.concatenate(u)))
