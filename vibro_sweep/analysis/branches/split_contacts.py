"""The end of a branch, or a curve, at which two contacts with one stop become one: the mass does not leave the stop
between them.

The branch of the orbits with one contact goes on smoothly, as far as its equations tell, beyond the place where the
mass comes back to the stop within the contact. So that place is looked for along it.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.branches.branch_events import SPLIT, locate
from vibro_sweep.analysis.continuation.events import LocatedEvent
from vibro_sweep.analysis.continuation.first_point import first_place, guess_of
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.periodic.joined_contacts import flights_between, joined, parted, turned
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.problem import GRAZE

SHORT = 1e-3  # of 1/omega: the flight between two contacts that are about to be one
STEPS = np.geomspace(1e-9, 1e-2, 15)  # along the branch of orbits with one contact
WITHIN = 401  # times within a contact
BESIDE = 1e-3  # of 1/omega, about the time at which the mass is at rest


def joined_contacts(curve: SolutionCurve, s: Solution, theta: float = 0.0) -> tuple[LocatedEvent, Solution] | None:
    """Where two contacts of an orbit at the end of its branch or curve become one, and the orbit there, with both.

    theta : of a Neimark-Sacker curve. None where it has no contacts that are about to be one.
    """
    apart, start, K = flights_between(s), curve.start, s.K
    if not s.family.linear.omega * apart.min(initial=np.inf) < SHORT:
        return None
    index = int(apart.argmin())
    if start.kind == GRAZE and start.index in (index, (index + 1) % K):
        return None
    near, wraps = s.ends[s.rests.index(index)] + apart[index] / 2, index == K - 1
    grazing = start.index - (start.index > index and not wraps)
    start = replace(start, solution=joined(s, index), index=grazing, theta=theta)
    count = len(curve.names)
    one = SolutionCurve(start, curve.names, curve.bounds[:count], curve.unit[:count])
    first = first_place(one)
    for step in [] if first is None else (sign * length for length in STEPS for sign in (1, -1)):
        other = one.step(first, step)
        found = other and locate(one, SPLIT, first, other)
        if found:
            both = _with_both(found.place.solution, index, near, wraps)
            return (found, both) if both else None
    return None


def set_apart(curve: SolutionCurve, length: float) -> Point | None:
    """The orbit with a flight of this length, in phase, between two contacts that are one where the curve begins."""
    index = int(flights_between(curve.orbit).argmin())
    following, row, guess = (index + 1) % curve.K, np.zeros(2 * curve.K + 3), guess_of(curve)
    if guess is None:
        return None
    row[[index, curve.K + index, following]] = -1.0, -1.0, 1.0
    guess.phases[following] += length
    guess.jumps[following] -= length
    return curve.correct(guess, curve.unit_row(row))


def in_two(s: Solution) -> Solution:
    """The orbit with the contact within which the mass is nearest to its stop, at rest, as two."""
    orbit, q, found = PeriodicOrbit(None, "ok", s, (0, 0)), s.family.linear, []
    for index, end in zip(s.rests, s.ends.tolist(), strict=True):
        times = np.linspace(s.times[index], end, WITHIN)
        depth = s.sides[index] * (orbit.sample(times)[:, 0::2] @ q.contact.normal)
        least = np.flatnonzero((depth[1:-1] <= depth[:-2]) & (depth[1:-1] <= depth[2:])) + 1
        found += [(depth[k] - s.sides[index] * q.contact.stop(s.sides[index]), index, times[k]) for k in least]
    _, index, near = min(found)
    step = (s.ends[s.rests.index(index)] - s.times[index]) / (WITHIN - 1)
    return parted(s, index, at_rest(orbit, near, step))


def at_rest(orbit: PeriodicOrbit, near: float, beside: float) -> float:
    """When the gap is at rest, so near to a time. Raises ValueError where it is not."""
    normal = orbit._solution.family.linear.contact.normal
    return brentq(lambda t: orbit.sample([t])[0, 1::2] @ normal, near - beside, near + beside, xtol=1e-15)


def _with_both(s: Solution, index: int, near: float, wraps: bool) -> Solution | None:
    """The orbit in which contact `index` ends where the gap is at rest, near this time, and the next one begins."""
    try:
        time = at_rest(PeriodicOrbit(None, "ok", s, (0, 0)), near, BESIDE / s.family.linear.omega)
    except ValueError:  # it is not at rest there
        return None
    return turned(parted(s, 0, time - s.P), -1) if wraps else parted(s, index, time)
