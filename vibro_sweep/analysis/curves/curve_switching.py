"""`switch`: also from a point of codimension two to the bifurcation curves that pass through it or begin there."""

import math
from itertools import combinations
from typing import overload

import numpy as np

from vibro_sweep.analysis.branches.branch_switching import switch as switch_branches
from vibro_sweep.analysis.branches.special import SpecialPoint, bare, inserted
from vibro_sweep.analysis.continuation.chatter import Chatter
from vibro_sweep.analysis.continuation.first_point import first_place
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.curves.born import born, box_around
from vibro_sweep.analysis.curves.curve_record import CurvePoint
from vibro_sweep.analysis.curves.curve_start import as_special, slow_impacts
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.arguments import check_type, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.engine.continuation.workspace import THETA
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, name_of

SINGULAR = 1e-8  # least singular value of G(mu), of its largest, below which mu is a multiplier
ON_CIRCLE = 1e-8  # | |mu| - 1 | of a Neimark-Sacker pair
BESIDE = 0.2  # theta at which the Neimark-Sacker curve of a double multiplier 1 (-1) is entered
ENDS = tuple(one.name for one in CODIMENSION_TWO if not one.label)
STRONG = ("resonance_1_1", "resonance_1_2")


@overload
def switch(special: CurvePoint) -> list[SpecialPoint]: ...  # type: ignore[overload-overlap]


@overload
def switch(special: SpecialPoint) -> list[PeriodicOrbit]: ...


@names_its_arguments
def switch(special):
    """The orbits or bifurcations that begin at a special point.

    Of a branch: the orbits just beyond a pitchfork (two mirror images), a flip (the doubled one) or a graze (with, or
    without, the impact that has no speed there; at the graze of the free motion those that hit one stop or both).
    Orbits that pass a stop are left out. Of a curve, at a point of codimension two: fold, flip (pitchfork),
    Neimark-Sacker, graze and sticking curves through it, and those of orbits with two or four times the period that
    begin there, as special points from which `bifurcation_curve` can start.

    Raises ValueError for a special point of another type.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> [(one.itinerary, one.stable) for one in vs.switch(branch.begins)]
    [('LR', False)]
    """
    check_type("special", special, SpecialPoint, "a special point of a branch or of a curve")
    if not isinstance(special, CurvePoint):
        return switch_branches(special)
    if special.type in ENDS:
        raise ArgumentError(f"type: {special.type!r} is not allowed; it must be a point of codimension two")
    found = [_special(special, start) for start in _starts(special)]
    if special.type in STRONG:
        beside = _beside_strong(special)
        found += [beside] if beside is not None else []
    return found + born(special)


def _starts(special: CurvePoint) -> list[StartingOrbit]:
    """Each bifurcation of each orbit that has this motion: with and without the impacts that have no speed."""
    if special._chatter is not None:
        return _sticking(special._chatter)
    whole = special.orbit._solution
    if special.touches:
        whole = inserted(whole, slow_impacts(whole))[0]
    slow = slow_impacts(whole)
    starts = []
    for count in range(len(slow) + 1):
        for dropped in combinations(slow, count):
            solution = bare(whole, dropped)
            kept = [k - sum(other < k for other in dropped) for k in slow if k not in dropped]
            starts += [StartingOrbit("graze", solution, k) for k in kept]
            if solution.K:
                starts += _smooth(solution, bool(kept) or special.type in STRONG)
    return starts


def _sticking(chatter: Chatter) -> list[StartingOrbit]:
    """The onset of the orbits with and without the impact that has no speed."""
    s = chatter.solution
    _, k = slow_impacts(s)  # the first is the end of the chatter
    return [StartingOrbit("sticking", solution, state=chatter.state) for solution in (s, bare(s, k))]


def _smooth(solution: Solution, no_pair: bool) -> list[StartingOrbit]:
    """Fold, flip and Neimark-Sacker of an orbit; no_pair: not the last, as where rounding makes a pair of a double
    multiplier 1 (-1)."""
    found = []
    for mu, name in ((1, "fold"), (-1, name_of("flip", solution.sigma))):
        if name and is_singular(solution, mu):
            found.append(StartingOrbit(name, solution))
    if not no_pair:
        values = solution.multipliers
        pair = values[(values.imag > 1e-6) & (np.abs(np.abs(values) - 1) < ON_CIRCLE)]
        found += [StartingOrbit("neimark_sacker", solution, theta=float(np.angle(mu))) for mu in pair]
    return found


def is_singular(solution: Solution, mu: int) -> bool:
    """Whether mu is a multiplier, also where an impact has no speed; False where all numbers would be."""
    try:
        values = np.linalg.svd(Linearised(solution).closure(mu), compute_uv=False)
    except np.linalg.LinAlgError:
        return False
    return bool(values[-1] < SINGULAR * values[0])


def _special(special: CurvePoint, start: StartingOrbit) -> SpecialPoint:
    if start.state is None:
        return as_special(start, special.parameters, special.orbit.system, special.error)
    chatter, none = Chatter(start.solution, start.state), np.empty(0, complex)
    return SpecialPoint(
        "sticking", special.parameters, special.orbit, none, special.error, special.stop, _chatter=chatter
    )


def _beside_strong(special: CurvePoint) -> SpecialPoint | None:
    """A point near the end of the Neimark-Sacker curve that leaves a double multiplier."""
    solution = special.orbit._solution
    names = tuple(special.parameters)
    theta = BESIDE if special.type == "resonance_1_1" else math.pi - BESIDE
    curve = SolutionCurve(StartingOrbit("neimark_sacker", solution, theta=theta), names, box_around(special))
    place = first_place(curve, curve.axis(THETA))
    if place is None:
        return None
    return as_special(
        StartingOrbit("neimark_sacker", curve.solution(place)), names, special.orbit.system, special.error
    )
