"""Periodic orbits that hit their stops in a given order, by Newton's method from fixed seeds."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.from_state import from_guess, from_state
from vibro_sweep.analysis.periodic.itinerary import is_mirrored, repetitions, word
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, found_orbit, leans, orbit_of
from vibro_sweep.analysis.periodic.seeds_of_contacts import contact_seeds
from vibro_sweep.analysis.periodic.seeds_of_free_motion import from_free_motion
from vibro_sweep.analysis.periodic.seeds_of_rests import evenly, with_rests
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.periodic.steady_gap import push_of_free_mode, steady_gap
from vibro_sweep.analysis.single.orbit import simulate
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.flow import flow
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import amplitudes, forcing_period

SEEDS = 4000
AT_ONCE = 250  # of them: the orbit may be among the first
MOMENTS = 24
ROUNDING = 1e-9  # of the free motion, by which states are kept from rigid stops
SAME = 1e-7  # relative difference of solutions from two seeds that are one, and in parts of their units
SAME_ORBIT = 1e-6  # the same of whole orbits
MORE = 8  # solutions that are looked at beside the first orbit: others of its itinerary may be among them
STARTS, SETTLING = 12, 300  # of simulations, and their forcing periods: more than those of the orbit


def from_itinerary(system, family, sides, periods, which: int = 0) -> PeriodicOrbit:
    """The orbit with this itinerary, of several in the order of the seeds the one that is asked for. Raises
    ArgumentError where there are not so many."""
    if not sides:
        return from_guess(system, family, [], periods)
    symmetric = family.linear.symmetric and periods % 2 == 1 and is_mirrored(sides)
    kinds = [(-1, periods, sides[: len(sides) // 2])] if symmetric else []
    least = [d for d in repetitions(sides) if periods % d == 0]
    virtual, real, looked = None, [], 0
    kinds = [Solution(family, *kind, np.empty(0)) for kind in [*kinds, (1, 2 * periods, sides)]]
    for start in kinds:
        for found in _with_contacts(start) if family.linear.compliant else _seeded(start):
            looked += len(real) > which
            if found is None or looked > MORE:  # the seeds that are tried at once are all looked at
                if len(real) > which:
                    break
                continue
            if virtual is not None and ((not found.rests and _passes_a_stop(found)) or not found.real):
                continue
            found = found.reduced()
            if least and len(found.whole().sides) != len(sides):
                continue
            if not found.real or leans(found):
                virtual = virtual or found
            elif all(not _is_same(found, other) for other in real):
                real.append(found)
        if len(real) > which:
            return replace(orbit_of(system, real[which]), others=len(real) - 1)
    if real:
        allowed = f"at most {len(real) - 1}: so many other orbits are found" if real[1:] else "0: no other is found"
        raise ArgumentError(not_allowed("which", which, allowed))
    if np.any(family.linear.contact.restitution(sides) == 0):
        for start in kinds:
            for guess in evenly(start):
                found = with_rests(guess)
                if found is not None and len(found.reduced().whole().sides) == len(sides):
                    return found_orbit(system, found)
    simulated = family.linear.compliant and periods <= SETTLING
    attracting = _attracting(system, family, sides, periods) if simulated else None
    return attracting or found_orbit(system, virtual)


def _is_same(one: Solution, other: Solution) -> bool:
    """Whether two solutions are one orbit, or its mirror image half a period later, whichever impact comes first."""
    if (one.half_periods, one.sigma, one.K) != (other.half_periods, other.sigma, other.K):
        return False
    T, units = forcing_period(one.family.linear), np.array([1 / one.family.linear.omega, np.abs(one.jumps).max()])
    rows = [np.column_stack([s.times % T, s.jumps * np.array(s.sides)]) for s in (one, other)]
    first, second = (row[np.lexsort(np.round(row / units / SAME_ORBIT).T)] for row in rows)
    return bool((np.abs(first - second) < SAME_ORBIT * units * 10).all())


def _attracting(system, family, sides, periods) -> PeriodicOrbit | None:
    """The orbit with these contacts, if one of a few simulations comes to it."""
    if isinstance(system, Family):
        return None
    q, letters = family.linear, word(sides)
    size = np.kron(np.abs(amplitudes(q)), [1.0, q.omega])  # of x1 v1 .. xN vN in the free motion
    one = q.contact
    inside, normal = ROUNDING * np.abs(one.normal @ size[::2]), one.normal
    rigid = [np.inf * side if one.is_compliant(side) else one.stop(side) - side * inside for side in (-1, 1)]
    for state in size * np.random.default_rng(0).uniform(-1, 1, (STARTS, len(size))):
        gap = normal @ state[::2]
        state[::2] += (np.clip(gap, *rigid) - gap) * normal / (normal @ normal)
        simulated = simulate(system, state, SETTLING)
        found = from_state(system, family, simulated.section[-1], periods) if str(simulated.status) == "ok" else None
        if found and found.ok and len(found.itinerary) == len(letters) and found.itinerary in 2 * letters:
            return found
    return None


def _with_contacts(start: Solution) -> Iterator[Solution | None]:
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
    start[0, q.masses] += s.jumps[k]
    moments, out = begin + lengths[k] / 2 + T * np.arange(MOMENTS) / MOMENTS, np.empty((MOMENTS, start.shape[1]))
    flights.sample_flights(f, start, begin, np.zeros(MOMENTS, int), moments, out, flights.new_workspace(start.shape[1]))
    size = abs(steady_gap(q).swing) + np.abs(q.contact.stop(s.sides)).max() + np.abs(s.jumps).max() / q.omega
    return bool(max(out[:, 0].max() - q.contact.high, q.contact.low - out[:, 0].min()) > 1e-9 * size)


def _seeded(start: Solution) -> Iterator[Solution | None]:
    """Solutions from fixed seeds, different ones, those whose impulses push first; None after so many seeds."""
    e, K, q = EventEquations.of(start), start.K, start.family.linear
    rng, T, sides = np.random.default_rng(0), forcing_period(q), np.array(start.sides)
    stops, pushed = np.abs(q.contact.stop(start.sides)).max(), abs(push_of_free_mode(q)) * start.P / K
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
        ends, changes = e.newton(guesses[first : first + AT_ONCE])
        converged = np.isfinite(changes)
        ends, changes = ends[converged], changes[converged]
        ends[:, :K] -= np.floor(ends[:, :1] / T) * T
        pushing = np.all(-sides * ends[:, K:] > 0, axis=1)
        pulling.append((ends[~pushing], changes[~pushing]))
        yield from new(ends[pushing], changes[pushing])
        yield None
    for found in pulling:
        yield from new(*found)
