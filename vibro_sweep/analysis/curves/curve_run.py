"""A run along a bifurcation curve in one direction: compiled steps, what they pass, and where the curve ends."""

import math

import numpy as np

from vibro_sweep.analysis.branches.crossings import nearest_pair
from vibro_sweep.analysis.branches.special import bare
from vibro_sweep.analysis.continuation.chatter import with_impacts, written_out
from vibro_sweep.analysis.continuation.events import Event
from vibro_sweep.analysis.continuation.secant import root
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve, copy
from vibro_sweep.analysis.curves.curve_events import (
    ENDS_OF_CONTACTS,
    beside,
    found_between,
    found_to_edge,
    lies_at,
    without_echoes,
)
from vibro_sweep.analysis.curves.curve_record import CurveRecord
from vibro_sweep.analysis.curves.ends import End, birth, birth_near, in_full, just_before, strong_resonance
from vibro_sweep.analysis.curves.singular_ends import end_where_steps_fail, preload_vanishes
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.curve_tests import NEAR_STRONG
from vibro_sweep.engine.continuation.problem import GRAZE, TORUS
from vibro_sweep.engine.continuation.workspace import TEST, THETA, Place, new_place

FIRST_STEP = 1e-3
CLOSE = 1e-6  # distance, in the units of a curve, from the first point where it comes back to it
SHORTER = 4  # times that the step over a boundary is halved
MOST_POINTS = 50_000


class CurveRun:
    """A run from the first point, forwards along its tangent or (sign = -1) backwards."""

    def __init__(self, curve: SolutionCurve, first: Place, sign: int, system, progress=None, virtual: bool = True):
        self.curve, self.progress, self.virtual = curve, progress, virtual
        self.first = curve.copied(first)
        self.first.tangent[:] *= sign
        self.first.tangent_p[:] *= sign
        self.record = CurveRecord(curve, system)
        self.closed = False
        self.record.add(self.first)

    def follow(self) -> None:
        """Follow the curve to its end."""
        w, passed = self.curve, 1
        path, b = w.path, new_place(w.K, w.n)
        a = path.a
        copy(self.first, path.first)
        copy(self.first, a)
        a.tests[TEST.length], path.before[0] = min(w.step_factor, 1.0) * FIRST_STEP, 0.0
        while passed < MOST_POINTS:
            path.counts[0] = passed
            reason, count = w.take_steps(b), int(path.counts[1])
            passed += count
            self.record.keep(path.record, count)
            if self.progress is not None:
                self.progress(passed, tuple(map(float, a.p[:2])))
            if reason == stepper.FAR:
                w.recentre(a)
            elif reason == stepper.CHATTER:
                if not self._write_out(a):
                    break
                w, path = self.curve, self.curve.path
                a, b = path.a, new_place(w.K, w.n)
            elif reason == stepper.LEFT and (beyond := outside_between(w, a, b)) is not None:
                self._leave(a, beyond)
                return
            elif reason in (stepper.CLOSED, stepper.LEFT) and closes(w, a, b, self.first):
                self.closed = True
                self.record.add_special("closed", self.first, np.nan)
                return
            elif reason in (stepper.EVENT, stepper.CLOSED, stepper.LEFT):
                if self._ends(a, b, reason != stepper.LEFT):
                    return
                if not passable(w, b):
                    break
                if self.record.short.are_lost(a, b):
                    beyond = self._over_graze(a)
                    if beyond is None:
                        break
                    copy(beyond, b)
                elif not self._pass(a, b):
                    return
                passed += 1
                copy(b, a)
            elif reason == stepper.FAILED:
                beyond = self._over_graze(a)
                if beyond is None:
                    break
                copy(beyond, a)
        end = birth_near(w, a) if w.problem.repeats or w.problem.mirrors else None
        if end is not None:
            self._end(end)
        else:
            end_where_steps_fail(self.record, a)

    def _write_out(self, a: Place) -> bool:
        """Go on with as many impacts of the chatter sequence as are needed at a."""
        found = written_out(self.curve, a)
        if found is None:
            return False
        w, place = found
        place = w.correct(place, place.direction)
        if place is None:
            return False
        copy(with_impacts(self.curve, self.curve.path.first, w.K)[1], w.path.first)
        copy(place, w.path.a)
        self.curve = self.record.curve = w
        return True

    def _pass(self, a: Place, b: Place, leaves: bool = False) -> bool:
        """Record what lies between a and b where the orbit is real, then b. Whether the curve goes on from there.

        A curve without virtual points ends where its orbit stops being real. Where it leaves the bounds at b, what lies
        there, or beyond by rounding, is left out: a number may be at the end of its range.
        """
        w = self.curve
        ends = not (self.virtual or w.is_real(b))
        found = without_echoes(w, (found_to_edge if ends else found_between)(w, a, b))
        if leaves:
            found = [one for one in found if not lies_at(w, one, b)]
        for one in found:
            self.record.add(one.place)
            if self._holds(one.event, one.place, *beside(w, a, b, one, found)) and not self.record.knows(one):
                self.record.add_special(one.event.type, one.place, one.error, one.event)
                if ends and (one.event.impact is not None or one.event.touches):
                    return False
                if one.event.type in ENDS_OF_CONTACTS:
                    return False
        if ends:  # at a place that could not be located
            self.record.add_special("failed", a, np.nan)
            return False
        self.record.add(b)
        return True

    def _holds(self, event: Event, place: Place, a: Place, b: Place) -> bool:
        """Whether this is a bifurcation of a motion, real there or at the edge of what is real; no neutral saddle."""
        w = self.curve
        if event.index is None and not event.type.startswith("resonance"):
            return w.is_real(a) or w.is_real(b)
        if not w.is_real(place):
            return False
        if event.index == TEST.pair:
            solution = w.solution(place)
            mu = (bare(solution, w.problem.index) if w.problem.kind == GRAZE else solution).multipliers
            return bool(abs(nearest_pair(mu)[0].imag) > 1e-9)
        return True

    def _leave(self, a: Place, b: Place) -> None:
        """The point where the curve leaves the bounds; near a corner the step to b passes two sides."""
        w = self.curve
        sides = [(j, boundary, side) for j in range(2) for boundary, side in zip(w.bounds[j], (-1, 1), strict=True)]
        passed = [(j, boundary) for j, boundary, side in sides if (b.p[j] - boundary) * side > 0]
        found = [place for j, boundary in passed if (place := self._at_boundary(a, b, j, boundary)) is not None]
        if not found:
            if not preload_vanishes(self.record, a):
                self.record.add_special("failed", a, np.nan)
            return
        place = min(found, key=lambda one: max((one.p[j] - boundary) * side for j, boundary, side in sides))
        if not self._ends(a, place, False) and self._pass(a, place, leaves=True):
            self.record.add_special("boundary", place, 0.0)

    def _at_boundary(self, a: Place, b: Place, j: int, boundary: float) -> Place | None:
        """The point where a parameter is at its boundary; the curve may be nearly parallel to that side of the
        bounds, or bent so much that the secant from a to b is no guess, but a shorter one is."""
        w = self.curve
        for _ in range(SHORTER):
            place = w.at_value(a, b, j, boundary)
            if place is None:
                found = root(w, a, b, lambda place: (place.p[j] - boundary) / np.ptp(w.bounds[j]))
                place = found and found[1]
            if place is not None:
                place.p[j] = boundary
                return place
            middle = w.step(a, w.distance(a, b) / 2)
            if middle is None:
                return None
            a, b = (a, middle) if (middle.p[j] - boundary) * (b.p[j] - boundary) > 0 else (middle, b)
        return None

    def _ends(self, a: Place, b: Place, inside: bool) -> bool:
        """Whether the curve ends: its pair meets at 1 or -1 ahead of b, or its orbit is born between a and b.

        inside : whether the curve goes on from b within its bounds
        """
        w = self.curve
        end = strong_resonance(w, a, b) if inside and is_near_strong(w, b) else None
        if end is None and (w.problem.repeats or w.problem.mirrors):
            end = birth(w, a, b)
        if end is None:
            return False
        last = just_before(w, a, b, end)
        if last is not None and not (self.virtual or w.is_real(last) or found_to_edge(w, a, last)):
            last = None  # no edge but the end itself
        if last is None or self._pass(a, last):
            self._end(end)
        return True

    def _end(self, end: End) -> None:
        """The end, on the curve of another orbit."""
        other, found = end.curve, end.found
        w, solution, p = self.curve, in_full(self.curve, end), found.place.p.copy()
        self.record.add_special(found.event.type, found.place, found.error, found.event, other)
        if w.problem.kind == TORUS:
            p[THETA] = round(self.record.points.p[-1, THETA] / np.pi) * np.pi
        self.record.add_solution(p, solution)

    def _over_graze(self, a: Place) -> Place | None:
        """The curve behind the graze of a contact whose length has no digits at a; the graze is recorded. None: there
        is none, or the curve ends there."""
        found = self.record.short.graze_beside(a)
        if found is None:
            return None
        beyond = self.record.short.behind(found.place)
        if beyond is None or not (self.virtual or self.curve.is_real(beyond)):
            return None
        beyond.tests[TEST.length] = a.tests[TEST.length]
        if self.curve.is_real(a) or self.curve.is_real(beyond):
            self.record.add_event(found)
        self.record.add(beyond)
        return beyond


def outside_between(curve: SolutionCurve, a: Place, b: Place) -> Place | None:
    """b, or the point between a and b where a parameter has its extremum, if it lies out of the bounds."""
    extrema = [j for j in range(2) if a.tangent_p[j] * b.tangent_p[j] < 0]
    found = [root(curve, a, b, lambda place, j=j: place.tangent_p[j]) for j in extrema]
    for place in (b, *(one[1] for one in found if one is not None)):
        if np.any((place.p[:2] < curve.bounds[:, 0]) | (place.p[:2] > curve.bounds[:, 1])):
            return place
    return None


def passable(curve: SolutionCurve, place: Place) -> bool:
    """False where a Neimark-Sacker curve has passed the end that was not found."""
    return curve.problem.kind != TORUS or 0 < place.p[THETA] < math.pi


def is_near_strong(curve: SolutionCurve, place: Place) -> bool:
    """Whether the pair of a Neimark-Sacker curve is about to meet at 1 or -1."""
    return curve.problem.kind == TORUS and not NEAR_STRONG < place.p[THETA] < math.pi - NEAR_STRONG


def closes(curve: SolutionCurve, a: Place, b: Place, first: Place) -> bool:
    """Whether the curve passes through its first point between a and b; other curves may come as near as a step."""
    first = curve.copied(first)
    first.phases[:] += 2 * np.pi * np.round(np.mean(a.phases - first.phases) / (2 * np.pi))
    row = first.direction
    ends = [row @ curve.difference(first, place) for place in (a, b)]
    if ends[0] * ends[1] > 0:
        return False
    place = curve.correct(curve.between(a, b, ends[0] / (ends[0] - ends[1])), row)
    return place is not None and curve.distance(first, place) < CLOSE
