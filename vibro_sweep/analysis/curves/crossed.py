"""Where an impulse vanishes at a point of a curve that another one passes, as where its orbit becomes the free motion.

There the orbits without the impact, whose impulse is zero all along, are solutions of the same equations. These are
singular: Newton's method finds no point nearer to it than rounding over its distance, and may find one of the others.
Farther off points are exact, and the polynomials through them give what lies between.
"""

import numpy as np

from vibro_sweep.analysis.continuation.rounding import DIGITS, ROWS, sensitivity
from vibro_sweep.analysis.continuation.secant import Secant
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.engine.continuation.problem import FOLD, TORUS
from vibro_sweep.engine.continuation.stepper import EXAMINE
from vibro_sweep.engine.continuation.workspace import TEST, Place

REACH = 5e-3  # in units of a curve: the distance of the points farthest off
NODES = np.array([-1.0, -2 / 3, -1 / 3, 1 / 3, 2 / 3, 1.0])
ROUNDS = 3  # of points, each about the zero of the last ones
FLAT = 1e-3  # of the mean slope of an impulse: a lesser one is zero
LOST = 1e-10  # of the parameters, by rounding of the equations
SMOOTH = 1e-8  # of the bounds: what all points and those without the outermost may say apart


def is_on_other(curve: SolutionCurve, a: Place, b: Place, place: Place, impact: int) -> bool:
    """Whether a place where this impulse vanishes, located between a and b, lies on the curve of orbits without it."""
    change, j = curve.difference(a, b), curve.K + impact
    return bool(abs(place.direction[j]) < FLAT * abs(change[j]) / np.linalg.norm(change))


def is_lost(curve: SolutionCurve, a: Place, b: Place, place: Place) -> bool:
    """Whether rounding of the equations moves a place, located between a and b, so far that others may be near."""
    return ROWS * sensitivity(curve, place, curve.unit_row(curve.difference(a, b))) > LOST


def aside(curve: SolutionCurve, a: Place, b: Place, place: Place, share: float, gone: list[int]) -> Place | None:
    """The point of the curve that lies this share of the secant from a to b beside a place on it. gone : impacts that
    vanish between a and b; None where there is but one of the orbits without them."""
    change = curve.difference(a, b)
    row = curve.unit_row(change)
    length = share * (row @ change) / (row @ place.direction)
    point = curve.correct(curve.moved(place, length), row)
    return None if point is None or any(is_on_other(curve, a, b, point, i) for i in gone) else point


def crossed(curve: SolutionCurve, a: Place, b: Place, impact: int) -> tuple[float, Place, float] | None:
    """(share of the secant from a to b, place, error of its parameters) where this impulse vanishes; None where it does
    so at a pole, there are no points beside it, or a fold or flip has a contact whose length the equations divide: the
    curve of its grazes tells."""
    if curve.problem.rests[impact] and FOLD <= curve.problem.kind < TORUS:
        return None
    secant = Secant(curve, a, b, lambda place: float(place.jumps[impact]))
    reach = REACH / curve.distance(a, b)
    low, high = secant.test(a), secant.test(b)
    zero = low / (low - high)
    try:
        for _ in range(ROUNDS):
            shares = zero + reach * NODES
            places = [secant.at(share) for share in shares.tolist()]
            tests = np.array([secant.test(place) for place in places])
            weights, fewer = lagrange_weights(tests), np.pad(lagrange_weights(tests[1:-1]), 1)
            zero = float(weights @ shares)
    except ArithmeticError:
        return None
    p = np.array([place.p[:2] for place in places])
    apart = np.abs((weights - fewer) @ p)
    if not (0.0 <= zero <= 1.0 and np.all(apart <= SMOOTH * np.ptp(curve.bounds, axis=1))):
        return None
    place = curve.copied(places[0])
    for name in ("x", "p", "tangent", "tangent_p", "v", "w"):
        getattr(place, name)[:] = np.tensordot(weights, [getattr(one, name) for one in places], 1)
    place.jumps[impact], place.tests[TEST.residual] = 0.0, 0.0
    if not (curve.take_numbers(place) and curve.run_task(EXAMINE, place)):
        return None
    lost = np.abs(weights) @ [sensitivity(curve, one, secant.across(one)) for one in places]
    return zero, place, float(apart.max() + DIGITS * np.abs(p).max() + ROWS * lost)


def lagrange_weights(tests: np.ndarray) -> np.ndarray:
    """Weights of values at points with these tests, for the polynomial through them at test zero (Lagrange)."""
    ratios = tests / (tests - tests[:, None] + np.diag(tests))  # 1 on the diagonal
    return np.prod(ratios, axis=1)
