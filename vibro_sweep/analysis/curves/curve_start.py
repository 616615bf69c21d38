"""From a special point to the bifurcation curve through it: which equations, and the first point."""

import numpy as np

from vibro_sweep.analysis.branches.branch_run import stop_and_impact
from vibro_sweep.analysis.branches.branch_switching import index_in
from vibro_sweep.analysis.branches.criticality import critical_angle
from vibro_sweep.analysis.branches.special import SpecialPoint, bare, inserted, vanishing
from vibro_sweep.analysis.continuation.starting_orbit import KINDS, StartingOrbit, keeps_symmetry
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.tables.bifurcations import BIRTHS

SLOW = 1e-9  # impulse, in parts of the gap's size times omega, below which an impact is a graze


def start_at(special: SpecialPoint, names: tuple[str, ...] = ()) -> StartingOrbit:
    """The start of a curve in the parameters `names`, in whole periods where one of them breaks the orbit's symmetry.

    A pitchfork is then a fold, and its point a cusp. Raises ValueError for a type without curves, and for orbits that
    rest.
    """
    solution = _solution(special)
    symmetric = all(keeps_symmetry(solution.family, name) for name in names)
    start = _start(special, solution, symmetric)
    if start.solution.sigma == 1 or symmetric:
        return start
    if start.type == "sticking":
        raise ArgumentError(
            f"parameters: {names!r} is not allowed: where the symmetry is broken, both chatter sequences of this "
            "orbit have an onset of their own"
        )
    name = "fold" if start.type in BIRTHS else start.type
    return StartingOrbit(name, start.solution.whole(), start.index, start.theta)


def as_special(start: StartingOrbit, names, system, error: float = np.nan) -> SpecialPoint:
    """A start as a special point in these parameters, from which `bifurcation_curve` begins.

    Its multipliers are not known where an impact has no speed, but for the one that grazes.
    """
    s, stop, impact = start.solution, None, None
    parameters = {name: float(s.family.free[name]) for name in names}
    if start.type == "graze":
        (stop, impact), multipliers = stop_and_impact(s, start.index), bare(s, start.index).multipliers
    elif len(slow_impacts(s)):
        multipliers = np.full(2 * s.family.linear.masses, np.nan, complex)
    else:
        multipliers = s.multipliers
    orbit = orbit_of(system.replace(**parameters), s)
    return SpecialPoint(start.type, parameters, orbit, multipliers, float(error), stop=stop, impact=impact)


def slow_impacts(solution: Solution) -> list[int]:
    """Indices of the impacts that have no speed."""
    least = SLOW * solution.family.linear.omega * solution.size_of_gap
    return np.flatnonzero(np.abs(solution.jumps) < least).tolist()


def _solution(special: SpecialPoint) -> Solution:
    if special.type not in KINDS:
        allowed = ", ".join(KINDS)
        raise ArgumentError(f"special.type: {special.type!r} is not allowed; it must be one of {allowed}")
    if special.type == "sticking":
        if special._chatter is None:
            raise ArgumentError("special: this sticking is not the onset at which impacts accumulate; it has no curve")
        return special._chatter.solution
    solution = special.orbit._solution
    if not np.all(solution.contacts[list(solution.rests)]):
        raise ArgumentError("special: the mass rests on a stop; curves of such orbits cannot be followed")
    return solution


def _start(special: SpecialPoint, solution: Solution, symmetric: bool) -> StartingOrbit:
    if special.type == "sticking":
        return StartingOrbit("sticking", solution, state=special._chatter.state)
    if special.type == "graze":
        if special.impact is not None:
            return _grazing(solution, index_in(special), symmetric)
        return StartingOrbit("graze", *inserted(solution))
    theta = critical_angle(solution) if special.type == "neimark_sacker" else 0.0
    return StartingOrbit(special.type, solution, theta=theta)


def _grazing(solution: Solution, index: int, symmetric: bool) -> StartingOrbit:
    """The start where impacts vanish together as one graze of a simpler orbit (or the free motion), in its periods:
    that one alone. The others have no speed all along the curve.

    symmetric : whether the oscillator remains so along the curve; else both halves of a symmetric orbit graze by
        themselves
    """
    gone = vanishing(solution, index)
    simpler = bare(solution, gone).reduced()
    if not symmetric and simpler.sigma == -1:
        simpler = simpler.whole()
    if len(gone) > 1 and simpler.half_periods < solution.half_periods:
        return StartingOrbit("graze", *inserted(simpler))
    return StartingOrbit("graze", solution, index)
