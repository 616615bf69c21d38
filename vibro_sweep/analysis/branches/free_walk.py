"""Points of a branch without impacts, and steps between them (as walk.py, of the others).

A point of the branch is x = (t_1, D_1, mean gap, p), in units of 1/omega for times, of the fastest impulse for
impulses, and of the parameter's range. There is an impact where a flight touches a stop, and a mean gap where a mode is
free.
"""

from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibro_sweep.analysis.periodic.impulse_equations import Equations
from vibro_sweep.analysis.periodic.solution import Solution, equations_for
from vibro_sweep.engine.impulses.equations import ROUNDING
from vibro_sweep.model.linear import Linear

ROUNDED = 16 * np.finfo(float).eps  # of the parameter, and of the gap at each impact
MOST_CORRECTIONS = 12
STILL = 1e-5  # in units of a walk: an orbit that Newton's method takes farther off is another one


@dataclass(eq=False)
class FreePoint:
    """A point of a branch; `x` in scaled units."""

    walk: "FreeWalk"
    x: np.ndarray
    equations: Equations
    J: np.ndarray  # (n, n + 1), by scaled unknowns and parameter
    motion: np.ndarray
    residual: float
    corrections: int
    direction: np.ndarray  # roughly forwards
    held: float | None = None  # the parameter, where it is given

    @property
    def guess(self) -> np.ndarray:
        return self.x

    @property
    def p(self) -> float:
        return self.held if self.held is not None else float(self.x[-1] * self.walk.unit)

    def hold(self, value: float) -> None:
        """The parameter is `value`, to the last bit: rounding may put it beyond what is allowed."""
        self.held = value
        self.__dict__.pop("solution", None)

    def backwards(self) -> "FreePoint":
        """The same point of the branch in the other direction."""
        other = copy(self)
        other.direction = -self.direction
        other.__dict__.pop("tangent", None)
        return other

    @cached_property
    def tangent(self) -> np.ndarray:
        """Unit tangent of the branch, scaled units."""
        t = np.linalg.solve(np.vstack([self.J, self.direction]), np.append(np.zeros(len(self.J)), 1.0))
        return t / np.linalg.norm(t)

    @cached_property
    def solution(self) -> Solution:
        return self.walk.solution(np.append(self.x[:-1], self.p / self.walk.unit))

    def rounding(self, normal: np.ndarray) -> float:
        """What rounding of the gap does to the parameter of the point, found on the plane with this normal."""
        axis = np.zeros(len(self.x))
        axis[-1] = self.walk.unit
        weights = np.linalg.solve(np.vstack([self.J, normal]).T, axis)
        moved = np.abs(weights[: self.walk.start.K]).sum() * self.solution.size_of_gap
        return float(ROUNDED * (abs(self.p) + moved))

    @cached_property
    def torus(self) -> float:
        """prod_{i<j} (1 - mu_i mu_j): zero at a Neimark-Sacker point, and at a neutral saddle. 1 without losses."""
        mu = self.solution.multipliers
        if abs(abs(np.prod(mu)) - 1) < 1e-9:
            return 1.0
        i, j = np.triu_indices(len(mu), 1)
        return float(np.prod(1 - mu[i] * mu[j]).real)

    releases, stays = np.empty(0), np.inf  # nothing rests


class FreeWalk:
    """A branch through `start` in the parameter `name`."""

    def __init__(self, start: Solution, name: str, span: float):
        self.start, self.name, self.family, self.unit = start, name, start.family, span
        self.scale = np.append(start.units, span)

    def oscillators(self, values: np.ndarray) -> list[Linear]:
        """At values of the parameter that points of the branch have."""
        return [self.family.replace(**{self.name: p}).linear for p in values.tolist()]

    def with_impact(self, touching: Solution) -> "FreeWalk":
        """The same for orbits with one impact more."""
        return FreeWalk(touching, self.name, self.unit)

    def equations(self, p: float) -> Equations:
        """Raises ParameterError where the parameter leaves what is allowed."""
        q = self.family.replace(**{self.name: p}).linear
        return equations_for(self.start, q, self.family.derivative(self.name, q))

    def correct(self, guess: np.ndarray, normal: np.ndarray, forwards: np.ndarray) -> FreePoint | None:
        """The point of the branch on the plane through `guess` with this normal; None if Newton's method fails."""
        x, before, K = guess.copy(), np.inf, self.start.K
        for corrections in range(1, MOST_CORRECTIONS + 1):
            try:
                e = self.equations(float(x[-1] * self.unit))
                F, J, Fp, motion = e.evaluate(self.start.sides, x[:-1] * self.scale[:-1])
                rows = np.hstack([J, Fp[:, None]]) * self.scale
                step = np.linalg.solve(np.vstack([rows, normal]), np.append(F, normal @ (x - guess)))
            except (np.linalg.LinAlgError, ValueError):  # also a parameter beyond its range
                return None
            change = float(np.abs(step).max())
            if not change <= 1:
                return None
            x = x - step
            size = ROUNDING * self.start.size_of_gap
            held = np.abs(F[:K]).max(initial=0.0) <= size
            if change <= 1e-15 or (change < (1e-7 if held else 1e-9) and change >= 0.3 * before):
                try:  # rounding moves the parameter of a nearly neutral orbit by more than what it leaves of the gaps
                    moved = np.abs(rows[:K, -1] * step[-1]).max(initial=0.0) > size
                    e = self.equations(float(x[-1] * self.unit)) if moved else e
                except ValueError:
                    return None
                return FreePoint(self, x, e, rows, motion, change, corrections, forwards)
            before = change
        return None

    def first(self, forwards: float) -> FreePoint | None:
        """`start` itself; `forwards`: sign of the parameter's change.

        None where Newton's method fails, or leads to another orbit.
        """
        point = self._first
        return point if point is None or forwards == 1 else point.backwards()

    @cached_property
    def _first(self) -> FreePoint | None:
        x, axis = self.of(self.start), np.zeros(len(self.scale))
        axis[-1] = 1.0
        point = self.correct(x, axis, axis)
        if point is None or np.abs(point.x - x).max() > STILL:
            return None
        point.hold(self.family.numbers[self.name])
        return point

    def step(self, point: FreePoint, length: float, near: np.ndarray | None = None) -> FreePoint | None:
        """The point of the branch whose projection on the tangent at `point` is `length`; near: a guess."""
        tangent = point.tangent
        guess = point.x + length * tangent
        if near is not None:
            guess = near + (length - tangent @ (near - point.x)) * tangent
        return self.correct(guess, tangent, tangent)

    def beside_start(self, length: float) -> FreePoint | None:
        """The point of the branch at a distance from the start, also where that is a fold."""
        start = self.start
        _, J, Fp, _ = self.equations(self.family.numbers[self.name]).evaluate(start.sides, start.u)
        tangent = np.linalg.svd(np.hstack([J, Fp[:, None]]) * self.scale)[2][-1]
        return self.correct(self.of(start) + length * tangent, tangent, tangent)

    def between(self, a: FreePoint, b: FreePoint, share: float) -> np.ndarray:
        """On the cubic through a and b with their tangents."""
        rest, length = 1 - share, np.linalg.norm(b.x - a.x)
        bend = share * rest * length * (rest * a.tangent - share * b.tangent)
        return rest**2 * (1 + 2 * share) * a.x + share**2 * (1 + 2 * rest) * b.x + bend

    def with_value(self, guess: np.ndarray, index: int, value: float) -> np.ndarray:
        """With another value of the unknown `index`."""
        guess[index] = value
        return guess

    def shaken(self, guess: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Moved by a small change."""
        return guess + change

    def of(self, solution: Solution) -> np.ndarray:
        """A guess that is this orbit."""
        return np.append(solution.u, solution.family.numbers[self.name]) / self.scale

    def solution(self, guess: np.ndarray) -> Solution:
        """The orbit of a guess."""
        family, s = self.family.replace(**{self.name: float(guess[-1] * self.unit)}), self.start
        return Solution(family, s.sigma, s.halves, s.sides, guess[:-1] * self.scale[:-1])

    def ahead(self, point: FreePoint) -> Solution:
        """The orbit to which the tangent leads, at the distance 1, with the parameter of the point."""
        return self.solution(np.append((point.x + point.tangent)[:-1], point.p / self.unit))

    def with_touch(self, guess: np.ndarray, touching: Solution, index: int) -> np.ndarray:
        """The guess with one impact more, the impact `index` of `touching`, which has no speed."""
        phase = touching.times[index] * self.start.family.linear.omega
        return np.insert(guess, [index, self.start.K + index], [phase, 0.0])

    def without_touch(self, guess: np.ndarray, index: int) -> np.ndarray:
        """A guess of a walk with one impact more, without that."""
        return np.delete(guess, [index, self.start.K + 1 + index])
