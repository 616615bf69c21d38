"""The stretch of a branch on which its orbit is stable: to the first special point in each direction."""

from vibro_sweep.analysis.branches.branch import Branch
from vibro_sweep.analysis.branches.branch_start import start_of_run
from vibro_sweep.analysis.branches.branch_switching import mirrored
from vibro_sweep.analysis.branches.free_run import run_from
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.recorded import both_directions
from vibro_sweep.analysis.continuation.starting_orbit import keeps_symmetry
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of


def stable_stretch(orbit: PeriodicOrbit, parameter: str, bounds: tuple[float, float]) -> Branch:
    """The branch of a stable orbit to its first bifurcation, its end or a bound, in both directions of `parameter`.

    Raises ValueError for an orbit that cannot be corrected.
    """
    first = start_of_run(orbit._solution, parameter, *bounds, stable=True)
    down, up = (run_from(point, orbit.system, stable=True) for point in (first.backwards(), first))
    down.follow()
    up.follow()
    rows = both_directions(down.points, up.points)
    special = [down.special[0], up.special[0]]
    return Branch(parameter, special, *special, down.closed, first.curve.orbit, down.frame, rows)


def stable_end(orbit: PeriodicOrbit, parameter: str, bounds: tuple[float, float], forwards: float) -> SpecialPoint:
    """The special point that ends the stability of an orbit in one direction, +1.0 or -1.0; type boundary: it is stable
    up to the bound.

    Raises ValueError for an orbit that cannot be corrected.
    """
    first = start_of_run(orbit._solution, parameter, *bounds, stable=True)
    run = run_from(first if forwards > 0 else first.backwards(), orbit.system, stable=True)
    run.follow()
    return run.special[0]


def representative(orbit: PeriodicOrbit, parameter: str) -> PeriodicOrbit:
    """The orbit, or its mirror image, that gives a window its name: the one with more impacts on the right.

    Where both have as many, the one whose itinerary comes first; of the same itinerary, whose first impact does. Where
    the parameter breaks the symmetry of the oscillator, the orbit itself.
    """
    solution = orbit._solution
    if orbit.symmetric or not solution.K or not solution.family.linear.symmetric:
        return orbit
    if not keeps_symmetry(solution.family, parameter):
        return orbit
    return min(orbit, orbit_of(orbit.system, mirrored(solution)), key=_order)


def _order(orbit: PeriodicOrbit) -> tuple:
    return -orbit.itinerary.count("R"), orbit.itinerary, float(orbit._whole[0][0])
