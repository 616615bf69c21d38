"""A run along a branch without impacts in one direction. Each point is known from the parameter alone.

The gap's amplitude |n.X| with Z X = f, Z = K - omega^2 M + i omega C, has peaks as narrow as the losses are small.
Where Z^-1 Z' times the step is small, X follows its tangent within the step, and so no peak is passed unseen.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from vibro_sweep.analysis.branches.births import is_steady
from vibro_sweep.analysis.branches.branch_run import MOST_POINTS, BranchRun
from vibro_sweep.analysis.continuation.events import Event
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import LONGEST_STEP, SHORTEST_STEP
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.periodic.steady_gap import steady_gap
from vibro_sweep.engine.continuation.branch_tests import PASSED
from vibro_sweep.oscillator.steady import dynamic_stiffness

SHARE = 0.25  # by which Z may change in a step, relative to itself
SHORTEST = 1e-7  # step: an undamped mode that is not driven in its resonance does not stop the run
ASIDE = 1e-7  # of a step, over which a slope is seen
ROUNDED = 48 * float(np.finfo(float).eps)  # of the parameter


@dataclass(frozen=True)
class FreeBranch:
    """The motion `orbit` without impacts along a parameter; unit: of steps; bounds: of the parameter;
    step_factor: of the lengths of steps."""

    orbit: Solution
    names: tuple[str]
    unit: float
    bounds: tuple[tuple[float, float]]
    step_factor: float

    def at(self, value: float, rate: float) -> "FreePoint | None":
        """The point with this parameter; None where there is no such motion."""
        family = self.orbit.family.replace(**{self.names[0]: value})
        point = FreePoint(self, value, rate, replace(self.orbit, family=family))
        return point if is_steady(point.solution, self.names[0]) else None


@dataclass(frozen=True, eq=False)
class FreePoint:
    """A point of such a branch; rate: 1 or -1, the direction in which it is followed."""

    curve: FreeBranch
    value: float
    rate: float
    solution: Solution

    def backwards(self) -> "FreePoint":
        """The same point in the other direction."""
        return replace(self, rate=-self.rate)

    @cached_property
    def stop_distance(self) -> float:
        """Least distance from the stops."""
        return self.solution.stop_distance

    def ahead(self, length: float) -> "FreePoint | None":
        return self.curve.at(self.value + self.rate * length * self.curve.unit, self.rate)


class FreeRun(BranchRun):
    """A run along a branch without impacts in one direction."""

    def follow(self) -> None:
        """Follow the branch to its end."""
        a, count, length, longest = self.first, 1, self.first_step, self.curve.step_factor * LONGEST_STEP
        self._add(a)
        while count < MOST_POINTS and length >= SHORTEST_STEP:
            length = min(length, longest_step(a))
            b = a.ahead(length)
            if b is None:
                length /= 2
                continue
            boundary = max(self.bounds[0], min(b.value, self.bounds[1]))
            if boundary != b.value:
                b = self.curve.at(boundary, b.rate)
            graze = grazes(a, b)
            if graze is not None:
                self._add(graze)
                self.special.append(self._end(Event("graze", None), graze, ROUNDED * abs(graze.value)))
                return
            self._add(b)
            if b.value in self.bounds:
                self.special.append(self._at("boundary", b, 0.0))
                return
            a, count, length = b, count + 1, min(1.5 * length, longest)
            self._show_progress(count, a.value)
        self.special.append(self._at("failed", a, math.nan))


def run_from(first: Point | FreePoint, system, progress=None, stable: bool = False) -> BranchRun:
    """The run along a branch from a point of it."""
    return (FreeRun if isinstance(first, FreePoint) else BranchRun)(first, system, progress, stable)


def longest_step(point: FreePoint) -> float:
    """The step in which Z changes by `SHARE`, in the units of the branch."""
    name, unit, q = point.curve.names[0], point.curve.unit, point.solution.family.linear
    slope = point.solution.family.derivative(name, q)
    turned = slope.omega * (1j * q.C - 2 * q.omega * q.M)
    change = slope.K - q.omega**2 * slope.M + 1j * q.omega * slope.C + turned
    if not np.any(change):
        return np.inf
    root = np.linalg.cholesky(q.M)  # in the norm of the kinetic energy, which units do not change
    Z, change = (np.linalg.solve(root, np.linalg.solve(root, of_z).T).T for of_z in (dynamic_stiffness(q), change))
    share = np.linalg.norm(np.linalg.lstsq(Z, change)[0], 2) * unit
    return max(SHARE / share, SHORTEST) if share > 0 else np.inf


def grazes(a: FreePoint, b: FreePoint) -> FreePoint | None:
    """The first point from a to b at which the motion touches a stop, if it passes it there."""
    inside = max(a.stop_distance, np.finfo(float).tiny)  # at the start rounding may say otherwise
    beyond = (
        b
        if b.stop_distance <= 0 < a.stop_distance or b.stop_distance < -PASSED * b.solution.size_of_gap
        else _highest(a, b)
    )
    if beyond is None:
        return None
    most = 2 * abs(a.stop_distance) if math.isfinite(a.stop_distance) else 1.0

    def test(value: float) -> float:
        if value == a.value:
            return inside
        point = a.curve.at(value, a.rate)
        return -most if point is None else min(point.stop_distance, most)  # in a resonance it is beyond all stops

    return a.curve.at(brentq(test, a.value, beyond.value, xtol=1e-300, rtol=4 * np.finfo(float).eps), a.rate)


def _highest(a: FreePoint, b: FreePoint) -> FreePoint | None:
    """The point between a and b, which stay inside, at which the motion is farthest beyond a stop."""
    if a.solution.is_free or min(a.stop_distance, b.stop_distance) <= 0:
        return None
    ends, aside = sorted((a.value, b.value)), ASIDE * abs(b.value - a.value)
    for side in (1, -1):

        def distance(value: float, side: int = side) -> float:
            q = a.solution.family.replace(**{a.curve.names[0]: value}).linear
            mean, swing = steady_gap(q)
            return side * (float(q.contact.stop(side)) - mean) - abs(swing)

        if all(distance(end + step) < distance(end) for end, step in zip(ends, (aside, -aside), strict=True)):
            least = minimize_scalar(distance, bounds=ends, method="bounded", options={"xatol": aside})
            found = a.curve.at(float(least.x), a.rate)
            if found is not None and found.stop_distance < 0:
                return found
    return None
