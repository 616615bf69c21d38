"""The interface to the engine: the period map of one oscillator, over whole and half forcing periods.

    step = PeriodMap(system)                             # the flow; PeriodMap(system, order=1 or 2): discontinuity map
    mapped = step(states, periods=2.5, jacobian=True, parameters=True)

P takes the state at t = 0 mod T to the state so many periods later. Orbits are carried eight at a time by the event
loop; derivatives are formed afterwards along the impacts and rests that it has recorded (variational/sensitivity.py),
with nothing orthonormalised, and are compiled when they are first asked for. They are right to rounding times the
condition of the orbit, which near a graze is about (omega |x1|/v1)^2, and belong to the orbit's own sequence of events.

Where an orbit begins at rest on a stop they are one-sided, into the gap. What flights without stops need is in
free_flight.py.
"""

import math
from dataclasses import dataclass

import numpy as np

from vibro_sweep.checks.arguments import is_number
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.variational.grazing_map import Expansion, iterate
from vibro_sweep.engine.variational.parameter_sensitivity import Equations, differentiate
from vibro_sweep.engine.variational.propagator import new_workspace
from vibro_sweep.oscillator.linear import Linear, gap_response, rigid_family_of
from vibro_sweep.oscillator.models.two_mass import NAMES
from vibro_sweep.oscillator.oscillator import Oscillator, System, checked_system
from vibro_sweep.oscillator.sensitivity import grazing_state, grazing_state_slopes, motion, motion_slopes
from vibro_sweep.tables import outcomes as status


@dataclass(frozen=True)
class Mapped:
    """The result of a `PeriodMap` for n states.

    states : (n, 2 N) where they are mapped to; NaN where the status is not 0
    status : (n,) int8, codes of tables/outcomes.py; a state behind a stop has BEYOND_STOP
    impacts : n structured arrays as those of `Orbit.impacts`, t from the section at which the state starts; of chatter
        those computed one by one
    sticking : n structured arrays, fields t_on, t_off, side; t_off is the end of the map for a rest that outlasts it
    jacobian : (n, 2 N, 2 N) or None; [., i, j] is the derivative of the i-th coordinate by the j-th at the start
    parameters : (n, 2 N, m) or None; the derivatives by the parameters `PeriodMap.names`, at a fixed phase omega t.
        For tau: grazing the others include the change of tau; that by tau is by tau alone.
    """

    states: np.ndarray
    status: np.ndarray
    impacts: tuple[np.ndarray, ...]
    sticking: tuple[np.ndarray, ...]
    jacobian: np.ndarray | None
    parameters: np.ndarray | None


class PeriodMap:
    """P of one oscillator; call it with states (n, 2 N) at t = 0 mod T.

    order : 0, the flow; 1 or 2, the discontinuity mapping (41), whose section is the phase of the right graze
        whatever the system's tau, and which knows no behind of a stop
    expand_at : clearance at which that is expanded, by default the exact b*

    `names` : the parameters by which it has derivatives, in order: those of a System are `NAMES` (two_mass.py), of
        others all numbers that are given. Raises ValueError for another order, and for the discontinuity mapping of an
        oscillator that is not symmetric, or has no steady motion.
    """

    def __init__(self, system: Oscillator, order: int = 0, expand_at: float | None = None):
        checked_system(system)
        rigid_family_of(system, "period map")
        if order not in (0, 1, 2):
            raise ArgumentError(not_allowed("order", order, "0 (the flow), 1 or 2"))
        self.system = system if order == 0 else system.replace(tau="grazing")
        self.order, self.expand_at = order, expand_at
        given = NAMES if isinstance(system, System) else tuple(self.system.numbers)
        numbers = self.system.family.numbers
        self.names = tuple(name for name in given if name == "tau" or is_number(numbers[name]))
        if order != 0:
            _check_symmetric(self.system)
        self._linear = self.system.linear
        self._engine = Engine(self.system)
        self._half_engine: Engine | None = None

    def __call__(self, states, periods: float = 1, *, jacobian: bool = False, parameters: bool = False) -> Mapped:
        """Map states (n, 2 N) over `periods`, a multiple of 1/2.

        Raises ValueError for another number of periods, or for states of another shape.
        """
        half_periods = 2 * periods
        if not (math.isfinite(half_periods) and half_periods >= 0 and half_periods == int(half_periods)):
            raise ArgumentError(not_allowed("periods", periods, "a multiple of 1/2, and not negative"))
        start, count = np.array(states, float), self._engine.states
        if start.ndim != 2 or start.shape[1] != count:
            raise ArgumentError(f"states: shape {start.shape} is not allowed; it must be (n, {count})")
        compute = self._flow if self.order == 0 else self._discontinuity_map
        equations = self._equations(parameters) if jacobian or parameters or self.order else None
        ends, codes, impacts, sticking, derivatives = compute(start, int(half_periods), equations)
        ends[codes != status.OK] = np.nan
        by_state = derivatives[..., :count] if jacobian else None
        by_parameter = derivatives[..., count:] if parameters else None
        return Mapped(ends, codes, impacts, sticking, by_state, by_parameter)

    def _slopes(self, parameters: bool) -> list[Linear]:
        """Derivatives of the oscillator by each of `names`; none where they are not wanted."""
        return [self._slope(name) for name in self.names] if parameters else []

    def _slope(self, name: str) -> Linear:
        if name == "tau":
            nothing = {field: np.zeros(np.shape(value)) for field, value in self._linear._asdict().items()}
            return Linear(**nothing)._replace(tau=1.0)
        return self.system.family.derivative(name, self._linear)

    def _equations(self, parameters: bool) -> Equations:
        """The equations in the order of kernels; the phase is that of the engine that carries the orbits."""
        q, slopes = self._linear, self._slopes(parameters)
        here, moved = motion(q), [motion_slopes(q, slope) for slope in slopes]
        size, states = len(here.A), self._engine.states
        moving = np.array([p for p, one in enumerate(moved) if np.any(one.A)], np.int64)
        in_columns = lambda values: np.array([*[np.zeros_like(values[0])] * states, *values[1:]]).T.copy()  # noqa: E731
        across = np.linalg.solve(q.M, q.C @ here.push)
        rate = max(abs(np.linalg.eigvals(matrix)).max() for matrix in (here.A, here.constrained))
        stops, restitution = np.array([q.low, q.high]), np.array([q.R_low, q.R_high])
        return Equations(
            here.A, np.array([moved[p].A for p in moving]).reshape(-1, size, size),
            here.constrained, np.array([moved[p].constrained for p in moving]).reshape(-1, size, size), states + moving,
            float(rate), q.omega, np.array(q.normal, float), here.push, across - here.push * (q.normal @ across),
            stops, restitution,
            in_columns([here.push, *(one.push for one in moved)]),
            in_columns([stops, *(np.array([slope.low, slope.high], float) for slope in slopes)]),
            in_columns([restitution, *(np.array([slope.R_low, slope.R_high], float) for slope in slopes)]),
            in_columns([0.0, *(float(slope.omega) for slope in slopes)]),
            in_columns([0.0, *(0.0 if self.order else float(slope.tau) for slope in slopes)]),
            float(self._engine.point["tau"][0]), self._engine.cells, self._engine.width,
        )  # fmt: skip

    def _flow(self, start: np.ndarray, half_periods: int, equations: Equations | None):
        """Half a period more than whole ones begins in the middle of a period of a force half a period later."""
        engine, cell = self._engine, 0
        if half_periods % 2:
            if self._half_engine is None:
                self._half_engine = Engine(self.system, later=np.pi)
            engine, cell = self._half_engine, self._half_engine.cells // 2
        periods, (n, states) = (half_periods + 1) // 2, start.shape
        end, begin = half_periods / 2 * engine.period, engine.time(0, cell, 0.0)
        ends, codes = np.full((n, states), np.nan), np.full(n, status.OK, np.int8)
        contact = engine.to_contact(start)
        finite = np.isfinite(start).all(axis=1)
        allowed = finite & (contact[:, 0] >= engine.stops.left) & (contact[:, 0] <= engine.stops.right)
        codes[~allowed], codes[~finite] = status.BEYOND_STOP, status.NOT_FINITE
        nothing = engine.impacts(np.empty((0, 3 + states)))
        impacts, sticking = [nothing] * n, [engine.sticking(np.empty((0, 4)), end)] * n
        columns = 0 if equations is None else len(equations.omega_slopes)
        derivatives = np.full((n, states, columns), np.nan)
        for first in range(0, np.count_nonzero(allowed), LANES):
            chosen = np.flatnonzero(allowed)[first : first + LANES]
            orbits, records = engine.carry_eight(contact[chosen], cell, periods)
            ends[chosen], codes[chosen] = engine.to_masses(orbits["X"][:, :states]), orbits["status"]
            for lane, i in enumerate(chosen):
                impacts[i] = engine.impacts(records.impacts[lane, : orbits["impacts_logged"][lane]])
                impacts[i]["t"] -= begin
                sticking[i] = engine.sticking(records.rests[lane, : orbits["rests_logged"][lane]], end + begin)
                sticking[i]["t_on"] -= begin
                sticking[i]["t_off"] -= begin
            if equations is not None:
                moved = equations._replace(tau=float(engine.point["tau"][0]))
                on_stop = np.isin(contact[chosen, 0], [engine.stops.left, engine.stops.right])
                events = np.concatenate([records.impacts[..., :5], engine.impact_states(records.impacts)], -1)
                found = np.empty((len(chosen), states, columns))
                # copies: fields of several records are not contiguous arrays, of one they are, and kernels are compiled
                # for each of the two
                hits, rests = orbits["impacts_logged"].copy(), orbits["rests_logged"].copy()
                differentiate(
                    moved, cell, start[chosen], on_stop & (contact[chosen, 1] != 0), codes[chosen],
                    events, hits, records.rests, rests,
                    np.array([periods, 0.0, 0.0]), np.empty(3), *_scratch(moved, columns), found,
                )  # fmt: skip
                derivatives[chosen] = found
        return ends, codes, tuple(impacts), tuple(sticking), derivatives

    def _discontinuity_map(self, start: np.ndarray, half_periods: int, equations: Equations):
        engine, (n, states) = self._engine, start.shape
        columns, masses = len(equations.omega_slopes), len(equations.normal)
        slopes = self._slopes(columns > states)
        d_graze, d_pull = np.zeros((2, states, columns))
        parameter = np.full(columns, -1)
        parameter[equations.columns] = np.arange(len(equations.columns))
        rows = slice(1, states, 2)
        pull = equations.omega * (equations.normal @ equations.A[rows, :states])
        for j, slope in enumerate(slopes, states):
            d_graze[:, j] = grazing_state_slopes(self._linear, slope)
            if self.expand_at is not None:
                d_graze[:, j] -= self._up_to(d_graze[0::2, j] @ equations.normal, equations.push)
                change = self.expand_at - grazing_state(self._linear)[0::2] @ equations.normal
                d_graze[:, j] += self._up_to(change, equations.push_slopes[:, j])
            d_pull[:, j] = slope.omega * pull / equations.omega
            if parameter[j] >= 0:
                moved = equations.A_p[parameter[j]]
                d_pull[:, j] += equations.omega * (equations.normal @ moved[rows, :states])
        stops = self.system.options.get("stops", "both")  # of a model that always has both
        expansion = Expansion(
            self.order, stops != "left", stops != "right", self.graze, d_graze, pull, d_pull, parameter
        )
        ends, derivatives = np.empty((n, states)), np.empty((n, states, columns))
        hits, counts = np.empty((n, half_periods + 1, 5 + states)), np.empty(n, np.int64)
        workspace = new_workspace(2 * masses + 3, len(equations.columns))
        iterate(equations, expansion, half_periods, start, ends, derivatives, hits, counts, workspace)
        codes = np.where(np.isfinite(ends).all(axis=1), status.OK, status.NOT_FINITE).astype(np.int8)
        impacts = tuple(engine.impacts_of(hits[i, :k, :5], hits[i, :k, 5:]) for i, k in enumerate(counts))
        return ends, codes, impacts, (engine.sticking(np.empty((0, 4)), 0.0),) * n, derivatives

    @property
    def graze(self) -> np.ndarray:
        """X* (2 N,), the point at which the discontinuity mapping is expanded."""
        state = grazing_state(self._linear)
        if self.expand_at is not None:
            state += self._up_to(self.expand_at - self._linear.normal @ state[0::2], motion(self._linear).push)
        return state

    @staticmethod
    def _up_to(gap: float, push: np.ndarray) -> np.ndarray:
        """A displacement (2 N,) of the gap by so much, in the direction of an impulse."""
        return np.kron(gap * push, [1.0, 0.0])


def _scratch(e: Equations, columns: int) -> tuple:
    """z, dz, bend and w of `differentiate`."""
    size, masses = len(e.A), len(e.normal)
    return np.empty(size), np.empty((size, columns)), np.empty((2, masses)), new_workspace(size, len(e.columns))


def _check_symmetric(system: Oscillator) -> None:
    """Check what the discontinuity mapping needs: the two halves of a period are mirror images, and a steady motion."""
    q = system.linear
    if getattr(system, "offset", 0.0) != 0 or q.R_low != q.R_high or np.any(q.constant):
        allowed = "one with equal stops about 0 and without a constant force, for the discontinuity mapping"
        raise ArgumentError(not_allowed("system", system, allowed))
    if not gap_response(q):
        raise ArgumentError(not_allowed("system", system, "one whose gap has a steady motion, which grazes"))
