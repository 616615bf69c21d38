"""What the normal form needs at a Neimark-Sacker point of a curve."""

import numpy as np

from vibro_sweep.analysis.curves.tracer import Tracer
from vibro_sweep.engine.impulses import curve
from vibro_sweep.engine.impulses.locus import Place
from vibro_sweep.engine.impulses.normal_form import MIXED, SQUARE


def second_order(tracer: Tracer, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Of the times and impulses (2K,) on the plane z w + conj(z w): coefficients of z^2 and |z|^2."""
    tracer.take(place)
    tracer.do(curve.EXAMINE, place)
    series = tracer.bench.series[: 2 * tracer.K]
    return series[:, SQUARE].copy(), series[:, MIXED].real.copy()


def rates_of_pair(tracer: Tracer, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Slopes along the orbits by both parameters: of log mu of the pair (2,), of times and impulses (2K, 2)."""
    tracer.go_to(place)
    tracer.do(curve.ASSEMBLE, place)
    J, S, unit = tracer.bench.J, tracer.S, tracer.curve.unit
    along = -np.linalg.solve(J[:S, :S], J[:S, S : S + 2])
    slopes = J[S, : S + 3] + 1j * J[S + 1, : S + 3]
    rates = -1j * (slopes[:S] @ along + slopes[S : S + 2]) / slopes[S + 2] / unit[S : S + 2]
    return rates, (along * unit[:S, None] / unit[S : S + 2])[: 2 * tracer.K]
