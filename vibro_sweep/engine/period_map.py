"""The interface to the engine: the period map of one system, over whole and half forcing periods.

    step = PeriodMap(system)                             # the flow; PeriodMap(system, order=1 or 2): discontinuity map
    mapped = step(states, periods=2.5, jacobian=True, parameters=True)

P takes the state at t = 0 mod T to the state so many periods later. Orbits are carried eight at a time by the event
loop; derivatives are formed afterwards along the impacts and rests that it has recorded (variational/sensitivity.py),
with nothing orthonormalised, and are compiled when they are first asked for. They are right to rounding times the
condition of the orbit, which near a graze is about (omega |x1|/v1)^2, and belong to the orbit's own sequence of events.

Where M1 begins at rest on a stop they are one-sided, into the gap. What flights without stops need is in
free_flight.py.
"""

import math
from dataclasses import dataclass

import numpy as np

from vibro_sweep.engine.one_system import Engine, is_paper
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.variational.grazing_map import Expansion, iterate
from vibro_sweep.engine.variational.propagator import SIZE, new_scratch
from vibro_sweep.engine.variational.sensitivity import Equations, differentiate
from vibro_sweep.model import status
from vibro_sweep.model.arguments import check_type
from vibro_sweep.model.grazing import expansion_point
from vibro_sweep.model.oscillator import System
from vibro_sweep.model.parameters import FREE_MOTION, NAMES
from vibro_sweep.model.sensitivity import flight_equations, grazing_derivatives, rest_equations

TAU = NAMES.index("tau")


@dataclass(frozen=True)
class Mapped:
    """What a `PeriodMap` returns for n states.

    states : (n, 4) where they are mapped to; NaN where the status is not 0
    status : (n,) int8, codes of model/status.py; a state behind a stop has BEYOND_STOP
    impacts : n structured arrays, fields t (from the section at which the state starts), side, v1 (before), x2, v2;
        of chatter those computed one by one
    sticking : n structured arrays, fields t_on, t_off, side; t_off is the end of the map for a rest that outlasts it
    jacobian : (n, 4, 4) or None; [., i, j] is the derivative of the i-th coordinate by the j-th at the start
    parameters : (n, 4, 8) or None; the derivatives by the parameters in the order of `model.parameters.NAMES`, at a
        fixed phase omega t. For tau: grazing the others include the change of tau; [..., 7] is by tau alone.
    """

    states: np.ndarray
    status: np.ndarray
    impacts: tuple[np.ndarray, ...]
    sticking: tuple[np.ndarray, ...]
    jacobian: np.ndarray | None
    parameters: np.ndarray | None


class PeriodMap:
    """P of one system; call it with states (n, 4) at t = 0 mod T.

    order : 0, the flow; 1 or 2, the discontinuity mapping (41), whose section is the phase of the right graze
        whatever the system's tau, and which knows no behind of a stop
    expand_at : clearance at which that is expanded, by default the exact b*

    Raises ValueError for another order, TypeError for an oscillator that is no System.
    """

    def __init__(self, system: System, order: int = 0, expand_at: float | None = None):
        check_type("system", system, System, "a System")
        if order not in (0, 1, 2):
            raise ValueError(f"order: {order!r} is not allowed; it must be 0 (the flow), 1 or 2")
        self.system = system if order == 0 else system.replace(tau="grazing")
        self.order, self.expand_at = order, expand_at
        self._engine = Engine(self.system)
        self._half_engine: Engine | None = None

    def __call__(self, states, periods: float = 1, *, jacobian: bool = False, parameters: bool = False) -> Mapped:
        """Map states (n, 4) over `periods`, a multiple of 1/2.

        Raises ValueError for another number of periods, or for states of another shape.
        """
        halves = 2 * periods
        if not (math.isfinite(halves) and halves >= 0 and halves == int(halves)):
            raise ValueError(f"periods: {periods!r} is not allowed; it must be a multiple of 1/2, and not negative")
        start = np.array(states, float)
        if start.ndim != 2 or start.shape[1] != 4:
            raise ValueError(f"states: shape {start.shape} is not allowed; it must be (n, 4)")
        columns = 4 + len(NAMES) if parameters else 4
        compute = self._flow if self.order == 0 else self._discontinuity_map
        ends, codes, impacts, sticking, derivatives = compute(start, int(halves), columns, jacobian or parameters)
        ends[codes != status.OK] = np.nan
        by_state = derivatives[..., :4] if jacobian else None
        by_parameter = self._with_phase(derivatives[..., 4:]) if parameters else None
        return Mapped(ends, codes, impacts, sticking, by_state, by_parameter)

    def _equations(self, engine: Engine, parameters: bool) -> Equations:
        numbers, q = self.system.parameters(), self.system.linear
        free, held = (make(numbers, self.system.mu_c is None) for make in (flight_equations, rest_equations))
        rate = max(abs(np.linalg.eigvals(matrix)).max() for matrix in (free.A, held.A))
        count = len(FREE_MOTION) if parameters else 0
        walls, restitution = np.zeros((2, 2, 4 + len(NAMES) if parameters else 4))
        if parameters:
            walls[:, 4 + NAMES.index("b")] = -1, 1
            restitution[:, 4 + NAMES.index("R")] = self.system.R_left is None, 1
        return Equations(
            free.A, free.A_p[:count], held.A, held.A_p[:count], float(rate),
            numbers["omega"], np.array([q.low, q.high]), np.array([q.R_low, q.R_high]), walls, restitution,
            2 * numbers["zeta"] / numbers["mu_m"],
            float(engine.point["tau"][0]), engine.cells, engine.width,
        )  # fmt: skip

    def _flow(self, start: np.ndarray, halves: int, columns: int, differentiated: bool):
        """Half a period more than whole ones begins in the middle of a period of a force half a period later."""
        engine, cell = self._engine, 0
        if halves % 2:
            if self._half_engine is None:
                self._half_engine = Engine(self.system, later=np.pi)
            engine, cell = self._half_engine, self._half_engine.cells // 2
        periods, n = (halves + 1) // 2, len(start)
        end, begin = halves / 2 * engine.period, engine.time(0, cell, 0.0)
        ends, codes = np.full((n, 4), np.nan), np.full(n, status.OK, np.int8)
        finite = np.isfinite(start).all(axis=1)
        allowed = finite & (start[:, 0] >= engine.stops.left) & (start[:, 0] <= engine.stops.right)
        codes[~allowed], codes[~finite] = status.BEYOND_STOP, status.NOT_FINITE
        impacts, sticking = [engine.impacts(np.empty((0, 7)))] * n, [engine.sticking(np.empty((0, 4)), end)] * n
        derivatives = np.full((n, 4, columns), np.nan)
        for first in range(0, np.count_nonzero(allowed), LANES):
            chosen = np.flatnonzero(allowed)[first : first + LANES]
            orbits, records = engine.carry_eight(start[chosen], cell, periods)
            ends[chosen], codes[chosen] = orbits["X"][:, :4], orbits["status"]
            for lane, i in enumerate(chosen):
                impacts[i] = engine.impacts(records.impacts[lane, : orbits["impacts_logged"][lane]])
                impacts[i]["t"] -= begin
                sticking[i] = engine.sticking(records.rests[lane, : orbits["rests_logged"][lane]], end + begin)
                sticking[i]["t_on"] -= begin
                sticking[i]["t_off"] -= begin
            if differentiated:
                found = np.empty((len(chosen), 4, columns))
                differentiate(
                    self._equations(engine, columns > 4), cell, start[chosen], codes[chosen],
                    records.impacts, orbits["impacts_logged"], records.rests, orbits["rests_logged"],
                    np.array([periods, 0.0, 0.0]), np.empty(3), np.empty(SIZE), np.empty((SIZE, columns)),
                    new_scratch(len(FREE_MOTION) if columns > 4 else 0), found,
                )  # fmt: skip
                derivatives[chosen] = found
        return ends, codes, tuple(impacts), tuple(sticking), derivatives

    def _discontinuity_map(self, start: np.ndarray, halves: int, columns: int, differentiated: bool):
        engine, numbers, n = self._engine, self.system.parameters(), len(start)
        d_graze = np.zeros((4, columns))
        if columns > 4:
            d_graze[:, 4 : 4 + len(FREE_MOTION)] = grazing_derivatives(numbers)[1]
            if self.expand_at is not None:
                d_graze[0] = 0.0
        stops = self.system.stops
        expansion = Expansion(self.order, stops != "left", stops != "right", self.graze, d_graze)
        ends, derivatives = np.empty((n, 4)), np.empty((n, 4, columns))
        rows, counts = np.empty((n, halves + 1, 7)), np.empty(n, np.int64)
        scratch = new_scratch(len(FREE_MOTION) if columns > 4 else 0)
        iterate(
            self._equations(engine, columns > 4), expansion, halves, start, ends, derivatives, rows, counts, scratch
        )
        codes = np.where(np.isfinite(ends).all(axis=1), status.OK, status.NOT_FINITE).astype(np.int8)
        impacts = tuple(engine.impacts(rows[i, : counts[i]]) for i in range(n))
        return ends, codes, impacts, (engine.sticking(np.empty((0, 4)), 0.0),) * n, derivatives

    @property
    def graze(self) -> np.ndarray:
        """X* (4,), the point at which the discontinuity mapping is expanded."""
        return expansion_point(
            {name: np.array(value) for name, value in self.system.parameters().items()}, self.expand_at
        )

    def _with_phase(self, derivatives: np.ndarray) -> np.ndarray:
        """Total derivatives (n, 4, 8) where tau follows the other parameters."""
        if self.order == 0 and self.system.tau == "grazing":
            if is_paper(self.system):
                dtau, _ = grazing_derivatives(self.system.parameters())
            else:
                dtau = [self.system.family.derivative(name).tau for name in FREE_MOTION]
            for name, change in zip(FREE_MOTION, dtau, strict=True):
                derivatives[..., NAMES.index(name)] += change * derivatives[..., TAU]
        return derivatives
