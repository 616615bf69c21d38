"""From a special point to the bifurcation curve through it: which equations, and the first point."""

import numpy as np

from vibro_sweep.analysis.branches.special import SpecialPoint, bare, inserted, vanishing
from vibro_sweep.analysis.branches.switching import index_in
from vibro_sweep.analysis.continuation.start import KINDS, Start, keeps_symmetry
from vibro_sweep.analysis.periodic.solution import Solution


def start_at(special: SpecialPoint, names: tuple[str, ...] = ()) -> Start:
    """For curves in the parameters `names`: in whole periods where one of them breaks the symmetry of the orbit.

    A pitchfork is then a fold, and its point a cusp. Raises ValueError for a type without curves, and for orbits that
    rest.
    """
    solution = _solution(special)
    symmetric = all(keeps_symmetry(solution.family, name) for name in names)
    start = _start(special, solution, symmetric)
    if start.solution.sigma == 1 or symmetric:
        return start
    if start.type == "sticking":
        raise ValueError(
            f"parameters: {names!r} is not allowed: where the symmetry is broken, both chatter sequences of this "
            "orbit have an onset of their own"
        )
    return Start("fold" if start.type == "pitchfork" else start.type, start.solution.whole(), start.index, start.theta)


def _solution(special: SpecialPoint) -> Solution:
    if special.type not in KINDS:
        allowed = ", ".join(KINDS)
        raise ValueError(f"special.type: {special.type!r} is not allowed; it must be one of {allowed}")
    if special.type == "sticking":
        if special._chatter is None:
            raise ValueError("special: this sticking is not the onset at which impacts accumulate; it has no curve")
        return special._chatter.solution
    solution = special.orbit._solution
    if solution.rests:
        raise ValueError("special: the mass rests on a stop; curves of such orbits cannot be followed")
    return solution


def _start(special: SpecialPoint, solution: Solution, symmetric: bool) -> Start:
    if special.type == "sticking":
        return Start("sticking", solution, state=special._chatter.state)
    if special.type == "graze":
        if special.impact is not None:
            return _grazing(solution, index_in(special), symmetric)
        return Start("graze", *inserted(solution))
    if special.type != "neimark_sacker":
        return Start(special.type, solution)
    mu = solution.multipliers
    critical = mu[np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf))]
    return Start("neimark_sacker", solution, theta=float(np.angle(critical)))


def _grazing(solution: Solution, index: int, symmetric: bool) -> Start:
    """Where impacts vanish together because they are one graze of a simpler orbit (or the free motion), in its periods:
    that one alone. The others have no speed all along the curve.

    symmetric : whether the oscillator remains so along the curve; else both halves of a symmetric orbit graze by
        themselves
    """
    simpler, gone = solution, vanishing(solution, index)
    for k in reversed(gone):
        simpler = bare(simpler, k)
    simpler = simpler.reduced()
    if not symmetric and simpler.sigma == -1:
        simpler = simpler.whole()
    if len(gone) > 1 and simpler.halves < solution.halves:
        return Start("graze", *inserted(simpler))
    return Start("graze", solution, index)
