"""`periodic_orbit`: finds an orbit by Newton's method, whether it attracts or repels.

The unknowns are the times and impulses of the impacts, so that nothing is singular at a graze.
"""

from collections.abc import Iterator
from contextlib import suppress
from itertools import pairwise

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import one_plus_R, presses_too_long
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.itinerary import SIDES, is_mirrored, repetitions, word
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, found_orbit, leans, orbit_of
from vibro_sweep.analysis.periodic.seeds_of_contacts import contact_seeds, with_contacts
from vibro_sweep.analysis.periodic.seeds_of_free_motion import from_free_motion
from vibro_sweep.analysis.periodic.seeds_of_rests import evenly, with_rests
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.periodic.steady_gap import push_of_free_mode, steady_gap
from vibro_sweep.analysis.single.orbit import simulate
from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.flow import flow
from vibro_sweep.engine.impulses.free_modes import ResonanceError, TooStiffError
from vibro_sweep.model.arguments import checked_count, checked_state
from vibro_sweep.model.errors import ArgumentError
from vibro_sweep.model.linear import Family, amplitudes, family_of, forcing_period
from vibro_sweep.model.real import array_of
from vibro_sweep.model.refusals import not_allowed

SEEDS = 4000
AT_ONCE = 250  # of them: the orbit may be among the first
MOMENTS = 24
SAME = 1e-7  # relative difference of solutions from two seeds that are one, and in parts of their units
ROUNDS = 4  # periods that are simulated, so that a whole one begins between any two of its events
ROUNDING = 1e-9  # of a period
SETTLED = 1e-3  # relative change of the state over the period of an orbit that it is taken to be near
STARTS, SETTLING = 12, 300  # of simulations, and their forcing periods: more than those of the orbit
MOST_PERIODS = 10**6
MOST_IMPACTS = 1000  # of an itinerary: each has thousands of seeds


def periodic_orbit(system, state=None, periods: int = 1, itinerary: str | None = None, guess=None) -> PeriodicOrbit:
    """Find a periodic orbit by Newton's method on its impact times and impulses.

    Parameters
    ----------
    state : near the orbit at t = 0 mod T: the orbit simulated from here over `periods` gives the impacts to start from
    periods : its period in forcing periods, or a multiple of it
    itinerary : the stops it hits, such as "LR", instead of a state; "" for the orbit without impacts
    guess : [(t, side, v), ...] with it or without: impacts of the whole orbit in order, from any one of them, v the gap
        velocity before.
        Without a guess fixed seeds are tried; the first real orbit with this itinerary counts. With compliant stops a
        few simulations are tried last.

    Raises ValueError for arguments that say nothing or contradict each other. `.status` says what fails.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> orbit = vs.periodic_orbit(system, itinerary="R")
    >>> orbit.status, orbit.period, orbit.stable, round(float(abs(orbit.multipliers[0])), 6)
    ('ok', 1, True, 0.903327)
    """
    family = family_of(system)
    periods = checked_count("periods", periods, 1, MOST_PERIODS)
    sides = None if itinerary is None else _checked_sides(family.linear, itinerary)
    rows = None if guess is None else _checked_guess(family.linear, guess, itinerary)
    if state is not None:
        state = checked_state(state, len(family.linear.normal))
        if not (sides is None and rows is None):
            raise ArgumentError(not_allowed("state", state, "left out where an itinerary or a guess is given"))
    elif sides is None and rows is None:
        raise ArgumentError(not_allowed("state", state, "given, or an itinerary or a guess"))
    elif rows is None and len(sides) > MOST_IMPACTS:
        raise ArgumentError(not_allowed("itinerary", itinerary, f"of at most {MOST_IMPACTS} impacts without a guess"))
    try:
        if state is not None:
            found = _from_state(system, family, state, periods)
        elif rows is not None:
            found = _from_guess(system, family, rows, periods)
        else:
            found = _from_itinerary(system, family, sides, periods)
    except ResonanceError:
        return PeriodicOrbit(system, "resonance")
    except TooStiffError:
        return PeriodicOrbit(system, "too_stiff")
    too_stiff = found.status == "not_converged" and presses_too_long(family.linear)
    return PeriodicOrbit(system, "too_stiff") if too_stiff else found


def _checked_sides(q, itinerary) -> tuple[int, ...]:
    if not isinstance(itinerary, str) or set(itinerary) - set(SIDES):
        raise ArgumentError(not_allowed("itinerary", itinerary, "a word of R and L"))
    sides = tuple(SIDES[letter] for letter in itinerary)
    if not np.all(np.isfinite(q.stop(sides))):
        raise ArgumentError(not_allowed("itinerary", itinerary, "a word of stops that the system has"))
    return sides


def _checked_guess(q, guess, itinerary):
    rows = array_of(guess, 2)
    none = rows is not None and rows.size == 0
    if rows is None or not (none or (rows.shape[1] == 3 and np.isfinite(rows).all() and {*rows[:, 1]} <= {1, -1})):
        raise ArgumentError(not_allowed("guess", guess, "(t, side, v) for each impact, finite, with side 1 or -1"))
    rows = [] if none else [tuple(row) for row in rows.tolist()]
    if any(b[0] <= a[0] for a, b in pairwise(rows)):
        raise ArgumentError(not_allowed("guess", guess, "(t, side, v) for each impact, in the order of their times"))
    sides = word([side for _, side, _ in rows])
    if not np.all(np.isfinite(q.stop([int(side) for _, side, _ in rows]))):
        raise ArgumentError(not_allowed("guess", guess, "(t, side, v) for each impact on a stop that the system has"))
    if itinerary is not None and (len(itinerary) != len(sides) or itinerary not in 2 * sides):  # any rotation of it
        raise ArgumentError(not_allowed("itinerary", itinerary, f"that of the guess, {sides!r}"))
    return rows


def _from_state(system, family, state, periods) -> PeriodicOrbit:
    if isinstance(system, Family):
        raise ArgumentError(not_allowed("state", state, "left out of a Family, which cannot be simulated"))
    simulated = simulate(system, state, periods)
    if str(simulated.status) != "ok":
        return PeriodicOrbit(system, "not_converged")
    settled = np.abs(simulated.section[-1] - state).max() < SETTLED * np.abs(state).max()
    if family.linear.compliant:
        return _from_contacts(system, family, simulate(system, state, ROUNDS * periods), periods, settled)
    if len(simulated.sticking):
        return _from_rests(system, family, simulate(system, state, 2 * periods), periods)
    impacts = simulate(system, state, ROUNDS * periods).impacts
    found = PeriodicOrbit(system, "not_converged")
    for which, earlier in _of_one_period(impacts["t"], simulated.start_time, periods * system.period, settled):
        rows = zip(impacts["t"][which] - earlier, impacts["side"][which], impacts["v1"][which], strict=True)
        found = _from_guess(system, family, list(rows), periods)
        if found.status == "ok":
            break
    return found


def _of_one_period(t: np.ndarray, start: float, P: float, settled: bool) -> list[tuple[np.ndarray, np.ndarray]]:
    """The events of one period, in the order from the first one on, and what their times are to be less by: twice.

    Once the period begins in the middle of the longest time between two events: an orbit near the periodic one comes
    back a little early or late, so that from an event on it may have that event twice. Once it is the first from the
    start on, which tells more where the orbit has not settled, or is unstable and has been left soon.
    """
    first = np.flatnonzero((t < t[:1] + P * (1 - ROUNDING)) & (t < start + P))
    if len(t) < 2:
        return [(first, np.zeros(len(first)))]
    k = int(np.argmax(np.diff(t[: np.count_nonzero(t <= t[0] + P) + 1])))
    begin = (t[k] + t[k + 1]) / 2
    which = np.flatnonzero((t > begin) & (t <= begin + P))
    which = which[np.argsort(which % max(1, len(which)))]
    both = [(which, which // max(1, len(which)) * P), (first, np.zeros(len(first)))]
    return both if settled else both[::-1]


def _from_contacts(system, family, simulated, periods, settled) -> PeriodicOrbit:
    """The orbit from a simulation over some periods in which the mass presses compliant stops."""
    if len(simulated.sticking):
        return PeriodicOrbit(system, "sticking")
    contacts, impacts, P = simulated.contacts, simulated.impacts, periods * system.period
    events = [(c["t_touch"], c["side"], -c["side"] * c["v_touch"], c["t_release"]) for c in contacts]
    events += [(i["t"], i["side"], -one_plus_R(family.linear, i["side"]) * i["v1"], np.nan) for i in impacts]
    events = sorted((one for one in events if one[0] > simulated.start_time), key=lambda one: one[0])
    if not events and len(contacts) and np.isnan(contacts["t_release"][-1]):
        return PeriodicOrbit(system, "permanent_contact")
    t, sides, D, ends = np.array(events, float).reshape(-1, 4).T
    none, found = Solution(family, 1, 2 * periods, (), np.empty(0)), PeriodicOrbit(system, "not_converged")
    for which, earlier in _of_one_period(t, simulated.start_time, P, settled):
        guess = none.with_events(sides[which], t[which] - earlier, D[which], ends[which] - earlier)
        found = _corrected(system, guess)
        if found.status == "ok":
            break
    return found


def _corrected(system, guess: Solution) -> PeriodicOrbit:
    """The orbit from a guess of contacts with compliant stops."""
    if len(guess.rests) < np.count_nonzero(guess.contacts) or not np.all(np.isfinite(guess.u)):
        return PeriodicOrbit(system, "not_converged")
    found = guess.corrected()
    if found is None and guess.family.linear.by_force:
        with suppress(np.linalg.LinAlgError):  # the guess has no motion
            if not guess.relaxes:
                return PeriodicOrbit(system, "unrelaxed")
    return found_orbit(system, found)


def _from_rests(system, family, simulated, periods) -> PeriodicOrbit:
    """The orbit from a simulation over two periods, in which the mass rests after impacts with R = 0."""
    impacts, P, R = simulated.impacts, periods * system.period, family.linear.restitution
    if np.any(R(simulated.sticking["side"]) != 0) or str(simulated.status) != "ok" or not len(impacts):
        return PeriodicOrbit(system, "sticking")
    begin = impacts["t"][0]
    impacts = impacts[impacts["t"] < begin + P * (1 - ROUNDING)]  # a rest forgets what was before: it has settled
    resting = simulated.sticking
    resting = resting[(resting["t_on"] > begin - ROUNDING * P) & (resting["t_on"] < begin + P * (1 - ROUNDING))]
    rests = tuple(int(np.argmin(np.abs(impacts["t"] - t))) for t in resting["t_on"])
    if not rests or np.abs(impacts["t"][list(rests)] - resting["t_on"]).max() > ROUNDING * P:
        return PeriodicOrbit(system, "sticking")
    u = np.concatenate([impacts["t"], -(1 + R(impacts["side"])) * impacts["v1"], resting["t_off"]])
    found = Solution(family, 1, 2 * periods, tuple(map(int, impacts["side"])), u, 0.0, rests).corrected()
    return found_orbit(system, found)


def _from_guess(system, family, rows, periods) -> PeriodicOrbit:
    sides = tuple(int(side) for _, side, _ in rows)
    R = family.linear.restitution(sides)
    t, v = np.array([row[0] for row in rows]), np.array([row[2] for row in rows])
    start = with_contacts(family, Solution(family, 1, 2 * periods, sides, np.empty(0)), t, v)
    if sides and t[-1] >= t[0] + start.P:
        raise ArgumentError(not_allowed("guess", rows, "(t, side, v) for each impact within one period"))
    found = start.corrected()
    if (found is None or not found.real) and np.any(R == 0):
        found = with_rests(found or start) or found
    return found_orbit(system, found)


def _from_itinerary(system, family, sides, periods) -> PeriodicOrbit:
    if not sides:
        return _from_guess(system, family, [], periods)
    symmetric = family.linear.symmetric and periods % 2 == 1 and is_mirrored(sides)
    kinds = [(-1, periods, sides[: len(sides) // 2])] if symmetric else []
    least = [d for d in repetitions(sides) if periods % d == 0]
    virtual = None
    kinds = [Solution(family, *kind, np.empty(0)) for kind in [*kinds, (1, 2 * periods, sides)]]
    for start in kinds:
        for found in _with_contacts(start) if family.linear.compliant else _seeded(start):
            if virtual is not None and ((not found.rests and _passes_a_stop(found)) or not found.real):
                continue
            found = found.reduced()
            if least and len(found.whole().sides) != len(sides):
                continue
            if found.real and not leans(found):
                return orbit_of(system, found)
            virtual = virtual or found
    if np.any(family.linear.restitution(sides) == 0):
        for start in kinds:
            for guess in evenly(start):
                found = with_rests(guess)
                if found is not None and len(found.reduced().whole().sides) == len(sides):
                    return found_orbit(system, found)
    simulated = family.linear.compliant and periods <= SETTLING
    attracting = _attracting(system, family, sides, periods) if simulated else None
    return attracting or found_orbit(system, virtual)


def _attracting(system, family, sides, periods) -> PeriodicOrbit | None:
    """The orbit with these contacts, if one of a few simulations comes to it."""
    if isinstance(system, Family):
        return None
    q, letters = family.linear, word(sides)
    size = np.kron(np.abs(amplitudes(q)), [1.0, q.omega])  # of x1 v1 .. xN vN in the free motion
    for state in size * np.random.default_rng(0).uniform(-1, 1, (STARTS, len(size))):
        simulated = simulate(system, state, SETTLING)
        found = _from_state(system, family, simulated.section[-1], periods) if str(simulated.status) == "ok" else None
        if found and found.ok and len(found.itinerary) == len(letters) and found.itinerary in 2 * letters:
            return found
    return None


def _with_contacts(start: Solution) -> Iterator[Solution]:
    """Orbits of an oscillator with compliant stops: from rigid ones, and that with the contacts of the free motion."""
    yield from contact_seeds(start, _seeded)
    if (found := from_free_motion(start)) is not None:
        yield found


def _passes_a_stop(s: Solution) -> bool:
    """Whether it does so at moments of one forcing period in its longest flight: seen soon, also of a long period."""
    q, T = s.family.linear, forcing_period(s.family.linear)
    lengths = np.diff(np.append(s.times, s.times[0] + s.P))
    k = int(np.argmax(lengths))
    if lengths[k] < 2 * T:
        return False
    start, begin, f = s.states[k : k + 1].copy(), s.times[k : k + 1], flow(q)
    start[0, len(q.normal)] += s.jumps[k]
    moments, out = begin + lengths[k] / 2 + T * np.arange(MOMENTS) / MOMENTS, np.empty((MOMENTS, start.shape[1]))
    flights.sample_flights(f, start, begin, np.zeros(MOMENTS, int), moments, out, flights.new_workspace(start.shape[1]))
    size = abs(steady_gap(q).swing) + np.abs(q.stop(s.sides)).max() + np.abs(s.jumps).max() / q.omega
    return bool(max(out[:, 0].max() - q.high, q.low - out[:, 0].min()) > 1e-9 * size)


def _seeded(start: Solution):
    """Solutions from fixed seeds, different ones, those whose impulses push first."""
    e, K, q = EventEquations.of(start), start.K, start.family.linear
    rng, T, sides = np.random.default_rng(0), forcing_period(q), np.array(start.sides)
    stops, pushed = np.abs(q.stop(start.sides)).max(), abs(push_of_free_mode(q)) * start.P / K
    size = max(q.omega * abs(steady_gap(q).swing), q.omega * stops, pushed)
    t = np.sort(rng.uniform(0, start.P, (SEEDS, K)), axis=1)
    t += rng.uniform(0, start.P, (SEEDS, 1)) - t[:, :1]
    guesses = np.hstack([t, -sides * size * 10 ** rng.uniform(-2, 0.5, (SEEDS, K))])
    units, known, pulling = np.repeat([1 / q.omega, size], K), np.empty((0, 2 * K)), []

    def new(ends, changes):
        nonlocal known
        for end, change in zip(ends, changes, strict=True):
            if np.all((np.abs(known - end) > SAME * (units + np.abs(known))).any(axis=1)):
                known = np.vstack([known, end])
                yield Solution(start.family, start.sigma, start.half_periods, start.sides, end, float(change))

    for first in range(0, SEEDS, AT_ONCE):
        ends, changes, _ = e.newton(guesses[first : first + AT_ONCE])
        converged = np.isfinite(changes)
        ends, changes = ends[converged], changes[converged]
        ends[:, :K] -= np.floor(ends[:, :1] / T) * T
        pushing = np.all(-sides * ends[:, K:] > 0, axis=1)
        pulling.append((ends[~pushing], changes[~pushing]))
        yield from new(ends[pushing], changes[pushing])
    for found in pulling:
        yield from new(*found)
