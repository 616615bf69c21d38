"""`continue_orbit`: a branch of periodic orbits in one parameter, with its bifurcations, to where it ends.

A branch has one itinerary. It ends where an impact appears or vanishes (graze), where a doubled or asymmetric orbit is
born (flip, pitchfork), or at the end of the range. Of several events within a step the earliest counts: what follows
the end of a branch is no motion any more.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import xarray as xr

from vibro_sweep.analysis.branch_points import dataset
from vibro_sweep.analysis.periodic import PeriodicOrbit
from vibro_sweep.analysis.special import SpecialPoint
from vibro_sweep.analysis.track import Rows, join
from vibro_sweep.analysis.walk import Walk
from vibro_sweep.analysis.way import Way
from vibro_sweep.model.arguments import check_type
from vibro_sweep.model.linear import family_of


@dataclass(frozen=True, eq=False)
class Branch:
    """A branch, from the end that is reached towards smaller parameters first to the other one.

    special : all special points in order, `begins` and `ends` among them
    closed : whether it comes back to itself; then both ends are the orbit it started from, of type "closed"
    """

    parameter: str
    special: list[SpecialPoint]
    begins: SpecialPoint
    ends: SpecialPoint
    closed: bool
    _walk: Walk
    _frame: tuple[int, int]
    _rows: Rows

    @cached_property
    def points(self) -> xr.Dataset:
        """Dataset over `point`: the parameter, state at t = 0, multipliers, margin, impacts (docs of `dataset`)."""
        return dataset(self._walk, self._frame, self._rows)


def continue_orbit(orbit: PeriodicOrbit, parameter: str, bounds: tuple[float, float], progress=None) -> Branch:
    """Follow a periodic orbit both ways in `parameter`, a number of its system, within bounds = (lo, hi).

    `progress(points, value)` is called now and then with the points so far, of this way, and where they are.

    Raises ValueError for an orbit that is not ok, a name that is no number of the system, or bounds that do not hold
    its value.
    """
    check_type("orbit", orbit, PeriodicOrbit, "a PeriodicOrbit, as `periodic_orbit` returns it")
    if not orbit.ok:
        raise ValueError(f"orbit: its status is {orbit.status!r}; only an orbit that is ok can be followed")
    family = family_of(orbit.system)
    names = [name for name, value in family.numbers.items() if isinstance(value, (int, float))]
    if parameter not in names:
        raise ValueError(f"parameter: {parameter!r} is not allowed; it must be one of {', '.join(names)}")
    lo, hi = map(float, bounds)
    if not (math.isfinite(lo) and math.isfinite(hi) and lo < hi and lo <= family.numbers[parameter] <= hi):
        raise ValueError(f"bounds: {bounds!r} is not allowed; it must be lo < hi around {family.numbers[parameter]!r}")
    walk = Walk(orbit._solution, parameter, hi - lo)
    down = Way(walk, -1.0, lo, hi, orbit.system, progress)
    down.go()
    if down.closed:
        closed = down.special
        return Branch(parameter, closed, closed[-1], closed[-1], True, walk, down.frame, down.points)
    up = Way(walk, 1.0, lo, hi, orbit.system, progress)
    up.go()
    special = [*reversed(down.special), *up.special]
    backwards = Rows(*(values[:0:-1] for values in down.points))
    rows = join([backwards, up.points])
    return Branch(parameter, special, down.special[-1], up.special[-1], False, walk, down.frame, rows)
