"""What the normal form needs at a Neimark-Sacker point of a curve."""

import numpy as np

from vibro_sweep.analysis.continuation.tracer import Tracer
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.normal_form import MIXED, SQUARE
from vibro_sweep.engine.continuation.workspace import Place


def second_order(tracer: Tracer, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Of the times and impulses (2K,) on the plane z w + conj(z w): coefficients of z^2 and |z|^2."""
    tracer.take(place)
    tracer.do(stepper.EXAMINE, place)
    series = (
        tracer.bench.events["series"].transpose(1, 0, 2).reshape(2 * tracer.K, -1) * in_time(tracer, place)[:, None]
    )
    return series[:, SQUARE].copy(), series[:, MIXED].real.copy()


def rates_of_pair(tracer: Tracer, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Slopes along the orbits by both parameters: of log mu of the pair (2,), of times and impulses (2K, 2)."""
    tracer.assemble(place)
    n, unit, omega = tracer.n, tracer.problem.unit, tracer.omega(place)
    ends = tracer.bench.work[0]["ends"][: n + 2, : n + 3].copy()
    first = -np.linalg.solve(ends[:n, :n], ends[:n, n : n + 2])
    along = np.array([tracer.taken_apart(place, first[:, j], np.eye(2)[j]) for j in range(2)]).T
    slopes = ends[n] + 1j * ends[n + 1]
    rates = -1j * (slopes[:n] @ first + slopes[n : n + 2]) / slopes[n + 2] / unit
    along = along[: 2 * tracer.K] * in_time(tracer, place)[:, None] / unit
    turned = [tracer.oscillators.at(place.p).derivative(name).omega / omega for name in tracer.names]
    along[: tracer.K] -= np.outer(tracer.times(place), turned)
    return rates, along


def in_time(tracer: Tracer, place: Place) -> np.ndarray:
    """(2K,) by which phases and jumps of a change become times and impulses."""
    return np.repeat([1 / tracer.omega(place), tracer.units.speed], tracer.K)
