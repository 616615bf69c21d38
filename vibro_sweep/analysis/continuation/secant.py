"""Where a test vanishes between two points of a branch or a curve: on planes across the secant through them."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.rounding import rounding_error
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.engine.continuation.workspace import Place

MANY = 60  # impacts of a long orbit
ROUNDING = 1e-15  # of tests, in their units
ASIDE = 1e-7  # of a secant: a zero found by polynomials is exact to far less
LEAST = 1e-14  # of a secant, far below what rounding of tests leaves of a zero
NOISE = 1e-11  # of a secant: nearer to a zero rounding of a test may lie
COARSE = 1e3  # times both, of orbits of many impacts: their tests round by more, and each point takes long
FINE = 1e-2  # length of a secant below which rounding is a larger share of it
STEPS = 4
ASTRAY = 3.0  # secants off the line: beyond it lies another piece of the curve
BESIDE = (-3e-12, -1e-12, 0.0, 1e-12, 3e-12)  # of a secant, from the zero: so near that only rounding differs
FARTHER = (ASIDE, 1e-5, 1e-3, 0.1)  # of a secant, from the zero: where its slope is looked at
ABOVE = 30.0  # times what rounding does: a test that changes by more has a slope
TIMES = 5.0  # the largest difference between locations
OF_TESTS = 3.0  # times what rounding of the equations does, where rounding of a test comes to it


def root(curve: SolutionCurve, a: Place, b: Place, test: Callable[[Point], float]) -> tuple[float, Point] | None:
    """(share of the secant from a to b, point) where the test, of size 1, vanishes; None where no point is found."""
    secant = Secant(curve, a, b, test)
    try:
        if secant.value(0.0) * secant.value(1.0) > 0:
            return None
        share = secant.near_zero()
        if share is None:
            share = brentq(secant.value, 0.0, 1.0, xtol=secant.coarse * LEAST, rtol=1e-15, maxiter=100)
            secant.value(share)
    except (ArithmeticError, RuntimeError):
        return None
    point = secant.seen[share]
    astray = curve.distance(curve.between(a, b, share), point) > ASTRAY * curve.distance(a, b)
    return None if astray else (share, point)


class Secant:
    """A test along the secant through a and b, by shares of it. Raises ArithmeticError where there is no point."""

    def __init__(self, curve: SolutionCurve, a: Place, b: Place, test: Callable[[Point], float]):
        self.curve, self.a, self.b, self.test = curve, a, b, test
        change = curve.difference(a, b)
        length = np.linalg.norm(change)
        self.row = change / length
        self.coarse = (COARSE if curve.K >= MANY else 1.0) * max(1.0, FINE / length)
        self.seen = {0.0: a, 1.0: b}

    def value(self, share: float) -> float:
        if share not in self.seen:
            self.seen[share] = self._point(share, self.seen, exact=True)
        found = self.test(self.seen[share])
        return found if abs(found) > ROUNDING else 0.0  # or the search may creep where rounding has one sign

    def near_zero(self) -> float | None:
        """The zero, by Newton's method from that of the polynomials; None where that does not find it."""
        seen = dict(self.seen)

        def rough(share: float) -> float:
            if share not in seen:
                seen[share] = self._point(share, seen, exact=False)
            return self.test(seen[share])

        try:
            begin = brentq(rough, 0.0, 1.0, xtol=ASIDE / 100, maxiter=100)
            beside = begin + (ASIDE if begin < 0.5 else -ASIDE)
            slope = (rough(beside) - rough(begin)) / (beside - begin)
            if begin not in self.seen:
                self.seen[begin] = self._point(begin, seen, exact=True)
            return self._refined(begin, slope) if slope else None
        except (ArithmeticError, RuntimeError, ValueError):
            return None

    def _refined(self, begin: float, slope: float) -> float | None:
        """The zero near `begin`, as accurately as rounding of the test allows."""
        zero = begin
        for _ in range(STEPS):
            left = self.value(zero)
            if abs(left) <= self.coarse * LEAST * abs(slope):
                break
            moved = zero - left / slope
            if not (0.0 <= moved <= 1.0 and abs(moved - begin) <= ASIDE):
                return None
            if not abs(self.value(moved)) < 0.5 * abs(left):
                break
            zero = moved
        return zero if abs(self.value(zero)) <= self.coarse * NOISE * abs(slope) else None

    def at(self, share: float, exact: bool = True) -> Point:
        """The point at a share of the secant, without keeping it."""
        return self._point(share, self.seen, exact)

    def across(self, place: Place) -> np.ndarray:
        """The plane across the secant, with parameters in units of their size: in those of narrow bounds it would hold
        them, and rounding of the equations would move the orbit alone, with which the test vanishes elsewhere."""
        row, own, p = self.row.copy(), slice(2 * self.curve.K, 2 * self.curve.K + 2), np.abs(place.p[:2])
        row[own] *= np.minimum(1.0, self.curve.unit / np.where(p > 0, p, self.curve.unit)) ** 2
        return row

    def _point(self, share: float, seen: dict[float, Point], exact: bool) -> Point:
        near = min(seen, key=lambda other: abs(other - share))
        guess = self.curve.shifted(seen[near], self.a, self.b, share - near)
        point = self.curve.correct(guess, self.row, exact)
        if point is None:
            raise ArithmeticError
        return point


def error_of(
    curve: SolutionCurve, a: Place, b: Place, test: Callable[[Point], float], share: float, point: Point
) -> float | None:
    """The error of the parameters of a zero at a share of the secant; None: there are no points beside it.

    Rounding of the equations moves the line, and rounding of the test moves its zero along the line. The second is seen
    in what points beside it say, which round differently: p - test dp/dtest, without the straight line that a wrong
    slope makes of these. It is not added, so that most errors are the same from whichever start.
    """
    secant = Secant(curve, a, b, test)
    secant.seen[share] = point
    try:
        points = [secant.at(share + step) if step else point for step in BESIDE]
        tests, p = (np.array([of(one) for one in points]) for of in (test, curve.parameters))
        middle, scatter, least = BESIDE.index(0.0), 0.0, ABOVE * np.ptp(tests)
        for distance in FARTHER:
            far = secant.at(share + (distance if share < 0.5 else -distance), exact=False)
            if not abs(test(far) - tests[middle]) < least:
                break
    except ArithmeticError:
        return None
    with np.errstate(all="ignore"):
        rate = (curve.parameters(far) - p[middle]) / np.float64(test(far) - tests[middle])
    if np.isfinite(rate).all():
        said = p - p[middle] - np.outer(tests, rate)
        slope, mean = np.polyfit(BESIDE, said, 1)
        scatter = np.abs(said - np.outer(BESIDE, slope) - mean).max()
    return float(max(TIMES * scatter, OF_TESTS * rounding_error(curve, point, secant.across(point))))
