"""`bifurcation_curve`: where a bifurcation happens in the plane of two parameters, from one point of it.

The curve goes on where an impact of its orbit grazes: behind that point the orbit is not a motion any more, and the
points say so (`virtual`).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.branches.sizes import check_width, checked_step
from vibro_sweep.analysis.branches.special import SpecialPoint, table_of
from vibro_sweep.analysis.continuation.allowed_range import in_range
from vibro_sweep.analysis.continuation.chatter import written_out
from vibro_sweep.analysis.continuation.first_point import converge, first_place, guess_of
from vibro_sweep.analysis.continuation.recorded import Rows, both_directions
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.curves import curve_text
from vibro_sweep.analysis.curves.curve_points import dataset, dataset_from_file
from vibro_sweep.analysis.curves.curve_record import CurvePoint
from vibro_sweep.analysis.curves.curve_run import CurveRun
from vibro_sweep.analysis.curves.curve_start import start_at
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit_portrait import portrait
from vibro_sweep.analysis.single.result import FileResult
from vibro_sweep.checks.arguments import check_call, check_type, checked_flag, checked_interval, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import array_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.continuation.curve_tests import TOUCHING
from vibro_sweep.engine.continuation.problem import GRAZE
from vibro_sweep.engine.continuation.workspace import TEST, Place
from vibro_sweep.oscillator.family import Family, family_of
from vibro_sweep.tables.file_columns import CHART

if TYPE_CHECKING:
    import xarray

LEVEL = 1e-9  # rate of a parameter, in parts of its range: rounding, where the curve keeps its value


@dataclass(frozen=True, eq=False, repr=False)
class BifurcationCurve(FileResult):
    """A bifurcation curve, from the end that is reached towards a smaller first parameter to the other one.

    type : fold, flip, pitchfork, neimark_sacker, graze or sticking; a pitchfork is a fold where a parameter breaks the
        symmetry
    parameters : names of both
    special : its points of codimension two in order, `begins` and `ends` among them
    closed : whether it comes back to itself; then both ends are the point it started from, of type "closed"

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> curve = vs.bifurcation_curve(branch.begins, ("b", "omega"), ((3.0, 3.5), (0.62, 0.64)))
    >>> curve.type, curve.begins.type, curve.ends.type
    ('graze', 'boundary', 'boundary')
    >>> float(curve.points.omega.min()), float(curve.points.omega.max())
    (0.62, 0.64)
    """

    type: str
    parameters: tuple[str, str]
    special: list[CurvePoint]
    begins: CurvePoint
    ends: CurvePoint
    closed: bool
    _solution_curve: SolutionCurve | None  # None of one that was read from a file, which has
    _rows: Rows | None
    _arrays: dict[str, np.ndarray] | None = None

    def __repr__(self) -> str:
        return curve_text.of_curve(self)

    @cached_property
    def points(self) -> "xarray.Dataset":
        """Dataset over `point`: parameters, multipliers, whether it is real, impacts (docs of `dataset`)."""
        from vibro_sweep.results.ragged_dataset import columns_in_file, described_points

        if self._solution_curve is None or self._rows is None:
            points = dataset_from_file(self._arrays, self.parameters)
        else:
            points = dataset(self._solution_curve, self._rows)
        of = self.special[0].orbit.system
        if isinstance(of, Family):  # whose numbers have no units
            return points
        return described_points(columns_in_file(CHART, list(self.parameters), of), points)

    def _table(self) -> dict[str, list]:
        return table_of(self.special) | {"touches": [one.touches for one in self.special]}

    def _picture_of(self, row: int) -> str:
        return portrait(self.special[row].orbit)

    def plot(self, *others: "BifurcationCurve", width: float | None = None):
        """Plot this curve and `others` in the same parameters, with their points of codimension two: a matplotlib
        Figure, `width` mm wide.

        Raises ValueError for curves in other parameters.
        """
        from vibro_sweep.plotting.drawn_curves import Drawn, plot_curves

        for curve in others:
            check_type("others", curve, BifurcationCurve, "curves, as `bifurcation_curve` returns them")
        names, drawn = self.parameters, []
        for curve in (self, *others):
            if curve.parameters != names:
                raise ArgumentError(not_allowed("others", curve.parameters, f"curves in {', '.join(names)}"))
            special = [(one.type, *(one.parameters[name] for name in names)) for one in curve.special]
            values = (curve.points[name].values for name in (*names, "virtual"))
            drawn.append(Drawn(curve.type, *values, special))
        return plot_curves(drawn, names, self.begins.orbit.system, width)


@names_its_arguments
@one_thread()
def bifurcation_curve(
    special: SpecialPoint, parameters: tuple[str, str], bounds, progress=None, virtual: bool = True, step: float = 1.0
) -> BifurcationCurve:
    """Follow a bifurcation in both directions in two parameters, numbers of its system.

    special : a fold, flip, pitchfork, neimark_sacker, graze or sticking onset of a branch or of another curve
    bounds : ((lo, hi), (lo, hi)) of both parameters, around the point
    progress(points, (p, q)) is called now and then.
    virtual : whether the curve goes on where its orbit is not a motion any more; otherwise it ends there, at a point of
        codimension two
    step : of the lengths of steps, a factor: shorter ones give more points; the first step is never lengthened

    Raises ValueError for a special point of another type, names that are not numbers of the system, bounds that do not
    hold the point, where the point does not belong to a single curve, and without virtual points where there is no
    motion beside it.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> special = next(one for one in branch.special if one.type == "neimark_sacker")
    >>> curve = vs.bifurcation_curve(special, ("b", "omega"), ((3.8, 4.5), (0.6, 0.66)))
    >>> [one.type for one in curve.special]
    ['boundary', 'degenerate_neimark_sacker', 'boundary']
    """
    check_type("special", special, SpecialPoint, "a special point of a branch or of a curve")
    family = family_of(special.orbit.system)
    allowed = family.free
    names = tuple(parameters) if isinstance(parameters, (tuple, list)) else ()
    if not (all(isinstance(name, str) and name in allowed for name in names) and len({*names}) == len(names) == 2):
        raise ArgumentError(not_allowed("parameters", parameters, f"two of {', '.join(allowed)}"))
    values = array_of(bounds, 2)
    if values is None or values.shape != (2, 2):
        raise ArgumentError(not_allowed("bounds", bounds, f"((lo, hi), (lo, hi)) of {names[0]} and {names[1]}"))
    limits = [
        checked_interval(f"bounds.{name}", ends, family.free[name])
        for name, ends in zip(names, values.tolist(), strict=True)
    ]
    system = special.orbit.system
    limits = [[in_range(system, name, end) for end in ends] for name, ends in zip(names, limits, strict=True)]
    check_call("progress", progress, "progress(points, (p, q))", 0, (0.0, 0.0))
    virtual, step = checked_flag("virtual", virtual), checked_step(step)
    start = start_at(special, names)
    for name, ends in zip(names, limits, strict=True):
        check_width(f"bounds.{name}", start.solution, name, *ends)
    curve = SolutionCurve(start, names, limits, step=step)
    curve, first = first_of(curve)
    if first is None:
        raise ArgumentError(f"special: this {special.type} cannot be followed; it may belong to several curves at once")
    if len(special.parameters) > 1 or special.type != start.type or touches_twice(curve, first):
        # a point of codimension two is seen by a run that passes it, not by one that begins there
        places = curve.beside(first)
        first = next((place for place in places if curve.is_real(place)), (places or [first])[0])
    if not (virtual or curve.is_real(first)):
        raise ArgumentError(f"special: beside this {special.type} there is no motion")
    first.p[:2] = np.clip(first.p[:2], *curve.bounds.T)  # rounding may put it beyond what is allowed
    rates = first.tangent_p[:2]
    sign = -1 if rates[np.argmax(np.abs(rates) > LEVEL)] > 0 else 1  # down in the first parameter that changes
    down = CurveRun(curve, first, sign, system, progress, virtual)
    down.follow()
    if down.closed:
        ends = down.record.special
        return BifurcationCurve(start.type, names, ends, ends[-1], ends[-1], True, curve, down.record.points)
    up = CurveRun(curve, first, -sign, system, progress, virtual)
    up.follow()
    ends = [*reversed(down.record.special), *up.record.special]
    rows = both_directions(down.record.points, up.record.points)
    return BifurcationCurve(start.type, names, ends, down.record.special[-1], up.record.special[-1], False, curve, rows)


def touches_twice(curve: SolutionCurve, place: Place) -> bool:
    """Whether two turning points touch a stop at this point of a curve of grazes: it is of codimension two."""
    if curve.problem.kind != GRAZE:
        return False
    others = np.abs(np.delete(place.jumps, curve.problem.index))
    return bool(abs(place.tests[TEST.stop_distance]) < TOUCHING or np.any(others < TOUCHING))


def first_of(curve: SolutionCurve) -> tuple[SolutionCurve, Place | None]:
    """The first point, if there is one; of an onset of sticking with as many impacts as are needed."""
    if curve.start.state is None:
        return curve, first_place(curve)
    guess = guess_of(curve)
    found = guess and written_out(curve, guess)
    return (found[0], converge(*found)) if found else (curve, None)
