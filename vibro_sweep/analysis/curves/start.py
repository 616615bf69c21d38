"""From a special point to the bifurcation curve through it: which equations, and the first point."""

from dataclasses import dataclass

import numpy as np

from vibro_sweep.analysis.branches.beginning import keeps_symmetry
from vibro_sweep.analysis.branches.special import SpecialPoint, inserted
from vibro_sweep.analysis.branches.switching import index_in
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses import locus

KINDS = {
    "fold": locus.FOLD,
    "flip": locus.FLIP,
    "pitchfork": locus.FLIP,
    "neimark_sacker": locus.TORUS,
    "graze": locus.GRAZE,
    "sticking": locus.STICK,
}


@dataclass(frozen=True)
class Start:
    """The orbit at a bifurcation; index: of the impact that grazes; state: of an onset of sticking (`Chatter`)."""

    type: str
    solution: Solution
    index: int = 0
    theta: float = 0.0
    state: np.ndarray | None = None

    @property
    def kind(self) -> int:
        return KINDS[self.type]


def start_at(special: SpecialPoint, names: tuple[str, ...] = ()) -> Start:
    """For curves in the parameters `names`: in whole periods where one of them breaks the symmetry of the orbit.

    A pitchfork is then a fold, and its point a cusp. Raises ValueError for a type without curves, and for orbits that
    rest.
    """
    start = _start(special)
    if start.solution.sigma == 1 or all(keeps_symmetry(start.solution.family, name) for name in names):
        return start
    if start.type == "sticking":
        raise ValueError(
            f"parameters: {names!r} is not allowed: where the symmetry is broken, both chatter sequences of this "
            "orbit have an onset of their own"
        )
    return Start("fold" if start.type == "pitchfork" else start.type, start.solution.whole(), start.index, start.theta)


def _start(special: SpecialPoint) -> Start:
    if special.type not in KINDS:
        allowed = ", ".join(KINDS)
        raise ValueError(f"special.type: {special.type!r} is not allowed; it must be one of {allowed}")
    if special.type == "sticking":
        if special._chatter is None:
            raise ValueError("special: this sticking is not the onset at which impacts accumulate; it has no curve")
        return Start("sticking", special._chatter.solution, 0, 0.0, special._chatter.state)
    solution = special.orbit._solution
    if solution.rests:
        raise ValueError("special: the mass rests on a stop; curves of such orbits cannot be followed")
    if special.type == "graze":
        if special.impact is not None:
            return Start("graze", solution, index_in(special))
        return Start("graze", *inserted(solution))
    if special.type != "neimark_sacker":
        return Start(special.type, solution)
    mu = solution.multipliers
    critical = mu[np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf))]
    return Start("neimark_sacker", solution, theta=float(np.angle(critical)))
