"""A periodic orbit: impacts, itinerary, multipliers, stability, certified distance from the stops."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.periodic import orbit_text
from vibro_sweep.analysis.periodic.contact_table import contacts_between
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.itinerary import canonical_start, word
from vibro_sweep.analysis.periodic.orbit_multipliers import squared
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.single.motion_of import motion_of, orbit_figure
from vibro_sweep.analysis.single.result import Result, event_table
from vibro_sweep.checks.arguments import LATEST, checked_times
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.flow import constrained_flow, contact_coordinates, contact_flow, flow
from vibro_sweep.engine.impulses.free_modes import ResonanceError, without_orbit
from vibro_sweep.engine.one_system import CONTACT, IMPACT, STICKING, impact_of
from vibro_sweep.oscillator.family import Family, family_of
from vibro_sweep.oscillator.linear import forcing_period
from vibro_sweep.oscillator.oscillator import Oscillator, System
from vibro_sweep.tables.outcomes import ORBITS, named

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit(Result):
    """A periodic orbit of a linear oscillator between stops. Times are absolute and nondimensional.

    status : "ok", or why it is not an orbit (`tables.outcomes.ORBITS`); numbers then are those found, or empty
    others : other orbits with its itinerary that were seen beside it; `which=` of `periodic_orbit` gives them

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> orbit = vs.periodic_orbit(system, itinerary="LR")
    >>> orbit.status, orbit.itinerary, orbit.period, orbit.symmetric, orbit.stable
    ('ok', 'LR', 1, True, False)
    >>> orbit.state.round(4), orbit.impacts["side"].tolist()
    (array([ 3.5283, -1.1417,  1.7403, -0.1755]), [-1, 1])
    """

    system: System | Oscillator | Family
    status: str
    _solution: Solution | None = field(repr=False, default=None)
    _frame: tuple[int, int] | None = field(repr=False, default=None)  # (first impact, periods to shift by)
    others: int = 0

    def __repr__(self) -> str:
        return orbit_text.of_orbit(self)

    @property
    def ok(self) -> bool:
        """Whether this is a periodic orbit, certified."""
        return self.status == "ok"

    @property
    def period(self) -> int:
        """The least period, in forcing periods; 0 without a motion."""
        if self._solution is None:
            return 0
        return self._solution.half_periods if self.symmetric else self._solution.half_periods // 2

    @property
    def symmetric(self) -> bool:
        """Whether x(t + period T/2) = -x(t)."""
        return self._solution is not None and self._solution.sigma == -1

    @cached_property
    def _canonical_frame(self) -> tuple[int, int]:
        """Index of the impact that begins, and periods T before the one that it lies in."""
        s = self._solution.whole()
        if not s.K:
            return 0, 0
        T = forcing_period(s.family.linear)
        first = canonical_start(s.sides, s.times, T, s.P)
        return first, math.floor(s.times[first] / T)

    @cached_property
    def _whole(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Times, sides, impulses and states before the impacts of the whole orbit, canonically rotated."""
        s = self._solution
        T = forcing_period(s.family.linear)
        t, sides, D, states = s.times, np.array(s.sides, int), s.jumps, s.states[:, :-3]
        if self.symmetric:
            t, sides, D = np.append(t, t + s.P), np.append(sides, -sides), np.append(D, -D)
            states = np.concatenate([states, -states])
        if s.K:
            first, shift = self._frame or self._canonical_frame
            order = (np.arange(len(t)) + first) % len(t)
            t = t[order] + (order < first) * (self.period * T) - shift * T
            sides, D, states = sides[order], D[order], states[order]
        return t, sides, D, states

    @cached_property
    def sticking(self) -> np.ndarray:
        """Structured, fields t_on, t_off, side: the rests, with R = 0, of a period that begins with `impacts`."""
        result = np.empty(0, STICKING)
        if self._solution is not None and self._solution.rests:
            s = self._solution.whole()
            rests, T = [k for k in s.rests if not s.contacts[k]], forcing_period(s.family.linear)
            first, shift = self._frame or self._canonical_frame
            later = np.where(np.array(rests) < first, self.period * T, 0.0) - shift * T
            result = np.empty(len(rests), STICKING)
            ends = s.ends[np.isin(s.rests, rests)]
            result["t_on"], result["t_off"] = s.times[rests] + later, ends + later
            result["side"] = np.array(s.sides)[rests]
            result = result[np.argsort(result["t_on"])]
        return result

    @cached_property
    def contacts(self) -> np.ndarray:
        """Structured, as `Orbit.contacts`: the contacts with compliant stops of a period that begins with the first."""
        if self._solution is None or not self._solution.rests:
            return np.empty(0, CONTACT)
        s = self._solution.whole()
        q, times = s.family.linear, self._whole[0]
        first, _ = self._frame or self._canonical_frame
        which = np.flatnonzero(s.contacts)
        which = which[np.argsort((which - first) % s.K)]
        _, began, _, ends = s.events
        begins, sides = times[(which - first) % s.K], np.array(s.sides)[which]
        states = s.states[which].copy()
        states[:, 0] = q.contact.stop(sides)
        return contacts_between(q, begins, (ends - began)[which], sides, states)

    @property
    def itinerary(self) -> str:
        """Sides of `impacts` and `contacts` in order, "R" and "L"; the least rotation with L < R."""
        return "" if self._solution is None else word(self._whole[1])

    @property
    def half(self) -> int | None:
        """Index of the impact that begins the second half; None unless symmetric."""
        return len(self._whole[0]) // 2 if self.symmetric else None

    @cached_property
    def impacts(self) -> np.ndarray:
        """Structured, fields t, side, v1 (before), x2, v2; x and xdot (N,) of all masses where there is no System. On
        rigid stops alone."""
        N = 2 if self._solution is None else self._solution.family.linear.masses
        kind = IMPACT if isinstance(self.system, System) else impact_of(N)
        if self._solution is None or not self._solution.K:
            return np.empty(0, kind)
        t, sides, _, states = self._whole
        struck = ~self._solution.family.linear.contact.is_compliant(sides)
        t, sides, states = t[struck], sides[struck], states[struck]
        x = self._masses(states)
        result = np.empty(len(t), kind)
        result["t"], result["side"], result["v1"] = t, sides, states[:, N]
        if kind is IMPACT:
            result["x2"], result["v2"] = x[:, 2], x[:, 3]
        else:
            result["x"], result["xdot"] = x[:, ::2], x[:, 1::2]
        return result

    def _masses(self, states) -> np.ndarray:
        """States (m, 2N) as x1 v1 .. xN vN from contact coordinates."""
        return contact_coordinates(self._solution.family.linear).to_masses(states)

    @property
    def half_multipliers(self) -> np.ndarray | None:
        """(2N,) complex multipliers of the half map with the mirror, by falling modulus; None unless symmetric."""
        return self._solution.multipliers if self.symmetric else None

    @cached_property
    def multipliers(self) -> np.ndarray:
        """(2N,) complex Floquet multipliers over `period`, by falling modulus, of a pair +im first."""
        if self._solution is None:
            return np.empty(0, complex)
        values = self._solution.multipliers
        if self.symmetric:
            values = squared(values)
            values = values[np.lexsort((-values.imag, -np.abs(values)))]
        return values

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return self._solution is not None and bool(np.all(np.abs(self.multipliers) < 1))

    @property
    def stop_distance(self) -> float:
        """Least distance of a turning point of the gap from its stop; negative: not real; inf: there is none."""
        return math.nan if self._solution is None else self._solution.stop_distance

    @property
    def residual(self) -> float:
        """Largest relative change of the last Newton step."""
        return math.nan if self._solution is None else self._solution.change

    def sample(self, times) -> np.ndarray:
        """States x1 v1 .. xN vN at `times`, (len(times), 2N); at an impact the state before it.

        Raises ValueError for no times, or for times beyond 10^9 forcing periods.
        """
        if self._solution is None:
            raise ArgumentError(f"this orbit has no motion: {named(ORBITS, self.status).text}")
        q = self._solution.family.linear
        length, latest = self.period * forcing_period(q), LATEST * forcing_period(q)
        allowed = f"within {LATEST} forcing periods of 0: beyond, times resolve no motion"
        times = checked_times(times, -latest, latest, allowed)
        begins, starts, held = self._pieces
        wrapped = times - length * np.ceil((times - begins[0]) / length - 1)  # in (begins[0], begins[0] + length]
        wrapped = np.where(wrapped <= begins[0], wrapped + length, wrapped)
        wrapped = np.where(wrapped > begins[0] + length, wrapped - length, wrapped)
        which = np.searchsorted(begins, wrapped, side="left") - 1
        out = np.empty((len(times), starts.shape[1]))
        workspace = flights.new_workspace(starts.shape[1])
        for side in (0, 1, -1):
            chosen = np.flatnonzero(held[which] == side)
            if len(chosen):
                part = np.empty((len(chosen), starts.shape[1]))
                pressed = q.contact.is_compliant(side)
                f = flow(q) if side == 0 else contact_flow(q, side) if pressed else constrained_flow(q)
                flights.sample_flights(f, starts, begins, which[chosen], wrapped[chosen], part, workspace)
                out[chosen] = part
        return self._masses(out[:, : 2 * q.masses])

    @cached_property
    def _pieces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Begins of flights and of events that last, the states there in contact coordinates, and of the latter the
        side; 0 of flights."""
        s = self._solution
        N, m = s.family.linear.masses, flow(s.family.linear).B.shape[0]
        if s.rests:
            whole = s.whole()
            begins, starts, held = whole.resting.pieces()
            _, shift = self._frame or self._canonical_frame
            return begins - shift * forcing_period(s.family.linear), starts, held
        t, _, D, states = self._whole
        starts = np.zeros((max(len(t), 1), m))
        starts[:, : 2 * N] = states[: len(starts)]
        if len(t):
            starts[:, N] += D
        return t if len(t) else np.zeros(1), starts, np.zeros(len(starts))

    @cached_property
    def state(self) -> np.ndarray:
        """(2N,) state x1 v1 .. xN vN at t = 0, before an impact there."""
        return self.sample([0.0])[0]

    def to_xarray(self) -> "xarray.Dataset":
        """The orbit as a Dataset: states over `section`, impacts, contacts and rests over `impact`, `contact`
        and `rest`, multipliers.

        Raises ValueError for an orbit without a motion, and for one of a Family, which has no numbers with names.
        """
        from vibro_sweep.analysis.single.dataset import dataset_of

        if isinstance(self.system, Family):
            raise ArgumentError("an orbit of a Family has no Dataset: its numbers are those of a function")
        times = forcing_period(family_of(self.system).linear) * np.arange(self.period)
        words = {name: getattr(self, name) for name in ("status", "period", "itinerary", "stop_distance", "residual")}
        about = {"kind": "periodic_orbit", **words, "symmetric": int(self.symmetric), "stable": int(self.stable)}
        data = dataset_of(self, times, self.sample(times), about)
        values = self.multipliers
        return data.assign(multiplier_re=("multiplier", values.real), multiplier_im=("multiplier", values.imag))

    def _table(self) -> dict[str, list]:
        return event_table(self)

    def plot(self, width: float | None = None, kind: str | None = None, units: str | Sequence[str] | None = None):
        """Phase portrait of the gap and its time history, impacts and contacts marked: a Figure, `width` mm wide.

        kind : "contact-force" for the force of the compliant stops over time and against the gap
        units : names of units in which numbers are shown, whatever the system has, as "mm, ms"
        """
        q = self._solution.family.linear if self._solution is not None else None
        if q is None:
            raise ArgumentError(f"this orbit has no motion: {named(ORBITS, self.status).text}")
        title = f"{self.itinerary or 'free'}, period {self.period}, {'stable' if self.stable else 'unstable'}"
        motion = motion_of(self, q, 0.0, self.period * forcing_period(q), repeats=True)
        return orbit_figure(motion, kind, title, self.system, ("gap", "gap velocity"), width, units)

    def save(self, path) -> Path:
        """Write the orbit as JSON, for `vibro_sweep.load`; nothing is overwritten."""
        from vibro_sweep.analysis.periodic.orbit_file import save_orbit

        return save_orbit(self, path)


def found_orbit(system, solution: Solution | None) -> PeriodicOrbit:
    """The orbit of a solution that was found: with its least period, as half an orbit where it is symmetric, certified.

    Whatever looks for an orbit ends here: an orbit that lost an impact may be symmetric, or a shorter one repeated.
    """
    if solution is None:
        return orbit_of(system, None)
    if leans(solution):
        return PeriodicOrbit(system, without_orbit(solution.family.linear))
    least = solution.reduced()
    same = (least.sigma, least.half_periods) == (solution.sigma, solution.half_periods)
    return orbit_of(system, solution if same else least)


def orbit_of(system, solution: Solution | None) -> PeriodicOrbit:
    """The orbit of a solution as it is, certified."""
    if solution is None:
        return PeriodicOrbit(system, "not_converged")
    if solution.K == 0 and not is_isolated(solution):
        return PeriodicOrbit(system, without_orbit(solution.family.linear))
    status = "ok" if solution.real else "inadmissible" if solution.relaxes else "unrelaxed"
    return PeriodicOrbit(system, status, solution)


def leans(solution: Solution) -> bool:
    """Whether only impacts without speed keep a free mode at its place: it may be at rest elsewhere as well."""
    return bool(solution.K) and solution.only_touches and not is_isolated(solution)


def is_isolated(free_motion: Solution) -> bool:
    """Whether a motion without impacts is the only one near it: a free mode may be at rest anywhere between the stops,
    and an undamped mode that repeats itself after the forcing period has any amplitude."""
    whole = free_motion.whole()
    try:
        EventEquations.of(whole)
    except ResonanceError:
        return False
    return not whole.is_free
