"""What a run along a bifurcation curve records: its points, and those of codimension two and ends among them."""

from dataclasses import dataclass

import numpy as np

from vibro_sweep.analysis.branches.branch_run import stop_and_impact
from vibro_sweep.analysis.branches.special import SpecialPoint, bare
from vibro_sweep.analysis.continuation.chatter import chatter_at
from vibro_sweep.analysis.continuation.events import Event, LocatedEvent
from vibro_sweep.analysis.continuation.recorded import Rows, join, rows_of
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.curves.short_contacts import ShortContacts
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.continuation.path import Record
from vibro_sweep.engine.continuation.problem import GRAZE, STICK
from vibro_sweep.engine.continuation.workspace import Place
from vibro_sweep.engine.impulses.flow import steady_motion


@dataclass(frozen=True, eq=False, repr=False)
class CurvePoint(SpecialPoint):
    """A point of codimension two on a bifurcation curve, or the end of one.

    type : two bifurcations at once: cusp, fold_flip, ... (docs/how/curves.md); closed, boundary or failed
    parameters : both, by their names
    multipliers : of the half map where the orbit is symmetric; of a graze, of the orbit without the grazing impact
    impact : index in `orbit.impacts` of one that has no speed there, or None
    error : own estimate of the error of the parameters
    curve : type of the curve that was followed
    touches : whether a flight of `orbit` touches a stop

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> curve = vs.bifurcation_curve(branch.special[1], ("b", "omega"), ((3.8, 4.5), (0.6, 0.66)))
    >>> point = curve.special[1]
    >>> point.type, {name: round(value, 8) for name, value in point.parameters.items()}
    ('degenerate_neimark_sacker', {'b': 4.40040895, 'omega': 0.63389548})
    """

    curve: str = ""
    touches: bool = False


class CurveRecord:
    """The points of a run, in order, and its special points; `curve` is the one that is followed now."""

    def __init__(self, curve: SolutionCurve, system):
        self.curve, self.system = curve, system
        self.special: list[CurvePoint] = []
        self.short = ShortContacts(curve)
        self._rows: list[Rows] = []

    @property
    def points(self) -> Rows:
        return join(self._rows)

    def keep(self, record: Record, count: int) -> None:
        """The points of compiled steps."""
        if count:
            r = Record(*(values[:count] for values in record))
            self._add_rows(r.x, r.motion, r.p, r.tests, r.omega)

    def add(self, place: Place) -> None:
        """A point of the curve."""
        w = self.curve
        w.assemble(place)
        motion, omega = w.workspace.events["motion"][None], w.planes[0]["numbers"][OMEGA, None]
        self._add_rows(place.x[None], motion, place.p[None], place.tests[None], omega)

    def _add_rows(self, x, motion, p, tests, omega) -> None:
        w = self.curve
        self.short.keep(x, p)
        state = x[:, 0, : w.n] * w.state_units
        self._rows.append(rows_of(w, x, motion, p, tests, omega, w.tau, state))

    def add_solution(self, p: np.ndarray, s: Solution) -> None:
        """An orbit that is not of this curve."""
        w, q = self.curve, s.family.linear
        later, motion = (q.tau - w.tau) / q.omega, s.motion[:, :2]
        h = s.states[0, : w.n] - steady_motion(q, s.times[0])
        values = p, s.times + later, s.jumps, s.ends + later, motion, np.array(s.stop_distance), np.array(s.change), h
        self._rows.append(Rows(*(value[None].copy() for value in values)))

    def add_special(self, of_type, place: Place, error: float, event: Event | None = None, curve=None) -> None:
        """A special point that is recorded already; `curve`: on which it lies, if not on this one."""
        self.special.append(self.special_point(of_type, place, error, event, curve))

    def add_event(self, found: LocatedEvent) -> None:
        """A special point, and the point of the curve."""
        self.add(found.place)
        self.add_special(found.event.type, found.place, found.error, found.event)

    def knows(self, one: LocatedEvent) -> bool:
        """Whether rounding of a test, which changes its sign more than once, does not tell this from a known point."""
        return one.event.index is not None and any(
            known.type == one.event.type
            and np.all(np.abs(one.place.p[:2] - list(known.parameters.values())) <= one.error + known.error)
            for known in self.special
        )

    def special_point(self, of_type, place: Place, error: float, event: Event | None = None, curve=None) -> CurvePoint:
        w = curve or self.curve
        solution = w.solution(place)
        parameters = dict(zip(w.names, map(float, place.p[:2]), strict=True))
        if w.problem.kind == STICK:
            orbit, stop = PeriodicOrbit(self.system.replace(**parameters), "sticking"), w.orbit.sides[-1]
            return CurvePoint(
                of_type, parameters, orbit, np.empty(0, complex), error, stop=stop, curve=w.start.type,
                _chatter=chatter_at(w, place, event is not None and event.touches),
            )  # fmt: skip
        orbit = orbit_of(self.system.replace(**parameters), solution)
        grazes = w.problem.kind == GRAZE
        index = w.problem.index if grazes else event.impact if event is not None else None
        stop, impact = (None, None) if index is None else stop_and_impact(solution, index)
        multipliers = bare(solution, w.problem.index).multipliers if grazes else solution.multipliers
        return CurvePoint(
            of_type, parameters, orbit, multipliers, error, impact=impact, stop=stop, curve=w.start.type,
            touches=event is not None and event.touches,
        )  # fmt: skip
