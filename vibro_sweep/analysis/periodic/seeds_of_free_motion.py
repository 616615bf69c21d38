"""A guess of the orbit with short contacts, from the free motion: the stops move in from where it grazes them.

The gap's free motion is mean + A cos(omega t + psi). A stop at h is met where that cosine is (h - mean)/A = cos alpha,
alpha before the turning point, with the speed A omega sin alpha; by a weak stop it is left alpha after that.
"""

import math
from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.periodic.seeds_of_contacts import with_contacts
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.periodic.steady_gap import steady_gap
from vibro_sweep.engine.continuation.curve_tests import TOUCHING
from vibro_sweep.engine.impulses.free_modes import has_free_gap
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import Linear

DEPTHS = 4.0 ** np.arange(-5, 1)  # of what the free motion passes a stop by
SHORTEST = 1e-9  # of its amplitude


def touches_of_free_motion(free: Solution) -> list[tuple[float, int]]:
    """(time, side) of the turning points at which the free motion touches its stops, in the order of one period."""
    q = free.family.linear
    if has_free_gap(q):
        return []
    mean, swing = steady_gap(q)
    reach = {side: side * (float(q.contact.stop(side)) - mean) for side in (1, -1)}
    sides = [side for side in (1, -1) if abs(abs(swing) - reach[side]) <= TOUCHING * abs(swing)]
    return sorted((_time(q, swing, side, 0.0) % free.P, side) for side in sides)


def with_touches(free: Solution, touches: list[tuple[float, int]]) -> Solution:
    """The free motion with these touches."""
    for index, (time, side) in enumerate(touches):
        free = free.with_touch(index, time, side)
    return free


def touching_at_once(free: Solution) -> tuple[Solution, int] | None:
    """The free motion that touches both stops at once with both touches, and the index of that which is named: of a
    rigid stop before a compliant one, of the left stop before the right one, so that rounding does not choose. None: it
    touches one, or is half an orbit."""
    if free.K or free.sigma == -1 or len(touches := touches_of_free_motion(free)) < 2:
        return None
    q = free.family.linear
    order = [(q.contact.is_compliant(side), side) for _, side in touches]
    return with_touches(free, touches), min(range(2), key=order.__getitem__)


def from_free_motion(start: Solution) -> Solution | None:
    """The orbit with the contacts of `start` that the free motion would have; None where it has others, or none."""
    q = start.family.linear
    if has_free_gap(q):
        return None
    mean, swing = steady_gap(q)
    passed = {side: abs(swing) - side * (float(q.contact.stop(side)) - mean) for side in _stops(start)}
    if min(passed.values()) <= SHORTEST * abs(swing):
        return None
    one = None
    for share in DEPTHS:
        high, low = ((1 - share) * passed.get(side, 0.0) for side in (1, -1))
        there = q.with_contact(high=q.contact.high + high, low=q.contact.low - low)
        family = start.family if share == 1 else Family(lambda there=there: there, {})
        guess = replace(one, family=family) if one else _touching(replace(start, family=family))
        one = guess and guess.corrected()
        if one is None:
            return None
    return one


def _touching(start: Solution) -> Solution | None:
    """The free motion with a contact, or an impact, wherever it passes a stop."""
    q, K = start.family.linear, start.K
    mean, swing = steady_gap(q)
    reach = {side: side * (float(q.contact.stop(side)) - mean) / abs(swing) for side in _stops(start)}
    angle = {side: math.acos(max(-1.0, share)) for side, share in reach.items()}
    turns = [(side, turn) for side in angle for turn in range(start.half_periods + 2)]
    events = sorted((_time(q, swing, side, angle[side]) + turn * 2 * math.pi / q.omega, side) for side, turn in turns)
    for first in range(len(events) - K):
        window = events[first : first + K]
        times, sides = np.array([t for t, _ in window]), tuple(side for _, side in window)
        if sides != start.sides or abs(events[first + K][0] - times[0] - start.P) > 1e-9 * start.P:
            continue
        speeds = [side * abs(swing) * q.omega * math.sin(angle[side]) for side in sides]
        guess = with_contacts(start.family, start, times, np.array(speeds))
        *events, ends = guess.events
        passed = times + 2 * np.array([angle[side] for side in sides]) / q.omega
        return guess.with_events(*events, np.minimum(ends, passed))
    return None


def _stops(start: Solution) -> set[int]:
    """The stops that the whole orbit meets."""
    return {sign * side for side in start.sides for sign in (1, start.sigma)}


def _time(q: Linear, swing: complex, side: int, angle: float) -> float:
    """When the free motion meets the stop on this side."""
    return float(((0.0 if side > 0 else math.pi) - angle - np.angle(swing) - q.tau) / q.omega)
