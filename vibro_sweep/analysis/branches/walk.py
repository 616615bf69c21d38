"""Pseudo-arclength steps along a branch of periodic orbits, with exact derivatives by the unknowns and the parameter.

A point of the branch is x = (t_1 .. t_K, D_1 .. D_K, (c), p). Distances are measured in units of 1/omega for times, of
the fastest impulse for impulses, and of the parameter's range.
"""

from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibro_sweep.analysis.periodic.impulse_equations import (
    Equations,
    check_unknowns,
    contacts_of,
    moves_stops_only,
    moves_stops_straight,
)
from vibro_sweep.analysis.periodic.long_orbits import (
    SPARSE,
    influence,
    is_sparse,
    residual,
    sign_and_log_det,
    solve_bordered,
)
from vibro_sweep.analysis.periodic.solution import Solution, equations_for
from vibro_sweep.engine.impulses import across
from vibro_sweep.engine.impulses.across import MOST_CORRECTIONS
from vibro_sweep.engine.impulses.equations import ROUNDING
from vibro_sweep.engine.impulses.green import space
from vibro_sweep.model.linear import CONTACT, Linear

PHASE = 1 / 16  # of the rounding of the gap: that of 1 radian of the force, twice what is lost at most
STILL = 1e-5  # in units of a walk: an orbit that Newton's method takes farther off is another one


@dataclass(eq=False)
class Point:
    """A point of a branch; `x` in scaled units."""

    walk: "Walk"
    x: np.ndarray
    equations: Equations
    J: np.ndarray  # (n, n + 1), by scaled unknowns and parameter; where the equations are sparse (n, 1), by the latter
    motion: np.ndarray
    change: float
    corrections: int
    direction: np.ndarray  # roughly forwards
    held: float | None = None  # the parameter, where it is given

    @property
    def p(self) -> float:
        return self.held if self.held is not None else float(self.x[-1] * self.walk.scale[-1])

    def hold(self, value: float) -> None:
        """The parameter is `value`, to the last bit: rounding may put it beyond what is allowed."""
        self.held = value
        self.__dict__.pop("solution", None)

    def backwards(self) -> "Point":
        """The same point of the branch in the other direction."""
        other = copy(self)
        other.direction = -self.direction
        other.__dict__.pop("tangent", None)
        return other

    @cached_property
    def tangent(self) -> np.ndarray:
        """Unit tangent of the branch, scaled units."""
        n = len(self.x)
        t = self.walk.solve(self.equations, self.x, self.J, self.motion, self.direction, np.zeros(n - 1), 1.0)
        return t / np.linalg.norm(t)

    @cached_property
    def solution(self) -> Solution:
        w = self.walk
        u = self.x[:-1] * w.scale[:-1]
        family = w.family.replace(**{w.name: self.p})
        s = w.start
        if self.held is None:
            family.__dict__["linear"] = self.equations.q
        solution = Solution(family, s.sigma, s.halves, s.sides, u, self.change, s.rests)
        solution.__dict__["equations"] = self.equations  # both are known
        return solution

    def sensitivity(self, normal: np.ndarray) -> float:
        """By how much the parameter moves, on the plane with this normal, where all gaps at impacts are off by their
        size. Of a long orbit also where gaps and speeds are off, each by chance, as far as rounding of omega t moves
        the force: that grows with t."""
        w, K = self.walk, self.walk.start.K
        if is_sparse(self.equations, w.start.sides):
            u, column = self.x[:-1] * w.scale[:-1], self.J[:, -1] / w.scale[-1]
            weights = influence(self.equations, w.start.sides, u, self.motion, column, normal / w.scale)
            late = PHASE * np.abs(u[:K]) * self.equations.q.omega
            speed = self.solution.size_of_gap * self.equations.q.omega
            turned = np.hypot(weights[:K] * self.solution.size_of_gap, weights[K : 2 * K] * speed) * late
            return float(np.abs(weights[:K]).sum() * self.solution.size_of_gap + np.linalg.norm(turned))
        else:
            axis = np.zeros(len(self.x))
            axis[-1] = w.scale[-1]
            weights = np.linalg.solve(np.vstack([self.J, normal]).T, axis)
        return float(np.abs(weights[:K]).sum() * self.solution.size_of_gap)

    @cached_property
    def reflection(self) -> tuple[float, float]:
        """Sign and logarithm of |det J(-1)|, zero at a flip (pitchfork)."""
        w = self.walk
        u, sides = self.x[:-1] * w.scale[:-1], w.start.sides
        if is_sparse(self.equations, sides):
            return sign_and_log_det(self.equations, sides, u, self.motion, -1)
        sign, size = np.linalg.slogdet(self.equations.linearised(-1, sides, u, self.motion))
        return float(sign), float(size)

    @cached_property
    def torus(self) -> float:
        """prod_{i<j} (1 - mu_i mu_j): zero at a Neimark-Sacker point, and at a neutral saddle. 1 without losses."""
        mu = self.solution.multipliers
        if abs(abs(np.prod(mu)) - 1) < 1e-9:
            return 1.0
        i, j = np.triu_indices(len(mu), 1)
        return float(np.prod(1 - mu[i] * mu[j]).real)

    @cached_property
    def releases(self) -> np.ndarray:
        """(K,) acceleration away from the stop just after an impact with R = 0; infinite for other impacts."""
        e, sides = self.equations, np.array(self.walk.start.sides, float)
        s = space(e.q)
        after = self.motion[:, 1] + self.solution.jumps * (s.e_g @ s.A @ (s.A @ s.e_v))
        leaves = np.where(e.q.restitution(sides) == 0, -sides * after, np.inf)
        leaves[list(self.walk.start.rests)] = np.inf
        return leaves

    @cached_property
    def stays(self) -> float:
        """The least of what makes a rest: its length, in 1/omega, and the acceleration into the stop; inf without."""
        s, omega = self.solution, self.solution.family.linear.omega
        if not s.rests:
            return np.inf
        lengths = (s.ends - s.times[list(s.rests)]) * omega
        return float(min(lengths.min(), s.hold / (omega**2 * s.size_of_gap)))


class Walk:
    """A branch through `start` in the parameter `name`."""

    def __init__(self, start: Solution, name: str, span: float):
        self.start, self.name, self.family = start, name, start.family
        self.media: dict[float, np.ndarray | None] = {}  # of compiled steps, by where they are centred
        self.scale = np.append(start.units, span)
        self._contact_only = not start.rests and moves_stops_only(self.family.derivative(name))
        self._straight = self._contact_only and moves_stops_straight(self.family, name, float(span))

    def oscillators(self, values: np.ndarray) -> list[Linear]:
        """At values of the parameter that points of the branch have."""
        if self._straight:
            q, slope = self.family.stops(self.name, self.family.linear)
            at_start, slopes = (np.array(one[-len(CONTACT) :]) for one in (q, slope))
            moved = np.multiply.outer(values - self.family.numbers[self.name], slopes)
            return [q._replace(**dict(zip(CONTACT, row, strict=True))) for row in (at_start + moved).tolist()]
        families = [self.family.replace(**{self.name: p}) for p in values.tolist()]
        if self._contact_only:
            return [family.stops(self.name, self.family.linear)[0] for family in families]
        return [family.linear for family in families]

    def with_impact(self, start: Solution, index: int) -> "Walk":
        """The same for `start`, orbits of this walk with one impact more, which is its impact `index`."""
        longer, K = copy(self), self.start.K
        for name in ("_contacts", "_first"):
            longer.__dict__.pop(name, None)
        longer.start = start
        longer.scale = np.insert(self.scale, [index, K + index], self.scale[[0, K]])
        return longer

    def equations(self, p: float) -> Equations:
        """Raises ParameterError where the parameter leaves what is allowed."""
        family = self.family.replace(**{self.name: p})
        if self._contact_only:
            return self.start.equations.with_stops(*family.stops(self.name, self.start.equations.q))
        q = family.linear
        return equations_for(self.start, q, family.derivative(self.name, q))

    @cached_property
    def _contacts(self) -> np.ndarray:
        q, slope = self.family.stops(self.name, self.family.linear)
        return contacts_of(q, slope, self.start.sides)

    def correct(self, guess: np.ndarray, normal: np.ndarray, forwards: np.ndarray) -> Point | None:
        """The point of the branch on the plane through `guess` with this normal; None if Newton's method fails."""
        sparse = is_sparse(self.start.equations, self.start.sides)
        if self._straight and self.start.K < SPARSE:  # the kernel eliminates one by one; LAPACK is faster from there on
            return self._corrected_at_once(guess, normal, forwards)
        x, before = guess.copy(), np.inf
        for corrections in range(1, MOST_CORRECTIONS + 1):
            try:
                e = self.equations(float(x[-1] * self.scale[-1]))
                u = x[:-1] * self.scale[:-1]
                if sparse:
                    F, Fp, motion = residual(e, self.start.sides, u)
                    rows = Fp[:, None] * self.scale[-1]
                else:
                    F, J, Fp, motion = e.evaluate(self.start.sides, u)
                    rows = np.hstack([J, Fp[:, None]]) * self.scale
                step = self.solve(e, x, rows, motion, normal, F, normal @ (x - guess))
            except (np.linalg.LinAlgError, ValueError):  # also a parameter beyond its range
                return None
            change = float(np.abs(step).max())
            if not change <= 1:
                return None
            x = x - step
            t = x[: self.start.K] * self.scale[0]
            if len(t) and not (np.all(np.diff(t) > 0) and t[-1] - t[0] < e.P):
                return None
            held = np.abs(F[: self.start.K]).max(initial=0.0) <= ROUNDING * self.start.size_of_gap
            if change <= 1e-15 or (change < (1e-7 if held else 1e-9) and change >= 0.3 * before):
                e = self._moved(e, x, np.abs(rows[: self.start.K, -1] * step[-1]).max(initial=0.0))
                return e and Point(self, x, e, rows, motion, change, corrections, forwards)
            before = change
        return None

    def _moved(self, e: Equations, x: np.ndarray, left: float) -> Equations | None:
        """The equations at x, after a last correction that leaves `left` of the gaps in those before it, e.

        Rounding moves the parameter of a long, nearly neutral orbit by more than what it leaves of the gaps elsewhere.
        None where the parameter is beyond its range.
        """
        if left <= ROUNDING * self.start.size_of_gap:
            return e
        try:
            return self.equations(float(x[-1] * self.scale[-1]))
        except ValueError:
            return None

    def _corrected_at_once(self, guess: np.ndarray, normal: np.ndarray, forwards: np.ndarray) -> Point | None:
        """`correct` by a kernel (engine/impulses/across.py)."""
        n, e = len(guess) - 1, self.start.equations
        check_unknowns(guess[:-1], e.size(self.start.sides))
        x, J, motion = np.empty(n + 1), np.empty((n, n + 1)), np.empty((self.start.K, 3))
        count, change = across.correct(
            e.train, e.steady, self._contacts, float(self.family.numbers[self.name]), np.empty((self.start.K, 4)),
            self.scale, guess, normal, float(self.start.size_of_gap), x, J, motion,
            np.empty((7, max(n + 1, 4))), np.empty((n + 1, n + 1)),
        )  # fmt: skip
        if not count:
            return None
        try:
            moved = self.equations(float(x[-1] * self.scale[-1]))
        except ValueError:  # the parameter is beyond its range
            return None
        return Point(self, x, moved, J, motion, change, count, forwards)

    def solve(self, e: Equations, x, J, motion, row, F, last: float) -> np.ndarray:
        """The solution of [J; row] step = [F; last] in scaled units; J, as of `Point`, belongs to x. LinAlgError."""
        if not is_sparse(e, self.start.sides):
            return np.linalg.solve(np.vstack([J, row]), np.append(F, last))
        u, scale = x[:-1] * self.scale[:-1], self.scale
        return solve_bordered(e, self.start.sides, u, motion, J[:, -1] / scale[-1], row / scale, F, last) / scale

    def first(self, forwards: float) -> Point | None:
        """`start` itself; `forwards`: sign of the parameter's change.

        None where Newton's method fails, or leads to another orbit, as at a fold to that from which it was born.
        """
        point = self._first
        return point if point is None or forwards == 1 else point.backwards()

    @cached_property
    def _first(self) -> Point | None:
        value = self.family.numbers[self.name]
        x = np.append(self.start.u, value) / self.scale
        axis = np.zeros(len(x))
        axis[-1] = 1.0
        point = self.correct(x, axis, axis)
        if point is None or np.abs(point.x - x).max() > STILL:
            return None
        point.hold(value)
        return point

    def step(self, point: Point, length: float, secant: np.ndarray | None = None) -> Point | None:
        """The point of the branch whose projection on the tangent at `point` is `length`."""
        tangent = point.tangent
        guess = point.x + length * tangent
        if secant is not None:
            guess = secant + (length - tangent @ (secant - point.x)) * tangent
        return self.correct(guess, tangent, tangent)
