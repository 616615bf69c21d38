"""The tables of one system, and the motion of its orbits: the base of `simulate` and `discontinuity_map`."""

import sys

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.compliant.law import LOGGED
from vibro_sweep.engine.motion import orbits
from vibro_sweep.engine.point_tables import ON_STOP
from vibro_sweep.engine.points.any_points import any_points, kind_of
from vibro_sweep.engine.records import Kind, new_results, starts_at
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.tables import cells
from vibro_sweep.engine.tables.flight import Flight
from vibro_sweep.engine.variational.spectrum import BATCHES
from vibro_sweep.oscillator.linear import stacked
from vibro_sweep.oscillator.oscillator import System
from vibro_sweep.oscillator.own_time import in_own_time, with_velocities
from vibro_sweep.tables import outcomes as status
from vibro_sweep.tables.coordinates import checked_state

IMPACT = np.dtype([("t", float), ("side", np.int8), ("v1", float), ("x2", float), ("v2", float)])


def impact_of(masses: int) -> np.dtype:
    """The record of impacts of oscillators that are not a System."""
    return np.dtype(
        [("t", float), ("side", np.int8), ("v1", float), ("x", float, (masses,)), ("xdot", float, (masses,))]
    )


STICKING = np.dtype([("t_on", float), ("t_off", float), ("side", np.int8)])

CONTACT = np.dtype(
    [
        ("t_touch", float), ("t_release", float), ("side", np.int8), ("v_touch", float), ("v_release", float),
        ("max_penetration", float), ("max_force", float),
    ]
)  # fmt: skip


def plan_of(transient: int = 0, record: int = 0, lyapunov: bool = False) -> orbit_block.Plan:
    """The plan of what the kernels compute."""
    return orbit_block.Plan(
        transient=transient,
        record=record,
        warm_up=min(transient, orbit_block.WARM_UP) if lyapunov else 0,
        settle=0,
        states=lyapunov,
        lyapunov=lyapunov,
        impacts=False,
        contacts=False,
        energy=False,
        attractors=False,
        section_side=0.0,
        periods=0,
        parts=min(record, BATCHES) if lyapunov else 0,
        order=0,
    )


def point_of_one(system, rate: float) -> tuple[np.ndarray, Kind]:
    """The POINT (1,) of a system in the unit of time 1/rate, and its kind."""
    one = stacked([in_own_time(system.linear, rate)])
    kind = kind_of(one)
    return any_points(one, kind), kind


SHORTEST = sys.float_info.min  # step of a contact: that of the stiffest is below


class Engine:
    """The tables of one system, and the motion of eight orbits, of which `orbit` is the first.

    system : a System, or an oscillator with `linear`, `omega` and `period`. States are those of the masses; the orbits
        themselves move in contact coordinates (`to_contact`, `to_masses`).
    rate : orbits move in the unit of time 1/rate; times and states of the masses are in that of the system

    Raises `ParameterError` where the rates of the system lie too far apart.
    """

    def __init__(self, system, rate: float = 1.0):
        self._made_of, self.system, self.rate = (system, rate), system, rate
        self.point, self.kind = point_of_one(system, rate)
        self.states = 2 * self.kind.masses
        self.is_system = isinstance(system, System)
        self.cells = int(self.point["cells"][0])
        if self.cells == 0:
            allowed = f"such that the fastest rate times the period is at most {cells.LONGEST:g}"
            raise ParameterError("omega", system.omega, allowed)
        self.period = system.period
        self.width = self.period * rate / self.cells
        self._workspace = orbit_block.new_workspace(plan_of(), self.cells, 0, self.kind)
        self._run(orbit_block.TABLES, LANES)
        self.stops = orbits.Stops(*self.point["stops"][0].tolist())
        self.ensemble = self._workspace.ensemble
        self.ensemble.orbits["status"][1:] = status.NOT_COMPUTED
        self.orbit = self.ensemble.orbits[:1]
        self.flight = Flight(*(table[0] for table in self.ensemble.flights))

    def __reduce__(self):
        """A copy is made anew: kernels need memory that begins at a cache line, and `orbit` is a part of `ensemble`."""
        return Engine, self._made_of

    def _run(self, step: int, count: int, section: np.ndarray | None = None, **kept) -> None:
        """One step of `run_points` for so many orbits. section: (orbits, periods, 2 N), if states are kept there."""
        nothing = np.empty((1, count, 0, self.states))
        workspace = self._workspace._replace(section=nothing[0] if section is None else section)
        orbit_block.run_points(
            self.point.repeat(count).reshape(1, count), starts_at(np.zeros((2, count, self.states))),
            new_results((1, count), self.kind.masses), nothing, np.empty((1, count, 0)), nothing,
            workspace._replace(ensemble=workspace.ensemble._replace(**kept)),
            plan_of()._replace(step=step, states=section is not None), None,
        )  # fmt: skip

    def checked(self, state) -> np.ndarray:
        """The state in contact coordinates. Raises ValueError where it is not a state, or behind a stop."""
        values = self.to_contact(checked_state(state, self.kind.masses))
        left, right = self.compliant
        if not (left or self.stops.left <= values[0]) or not (right or values[0] <= self.stops.right):
            low, high, gap = (float(one + self.middle) for one in (self.stops.left, self.stops.right, values[0]))
            name = "the gap" if self.turned else "x1"
            raise ArgumentError(f"state: {name} = {gap!r} is behind a stop; allowed: {low!r} .. {high!r}")
        return values

    @property
    def steps(self) -> int:
        """Of a period at most: its cells, or the steps of contacts that last."""
        law = self.ensemble.law
        fine = 1.0 if law is None else max(self.width / max(float(law.orbits["step"][0].min()), SHORTEST), 1.0)
        return int(min(self.cells * fine, 1e18))

    @property
    def compliant(self) -> tuple[bool, bool]:
        """Whether the left stop is, and the right one."""
        left, right = self.system.linear.contact.is_compliant((-1, 1))
        return bool(left), bool(right)

    @property
    def turned(self) -> bool:
        """Whether contact coordinates are others than those of the masses."""
        return bool(self.point["turned"][0])

    @property
    def contact_matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """(N, N) of displacements of the masses to contact coordinates, and back."""
        if self.turned:
            return self.point["P"][0], self.point["back"][0]
        return np.eye(self.kind.masses), np.eye(self.kind.masses)

    @property
    def middle(self) -> float:
        """The gap of the masses where it is 0 in contact coordinates."""
        return float(self.point["P"][0, 0] @ self.point["origin"][0]) if self.turned else 0.0

    def to_contact(self, states) -> np.ndarray:
        """States (..., 2 N) of the masses in contact coordinates; on a stop, and at rest there, but for rounding."""
        states = with_velocities(states, self.kind.masses, 1 / self.rate)
        if self.turned:
            P = self.point["P"][0]
            sizes = np.abs(states[..., 0::2]) @ np.abs(P[0]), np.abs(states[..., 1::2]) @ np.abs(P[0])
            states[..., 0::2] -= self.point["origin"][0]
            states = self._turn(states, P)
            states[..., 1][np.abs(states[..., 1]) <= ON_STOP * sizes[1]] = 0.0
            for wall in (self.stops.left, self.stops.right):
                states[..., 0][np.abs(states[..., 0] - wall) <= ON_STOP * sizes[0]] = wall
        return states

    def to_masses(self, states: np.ndarray) -> np.ndarray:
        """States (..., 2 N) in contact coordinates as those of the masses."""
        if self.turned:
            states = self._turn(states, self.point["back"][0])
            states[..., 0::2] += self.point["origin"][0]
        return with_velocities(states, self.kind.masses, self.rate)

    @staticmethod
    def _turn(states: np.ndarray, matrix: np.ndarray) -> np.ndarray:
        pairs = states.reshape(*states.shape[:-1], states.shape[-1] // 2, 2)
        return np.einsum("ij,...jk->...ik", matrix, pairs).reshape(states.shape)

    def put(self, state, cell: int = 0, offset: float = 0.0, lane: int = 0) -> None:
        """Start a new orbit from an allowed state in contact coordinates, at this offset of this cell."""
        nodes = self.ensemble.flights.nodes[0]
        if self.ensemble.law is not None:
            for name in ("relaxed", "pressed", "logged"):
                self.ensemble.law.orbits[name][lane] = 0
            self.ensemble.law.orbits["close_until"][lane] = -1
        orbits.set_state(
            self.ensemble.orbits[lane], nodes, self.stops, int(cell), float(offset), np.asarray(state, float)
        )

    def carry(self, records: orbits.Records, section: np.ndarray, contacts: np.ndarray | None = None) -> int:
        """Carry the orbit over as many periods as `section` (n, 2 N) has rows. Returns a status.

        contacts : (1, m, LOGGED), room for those with compliant stops
        """
        self.orbit["periods"] = len(section)
        self.ensemble.orbits["status"][1:] = status.NOT_COMPUTED
        law = self.ensemble.law
        kept = {} if law is None or contacts is None else {"law": law._replace(log=contacts)}
        self._run(orbit_block.MOTION, 1, section[None], records=records, **kept)
        return int(self.orbit["status"][0])

    def locate(self, times) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Period, cell and offset of absolute times."""
        times = np.asarray(times, float)
        period = np.floor(times / self.period)
        # a quotient that was rounded up to a whole number leaves a remainder below zero
        cell, offset = np.divmod(np.maximum(times - period * self.period, 0.0) * self.rate, self.width)
        late = cell >= self.cells
        return (period + late).astype(np.int64), np.where(late, 0, cell).astype(np.int64), np.where(late, 0.0, offset)

    def time(self, period, cell, offset):
        return period * self.period + (cell * self.width + offset) / self.rate

    def impacts(self, rows: np.ndarray, start: float = -np.inf) -> np.ndarray:
        """Recorded impacts (m, 3 + 2 N) as a structured array with absolute times, none before `start`.

        Of a `System` `IMPACT`; of others with x and xdot (N,) of all masses before the impact.
        """
        wall = np.where(rows[:, 3:4] > 0, self.stops.right, self.stops.left)
        states = self.to_masses(np.concatenate([wall, rows[:, 4:]], -1))
        result = np.empty(len(rows), IMPACT if self.is_system else impact_of(self.kind.masses))
        result["t"] = np.maximum(self.time(rows[:, 0], rows[:, 1], rows[:, 2]), start)  # cell and offset round it
        result["side"], result["v1"] = rows[:, 3], rows[:, 4] * self.rate
        if self.is_system:
            result["x2"], result["v2"] = states[:, 2], states[:, 3]
        else:
            result["x"], result["xdot"] = states[:, 0::2], states[:, 1::2]
        return result

    def before(self) -> tuple[np.ndarray, ...]:
        """Where the first orbit is, for `go_back`."""
        law = self.ensemble.law
        return self.orbit.copy(), *(() if law is None else (law.orbits[:1].copy(),))

    def go_back(self, before: tuple[np.ndarray, ...]) -> None:
        self.orbit[:] = before[0]
        if self.ensemble.law is not None:
            self.ensemble.law.orbits[:1] = before[1]

    def new_log(self, room: int, open_contact: np.ndarray) -> np.ndarray:
        """Room for so many contacts of the first orbit, of which one may be going on."""
        log, law = np.empty((1, room if self.ensemble.law is not None else 0, LOGGED)), self.ensemble.law
        if law is not None:
            log[0, : len(open_contact)] = open_contact
            law.orbits["logged"][0] = len(open_contact)
            law.orbits["row"][0] = 0 if len(open_contact) else -1
        return log

    @property
    def contacts_logged(self) -> int:
        law = self.ensemble.law
        return 0 if law is None else int(law.orbits["logged"][0])

    @property
    def in_contact(self) -> bool:
        """Whether the first orbit is in contact with a compliant stop."""
        law = self.ensemble.law
        return law is not None and bool(law.orbits["pressed"][0] != 0 and self.orbit["resting"][0] != 0)

    def contacts(self, rows: np.ndarray, start: float = -np.inf) -> np.ndarray:
        """Logged contacts (m, LOGGED) as a structured array `CONTACT`; none before `start`."""
        result = np.empty(len(rows), CONTACT)
        result["t_touch"] = np.maximum(self.time(rows[:, 0], rows[:, 1], rows[:, 2]), start)
        result["t_release"] = self.time(rows[:, 3], rows[:, 4], rows[:, 5])
        for name, column in zip(CONTACT.names[2:], rows.T[6:], strict=True):
            result[name] = column
        result["v_touch"] *= self.rate
        result["v_release"] *= self.rate
        result["max_force"] *= self.rate**2
        return result

    def sticking(self, rows: np.ndarray, end: float) -> np.ndarray:
        """Recorded rests (m, 4) as a structured array `STICKING`; t_off is `end` for one that outlasts the record."""
        times, sides = self.time(rows[:, 0], rows[:, 1], rows[:, 2]), rows[:, 3]
        result = np.empty(np.count_nonzero(sides), STICKING)
        result["t_on"], result["side"] = times[sides != 0], sides[sides != 0]
        result["t_off"] = end
        released = times[sides == 0]
        result["t_off"][: len(released)] = released
        return result
