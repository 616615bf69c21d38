"""Points of a bifurcation curve with the exact oscillator: the first one, corrections, what is read there."""

from copy import copy as copy_object

import numpy as np

from vibro_sweep.analysis.branches.beginning import keeps_symmetry
from vibro_sweep.analysis.curves.oscillators import Oscillators
from vibro_sweep.analysis.curves.start import Start
from vibro_sweep.analysis.periodic.solution import Solution, equations_for
from vibro_sweep.engine.impulses import curve, curve_path, locus
from vibro_sweep.engine.impulses.curve_tests import RESIDUAL
from vibro_sweep.engine.impulses.locus import Curve, Place
from vibro_sweep.model.linear import Family, forcing_period

MOST_CORRECTIONS = 12
LONGEST_STEP, SHORTEST_STEP = 0.05, 1e-10
STRAIGHT = 0.1  # radians between the tangents of neighbouring points, at most
BESIDE = 2e-3
AT_ONCE = 1024  # points of one call


class NoPlaneError(ValueError):
    """The oscillator has no polynomials around a point of the plane."""


class Tracer:
    """A curve of one kind through `start`, in the parameters `names`, with distances in units of the box."""

    def __init__(self, start: Start, names: tuple[str, str], box):
        self.start, self.names = start, names
        self.box = np.array(box, float)
        s = start.solution
        q = s.family.linear
        self.oscillators = Oscillators(s.family, names, s.halves, float(q.tau))
        self.n, self.size_of_gap = 2 * len(q.along), s.size_of_gap
        self._take_sides(s.sides)
        middle, reach = self.box.mean(axis=1), np.ptp(self.box, axis=1) / 2
        planes = self.oscillators.around(middle, reach)
        self.planes = self._around([s.family.numbers[name] for name in names], reach) if planes is None else planes

    def _take_sides(self, which: tuple[int, ...]) -> None:
        """Of the impacts."""
        start, s = self.start, self.start.solution
        q, K, n = s.family.linear, len(which), self.n
        self.K, self.S = K, 2 * K + n
        speed = q.omega * self.size_of_gap
        states = np.repeat([speed / q.omega, speed], n // 2)
        unit = np.concatenate([np.full(K, 1 / q.omega), np.full(K, speed), states, np.ptp(self.box, axis=1), [1.0]])
        row_unit = np.concatenate([np.full(K, speed / q.omega), np.full(K, speed), states])
        sides = np.array(which, float)
        struck = which[: start.index] + which[start.index + 1 :] if start.kind == locus.GRAZE and K % 2 else which
        half, whole = len(struck) // 2, s.sigma == 1 and len(struck) > 0 and len(struck) % 2 == 0
        whole = whole and start.kind != locus.STICK
        repeats = whole and s.halves % 4 == 0 and struck[:half] == struck[half:]
        symmetric = q.symmetric and all(keeps_symmetry(s.family, name) for name in self.names)
        mirrors = whole and symmetric and s.halves % 4 == 2 and struck[:half] == tuple(-side for side in struck[half:])
        self.curve = Curve(start.kind, start.index, sides, float(s.sigma), unit, row_unit, repeats, mirrors)
        self.bench = locus.new_bench(K, n)
        self.path = curve_path.new_path(AT_ONCE, K, n, LONGEST_STEP, SHORTEST_STEP, STRAIGHT, self.box)

    def resized(self, K: int) -> "Tracer":
        """For the same curve with K impacts: without the last, or with more on the same stop."""
        other, sides = copy_object(self), tuple(map(int, self.curve.sides))
        other._take_sides(sides[:K] + sides[-1:] * (K - len(sides)))
        return other

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.S + (3 if self.curve.kind == locus.TORUS else 2)

    def _around(self, centre, reach) -> np.ndarray:
        found = self.oscillators.around(centre, reach)
        if found is None:
            raise NoPlaneError(f"box: around {tuple(map(float, centre))} the oscillator is no smooth function of it")
        return found

    def recentre(self, place: Place) -> None:
        """Polynomials around this place."""
        self.planes = self._around(place.p, np.ptp(self.box, axis=1) / 2)

    def do(self, task: int, place: Place, row: np.ndarray | None = None) -> float:
        """One task of `curve.at`; what it leaves is in `bench`."""
        row = place.tangent if row is None else row
        return curve.at(task, self.planes, self.curve, self.path, place, row, self.bench)

    def take(self, place: Place) -> bool:
        """Take the oscillator's numbers at the parameters of `place`. False where there is none."""
        try:
            if np.any(np.abs(place.p[:2] - self.planes[0]["centre"]) > self.planes[0]["reach"]):
                self.recentre(place)  # slopes of the polynomials mean nothing beyond their reach
            self.planes[0]["exact"] = self.oscillators.values(place.p)
        except (ValueError, ZeroDivisionError, np.linalg.LinAlgError):
            return False
        return bool(np.isfinite(place.p).all())

    def go_to(self, place: Place) -> bool:
        """Move the oscillator exactly to the parameters of `place`. False where it has no forced motion."""
        return self.take(place) and bool(self.do(curve.MOVE, place))

    def walk(self, place: Place) -> int:
        """Compiled steps from `path.a` until something happens, and why they end (engine/impulses/curve.py)."""
        return int(self.do(curve.WALK, place, np.zeros(self.S + 3)))

    def motion(self, place: Place) -> np.ndarray:
        """(K, 2) gap velocity and acceleration before each impact."""
        self.go_to(place)
        self.do(curve.ASSEMBLE, place)
        return self.bench.room.motion.copy()

    def tail(self, place: Place) -> np.ndarray:
        """`numbers` of what follows the last impact written out, of an onset of sticking."""
        self.go_to(place)
        self.do(curve.ASSEMBLE, place)
        return self.bench.tail.numbers.copy()

    def nearest(self, place: Place) -> tuple[float, int]:
        """Time and side of the turning point nearest to its stop."""
        self.take(place)
        self.do(curve.EXAMINE, place)
        return float(self.bench.nearest[1]), int(self.bench.nearest[2])

    def first(self, row: np.ndarray | None = None) -> Place | None:
        """The point of the curve at `start`, or near it on the plane across `row`; None where it is not isolated."""
        place = self.guess()
        return place and self.settle(place, row)

    def guess(self) -> Place | None:
        """`start`, as it is; None where the oscillator has no forced motion."""
        s, place = self.start.solution, locus.new_place(self.K, self.n)
        place.t[:], place.D[:] = s.times, s.jumps
        place.p[:2] = [s.family.numbers[name] for name in self.names]
        place.p[locus.THETA] = self.start.theta
        if not self.go_to(place):
            return None
        f = self.planes[0]
        phase = s.family.linear.omega * place.t[0] + f["tau"]
        state = s.states[0, : self.n] if self.start.state is None else self.start.state
        place.h[:] = state - (f["Z"] * np.exp(1j * phase)).real
        return place

    def settle(self, place: Place, row: np.ndarray | None = None) -> Place | None:
        """The point of the curve near a guess without a tangent."""
        if not self.go_to(place):
            return None
        if self.curve.kind < locus.GRAZE:
            self._take_null_vectors(place)
        if row is None:
            row = self._direction(place)
        return None if row is None else self.correct(place, row)

    def beside(self, place: Place) -> list[Place]:
        """Points of the curve within the box, a little beside `place`."""
        found = [self.along(place, length) for length in (BESIDE, -BESIDE)]
        lo, hi = self.box.T
        return [one for one in found if one is not None and np.all((lo <= one.p[:2]) & (one.p[:2] <= hi))]

    def along(self, place: Place, length: float) -> Place | None:
        """The point of the curve whose projection on the tangent at `place` is `length`."""
        return self.correct(self.moved(place, length), self.row_of(place.tangent))

    def level(self, place: Place, axis: int, value: float) -> Place | None:
        """The point of the curve near `place` where the parameter `axis` (0, 1) has this value."""
        slope = self.curve.unit[self.S + axis] * place.tangent[self.S + axis]
        if abs(value - place.p[axis]) > 2 * LONGEST_STEP * abs(slope):  # it turns back before
            return None
        guess = self.moved(place, (value - place.p[axis]) / slope if slope else 0.0)
        guess.p[axis] = value
        row = np.zeros(self.size)
        row[self.S + axis] = 1.0
        return self.correct(guess, row)

    def moved(self, place: Place, length: float) -> Place:
        """A guess on the tangent."""
        guess, unit, step = copied(place), self.curve.unit, length * place.tangent
        K, S = self.K, self.S
        guess.t[:] += unit[:K] * step[:K]
        guess.D[:] += unit[K : 2 * K] * step[K : 2 * K]
        guess.p[: self.size - S] += (unit * step)[S : self.size]
        return guess

    def _take_null_vectors(self, place: Place) -> None:
        """w and psi, the singular vectors of M(mu)."""
        place.w[:], place.psi[:] = 1.0, 1.0  # any border
        self.do(curve.ASSEMBLE, place)
        unit, row_unit = self.curve.unit[: self.S], self.curve.row_unit
        M = (self.bench.room.M * unit / row_unit[:, None]).astype(complex)
        mu = {locus.FOLD: 1.0, locus.FLIP: -1.0}.get(self.curve.kind, np.exp(1j * place.p[locus.THETA]))
        closing = np.arange(2 * self.K, self.S)
        M[closing, closing] += self.curve.sigma * mu
        if self.curve.kind != locus.TORUS:
            M = M.real
        left, _, right = np.linalg.svd(M)
        place.w[:], place.psi[:] = right[-1].conj(), left[:, -1].conj()

    def _direction(self, place: Place) -> np.ndarray | None:
        """The tangent of the curve at a place to which the oscillator was moved."""
        if self.curve.kind == locus.STICK:
            for row in np.eye(self.S + 3)[self.S : self.S + 2]:  # one of the parameters may have its extremum there
                beside = copied(place)
                if np.isfinite(self.do(curve.CORRECT, beside, row)):
                    return self.row_of(beside.tangent)
            return None
        if not self.do(curve.ASSEMBLE, place):
            return None
        return self.row_of(np.linalg.svd(self.bench.J[: self.size - 1, : self.size])[2][-1])

    def row_of(self, tangent) -> np.ndarray:
        """The plane across a tangent: distances are not measured over h."""
        row = self._measured(tangent)
        return row / np.linalg.norm(row)

    def _measured(self, tangent) -> np.ndarray:
        row = np.array(tangent[: self.size])
        row[2 * self.K : self.S] = 0.0
        return row

    def correct(self, guess: Place, row: np.ndarray, exact: bool = True) -> Place | None:
        """The point of the curve on the plane through `guess` across `row`, examined; None: none was found.

        exact : of the oscillator itself, or of its polynomials, which is ten times as fast and nearly the same
        """
        place = copied(guess)
        near = self.do(curve.NEAR, place, row)
        if not exact:
            return place if near else None
        place = place if near else copied(guess)
        before = np.inf
        for _ in range(MOST_CORRECTIONS):
            if not self.take(place):
                return None
            change = self.do(curve.CORRECT, place, row)
            if not change <= 1.0:
                return None
            if change <= 1e-15 or (change < 1e-8 and change >= 0.3 * before):
                place.tests[RESIDUAL] = change
                place.tangent[: self.size] /= np.linalg.norm(self._measured(place.tangent))
                return place if self.take(place) and self.do(curve.EXAMINE, place) else None
            before = change
        return None

    def between(self, a: Place, b: Place, share: float) -> Place:
        """On the chord."""
        return self.shifted(a, a, b, share)

    def shifted(self, place: Place, a: Place, b: Place, share: float) -> Place:
        """`place` moved by a share of the chord from a to b."""
        result = copied(place)
        for name in ("t", "D", "h", "p"):
            getattr(result, name)[:] += share * (getattr(b, name) - getattr(a, name))
        return result

    def difference(self, a: Place, b: Place) -> np.ndarray:
        """From a to b, scaled."""
        change = np.zeros(self.size)
        change[: self.K], change[self.K : 2 * self.K] = b.t - a.t, b.D - a.D
        change[self.S :] = (b.p - a.p)[: self.size - self.S]
        return change / self.curve.unit[: self.size]

    def family(self, place: Place) -> Family:
        return self.oscillators.at(place.p)

    def solution(self, place: Place) -> Solution:
        """The orbit of a point; its times are those of the oscillator with its own phase."""
        s, family = self.start.solution, self.family(place)
        q = family.linear
        sides = tuple(map(int, self.curve.sides))
        t = place.t + (self.oscillators.tau - q.tau) / q.omega
        t -= forcing_period(q) * np.round((t[0] - s.times[0]) / forcing_period(q)) if self.K else 0.0
        found = Solution(family, s.sigma, s.halves, sides, np.concatenate([t, place.D]), float(place.tests[RESIDUAL]))
        e = equations_for(found, q)
        if e.free:
            u = np.append(found.u, 0.0)
            u[-1] = -np.mean(e.evaluate(s.sides, u)[0][: self.K])
            found = Solution(family, s.sigma, s.halves, s.sides, u, found.change)
        return found


def copied(place: Place) -> Place:
    return Place(*(values.copy() for values in place))


def copy(source: Place, target: Place) -> None:
    for here, there in zip(source, target, strict=True):
        there[...] = here
