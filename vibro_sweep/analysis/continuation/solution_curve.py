"""Points of a branch or a curve with the exact oscillator: corrections, and what is read there."""

from bisect import bisect_left, insort
from copy import copy as copy_object

import numpy as np

from vibro_sweep.analysis.continuation.oscillators import Oscillators
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit, keeps_symmetry
from vibro_sweep.analysis.periodic.contact_numbers import EventUnits, compliant_stops, one_plus_R
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.engine.continuation import path, stepper
from vibro_sweep.engine.continuation.curve_tests import TOUCHING
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.continuation.problem import GRAZE, STICK, Problem, unknowns
from vibro_sweep.engine.continuation.workspace import TEST, Place, new_workspace
from vibro_sweep.oscillator.family import Family

LONGEST_STEP, SHORTEST_STEP = 0.05, 1e-11
STRAIGHT = 0.1  # radians between the tangents of neighbouring points, at most
BESIDE = 2e-3
ASIDE = 2.0  # times the distance of two points, how far from the first a point between them may lie
AT_ONCE = 1024  # points of one call


class NoPlaneError(VibroSweepError, ValueError):
    """The oscillator has no polynomials around a point of the plane."""


class SolutionCurve:
    """A branch in one parameter, a curve of one kind in two, or a single point, through `start`."""

    def __init__(self, start: StartingOrbit, names: tuple[str, ...], bounds, unit=None, step: float = 1.0):
        """bounds : ends of each parameter; unit: of distances in each, by default the length of its side; step: of the
        lengths of all steps, a factor"""
        self.start, self.orbit, self.names, self.step_factor = start, start.solution, names, step
        self.bounds = np.array([*bounds, *[(-np.inf, np.inf)] * (2 - len(names))], float)
        self.unit = np.append(np.ptp(bounds, axis=1) if unit is None else unit, [1.0] * (2 - len(names)))
        s = self.orbit
        q = s.family.linear
        self.units = EventUnits(float(s.size_of_gap), float(q.omega))
        self.tau = float(q.tau)  # by which phases become times: those of the curve do not move with it
        self._taus = [(s.family.free[names[0]], self.tau)]
        self.oscillators = Oscillators(s.family, names, s.half_periods, self.units)
        self.n = 2 * q.masses
        self._take_sides(s.sides)
        planes = self.oscillators.around(self.bounds.mean(axis=1), self.unit / 2) if len(names) > 1 else None
        self.planes = self._around([s.family.free[name] for name in names]) if planes is None else planes

    def _take_sides(self, which: tuple[int, ...]) -> None:
        """Set the stops of the impacts, and what follows from them."""
        start, s = self.start, self.orbit
        q, K, kind = s.family.linear, len(which), self.start.kind
        self.K = K
        struck = which[: start.index] + which[start.index + 1 :] if kind == GRAZE and K % 2 else which
        half, whole = len(struck) // 2, s.sigma == 1 and len(struck) > 0 and len(struck) % 2 == 0
        whole = whole and kind != STICK
        repeats = whole and s.half_periods % 4 == 0 and struck[:half] == struck[half:]
        mirrors = whole and s.half_periods % 4 == 2 and struck[:half] == tuple(-side for side in struck[half:])
        mirrors = mirrors and q.symmetric and all(keeps_symmetry(s.family, name) for name in self.names)
        sides, rests, count = np.array(which, float), np.isin(np.arange(K), s.rests), len(self.names)
        kinds, orbit = (kind, start.index, sides, rests), (float(s.sigma), count, self.unit, repeats, mirrors)
        self.problem = Problem(*kinds, *orbit, compliant_stops(q))
        self.workspace = new_workspace(K, self.n)
        self.path = path.new_path(AT_ONCE, K, self.n, *self._limits(), self.bounds)

    def _limits(self) -> tuple[float, float, float]:
        """The longest and the shortest step, and the turn of the tangent in one."""
        return self.step_factor * LONGEST_STEP, SHORTEST_STEP, self.step_factor * STRAIGHT

    def resized(self, K: int) -> "SolutionCurve":
        """The same curve with K impacts: without the last, or with more on the same stop."""
        other, sides = copy_object(self), tuple(map(int, self.problem.sides))
        other._take_sides(sides[:K] + sides[-1:] * (K - len(sides)))
        return other

    @property
    def state_units(self) -> np.ndarray:
        """(n,) of contact coordinates."""
        return np.repeat([self.units.length, self.units.speed], self.n // 2)

    def _around(self, centre) -> np.ndarray:
        found = self.oscillators.around(centre, self.unit / len(self.names))
        if found is None:
            raise NoPlaneError(
                f"bounds: around {tuple(map(float, centre))} the oscillator is not a smooth function of it, "
                "or they are too wide for it"
            )
        return found

    def recentre(self, place: Place) -> None:
        """Set the polynomials anew, around this place."""
        self.planes = self._around(place.p)

    def run_task(self, task: int, place: Place, row: np.ndarray | None = None) -> float:
        """Run one task of `stepper.at`, which leaves its results in `workspace`."""
        row = place.direction if row is None else row
        return stepper.at(task, self.planes, self.problem, self.path, Place._make(place), row, self.workspace)

    def take_numbers(self, place: Place) -> bool:
        """Take the oscillator's numbers at the parameters of `place`. False where there is none."""
        try:
            if np.any(np.abs(place.p[:2] - self.planes[0]["centre"]) > self.planes[0]["reach"]):
                self.recentre(place)  # slopes of the polynomials mean nothing beyond their reach
            self.planes[0]["exact"] = self.oscillators.values(place.p)
        except (ValueError, ZeroDivisionError, np.linalg.LinAlgError):
            return False
        return bool(np.isfinite(place.p).all())

    def move_to(self, place: Place) -> bool:
        """Move the oscillator exactly to the parameters of `place`. False where it has no forced motion."""
        return self.take_numbers(place) and bool(self.run_task(stepper.MOVE, place))

    def assemble(self, place: Place, row: np.ndarray | None = None) -> bool:
        """Leave the equations at `place` in `workspace`. False where they are singular."""
        return self.move_to(place) and bool(self.run_task(stepper.ASSEMBLE, place, row))

    def take_steps(self, place: Place) -> int:
        """Compiled steps from `path.a` until something happens, and why they end (engine/continuation/stepper.py)."""
        return int(self.run_task(stepper.STEPS, place, np.zeros(2 * self.K + 3)))

    def motion(self, place: Place) -> np.ndarray:
        """(K, 2) gap velocity and acceleration before each impact."""
        self.assemble(place)
        return self.workspace.events["motion"] * self.units.speed * [1.0, self.units.rate]

    def tail(self, place: Place) -> np.ndarray:
        """`numbers` of what follows the last impact written out, of an onset of sticking: times."""
        self.assemble(place)
        return self.workspace.tail[0]["numbers"] / self.units.rate

    def nearest(self, place: Place) -> tuple[float, int]:
        """Time and side of the turning point nearest to its stop."""
        self.take_numbers(place)
        self.run_task(stepper.EXAMINE, place)
        _, phase, side = self.workspace.work[0]["nearest"]
        return float((phase - self.tau) / self.omega(place)), int(side)

    def omega(self, place: Place) -> float:
        """The angular frequency of the force."""
        return float(self.family(place).linear.omega)

    def times(self, place: Place) -> np.ndarray:
        """(K,) of the impacts, for the phase `tau` of the start."""
        return (place.phases - self.tau) / self.omega(place)

    def period(self, place: Place) -> float:
        return float(np.pi * self.orbit.half_periods / self.omega(place))

    def beside(self, place: Place) -> list[Point]:
        """Points of the curve within the bounds, a little beside `place`."""
        found = [self.step(place, length) for length in (BESIDE, -BESIDE)]
        lo, hi = self.bounds.T
        return [one for one in found if one is not None and np.all((lo <= one.p[:2]) & (one.p[:2] <= hi))]

    def step(self, place: Place, length: float, near: Place | None = None) -> Point | None:
        """The point whose projection on the tangent at `place` is `length`; near: a guess."""
        if near is not None:
            length -= float(place.direction @ self.difference(place, near))
        return self.correct(self.moved(near or place, length, place), place.direction)

    def level(self, place: Place, axis: int, value: float) -> Point | None:
        """The point of the curve near `place` where the parameter `axis` (0, 1) has this value."""
        slope = self.problem.unit[axis] * place.tangent_p[axis]
        if abs(value - place.p[axis]) > 2 * self.step_factor * LONGEST_STEP * abs(slope):  # it turns back before
            return None
        guess = self.moved(place, (value - place.p[axis]) / slope if slope else 0.0)
        guess.p[axis] = value
        return self.correct(guess, self.axis(axis))

    def at_value(self, a: Place, b: Place, axis: int, value: float) -> Point | None:
        """The point between a and b where the parameter `axis` has this value, which lies between theirs.

        None where Newton's method finds none, or one that is not between them.
        """
        change = b.p[axis] - a.p[axis]
        guess = self.between(a, b, (value - a.p[axis]) / change)
        guess.p[axis] = value
        found = self.correct(guess, np.sign(change) * self.axis(axis))
        if found is None or self.distance(a, found) > ASIDE * self.distance(a, b):
            return None
        return found

    def axis(self, parameter: int) -> np.ndarray:
        """The plane on which a parameter (or theta) is held."""
        return np.eye(1, 2 * self.K + 3, 2 * self.K + parameter)[0]

    def copied(self, place: Place) -> Point:
        """The same point, with arrays of its own."""
        return Point(self, Place(*(values.copy() for values in place)))

    def moved(self, place: Place, length: float, along: Place | None = None) -> Point:
        """A guess on the tangent, or on one parallel to that at another place."""
        guess, along = self.copied(place), along or place
        guess.x[:] += length * along.tangent
        guess.p[:] += length * along.tangent_p * [*self.problem.unit, 1.0]
        return guess

    def taken_apart(self, place: Place, first: np.ndarray, parameters: np.ndarray) -> np.ndarray:
        """(2 K + 3,) phases, jumps, parameters of a change with this xi_1, after `assemble`."""
        null = self.workspace.work[0]["null"]
        null[:] = 0.0
        null[: self.n], null[self.n : self.n + len(parameters)] = first, parameters
        self.run_task(stepper.TAKE_APART, place)
        changes = self.workspace.events["changes"][:, 1]
        return np.concatenate([changes[:, self.n], changes[:, self.n + 1], null[self.n :]])

    def unit_row(self, change: np.ndarray) -> np.ndarray:
        """The row of the plane across a change."""
        return change / np.linalg.norm(change)

    def correct(self, guess: Place, row: np.ndarray, exact: bool = True) -> Point | None:
        """The point of the curve on the plane through `guess` across `row`, examined; None: none was found.

        exact : of the oscillator itself, or of its polynomials, which is ten times as fast and nearly the same
        """
        place = self.copied(guess)
        near = self.run_task(stepper.NEAR, place, row)
        if not exact:
            return place if near else None
        place = place if near else self.copied(guess)
        return place if self.take_numbers(place) and self.run_task(stepper.SOLVE, place, row) else None

    def parameters(self, place: Place) -> np.ndarray:
        """The free parameters of a place, (1,) or (2,)."""
        return place.p[: len(self.names)]

    def between(self, a: Place, b: Place, share: float) -> Point:
        """The point at a share of the secant from a to b, as a guess."""
        return self.shifted(a, a, b, share)

    def shifted(self, place: Place, a: Place, b: Place, share: float) -> Point:
        """`place` moved by a share of the secant from a to b."""
        result = self.copied(place)
        result.x[:] += share * (b.x - a.x)
        result.p[:] += share * (b.p - a.p)
        return result

    def distance(self, a: Place, b: Place) -> float:
        return float(np.linalg.norm(self.difference(a, b)))

    def difference(self, a: Place, b: Place) -> np.ndarray:
        """The change from a to b, with the entries of `direction`."""
        moved = (b.p - a.p) / [*self.problem.unit, 1.0]
        moved[unknowns(self.problem) :] = 0.0
        return np.concatenate([b.phases - a.phases, b.jumps - a.jumps, moved])

    def is_real(self, place: Place) -> bool:
        """Whether all impulses but the grazing one push, and every flight stays inside."""
        pushes = np.where(self.problem.rests, 1.0, -self.problem.sides) * place.jumps
        if self.problem.kind >= GRAZE:
            pushes = np.delete(pushes, self.problem.index)
        holds = min(place.tests[TEST.hold], place.tests[TEST.relaxed]) > -TOUCHING
        return bool(np.all(pushes > 0) and place.tests[TEST.stop_distance] > -TOUCHING and holds)

    def family(self, place: Place) -> Family:
        return self.oscillators.at(place.p)

    def solution(self, place: Place) -> Solution:
        """The orbit of a point."""
        s, family = self.orbit, self.family(place)
        t = (place.phases - self._tau_of(place)) / family.linear.omega
        sides, rests = tuple(map(int, self.problem.sides)), self.problem.rests
        ends = (t + place.jumps / family.linear.omega)[rests]
        jumps = np.where(rests, -self.speeds(place), place.jumps) if len(ends) else place.jumps
        u = np.concatenate([t, jumps * self.units.speed, ends])
        return Solution(family, s.sigma, s.half_periods, sides, u, float(place.tests[TEST.residual]), s.rests)

    def _tau_of(self, place: Place) -> float:
        """The phase of the force, by which phases become times; on a curve they are as near to the start's as they can
        without a change of the motion."""
        if len(self.names) == 1:
            return self.tau_at(place.p[0])
        q = self.family(place).linear
        turns = (place.phases[0] - q.tau - q.omega * self.orbit.times[0]) / (2 * np.pi)
        return q.tau + 2 * np.pi * round(turns)

    def tau_at(self, p: float) -> float:
        """The phase of the force, a continuous function of the parameter of a branch: times do not jump."""
        if not self.oscillators.slopes[0].tau:
            return self.tau
        i = bisect_left(self._taus, p, key=lambda known: known[0])
        near = min(self._taus[max(i - 1, 0) : i + 1], key=lambda known: abs(known[0] - p))
        if near[0] == p:
            return near[1]
        tau = float(self.oscillators.at([p]).linear.tau)
        tau += 2 * np.pi * round((near[1] - tau) / (2 * np.pi))
        insort(self._taus, (p, tau))
        return tau

    def speeds(self, place: Place) -> np.ndarray:
        """(K,) velocities of the gap before the impacts, in units of the curve."""
        self.move_to(place)
        N = self.n // 2
        return place.x[:, N] + (self.planes[0]["Z"][N] * np.exp(1j * place.phases)).real

    def releases(self, place: Place) -> np.ndarray:
        """(K,) acceleration away from the stop just after an impact with R = 0; infinite for other impacts."""
        sides, rests = self.problem.sides, self.problem.rests
        R = one_plus_R(self.family(place).linear, sides) - 1
        if np.all(R > 0):
            return np.full(len(sides), np.inf)
        self.assemble(place)
        N, events = self.n // 2, self.workspace.events
        after = events["motion"][:, 1] + self.planes[0]["numbers"][OMEGA] * events["bend"][:, N]
        return np.where((R == 0) & ~rests, -sides * after, np.inf)


def branch_through(
    solution: Solution, name: str, unit: float, bounds=(-np.inf, np.inf), step: float = 1.0
) -> SolutionCurve:
    """The branch of an orbit in one parameter. Raises NoPlaneError, TooStiffError."""
    return SolutionCurve(StartingOrbit("orbit", solution), (name,), [bounds], [unit], step)


def copy(source: Place, target: Place) -> None:
    for here, there in zip(source, target, strict=True):
        there[...] = here
