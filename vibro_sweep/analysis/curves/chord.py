"""Where a test vanishes on a bifurcation curve: on planes across the chord between two of its points."""

from collections.abc import Callable

from scipy.optimize import brentq

from vibro_sweep.analysis.curves.tracer import Tracer
from vibro_sweep.engine.impulses.locus import Place

ROUNDING = 1e-15  # of tests, in their units
ASIDE = 1e-7  # of a chord: a zero found by polynomials is exact to far less
LEAST = 1e-14  # of a chord, far below what rounding of tests leaves of a zero


def root(tracer: Tracer, a: Place, b: Place, test: Callable[[Place], float]) -> tuple[float, Place] | None:
    """(share of the chord from a to b, point) where the test, of size 1, vanishes."""
    chord = Chord(tracer, a, b, test)
    try:
        if chord.value(0.0) * chord.value(1.0) > 0:
            return None
        lo, hi = chord.near_zero()
        share = brentq(chord.value, lo, hi, xtol=LEAST, rtol=1e-15, maxiter=100)
        chord.value(share)
    except (ArithmeticError, RuntimeError):
        return None
    return share, chord.seen[share]


class Chord:
    """A test along the curve between a and b, over shares of the chord. ArithmeticError where there is no point."""

    def __init__(self, tracer: Tracer, a: Place, b: Place, test: Callable[[Place], float]):
        self.tracer, self.a, self.b, self.test = tracer, a, b, test
        self.row = tracer.row_of(tracer.difference(a, b))
        self.seen = {0.0: a, 1.0: b}

    def value(self, share: float) -> float:
        if share not in self.seen:
            self.seen[share] = self._point(share, self.seen, exact=True)
        found = self.test(self.seen[share])
        return found if abs(found) > ROUNDING else 0.0  # or the search may creep where rounding has one sign

    def near_zero(self) -> tuple[float, float]:
        """Two shares between which the test changes its sign, close to the zero that polynomials give."""
        seen = dict(self.seen)

        def rough(share: float) -> float:
            if share not in seen:
                seen[share] = self._point(share, seen, exact=False)
            return self.test(seen[share])

        try:
            zero = brentq(rough, 0.0, 1.0, xtol=ASIDE / 100, maxiter=100)
            if zero not in self.seen:
                self.seen[zero] = self._point(zero, seen, exact=True)
            lo, hi = max(zero - ASIDE, 0.0), min(zero + ASIDE, 1.0)
            if self.value(lo) * self.value(hi) <= 0:
                return lo, hi
        except (ArithmeticError, RuntimeError, ValueError):
            pass
        return 0.0, 1.0

    def _point(self, share: float, seen: dict[float, Place], exact: bool) -> Place:
        near = min(seen, key=lambda other: abs(other - share))
        guess = self.tracer.shifted(seen[near], self.a, self.b, share - near)
        point = self.tracer.correct(guess, self.row, exact)
        if point is None:
            raise ArithmeticError
        return point
