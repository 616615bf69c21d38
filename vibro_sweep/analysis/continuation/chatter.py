"""How many impacts of a chatter sequence are written out at an onset of sticking.

The last of them must lie within the reach of the series, and not far below it: slow impacts add nothing but rounding.
"""

from dataclasses import dataclass

import numpy as np

from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.chatter_sum import NEXT, REACH
from vibro_sweep.engine.continuation.curve_tests import LATEST
from vibro_sweep.engine.continuation.stepper import FOLLOW
from vibro_sweep.engine.continuation.workspace import Place, new_place

NEAR_END = 0.45  # of the reach: all earlier impacts are written out
MOST_IMPACTS = 120


@dataclass(frozen=True, eq=False)
class Chatter:
    """The orbit at an onset of sticking: what infinitely many impacts leave out.

    solution : impacts from the end of the chatter sequence, as one without impulse, to the last written out before the
        same end, one period (sigma = -1: half a period, mirrored) later
    state : (2N,) at that end, in contact coordinates
    """

    solution: Solution
    state: np.ndarray


def written_out(curve: SolutionCurve, place: Place) -> tuple[SolutionCurve, Place] | None:
    """The same point, not corrected, with as many impacts as are needed; None where these are too many."""
    while curve.K <= MOST_IMPACTS:
        reach = curve.tail(place)[REACH]
        times = curve.times(place)
        before_end = times[0] + curve.period(place) - times[1:]
        if before_end[-1] > LATEST * reach:
            curve, place = with_impacts(curve, place, curve.K + 1)
            continue
        needed = max(int(np.sum(before_end > NEAR_END * reach)), 1)
        if before_end[needed - 1] > LATEST * reach:
            needed += 1
        return with_impacts(curve, place, 1 + needed)
    return None


def with_impacts(curve: SolutionCurve, place: Place, K: int) -> tuple[SolutionCurve, Place]:
    """The point with the first K impacts, or with more of the chatter sequence."""
    while curve.K < K:
        time = curve.period(place) - curve.tail(place)[NEXT]
        curve, place = _resized(curve, place, curve.K + 1)
        place.phases[-1] = place.phases[0] + curve.omega(place) * time
        curve.run_task(FOLLOW, place)
        one_plus_R = 1 + curve.family(place).linear.contact.restitution(curve.problem.sides[-1:])[0]
        place.jumps[-1] = -one_plus_R * curve.motion(place)[-1, 0] / curve.units.speed
    return (curve, curve.copied(place)) if curve.K == K else _resized(curve, place, K)


def _resized(curve: SolutionCurve, place: Place, K: int) -> tuple[SolutionCurve, Place]:
    """Numbers of impacts that are new are 0."""
    w, old = curve.resized(K), curve.K
    result, kept = new_place(K, w.n), min(K, old)
    for name in ("x", "tangent"):
        getattr(result, name)[:kept] = getattr(place, name)[:kept]
    for name in ("p", "tangent_p", "tests"):
        getattr(result, name)[:] = getattr(place, name)
    return w, result


def chatter_at(curve: SolutionCurve, place: Place, touches: bool) -> Chatter:
    """The chatter to start from at a point of a curve; touches: with the nearest turning point as an impact without
    speed."""
    solution = curve.solution(place)
    steady = (curve.planes[0]["Z"] * np.exp(1j * place.phases[0])).real
    state = (place.x[0, : curve.n] + steady) * curve.state_units
    if not touches:
        return Chatter(solution, state)
    time, side = curve.nearest(place)
    time += solution.times[0] - curve.times(place)[0]
    return Chatter(solution.with_touch(int(np.searchsorted(solution.times, time)), time, side), state)
