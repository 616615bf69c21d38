"""One orbit, for a person at a prompt: `simulate` and `lyapunov`."""

import math
from dataclasses import dataclass, field

import numpy as np

from vibro_sweep.kernels import ensemble, orbits, points, status, tables
from vibro_sweep.kernels.spectrum import BATCHES
from vibro_sweep.system import NAMES, ParameterError, System, modes

IMPACT = np.dtype([("t", float), ("side", np.int8), ("v1", float), ("x2", float), ("v2", float)])
STICKING = np.dtype([("t_on", float), ("t_off", float), ("side", np.int8)])

CHUNK = 256  # periods computed before a look at how many impacts there were
ROOM = 4096  # impacts there is room for at first


def points_of(parameters: dict[str, np.ndarray]) -> np.ndarray:
    """Systems with these numbers (arrays of one shape, tau resolved) as POINTs of the kernels, of that shape."""
    result = np.zeros(np.shape(parameters["b"]), points.POINT)
    for name in NAMES:
        result[name] = parameters[name]
    result["psi"], result["omega_squared"] = modes(result["mu_m"], result["mu_k"])
    result["cells"] = tables.cells_needed(result["omega_squared"], result["zeta"], result["omega"])
    return result


def _plan(system: System, transient: int = 0, record: int = 0, lyapunov: bool = False) -> points.Plan:
    """What the kernels are asked for."""
    return points.Plan(
        transient=transient,
        record=record,
        warm_up=min(transient, points.WARM_UP) if lyapunov else 0,
        states=lyapunov,
        lyapunov=lyapunov,
        impacts=False,
        attractors=False,
        right=system.stops != "left",
        left=system.stops != "right",
        section_side=0.0,
        periods=0,
        parts=min(record, BATCHES) if lyapunov else 0,
        order=0,
    )


class Engine:
    """The tables of one system, and an orbit on its way; with tangent vectors if they are wanted."""

    def __init__(self, system: System, lyapunov: bool = False):
        self.point = points_of(system.parameters()).reshape(1)
        self.cells = int(self.point["cells"][0])
        if self.cells == 0:
            allowed = f"such that the fastest rate times the period is at most {tables.LONGEST:g}"
            raise ParameterError("omega", system.omega, allowed)
        self.period = system.period
        self.width = self.period / self.cells
        plan = _plan(system, lyapunov=lyapunov)
        workspace = points.new_workspace(plan, self.cells, 0)
        self.stops = points.prepare(self.point, 0, workspace, plan)
        self.ensemble = workspace.ensemble
        self.ensemble.orbits["status"][1:] = status.NOT_COMPUTED
        self.orbit = self.ensemble.orbits[:1]

    def place(self, state) -> None:
        values = np.asarray(state, float)
        if values.shape != (4,) or not np.isfinite(values).all():
            raise ValueError(f"state: {state!r} is not allowed; it must be four finite numbers (x1, v1, x2, v2)")
        if not self.stops.left <= values[0] <= self.stops.right:
            allowed = f"{self.stops.left!r} .. {self.stops.right!r}"
            raise ValueError(f"state: x1 = {float(values[0])!r} is behind a stop; allowed: {allowed}")
        self.put(values)

    def put(self, state, cell: int = 0, offset: float = 0.0) -> None:
        """Start a new orbit from a state that is known to be allowed, at this offset of this cell."""
        nodes = self.ensemble.flights.nodes[0]
        orbits.place(self.orbit[0], nodes, self.stops, int(cell), float(offset), *map(float, state))

    def carry(self, records, section) -> int:
        """Carry the orbit over as many periods as `section` (n, 4) has rows. Returns a status."""
        self.orbit["periods"] = len(section)
        ensemble.carry(self.ensemble._replace(records=records), None, section[None], True, np.empty((1, 0, 4)), 0)
        return int(self.orbit["status"][0])

    def locate(self, times) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Period, cell and offset of absolute times."""
        times = np.asarray(times, float)
        period = np.floor(times / self.period)
        cell, offset = np.divmod(times - period * self.period, self.width)
        late = cell >= self.cells
        return (period + late).astype(np.int64), np.where(late, 0, cell).astype(np.int64), np.where(late, 0.0, offset)

    def time(self, period, cell, offset):
        return period * self.period + (cell * self.width + offset)


class Status(str):
    """The name of an outcome ("ok", ...), with its `code` and a `note`."""

    def __new__(cls, code: int, chatters: int):
        status_name = super().__new__(cls, status.MEANINGS[code])
        status_name.code = code
        status_name.note = (
            f"{chatters} chatter sequences end in a closed-form sum of impacts that are not listed" if chatters else ""
        )
        return status_name


@dataclass(frozen=True)
class Orbit:
    """What `simulate` returns. Times are absolute and nondimensional, sides +1 (right, A) and -1 (left, C).

    impacts : structured, fields t, side, v1 (before), x2, v2; in order. Of chatter, those computed one by one.
    sticking : structured, fields t_on, t_off, side; t_off is the end of the simulation for a rest that outlasts it.
    section : (periods + 1, 4) states (x1, v1, x2, v2) at t = 0 mod T, NaN after a failure
    status : "ok", or what went wrong; `status.note` counts the chatter sequences whose end was summed up
    """

    system: System
    start_time: float
    impacts: np.ndarray
    sticking: np.ndarray
    section: np.ndarray
    status: "Status"
    _start: np.ndarray = field(repr=False)
    _engine: Engine = field(repr=False)

    @property
    def section_times(self) -> np.ndarray:
        """(periods + 1,) times of `section`."""
        first = math.ceil(self.start_time / self._engine.period)
        return (first + np.arange(len(self.section))) * self._engine.period

    def sample(self, times) -> np.ndarray:
        """States (x1, v1, x2, v2) at `times`, (len(times), 4); |x1| <= b. ValueError outside the simulated time."""
        times = np.atleast_1d(np.asarray(times, float))
        end = self.section_times[-1]
        outside = ~((times >= self.start_time) & (times <= end))
        if outside.any():
            raise ValueError(
                f"times: {times[outside][0]!r} is outside the simulated time {self.start_time!r} .. {end!r}"
            )
        engine = self._engine
        period, cell, offset = engine.locate(times)
        order = np.lexsort((offset, cell, period))
        result = np.empty((len(times), 4))
        first = math.ceil(self.start_time / engine.period)
        _, start_cell, start_offset = (value[()] for value in engine.locate(self.start_time))
        for n in np.unique(period):
            chosen = order[period[order] == n]
            if n - first == len(self.section) - 1:  # the very end
                result[chosen] = self.section[-1]
                continue
            records = orbits.new_records(1, samples=len(chosen))
            records.times[:, 0], records.times[:, 1] = cell[chosen], offset[chosen]
            if n < first:
                engine.put(self._start, start_cell, start_offset)
            else:
                engine.put(self.section[n - first])
            engine.carry(records, np.empty((1, 4)))
            result[chosen] = records.samples
        result[:, 0] = np.clip(result[:, 0], engine.stops.left, engine.stops.right)
        return result


def simulate(system: System, state, periods: int, start_time: float = 0.0) -> Orbit:
    """Simulate one orbit of the impact oscillator (3), (4).

    Parameters
    ----------
    state : (x1, v1, x2, v2) at `start_time`
    periods : forcing periods, counted from the first section t = 0 mod T at or after `start_time`

    Raises ValueError for a state behind a stop, or for fewer than 0 periods. What goes wrong on the way is told by
    `Orbit.status`.
    """
    if periods != int(periods) or periods < 0:
        raise ValueError(f"periods: {periods!r} is not allowed; it must be a whole number >= 0")
    if not math.isfinite(start_time):
        raise ValueError(f"start_time: {start_time!r} is not allowed; it must be finite")
    engine = Engine(system)
    engine.place(state)
    first, cell, offset = (value[()] for value in engine.locate(start_time))
    engine.put(state, cell, offset)
    engine.orbit["period"] = first
    section = np.full((int(periods) + 1, 4), np.nan)
    inside = cell > 0 or offset > 0  # the period in which the orbit starts is not recorded, but its impacts are
    if not inside:
        section[0] = state
    hits, rests, chatters, room, outcome = [], [], 0, ROOM, status.OK
    done = 0 if inside else 1
    while done <= periods and outcome == status.OK:
        before = engine.orbit.copy()
        records = orbits.new_records(1, impacts=room, rests=room)
        count = min(CHUNK, len(section) - done)
        outcome = engine.carry(records, section[done : done + count])
        logged = max(engine.orbit["impacts_logged"][0], engine.orbit["rests_logged"][0])
        if logged > room:
            engine.orbit[:] = before
            room, outcome = 2 * int(logged), status.OK
            continue
        hits.append(records.impacts[0, : engine.orbit["impacts_logged"][0]])
        rests.append(records.rests[0, : engine.orbit["rests_logged"][0]])
        chatters += int(engine.orbit["chatters"][0])
        engine.orbit["impacts_logged"] = engine.orbit["rests_logged"] = engine.orbit["chatters"] = 0
        done += count
    if outcome != status.OK:
        reached = int(engine.orbit["period"][0]) - math.ceil(start_time / engine.period)
        section[max(reached + 1, 0) :] = np.nan
    end = (math.ceil(start_time / engine.period) + int(periods)) * engine.period
    return Orbit(
        system,
        float(start_time),
        _impacts(engine, np.concatenate(hits) if hits else np.empty((0, 7))),
        _sticking(engine, np.concatenate(rests) if rests else np.empty((0, 4)), end),
        section,
        Status(outcome, chatters),
        np.asarray(state, float),
        engine,
    )


def _impacts(engine: Engine, rows: np.ndarray) -> np.ndarray:
    result = np.empty(len(rows), IMPACT)
    result["t"] = engine.time(rows[:, 0], rows[:, 1], rows[:, 2])
    for column, name in enumerate(("side", "v1", "x2", "v2"), start=3):
        result[name] = rows[:, column]
    return result


def _sticking(engine: Engine, rows: np.ndarray, end: float) -> np.ndarray:
    times, sides = engine.time(rows[:, 0], rows[:, 1], rows[:, 2]), rows[:, 3]
    result = np.empty(np.count_nonzero(sides), STICKING)
    result["t_on"], result["side"] = times[sides != 0], sides[sides != 0]
    result["t_off"] = end
    released = times[sides == 0]
    result["t_off"][: len(released)] = released
    return result


def lyapunov(system: System, state, transient: int = 1000, periods: int = 10_000) -> np.ndarray:
    """Lyapunov spectrum (4,) of the orbit from `state` at t = 0: descending, natural logarithm, per unit time.

    -inf for dimensions lost by sticking, NaN where the orbit fails. A periodic orbit (period at most periods/2) gives
    its Floquet exponents. Raises ValueError as `simulate` does.
    """
    for name, value, least in (("transient", transient, 0), ("periods", periods, 1)):
        if value != int(value) or value < least:
            raise ValueError(f"{name}: {value!r} is not allowed; it must be a whole number >= {least}")
    engine = Engine(system)
    engine.place(state)
    plan = _plan(system, int(transient), int(periods), lyapunov=True)
    results, nothing = points.new_results((1, 1)), np.empty((1, 1, 0))
    starts, workspace = np.asarray(state, float).reshape(1, 4), points.new_workspace(plan, engine.cells, 0)
    point = engine.point.reshape(1, 1)
    points.run_points(point, starts, results, nothing[..., None], nothing, nothing[..., None], workspace, plan, None)
    return results["lyapunov"][0, 0]
