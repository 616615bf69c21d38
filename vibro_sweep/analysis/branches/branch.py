"""`continue_orbit`: a branch of periodic orbits in one parameter, with its bifurcations, to where it ends.

A branch has one itinerary. It ends where an impact appears or vanishes (graze), where a doubled or asymmetric orbit is
born (flip, pitchfork), or at the end of the range. Of several events within a step the earliest counts: what follows
the end of a branch is not a motion any more.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.analysis.branches import branch_text
from vibro_sweep.analysis.branches.branch_orbits import Arrays, orbit_at, outline
from vibro_sweep.analysis.branches.branch_points import columns, columns_from_file, of_contacts
from vibro_sweep.analysis.branches.branch_start import NoStartError, changes_rests, start_of_run
from vibro_sweep.analysis.branches.compiled_stepper import row_of
from vibro_sweep.analysis.branches.free_run import run_from
from vibro_sweep.analysis.branches.sizes import check_width, checked_step
from vibro_sweep.analysis.branches.special import SpecialPoint, table_of
from vibro_sweep.analysis.branches.sticking import sticking_onset
from vibro_sweep.analysis.continuation.allowed_range import in_range
from vibro_sweep.analysis.continuation.recorded import Rows, both_directions
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit_portrait import portrait
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.single.result import FileResult
from vibro_sweep.checks.arguments import (
    check_call,
    check_type,
    checked_count,
    checked_interval,
    checked_word,
    names_its_arguments,
)
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.family import Family, family_of
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.oscillator.stops import NOT_PRESSED
from vibro_sweep.tables.file_columns import BRANCHES, OF_CONTACTS
from vibro_sweep.tables.observables import ALONG_BRANCHES

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False, repr=False)
class Branch(FileResult):
    """A branch, from the end that is reached towards smaller parameters first to the other one.

    parameter : the name of the number that changes along it
    special : all special points in order, `begins` and `ends` among them. Beyond an end at which a chatter sequence
        gains an impact follows the onset of sticking, where such grazes accumulate; it is the end itself where rounding
        does not distinguish the two
    closed : whether it comes back to itself; then both ends are the orbit it started from, of type "closed"

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> branch.status, branch.begins.type, branch.ends.type
    ('ok', 'graze', 'boundary')
    >>> int(branch.points.unstable[0]), int(branch.points.unstable[-1])
    (0, 2)
    """

    parameter: str
    special: list[SpecialPoint]
    begins: SpecialPoint
    ends: SpecialPoint
    closed: bool
    _start: Solution
    _frame: tuple[int, int]
    _rows: Rows | None  # None of one that was read from a file, which has
    _arrays: dict[str, np.ndarray] | None = None
    _contacts: bool = False  # whether `points` has what is observed of them

    def __repr__(self) -> str:
        return branch_text.of_branch(self)

    @property
    def status(self) -> str:
        """`ok`, or `failed` where it could not be followed to an end, or not at all: then it has one point."""
        return "failed" if "failed" in (self.begins.type, self.ends.type) else "ok"

    @property
    def ok(self) -> bool:
        """Whether it was followed to both of its ends."""
        return self.status == "ok"

    @cached_property
    def points(self) -> "xarray.Dataset":
        """Dataset over `point`, with the parameter as a coordinate: state at t = 0, multipliers, distance, impacts, and
        where `observe` has contacts, their largest force and penetration."""
        import xarray

        from vibro_sweep.results.ragged_dataset import columns_in_file, described_points

        of = self.special[0].orbit.system
        points = xarray.Dataset(self._columns).set_coords(self.parameter)
        if isinstance(of, Family):  # whose numbers have no units
            return points
        return described_points(columns_in_file(BRANCHES, [self.parameter], of, OF_CONTACTS), points)

    @cached_property
    def _columns(self) -> dict[str, tuple]:
        """Dimensions and values of each column of `points`."""
        if self._arrays is not None:
            return columns_from_file(self._arrays, self.parameter)
        result = columns(self._start, self.parameter, self._frame, self._rows)
        return result | of_contacts(map(self.orbit, range(len(self._rows.p)))) if self._contacts else result

    def orbit(self, point: int) -> PeriodicOrbit:
        """The orbit at a point, as `points` counts them from 0; -1 is the last.

        Raises ValueError for a point that there is not.

        Examples
        --------
        >>> import vibro_sweep as vs
        >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
        >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.9, 4.1))
        >>> orbit = branch.orbit(-1)
        >>> orbit.itinerary, orbit.system.b
        ('R', 4.1)
        """
        arrays = self._outline
        count = len(arrays["value"])
        point = checked_count("point", point, -count, count - 1)
        system = self.special[0].orbit.system.replace(**{self.parameter: float(arrays["value"][point])})
        return orbit_at(arrays, point, system)

    @cached_property
    def _outline(self) -> Arrays:
        return self._arrays or outline(self._start, self.parameter, self._frame, self._rows)

    def _table(self) -> dict[str, list]:
        return table_of(self.special)

    def _picture_of(self, row: int) -> str:
        return portrait(self.special[row].orbit)


@names_its_arguments
@one_thread()
def continue_orbit(
    orbit: PeriodicOrbit,
    parameter: str,
    bounds: tuple[float, float],
    progress=None,
    step: float = 1.0,
    observe: Iterable[str] = (),
) -> Branch:
    """Follow a periodic orbit in both directions of `parameter`, a number of its system, within bounds = (lo, hi).

    `progress(points, value)` is called now and then with the points of this direction so far, and where they are.
    `step` multiplies the lengths of all steps: shorter ones give more points, and the same special points.
    `observe`, of compliant stops, may have "contacts": their largest force and penetration at each point.

    A branch that comes to where the number is not allowed any more ends there, with the type "boundary". What fails is
    told by `.status`.

    Raises ValueError for an orbit that is not ok, a name that is not a number of the system, bounds that do not hold
    its value, the restitution of a stop on which the mass rests, or contacts of rigid stops.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> [(one.type, round(one.parameters["b"], 8)) for one in branch.special]
    [('graze', 3.22190388), ('neimark_sacker', 4.34741799), ('boundary', 4.5)]
    """
    check_type("orbit", orbit, PeriodicOrbit, "a PeriodicOrbit, as `periodic_orbit` returns it")
    check_call("progress", progress, "progress(points, value)", 0, 0.0)
    if not orbit.ok:
        raise ArgumentError(f"orbit: its status is {orbit.status!r}; it must be ok to be followed")
    family = family_of(orbit.system)
    parameter = checked_word("parameter", parameter, list(family.free))
    solution = orbit._solution
    if changes_rests(solution, parameter):
        allowed = "another number: an orbit that rests after one impact does so at R = 0"
        raise ArgumentError(not_allowed("parameter", parameter, allowed))
    lo, hi = checked_interval("bounds", bounds, family.free[parameter])
    step, contacts = checked_step(step), bool(checked_observe(observe, family.linear))
    lo, hi = (in_range(orbit.system, parameter, bound) for bound in (lo, hi))
    check_width("bounds", solution, parameter, lo, hi)
    try:
        first = start_of_run(solution, parameter, lo, hi, step=step)
    except NoStartError:
        return not_followed(orbit, parameter, contacts)
    start, down = first.curve.orbit, run_from(first.backwards(), orbit.system, progress)
    down.follow()
    if down.closed:
        closed = down.special
        end = closed[-1]
        return Branch(parameter, closed, end, end, True, start, down.frame, down.points, None, contacts)
    up = run_from(first, orbit.system, progress)
    up.follow()
    (begins, before), (ends, after) = (_accumulation(run.special[-1], lo, hi) for run in (down, up))
    special = [*before, begins, *reversed(down.special[:-1]), *up.special[:-1], ends, *after]
    rows = both_directions(down.points, up.points)
    return Branch(parameter, special, begins, ends, False, start, down.frame, rows, None, contacts)


MOST_WORDS = 100  # that are read of `observe`, which may have no end


def checked_observe(observe: Any, q: Linear) -> tuple[str, ...]:
    """The words of `observe`. Raises ValueError."""
    try:
        words = None if isinstance(observe, (str, bytes, dict)) else tuple(islice(observe, MOST_WORDS))
    except Exception:  # nothing to go through, or what cannot be
        words = None
    if words is None or any(not isinstance(word, str) or word not in ALONG_BRANCHES for word in words):
        raise ArgumentError(not_allowed("observe", observe, f"[] or {list(ALONG_BRANCHES)}"))
    if words and not q.compliant:
        raise ArgumentError(not_allowed("observe", observe, f"left out: {NOT_PRESSED}"))
    return words


def not_followed(orbit: PeriodicOrbit, parameter: str, contacts: bool = False) -> Branch:
    """An orbit whose branch cannot be followed, as a branch of one point."""
    s, frame = orbit._solution, orbit._canonical_frame
    value = s.family.free[parameter]
    end = SpecialPoint("failed", {parameter: value}, orbit, s.multipliers)
    return Branch(parameter, [end], end, end, False, s, frame, row_of(value, s, frame), None, contacts)


def _accumulation(end: SpecialPoint, lo: float, hi: float) -> tuple[SpecialPoint, list[SpecialPoint]]:
    """The end of a run, and the onset of sticking beyond it, if there is one within the bounds."""
    onset = sticking_onset(end)
    if onset is None:
        return end, []
    ((name, value),) = onset.parameters.items()
    if not lo <= value <= hi:
        return end, []
    apart = abs(value - end.parameters[name]) > end.error + onset.error
    return (end, [onset]) if apart else (onset, [])
