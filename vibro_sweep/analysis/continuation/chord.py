"""Where a test vanishes between two points of a branch or a curve: on planes across the chord between them."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.rounding import rounding_error
from vibro_sweep.analysis.continuation.tracer import Tracer
from vibro_sweep.engine.continuation.workspace import Place

MANY = 60  # impacts of a long orbit
ROUNDING = 1e-15  # of tests, in their units
ASIDE = 1e-7  # of a chord: a zero found by polynomials is exact to far less
LEAST = 1e-14  # of a chord, far below what rounding of tests leaves of a zero
NOISE = 1e-11  # of a chord: nearer to a zero rounding of a test may lie
COARSE = 1e3  # times both, of orbits of many impacts: their tests round by more, and each point takes long
STEPS = 4
BESIDE = (-3e-12, -1e-12, 0.0, 1e-12, 3e-12)  # of a chord, from the zero: so near that only rounding differs
TIMES = 5.0  # the largest difference between locations
OF_TESTS = 3.0  # times what rounding of the equations does, where rounding of a test comes to it


def root(tracer: Tracer, a: Place, b: Place, test: Callable[[Point], float]) -> tuple[float, Point] | None:
    """(share of the chord from a to b, point) where the test, of size 1, vanishes."""
    chord = Chord(tracer, a, b, test)
    try:
        if chord.value(0.0) * chord.value(1.0) > 0:
            return None
        share = chord.near_zero()
        if share is None:
            share = brentq(chord.value, 0.0, 1.0, xtol=chord.coarse * LEAST, rtol=1e-15, maxiter=100)
            chord.value(share)
    except (ArithmeticError, RuntimeError):
        return None
    return share, chord.seen[share]


class Chord:
    """A test along the line between a and b, over shares of the chord. ArithmeticError where there is no point."""

    def __init__(self, tracer: Tracer, a: Place, b: Place, test: Callable[[Point], float]):
        self.tracer, self.a, self.b, self.test = tracer, a, b, test
        change = tracer.difference(a, b)
        self.row = change / np.linalg.norm(change)
        self.coarse = COARSE if tracer.K >= MANY else 1.0
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
        """The zero near `begin`, as far as rounding of the test lets it be told."""
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
        """The point at a share of the chord, without keeping it."""
        return self._point(share, self.seen, exact)

    def _point(self, share: float, seen: dict[float, Point], exact: bool) -> Point:
        near = min(seen, key=lambda other: abs(other - share))
        guess = self.tracer.shifted(seen[near], self.a, self.b, share - near)
        point = self.tracer.correct(guess, self.row, exact)
        if point is None:
            raise ArithmeticError
        return point


def error_of(
    tracer: Tracer, a: Place, b: Place, test: Callable[[Point], float], share: float, point: Point
) -> float | None:
    """Of the parameters of a zero at a share of the chord from a to b; None: there are no points beside it.

    Rounding of the equations moves the line, and rounding of the test moves its zero along the line. The second is seen
    in what points beside it say, which round differently: p - test dp/dtest, without the straight line that a wrong
    slope makes of these. It is not added, so that most errors are the same from whichever start.
    """
    chord = Chord(tracer, a, b, test)
    chord.seen[share] = point
    try:
        points = [chord.at(share + step) if step else point for step in BESIDE]
        far = chord.at(share + (ASIDE if share < 0.5 else -ASIDE), exact=False)
    except ArithmeticError:
        return None
    tests, p = (np.array([of(one) for one in points]) for of in (test, tracer.parameters))
    middle, scatter = BESIDE.index(0.0), 0.0
    with np.errstate(all="ignore"):
        rate = (tracer.parameters(far) - p[middle]) / np.float64(test(far) - tests[middle])
    if np.isfinite(rate).all():
        said = p - p[middle] - np.outer(tests, rate)
        slope, mean = np.polyfit(BESIDE, said, 1)
        scatter = np.abs(said - np.outer(BESIDE, slope) - mean).max()
    return float(max(TIMES * scatter, OF_TESTS * rounding_error(tracer, point, chord.row)))
