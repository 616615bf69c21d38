"""Periodic orbits by Newton's method: from impacts or contacts that are known, or from a state near the orbit."""

from contextlib import suppress

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import one_plus_R
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, found_orbit
from vibro_sweep.analysis.periodic.seeds_of_contacts import with_contacts
from vibro_sweep.analysis.periodic.seeds_of_rests import with_rests
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.single.orbit import simulate
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.own_time import as_lengths

ROUNDS = 4  # periods that are simulated, so that a whole one begins between any two of its events
ROUNDING = 1e-9  # of a period
SETTLED = 1e-3  # relative change of the state over the period of an orbit that it is taken to be near


def from_state(system, family, state, periods) -> PeriodicOrbit:
    if isinstance(system, Family):
        raise ArgumentError(not_allowed("state", state, "left out of a Family, which cannot be simulated"))
    simulated = simulate(system, state, periods)
    if str(simulated.status) != "ok":
        return PeriodicOrbit(system, "not_converged")
    begin, end = as_lengths(np.stack([state, simulated.section[-1]]), family.linear.omega)
    settled = np.abs(end - begin).max() < SETTLED * np.abs(begin).max()
    if family.linear.compliant:
        return _from_contacts(system, family, simulate(system, state, ROUNDS * periods), periods, settled)
    if len(simulated.sticking):
        return _from_rests(system, family, simulate(system, state, 2 * periods), periods)
    impacts = simulate(system, state, ROUNDS * periods).impacts
    found = PeriodicOrbit(system, "not_converged")
    for which, earlier in _of_one_period(impacts["t"], simulated.start_time, periods * system.period, settled):
        rows = zip(impacts["t"][which] - earlier, impacts["side"][which], impacts["v1"][which], strict=True)
        found = from_guess(system, family, list(rows), periods)
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
    if found is None and guess.family.linear.contact.by_force:
        with suppress(np.linalg.LinAlgError):  # the guess has no motion
            if not guess.relaxes:
                return PeriodicOrbit(system, "unrelaxed")
    return found_orbit(system, found)


def _from_rests(system, family, simulated, periods) -> PeriodicOrbit:
    """The orbit from a simulation over two periods, in which the mass rests after impacts with R = 0."""
    impacts, P, R = simulated.impacts, periods * system.period, family.linear.contact.restitution
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


def from_guess(system, family, rows, periods) -> PeriodicOrbit:
    sides = tuple(int(side) for _, side, _ in rows)
    R = family.linear.contact.restitution(sides)
    t, v = np.array([row[0] for row in rows]), np.array([row[2] for row in rows])
    start = with_contacts(family, Solution(family, 1, 2 * periods, sides, np.empty(0)), t, v)
    if sides and t[-1] >= t[0] + start.P:
        raise ArgumentError(not_allowed("guess", rows, "(t, side, v) for each impact within one period"))
    found = start.corrected()
    if (found is None or not found.real) and np.any(R == 0):
        found = with_rests(found or start) or found
    return found_orbit(system, found)
