"""Whether the invariant circle that is born at a Neimark-Sacker point attracts: the first Lyapunov coefficient.

It is Re c in f(z) = e^{i theta} (z + c |z|^2 z) (engine/continuation/normal_form.py); negative: supercritical. At the
resonance 1:4 the term d conj(z)^3 is of the same order.
"""

import numpy as np

from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.normal_form import OPPOSITE, RESONANT
from vibro_sweep.engine.continuation.problem import TORUS, Problem
from vibro_sweep.engine.continuation.workspace import THETA, Bench, Place

STRONG = 1e-3  # |e^{i k theta} - 1| for k = 1 .. 4 below which c does not decide
ROUNDED = 1e-8  # part of its terms below which Re c is rounding


def critical_angle(solution: Solution) -> float:
    """Of the complex multiplier nearest to the unit circle."""
    mu = solution.multipliers
    return float(np.angle(mu[np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf))]))


def criticality(solution: Solution) -> str | None:
    """ "super" or "sub" of a Neimark-Sacker point; None where the coefficient does not tell, also at a resonance."""
    theta = critical_angle(solution)
    if solution.rests or min(abs(np.exp(1j * k * theta) - 1) for k in range(1, 5)) < STRONG:
        return None
    try:
        linearised = Linearised(solution)
        linearised.take_null_vectors(TORUS, theta)
    except np.linalg.LinAlgError:
        return None
    e = linearised.equations
    e.do(stepper.EXAMINE)
    (c, _), (size, _) = cubic_terms(e.bench, e.problem, e.place)
    return None if not abs(c.real) > ROUNDED * size else "super" if c.real < 0 else "sub"


def cubic_terms(bench: Bench, problem: Problem, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """c and d, and the sum of the sizes of the terms of each, of an examined point; z is in units of `place.v`."""
    closing, angle = bench.work[0]["closing"], place.p[THETA]
    n = len(closing)
    left = [place.w[:-1, :2, None] * bench.events["left"], place.w[-2, 2:, None] * closing]
    terms = np.concatenate([one[..., [RESONANT, OPPOSITE]].reshape(-1, 2) for one in left])
    terms /= -problem.sigma * np.exp(1j * angle) * (place.w[-2, 2:] @ place.v[0, :n])
    return terms.sum(0), np.abs(terms).sum(0)
