"""What the normal form needs at a Neimark-Sacker point of a curve."""

import numpy as np

from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.normal_form import MIXED, SQUARE
from vibro_sweep.engine.continuation.workspace import Place


def second_order(curve: SolutionCurve, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of z^2 and |z|^2 of the numbers `in_time` on the plane z w + conj(z w)."""
    curve.take_numbers(place)
    curve.run_task(stepper.EXAMINE, place)
    series = in_time(curve, place, curve.workspace.events["series"].transpose(1, 0, 2).reshape(2 * curve.K, -1))
    return series[:, SQUARE].copy(), series[:, MIXED].real.copy()


def rates_of_pair(curve: SolutionCurve, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Slopes along the orbits by both parameters: of log mu of the pair (2,), of the numbers `in_time` (.., 2)."""
    curve.assemble(place)
    n, unit, omega = curve.n, curve.problem.unit, curve.omega(place)
    ends = curve.workspace.work[0]["ends"][: n + 2, : n + 3].copy()
    first = -np.linalg.solve(ends[:n, :n], ends[:n, n : n + 2])
    along = np.array([curve.taken_apart(place, first[:, j], np.eye(2)[j]) for j in range(2)]).T
    slopes = ends[n] + 1j * ends[n + 1]
    rates = -1j * (slopes[:n] @ first + slopes[n : n + 2]) / slopes[n + 2] / unit
    along = in_time(curve, place, along[: 2 * curve.K]) / unit
    turned = [curve.oscillators.at(place.p).derivative(name).omega / omega for name in curve.names]
    along[: curve.K] -= np.outer(curve.times(place), turned)
    along[2 * curve.K :] -= np.outer(curve.solution(place).ends, turned)
    return rates, along


def in_time(curve: SolutionCurve, place: Place, change: np.ndarray) -> np.ndarray:
    """A change (2K, ..) of phases, jumps and lengths as one (2K + rests, ..) of times, impulses and ends: `Solution.u`.

    The speed at which an event that lasts begins follows from the others: 0 here.
    """
    rests, phases, others = list(curve.orbit.rests), *np.split(change, 2)
    impulses = others * curve.units.speed
    impulses[rests] = 0.0
    return np.concatenate([phases / curve.omega(place), impulses, (phases + others)[rests] / curve.omega(place)])


def in_phase(curve: SolutionCurve, place: Place, change: np.ndarray) -> np.ndarray:
    """(2K,) the reverse of `in_time`."""
    rests, (times, impulses, ends) = list(curve.orbit.rests), np.split(change, [curve.K, 2 * curve.K])
    others = impulses / curve.units.speed
    others[rests] = (ends - times[rests]) * curve.omega(place)
    return np.concatenate([times * curve.omega(place), others])
