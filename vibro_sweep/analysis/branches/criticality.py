"""Whether what is born at a flip, a pitchfork or a Neimark-Sacker point attracts: the first Lyapunov coefficient.

It is Re c in f(z) = e^{i theta} (z + c |z|^2 z) (engine/continuation/normal_form.py), theta = pi and z real at a flip;
negative: supercritical. At the resonance 1:4 the term d conj(z)^3 is of the same order.
"""

import numpy as np

from vibro_sweep.analysis.branches.births import born
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.normal_form import CUBE, OPPOSITE, RESONANT
from vibro_sweep.engine.continuation.problem import FLIP, Problem
from vibro_sweep.engine.continuation.workspace import THETA, Place, Workspace
from vibro_sweep.engine.impulses.pairs import ON_PAIR

STRONG = 1e-3  # |e^{i k theta} - 1| for k = 1 .. 4, or a flip's distance of the next multiplier from -1, below which c
# does not decide
ROUNDED = 1e-8  # part of its terms below which Re c is rounding


def critical_angle(solution: Solution) -> float:
    """The angle of the complex multiplier nearest to the unit circle."""
    mu = solution.multipliers
    return float(np.angle(mu[np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf))]))


def criticality(solution: Solution, kind: int, name: str) -> str | None:
    """ "super" or "sub" of a bifurcation in a parameter, FLIP (also a pitchfork) or TORUS; None where the coefficient
    does not tell: also at a resonance, and of orbits that rest.

    Without losses the multiplier -1 is double. What is born there is then unstable where it is "sub".
    """
    if kind == FLIP:
        theta, apart = np.pi, np.sort(np.abs(solution.multipliers + 1))[1]
    else:
        theta = critical_angle(solution)
        apart = min(abs(np.exp(1j * k * theta) - 1) for k in range(1, 5))
    if kind == FLIP and solution.torus == 1.0 and (child := born(solution, name, 1)) is not None:
        near = child.multipliers[np.argsort(np.abs(child.multipliers - 1))[:2]]
        return "sub" if np.abs(near).max() > 1 + ON_PAIR else "super"
    if apart < STRONG or not np.all(solution.contacts[list(solution.rests)]):
        return None
    try:
        linearised = Linearised(solution)
        linearised.take_null_vectors(kind, theta)
    except np.linalg.LinAlgError:
        return None
    e = linearised.equations
    e.run_task(stepper.EXAMINE)
    (c, _), (size, _) = cubic_terms(e.workspace, e.problem, e.place)
    return None if not abs(c.real) > ROUNDED * size else "super" if c.real < 0 else "sub"


def cubic_terms(workspace: Workspace, problem: Problem, place: Place) -> tuple[np.ndarray, np.ndarray]:
    """c and d, and the sum of the sizes of the terms of each, of an examined point; z is in units of `place.v`."""
    closing, angle = workspace.work[0]["closing"], place.p[THETA]
    n = len(closing)
    left = [place.w[:-1, :2, None] * workspace.events["left"], place.w[-2, 2:, None] * closing]
    orders = [CUBE if problem.kind == FLIP else RESONANT, OPPOSITE]
    terms = np.concatenate([one[..., orders].reshape(-1, 2) for one in left])
    terms /= -problem.sigma * np.exp(1j * angle) * (place.w[-2, 2:] @ place.v[0, :n])
    return terms.sum(0), np.abs(terms).sum(0)
