"""Two contacts with one stop of which the second begins where the first ends: the motion of a single contact.

The mass comes back to the stop within a contact, without speed. Orbits with one contact and orbits with two meet there.
"""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from vibro_sweep.analysis.periodic.solution import Solution

ROUNDING = 1e-14  # of times, in parts of the period


def flights_between(s: "Solution") -> np.ndarray:
    """(K,) times from the end of each contact to the next one where that is with the same stop, else inf."""
    sides, times, _, ends = s.events
    following, pressed = np.append(times[1:], times[:1] + s.P), s.contacts
    same = np.append(sides[1:], s.sigma * sides[:1]) == sides
    return np.where(pressed & np.roll(pressed, -1) & same & (s.K > 1), following - ends, np.inf)


def contacts_are_one(s: "Solution") -> bool:
    """Whether the mass does not leave its stop between two contacts, to rounding."""
    return bool(flights_between(s).min(initial=np.inf) <= ROUNDING * s.P)


def without_flights(s: "Solution") -> "Solution":
    """The motion with two contacts that are one as one; else the solution itself."""
    return joined(s, int(flights_between(s).argmin())) if contacts_are_one(s) else s


def joined(s: "Solution", index: int) -> "Solution":
    """The motion in which this contact and the next one are one."""
    if index == s.K - 1:  # the next one is the first
        return joined(turned(s, 1), 0)
    *others, ends = s.events
    return s.with_events(*(np.delete(values, index + 1) for values in others), np.delete(ends, index))


def parted(s: "Solution", index: int, time: float) -> "Solution":
    """The motion in which this contact is two: it ends at this time, without speed, and the next one begins."""
    sides, times, jumps, ends = s.events
    inserted = (
        np.insert(sides, index, sides[index]),
        np.insert(times, index + 1, time),
        np.insert(jumps, index + 1, 0.0),
    )
    return s.with_events(*inserted, np.insert(ends, index, time))


def turned(s: "Solution", by: int) -> "Solution":
    """The same orbit with its last event as the first, by = 1, or its first event as the last, by = -1."""
    turns = np.zeros(s.K)
    turns[0 if by > 0 else -1] = -by
    sides, times, jumps, ends = (np.roll(values, by) for values in s.events)
    signs = float(s.sigma) ** turns
    return s.with_events(signs * sides, times + turns * s.P, signs * jumps, ends + turns * s.P)
