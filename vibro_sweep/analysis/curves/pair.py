"""What the normal form needs at a Neimark-Sacker point of a curve."""

import numpy as np

from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.normal_form import MIXED, SQUARE
from vibro_sweep.engine.continuation.workspace import Place


def second_order(curve: SolutionCurve, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of z^2 and |z|^2 of the times and impulses (2K,) on the plane z w + conj(z w)."""
    curve.take_numbers(place)
    curve.run_task(stepper.EXAMINE, place)
    series = (
        curve.workspace.events["series"].transpose(1, 0, 2).reshape(2 * curve.K, -1) * in_time(curve, place)[:, None]
    )
    return series[:, SQUARE].copy(), series[:, MIXED].real.copy()


def rates_of_pair(curve: SolutionCurve, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Slopes along the orbits by both parameters: of log mu of the pair (2,), of times and impulses (2K, 2)."""
    curve.assemble(place)
    n, unit, omega = curve.n, curve.problem.unit, curve.omega(place)
    ends = curve.workspace.work[0]["ends"][: n + 2, : n + 3].copy()
    first = -np.linalg.solve(ends[:n, :n], ends[:n, n : n + 2])
    along = np.array([curve.taken_apart(place, first[:, j], np.eye(2)[j]) for j in range(2)]).T
    slopes = ends[n] + 1j * ends[n + 1]
    rates = -1j * (slopes[:n] @ first + slopes[n : n + 2]) / slopes[n + 2] / unit
    along = along[: 2 * curve.K] * in_time(curve, place)[:, None] / unit
    turned = [curve.oscillators.at(place.p).derivative(name).omega / omega for name in curve.names]
    along[: curve.K] -= np.outer(curve.times(place), turned)
    return rates, along


def in_time(curve: SolutionCurve, place: Place) -> np.ndarray:
    """(2K,) by which phases and jumps of a change become times and impulses."""
    return np.repeat([1 / curve.omega(place), curve.units.speed], curve.K)
