"""A run along a branch in one direction: steps of adaptive length, what they pass, and where the branch ends."""

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from vibro_sweep.analysis.branches.branch_events import SPLIT, bifurcations, ends_between, first_end
from vibro_sweep.analysis.branches.compiled_stepper import CompiledStepper, row_of
from vibro_sweep.analysis.branches.criticality import criticality
from vibro_sweep.analysis.branches.crossings import is_torus
from vibro_sweep.analysis.branches.looking import hidden_between
from vibro_sweep.analysis.branches.own_birth import before_birth, lands_on_birth, own_birth
from vibro_sweep.analysis.branches.passed_births import before_passed, how_many_on, passed
from vibro_sweep.analysis.branches.permanent_contact import permanent_contact
from vibro_sweep.analysis.branches.special import TOUCHING, SpecialPoint, graze_at, shallow, vanishing
from vibro_sweep.analysis.branches.split_contacts import joined_contacts
from vibro_sweep.analysis.continuation.events import Event, LocatedEvent
from vibro_sweep.analysis.continuation.point import Point, along
from vibro_sweep.analysis.continuation.recorded import Rows, join
from vibro_sweep.analysis.continuation.solution_curve import SHORTEST_STEP, SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import KINDS
from vibro_sweep.analysis.periodic.contact_numbers import is_smooth
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.analysis.periodic.seeds_of_free_motion import touching_at_once
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import FLIP, TORUS

# The first step is not AMPLITUDE of births.py: from an orbit that was just born it would end at the birth itself, where
# the branch has no tangent, and pass it unseen.
FIRST_STEP = 6e-4
OF_STABLE = 4e-3  # the same of an orbit that was not just born
MOST_POINTS = 20_000
BEFORE = 1e-8  # share of the way to a graze
ABOVE_ROUNDING = 1e-13  # length of a step, nearer than which to a graze multipliers have any sign
DIVISIONS = 60  # of a step in which more happens than its tests tell, in all


class BranchRun:
    """A run along a branch in one direction."""

    def __init__(self, first: Point, system, progress=None, stable: bool = False):
        """stable : only as far as the orbit is stable, that is to the first bifurcation."""
        self.first, self.curve, self.system, self.progress, self.stable = first, first.curve, system, progress, stable
        (self.name,), self.bounds = self.curve.names, self.curve.bounds[0]
        self.first_step = self.curve.step_factor * (OF_STABLE if stable else FIRST_STEP)
        self.special: list[SpecialPoint] = []
        self.closed = False
        self.rows: list[Rows] = []
        self._passed: tuple[Point, int, int] | None = None  # where the last step began; rows and special points then

    @cached_property
    def frame(self) -> tuple[int, int]:
        """The first impact and the forcing periods before it, for all points of the branch."""
        return orbit_of(self.system, self.first.solution)._canonical_frame

    @property
    def points(self) -> Rows:
        return join(self.rows)

    def follow(self) -> None:
        """Follow the branch to its end."""
        self._add(self.first)
        compiled = CompiledStepper(self.first, self.frame[1], self.first_step)
        a, count, looked = self.first, 1, 0
        while count < MOST_POINTS:
            reason, rows = compiled.run(count)
            count += len(rows.p)
            if len(rows.p):
                self.rows.append(rows)
                self._passed = None
            self._show_progress(count, compiled.a.p[0])
            if reason in (stepper.FULL, stepper.FAR):
                continue
            a, b = compiled.point(compiled.a), compiled.point(compiled.b)
            before = self._count(looked)
            if self._over_birth(compiled, [before + more for more in passed(self.curve, self.rows[looked:], a)]):
                return
            looked = len(self.rows) - 1
            if reason == stepper.FAILED or a is None or b is None:
                if self._over_birth(compiled, [self._count()]) or self._join_contacts():
                    return
                if self._press_for_good(self._last_solution()):
                    return
                break
            if reason == stepper.CLOSED:
                self._close()
                return
            before = self._point_before(compiled) if reason == stepper.TOUCH else None
            if before is not None and self._again(before, a, b):
                return
            if self._pass(a, b, beside=(before, None)):
                return
            compiled.accept(a, b)
        self.special.append(self._fail_at(a) if a else self._fail_behind_last())

    def _fail_at(self, a: Point) -> SpecialPoint:
        """`failed` at this point, or the graze at which it lies to rounding: all contacts may vanish there at once.

        It is the last one that was recorded, corrected: that is recorded in its place.
        """
        self.rows = self._without_last()
        self._add(a)
        if abs(a.stop_distance) <= TOUCHING * a.solution.size_of_gap or np.any(shallow(a.solution)):
            self._forget_beside(a.value, 0.0)
            return self._end(Event("graze", lambda point: point.stop_distance, touches=True), a, 0.0)
        return self._at("failed", a, math.nan)

    def _fail_behind_last(self) -> SpecialPoint:
        """`failed` at the last point, at which no derivatives are known."""
        s = self._last_solution()
        at = {self.name: s.family.free[self.name]}
        return SpecialPoint("failed", at, orbit_of(self.system.replace(**at), s), s.multipliers)

    def _point_before(self, compiled: CompiledStepper) -> Point | None:
        """The last point of the branch before the place a."""
        if self._passed is not None:
            return self._passed[0]
        last = next((rows for rows in reversed(self._without_last()) if len(rows.p)), None)
        return None if last is None else compiled.point_of(last)

    def _over_birth(self, compiled: CompiledStepper, counts: list[int]) -> bool:
        """End at the birth that lies behind one of so many points. False: there is none (`before_passed`)."""
        found = before_passed(self.curve, compiled, self.points, counts, self.first) if counts else None
        if found is None:
            return False
        kept, a, b = found
        self.rows = [kept]
        del self.special[how_many_on(kept, self.special) :]
        if not self._pass(a, b):
            self.special.append(self._at("failed", a, math.nan))
        return True

    def _join_contacts(self) -> bool:
        """End where two contacts become one behind the last point. False: there are none."""
        found = joined_contacts(self.curve, self._last_solution())
        if found is None:
            return False
        (_, _, place, error), both = found
        return self._end_behind("split", place.value, both, place.solution.multipliers, error)

    def _press_for_good(self, s: Solution) -> bool:
        """End where a contact never ends, beside this orbit. False: there is none."""
        found = permanent_contact(s, self.name, float(self.curve.unit[0]))
        if found is None:
            return False
        return self._end_behind("permanent_contact", found.value, found.solution, found.multipliers, found.error)

    def _end_behind(self, of_type: str, value: float, s: Solution, multipliers: np.ndarray, error: float) -> bool:
        """End at an orbit beyond the last point that the equations of the branch reach."""
        self._add_solution(value, s)
        at = {self.name: value}
        self.special.append(SpecialPoint(of_type, at, orbit_of(self.system.replace(**at), s), multipliers, error))
        return True

    def _last_solution(self) -> Solution:
        last = self.points.taken(np.s_[-1:])
        u = np.concatenate([last.t[0], last.D[0], last.ends[0]])
        return replace(self.curve.orbit, family=self.curve.oscillators.at(last.p), u=u)

    def _count(self, parts: int | None = None) -> int:
        """Points in the first parts of its rows."""
        return sum(len(rows.p) for rows in self.rows[:parts])

    def _without_last(self) -> list[Rows]:
        return [*self.rows[:-1], self.rows[-1].taken(np.s_[:-1])]

    def _again(self, before: Point, a: Point, b: Point | None) -> bool:
        """Pass the step from `before` to a once more, knowing b behind it. True where the branch ends there."""
        if self._passed is None:
            self.rows = self._without_last()
        else:
            _, rows, special = self._passed
            del self.rows[rows:], self.special[special:]
        return self._pass(before, a, beside=(None, b))

    def _show_progress(self, passed: int, value: float) -> None:
        if self.progress is not None:
            self.progress(passed, float(value))

    def _close(self) -> None:
        self.closed = True
        self.special.append(self._at("closed", self.first, math.nan))

    def _add(self, point: Point) -> None:
        self._add_solution(point.value, point.solution)

    def _add_solution(self, p: float, s: Solution) -> None:
        self.rows.append(row_of(p, s, self.frame))

    def _pass(self, a: Point, b: Point, beside=(None, None)) -> bool:
        """Record what lies between a and b, and b. True where the branch ends there.

        beside : the points before a and behind b, None where they are not known
        """
        self._passed = a, len(self.rows), len(self.special)
        self._divisions = DIVISIONS
        over = lands_on_birth(self.curve, a, b)
        if over is not None:
            b, beside = over, (beside[0], None)
        return self._divide(a, b, beside)

    def _divide(self, a: Point, b: Point, beside) -> bool:
        """`_pass`, in as many parts as it takes until tests at their ends tell what lies in them."""
        ends = ends_between(self.curve, self.bounds, a, b)
        end = first_end(self.curve, ends, a, b)
        if end and not self.bounds[0] <= end.place.value <= self.bounds[1]:  # where it turns: b is within them again
            b = end.place
            end = first_end(self.curve, ends_between(self.curve, self.bounds, a, b), a, b) or end
        if ends and end is None:  # what follows is not a motion
            if not (self._join_contacts() or self._press_for_good(self._last_solution())):
                self.special.append(self._fail_at(a))
            return True
        last = end.place if end else b
        birth = own_birth(self.curve, a, last)
        before = None
        if birth:
            before = before_birth(self.curve, a, birth.share * along(a, last), birth.place)
        elif end and end.event.impact is not None:
            before = self._before_graze(a, last)
        told = before or last
        found = [] if birth else bifurcations(self.curve, a, told if end and turns_at(self.curve, end.event) else last)
        if (
            end and end.event.boundary is not None
        ):  # where rounding does not tell them from the end they may lie beyond it
            found = [one for one in found if abs(one.place.value - last.value) > one.error]
        if before is not None:
            known = {one.event.type for one in found}
            found += [one for one in bifurcations(self.curve, a, before) if one.event.type not in known]
            found.sort(key=lambda one: along(a, one.place))
        if self._divisions and along(a, b) > SHORTEST_STEP and (before or not birth):
            behind = None if end or birth else beside[1]
            c = hidden_between(self.curve, self.bounds, a, before or last, found, (beside[0], behind))
            if c is not None:
                self._divisions -= 1
                return self._divide(a, c, (beside[0], b)) or self._divide(c, b, (a, beside[1]))
        if self._bifurcate(found):
            return True
        if birth:
            self._birth(birth)
            return True
        # a mass that leaves its stop only just before it is back is at rest there within that contact, too
        if end and end.event is SPLIT and self._press_for_good(last.solution):
            return True
        self._add(last)
        if end:
            if end.event.type == "graze":
                self._forget_beside(last.value, end.error)
            self.special.append(self._end(end.event, last, end.error))
        return end is not None

    def _before_graze(self, a: Point, graze: Point) -> Point | None:
        """A point between a and the graze, where multipliers are finite; None where rounding leaves no room for one."""
        length = along(a, graze)
        room = max(BEFORE * length, ABOVE_ROUNDING)
        return self.curve.step(a, length - room, graze) if room < length else None

    def _forget_beside(self, value: float, error: float) -> None:
        """Take back bifurcations that rounding does not tell from the graze: multipliers of free modes are 1 there."""
        error = error if math.isfinite(error) else 0.0  # of singular equations: it does not tell which are near
        while self.special and abs(self.special[-1].parameters[self.name] - value) <= self.special[-1].error + error:
            self.special.pop()

    def _bifurcate(self, found: list[LocatedEvent]) -> bool:
        """Record bifurcations. True where the run ends at the first."""
        for event, _, point, error in found:
            self._add(point)
            if event.type == "neimark_sacker" and not is_torus(point):
                continue
            self.special.append(self._at(event.type, point, error))
            if self.stable:
                return True
        return False

    def _birth(self, found: LocatedEvent) -> None:
        """The branch begins at a flip or pitchfork of its parent."""
        special = self._at(found.event.type, found.place, found.error)
        self._add_solution(found.place.value, special.orbit._solution.repeated(2))
        self.special.append(special)

    def _at(self, of_type: str, point: Point, error: float, multipliers=None, **more) -> SpecialPoint:
        system = self.system.replace(**{self.name: point.value})
        orbit, kind = orbit_of(system, point.solution), KINDS.get(of_type)
        multipliers = point.solution.multipliers if multipliers is None else multipliers
        if kind in (FLIP, TORUS):
            more["criticality"] = criticality(point.solution, kind, self.name)
        return SpecialPoint(of_type, {self.name: point.value}, orbit, multipliers, error, **more)

    def _end(self, event: Event, point: Point, error: float) -> SpecialPoint:
        if event.type != "graze":
            return self._at(event.type, point, error)
        index = event.impact
        if index is None and np.any(gone := shallow(point.solution)):  # behind it the motion passes the stop, too
            index = int(np.argmax(gone))
        if index is not None:  # of those that vanish at once the first
            first = orbit_of(None, point.solution)._canonical_frame[0]
            index = min(vanishing(point.solution, index).tolist(), key=lambda i: (i - first) % point.solution.K)
        try:
            touching = (touching_at_once(point.solution) if index is None else None) or ()
            graze = graze_at(point.solution, self.name, index, *touching)
        except np.linalg.LinAlgError:  # a fold of the orbits without the impact as well: no slopes
            return self._at("failed", point, error or math.nan)
        side = graze.touching.sides[graze.index]
        slope = abs(graze.distance_slope)
        if slope > 0:
            error += float(TOUCHING * point.solution.size_of_gap / slope)
        elif not error:  # it was not located, and the distance from the stop says nothing
            error = math.nan
        impact, multipliers = None, None
        if index is not None:
            multipliers = graze.multipliers
            side, impact = stop_and_impact(point.solution, index)
        return self._at(
            "graze", point, error, multipliers, stop=side, kind=graze.kind, impact=impact,
            direction=1 if graze.distance_slope > 0 else -1,
        )  # fmt: skip


def turns_at(curve: SolutionCurve, event: Event) -> bool:
    """Whether the branch turns where this event ends it, so that tests are 0/0 there: the graze of a smooth contact."""
    return event.impact is not None and is_smooth(curve.orbit.family.linear, curve.orbit.sides[event.impact])


def stop_and_impact(solution: Solution, index: int) -> tuple[int, int]:
    """Stop and index, in `orbit.impacts`, of an impact of a solution; of a symmetric orbit, of its first half."""
    first, _ = orbit_of(None, solution)._canonical_frame
    impact, sides = (index - first) % solution.K, solution.whole().sides
    return sides[(impact + first) % len(sides)], impact
