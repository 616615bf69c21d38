"""One orbit, for interactive use: `simulate` and `lyapunov`."""

from __future__ import annotations  # help() says ArrayLike, and not all that this may be

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from vibro_sweep.analysis.single.exponent_array import Exponents
from vibro_sweep.analysis.single.motion_of import motion_of, orbit_figure, sampled
from vibro_sweep.analysis.single.result import Result, event_table
from vibro_sweep.checks.arguments import LATEST, checked_count, checked_times, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import number_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.compliant.law import LOGGED
from vibro_sweep.engine.halting import interruptible
from vibro_sweep.engine.motion import orbits
from vibro_sweep.engine.one_system import Engine, plan_of
from vibro_sweep.engine.records import new_results, starts_at
from vibro_sweep.oscillator.linear import rest_state
from vibro_sweep.oscillator.oscillator import Oscillator, checked_system
from vibro_sweep.oscillator.own_time import rate_of, with_velocities
from vibro_sweep.tables.coordinates import checked_state
from vibro_sweep.tables.outcomes import OK, status_of
from vibro_sweep.tables.units import AS_STORED, display_of, unit_in, unit_text

if TYPE_CHECKING:
    import xarray
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure

CHUNK = 256  # periods computed before a look at how many impacts there were
ROOM = 4096  # impacts there is room for at first
MOST_PERIODS = 10**8  # of one orbit, whose section then takes 3 GB
MAX_RECORD = 10**7 * 5 // 4  # of these with all section points in memory: 400 MB


class Status(str):
    """The name of an outcome ("ok", ...), with its `code` and a `note`; `chatters`: sequences that were summed up.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> orbit = vs.simulate(system.replace(R=0.1, b=1), (0, 0, 0, 0), periods=300)
    >>> orbit.status, orbit.status.code
    ('ok', 0)
    >>> orbit.status.note
    '598 chatter sequences end in a closed-form sum of impacts that are not listed'
    """

    code: int
    chatters: int

    def __new__(cls, code: int, chatters: int) -> Status:
        status_name = super().__new__(cls, status_of(code).name)
        status_name.code, status_name.chatters = code, chatters
        return status_name

    def __getnewargs__(self) -> tuple[int, int]:
        """The arguments from which a copy is made."""
        return self.code, self.chatters

    @property
    def note(self) -> str:
        """The note on how many chatter sequences ended in a closed-form sum."""
        if not self.chatters:
            return ""
        return f"{self.chatters} chatter sequences end in a closed-form sum of impacts that are not listed"


@dataclass(frozen=True, repr=False, eq=False)
class Orbit(Result):
    """The result of `simulate`. Times are absolute and nondimensional, sides +1 (right, A) and -1 (left, C).

    impacts : structured, fields t, side, v1 (before), x2, v2; in order. Of chatter, those computed one by one.
    sticking : structured, fields t_on, t_off, side; t_off is the end of the simulation for a rest that outlasts it.
    contacts : with compliant stops, structured, fields t_touch, t_release, side, v_touch, v_release (speeds into the
        stop), max_penetration, max_force; of one that outlasts the simulation the end is NaN, the largest so far
    section : (periods + 1, 2N) states (x1, v1, x2, v2, ...) at t = 0 mod T, NaN after a failure
    status : "ok", or what went wrong; `status.note` counts the chatter sequences whose end was summed up

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> orbit = vs.simulate(system, (0, 0, 0, 0), periods=200)
    >>> orbit.section.shape, orbit.sample([1.0, 2.0]).shape
    ((201, 4), (2, 4))
    >>> last = orbit.impacts[-1]
    >>> int(last["side"]), round(float(last["v1"]), 6)
    (1, 1.633337)
    """

    system: Oscillator
    start_time: float
    impacts: np.ndarray
    sticking: np.ndarray
    contacts: np.ndarray
    section: np.ndarray
    status: Status
    _start: np.ndarray  # in contact coordinates, as
    _states: np.ndarray  # `section`
    _engine: Engine

    def __repr__(self) -> str:
        counts = {"impacts": self.impacts, "rests": self.sticking, "contacts": self.contacts}
        shown = [f"{len(one):,} {name}" for name, one in counts.items() if name != "contacts" or len(one)]
        what = ", ".join([f"{len(self.section) - 1:,} forcing periods", *shown])
        return f"<Orbit from t = {self.start_time:g}: {what}, status '{self.status}'; {self.system}>"

    @property
    def section_times(self) -> np.ndarray:
        """(periods + 1,) times of `section`."""
        first = math.ceil(self.start_time / self._engine.period)
        return (first + np.arange(len(self.section))) * self._engine.period

    def to_xarray(self) -> xarray.Dataset:
        """The orbit as a Dataset: states over `section`, impacts over `impact`, rests over `rest`."""
        from vibro_sweep.analysis.single.dataset import dataset_of

        about = {"start_time": self.start_time, "status": str(self.status), "status_note": self.status.note}
        return dataset_of(self, self.section_times, self.section, {"kind": "orbit", **about})

    def _table(self) -> dict[str, list]:
        return event_table(self)

    def plot(
        self,
        periods: int = 4,
        width: float | None = None,
        kind: str | None = None,
        units: str | Sequence[str] | None = None,
    ) -> Figure:
        """Phase portrait and time history of the last forcing periods, impacts marked; so many mm wide.

        kind : "contact-force" for the force of the compliant stops over time and against the gap
        units : names of units in which numbers are shown, whatever the system has, as "mm, ms"
        Raises ValueError where `periods` is not a whole number >= 1, or nothing is simulated.
        """
        (begin, end), q = self._last(checked_count("periods", periods, 1)), self.system.linear
        names = ("$x_1$", "$v_1$") if self.system.gap_is_x1 else ("$g$", r"$\dot g$")
        display = display_of(units) or AS_STORED  # a wrong one is refused below
        t, t_unit = display.of(unit_in("s", self.system.units))
        length, b_unit = display.of(unit_in("m", self.system.units))
        t_text = f"{begin * t:.6g} < t < {end * t:.6g} {unit_text(t_unit)}".rstrip()
        title = f"{t_text}, b = {self.system.b * length:.6g} {unit_text(b_unit)}".rstrip()
        return orbit_figure(motion_of(self, q, begin, end), kind, title, self.system, names, width, units)

    def animate(self, periods: int = 8) -> FuncAnimation:
        """A film of the last forcing periods: masses between stops, time history and phase portrait in step.

        A notebook shows it by `HTML(orbit.animate().to_jshtml())`, and `.save("film.gif")` writes it. Raises ValueError
        where that is not a whole number >= 1, or nothing is simulated.
        """
        from vibro_sweep.plotting.film import FRAMES, film_of

        times = np.linspace(*self._last(checked_count("periods", periods, 1)), 8 * FRAMES)
        motion, period = sampled(self, self.system.linear, times), self.system.period
        motion = replace(motion, t=times / period, unit=period)
        return film_of(motion, f"b = {self.system.b:.6g}").animation()

    def _last(self, periods: int) -> tuple[float, float]:
        """Begin and end of the last forcing periods that were simulated. Raises ArgumentError where there are none."""
        reached = self.section_times[np.isfinite(self.section[:, 0])]
        if not len(reached) or reached[-1] <= self.start_time:
            raise ArgumentError(
                f"this orbit has no motion to draw: its status is {self.status!r}, its periods are too few"
            )
        return max(self.start_time, reached[-1] - periods * self.system.period), float(reached[-1])

    def sample(self, times: ArrayLike) -> np.ndarray:
        """States x1 v1 .. xN vN at `times`, (len(times), 2N). ValueError for no times, or beyond the simulated ones.

        |x1| may pass b by the rounding of an evaluation, some units in the last place.
        """
        end = float(self.section_times[-1])
        times = checked_times(times, self.start_time, end, f"within the simulated time {self.start_time!r} .. {end!r}")
        engine = self._engine
        period, cell, offset = engine.locate(times)
        order = np.lexsort((offset, cell, period))
        result = np.empty((len(times), engine.states))
        first = math.ceil(self.start_time / engine.period)
        _, start_cell, start_offset = (value[()] for value in engine.locate(self.start_time))
        for n in np.unique(period):
            chosen = order[period[order] == n]
            if n - first == len(self.section) - 1:  # the very end
                result[chosen] = self._states[-1]
                continue
            records = orbits.new_records(1, samples=len(chosen), masses=engine.kind.masses)
            records.times[:, 0], records.times[:, 1] = cell[chosen], offset[chosen]
            if n < first:
                engine.put(self._start, start_cell, start_offset)
            elif self.system.linear.contact.by_force:  # stops that relax at a section are not part of its state
                engine.put(self._start, start_cell, start_offset)
                if periods := n - first + int(start_cell > 0 or start_offset > 0):
                    engine.carry(orbits.new_records(1, masses=engine.kind.masses), np.empty((periods, engine.states)))
            else:
                engine.put(self._states[n - first])
            engine.carry(records, np.empty((1, engine.states)))
            result[chosen] = records.samples
        return engine.to_masses(result)


@names_its_arguments
def simulate(system: Oscillator, state: ArrayLike | None = None, periods: int = 100, start_time: float = 0.0) -> Orbit:
    """Simulate one orbit of the impact oscillator (3), (4).

    Parameters
    ----------
    state : (2N,), x1 v1 .. xN vN at `start_time`; None: at rest, as a sweep begins
    periods : forcing periods, counted from the first section t = 0 mod T at or after `start_time`

    Raises TypeError where `system` is not a System; ValueError for a state that is not a state or is behind a rigid
    stop (behind a compliant one it presses it in), for fewer than 0 periods, or for a start beyond 10^9 of them.
    `Orbit.status` says what goes wrong later.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> orbit = vs.simulate(system, (0, 0, 0, 0), periods=200)
    >>> orbit.status, len(orbit.impacts), orbit.section[-1].round(6)
    ('ok', 203, array([ 2.383407, -2.120291,  1.31271 ,  0.13647 ]))
    """
    checked_system(system)
    state, periods = _state(system, state), checked_count("periods", periods, 0, MOST_PERIODS)
    begins = number_of(start_time)
    if begins is None or not abs(begins) <= LATEST * system.period:
        allowed = f"a number of at most {LATEST} forcing periods: beyond, times resolve no motion"
        raise ArgumentError(not_allowed("start_time", start_time, allowed))
    start_time = begins
    engine = Engine(system, rate=rate_of(system.omega))
    begin = engine.checked(state)
    first, cell, offset = (value[()] for value in engine.locate(start_time))
    engine.put(begin, cell, offset)
    engine.orbit["period"] = first
    section = np.full((periods + 1, engine.states), np.nan)  # in contact coordinates
    inside = cell > 0 or offset > 0  # the period in which the orbit starts is not recorded, but its impacts are
    if not inside:
        section[0] = begin
    done = 0 if inside else 1
    hits, rests, contacts, chatters, outcome = interruptible(
        _carried, engine, section[done:], halt=engine.ensemble.halt, cells=engine.steps * periods
    )
    if outcome != OK:
        reached = int(engine.orbit["period"][0]) - math.ceil(start_time / engine.period)
        section[max(reached + 1, 0) :] = np.nan
    end = (math.ceil(start_time / engine.period) + periods) * engine.period
    return Orbit(
        system,
        start_time,
        engine.impacts(np.concatenate(hits) if hits else np.empty((0, 3 + engine.states)), start_time),
        engine.sticking(np.concatenate(rests) if rests else np.empty((0, 4)), end),
        engine.contacts(np.concatenate(contacts) if contacts else np.empty((0, LOGGED)), start_time),
        engine.to_masses(section),
        Status(outcome, chatters),
        begin,
        section,
        engine,
    )


def _state(system: Oscillator, state: ArrayLike | None) -> np.ndarray:
    """A state, checked; by default at rest."""
    if state is not None:
        return checked_state(state, system.masses)
    places = rest_state(system.linear)
    return np.stack([places, np.zeros_like(places)], -1).ravel()


_Carried = tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray], int, int]


def _carried(engine: Engine, section: np.ndarray) -> _Carried:
    """Carry the orbit over as many periods as `section` (n, 2 N) has rows: impacts, rests, contacts, chatters, a
    status."""
    hits, rests, contacts, chatters, room, outcome = [], [], [], 0, ROOM, OK
    done, open_contact = 0, np.empty((0, LOGGED))
    while done < len(section) and outcome == OK:
        before = engine.before()
        records = orbits.new_records(1, impacts=room, rests=room, masses=engine.kind.masses)
        log = engine.new_log(room, open_contact)
        outcome = engine.carry(records, section[done : done + CHUNK], log)
        touched = engine.contacts_logged
        logged = max(engine.orbit["impacts_logged"][0], engine.orbit["rests_logged"][0], touched)
        if logged > room:
            engine.go_back(before)
            room, outcome = 2 * int(logged), OK
            continue
        hits.append(records.impacts[0, : engine.orbit["impacts_logged"][0]])
        rests.append(records.rests[0, : engine.orbit["rests_logged"][0]])
        ended = touched - int(engine.in_contact)
        contacts.append(log[0, :ended])
        open_contact = log[0, ended:touched]
        chatters += int(engine.orbit["chatters"][0])
        engine.orbit["impacts_logged"] = engine.orbit["rests_logged"] = engine.orbit["chatters"] = 0
        done += CHUNK
    return hits, rests, [*contacts, open_contact], chatters, outcome


@names_its_arguments
def lyapunov(
    system: Oscillator, state: ArrayLike | None = None, transient: int = 1000, record: int = 10_000
) -> Exponents:
    """Lyapunov spectrum (2N,) of the orbit from `state` at t = 0, by default from rest: descending, natural logarithm,
    per unit time.

    An array that has `.error`, the standard errors (2N,), and `.residual`, the sum minus its exact value, too.
    -inf for dimensions lost by sticking, NaN where the orbit fails. A periodic orbit (period at most record/2) gives
    its Floquet exponents. Raises ValueError as `simulate` does, and for a longer record than memory is to be taken for.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> exponents = vs.lyapunov(system, (0, 0, 0, 0), transient=200, record=400)
    >>> exponents.round(6)
    array([-0.010194, -0.010194, -0.09218 , -0.09218 ])
    >>> bool(exponents.error.max() < 1e-9), bool(abs(exponents.residual) < 1e-12)
    (True, True)
    """
    checked_system(system)
    state, transient = _state(system, state), checked_count("transient", transient, 0)
    record = checked_count("record", record, 1, MAX_RECORD)
    engine = Engine(system, rate=rate_of(system.omega))
    engine.checked(state)
    plan = plan_of(transient, record, lyapunov=True)
    results, nothing = new_results((1, 1), engine.kind.masses), np.empty((1, 1, 0))
    starts = starts_at(np.tile(with_velocities(state, system.masses, 1 / engine.rate), (2, 1, 1)))
    workspace = orbit_block.new_workspace(plan, engine.cells, 0, engine.kind, 1)
    steps = engine.point.reshape(1, 1)
    kept = nothing[..., None], nothing, nothing[..., None]
    interruptible(
        orbit_block.run_points, steps, starts, results, *kept, workspace, plan, None,
        halt=workspace.ensemble.halt, cells=engine.steps * (transient + record),
    )  # fmt: skip
    found = (results[0, 0][name] * engine.rate for name in ("lyapunov", "lyapunov_error", "lyapunov_residual"))
    return Exponents(*found)
