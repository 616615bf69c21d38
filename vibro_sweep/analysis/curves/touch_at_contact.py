"""The end of a curve of grazes at which its touch comes to the contact beside it: no flight is left between them.

There the speed at which the mass leaves the stop, or comes to it, vanishes with its acceleration, and the equations of
the contact are singular. Points with some flight are exact, and the polynomials through them give what lies at its end.
"""

import numpy as np

from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.curves.crossed import lagrange_weights
from vibro_sweep.analysis.periodic.joined_contacts import flights_between
from vibro_sweep.engine.continuation.problem import GRAZE
from vibro_sweep.engine.continuation.workspace import TEST, Place

SHORT = 1e-4  # in phase: a flight that is about to vanish
REACHES = (1e-2, 3e-3, 1e-3, 3e-4)  # in phase: the longest flight of the points; with which of them they say the same
SHARES = np.arange(1, 7) / 6
TIMES = 5.0  # what they say apart
SMOOTH = 1e-8  # of the bounds: what all points and those without the outermost may say apart


def touch_at_contact(curve: SolutionCurve, a: Place) -> tuple[Point, float] | None:
    """The end near a, and its error; None where no flight beside the touch is about to vanish."""
    if curve.problem.kind != GRAZE:
        return None
    flights, touch = flights_between(curve.solution(a)) * curve.omega(a), curve.problem.index
    beside = [i for i in (touch - 1, touch) if flights[i] < SHORT]
    if not beside:
        return None
    ends = [end for reach in REACHES if (end := _without_flight(curve, a, beside[0] % curve.K, reach)) is not None]
    if not ends:
        return None
    (end, apart), *others = sorted(ends, key=lambda one: one[1])
    error = TIMES * apart + min((float(np.abs(end.p - one.p)[:2].max()) for one, _ in others), default=0.0)
    return (end, error) if apart <= SMOOTH * np.ptp(curve.bounds, axis=1).max() else None


def _without_flight(curve: SolutionCurve, a: Place, before: int, reach: float) -> tuple[Point, float] | None:
    """(place, error) without a flight after the event `before`, from points with flights of up to `reach`."""
    K, row, places, guess = curve.K, np.zeros(2 * curve.K + 3), [], curve.copied(a)
    following, lasts = (before + 1) % K, float(curve.problem.rests[before])
    row[[before, K + before, following]] = -1.0, -lasts, 1.0

    def flight(place: Place) -> float:
        left = place.phases[following] - place.phases[before] - lasts * place.jumps[before]
        return float((left + 1) % (np.pi * curve.orbit.half_periods) - 1)

    for share in SHARES.tolist():
        guess.phases[following] += reach * share - flight(guess)
        place = curve.correct(guess, curve.unit_row(row))
        if place is None:
            return None
        places.append(place)
        guess = curve.copied(place)
    flights = np.array([flight(place) for place in places])
    weights, fewer = lagrange_weights(flights), np.append(lagrange_weights(flights[:-1]), 0.0)
    end = curve.copied(places[0])
    end.x[:], end.p[:] = (np.tensordot(weights, [getattr(one, name) for one in places], 1) for name in ("x", "p"))
    end.tests[TEST.residual] = 0.0
    return end, float(np.abs((weights - fewer) @ [place.p[:2] for place in places]).max())
