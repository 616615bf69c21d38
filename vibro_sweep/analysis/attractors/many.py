"""`attractors.group` for more orbits than memory holds: the same groups, from several passes over pieces of them."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.attractors.grouping import NOT_SETTLED, alike, doubtful, group, ranges, settled

ROOM = 300_000  # orbits that are held at once


class Orbits(NamedTuple):
    """The data of some orbits, as `attractors.group` takes them."""

    period: np.ndarray  # (orbits,)
    average: np.ndarray  # (orbits, 2 N + 3)
    error: np.ndarray  # (orbits, 2 N + 3)


def group_pieces(ends: list[int], read: Callable[[int], Orbits], room: int = ROOM) -> np.ndarray:
    """The attractor 1, 2, ... of each orbit, in any order; or `NOT_SETTLED`. (orbits,)

    Orbits come in pieces, of which piece n ends before orbit ends[n]; `read` gives a piece. Of each orbit 20 bytes are
    held. Attractors are taken out one by one, by passes over the pieces, until `room` orbits are left.
    """
    count, starts = ends[-1], [0, *ends[:-1]]
    period, label = np.empty(count, np.int64), np.full(count, NOT_SETTLED, np.int32)
    waiting, unsure = np.empty(count, bool), np.empty(count, bool)
    for n, (start, end) in enumerate(zip(starts, ends, strict=True)):
        orbits = read(n)
        period[start:end], waiting[start:end] = orbits.period, settled(ranges(*orbits)[0])
        unsure[start:end] = doubtful(*orbits)
    pieces = list(zip(range(len(ends)), starts, ends, strict=True))

    def rest():
        """The waiting orbits of each piece: where they are, and what is known of them."""
        for n, start, end in pieces:
            chosen = np.flatnonzero(waiting[start:end])
            if len(chosen):
                yield start + chosen, Orbits(*(values[chosen] for values in read(n)))

    number = 0
    while np.count_nonzero(waiting) > room:
        number += 1
        found, near = _take(waiting, period, rest)
        label[found] = number
        periodic = period[np.argmax(found)] > 0
        waiting &= ~found & ~(near & unsure & periodic)
    left = list(rest())
    if left:
        where = np.concatenate([chosen for chosen, _ in left])
        last = group(*(np.concatenate(values) for values in zip(*(orbits for _, orbits in left), strict=True)))
        label[where] = np.where(last > 0, last + number, last)
    return label


def _take(waiting, period, rest) -> tuple[np.ndarray, np.ndarray]:
    """The orbits on the attractor of the first waiting one, a periodic one if there is any, and all near it (bool)."""
    first = np.argmax(waiting * (1 + (period > 0)))
    found, near = np.zeros(len(waiting), bool), np.zeros(len(waiting), bool)
    lowest = highest = None
    growing = True
    while growing:
        growing = False
        for where, orbits in rest():
            low, high = ranges(*orbits)
            if lowest is None:
                if first not in where:
                    growing = True  # what comes before the first orbit is looked at in the next pass
                    continue
                at = np.searchsorted(where, first)
                lowest, highest, found[first] = low[at], high[at], True
            same = alike(orbits.period, period[first])
            while True:
                close = ((low <= highest) & (high >= lowest)).all(axis=1)
                new = same & close & ~found[where]
                if not new.any():
                    break
                lowest = np.minimum(lowest, low[new].min(axis=0))
                highest = np.maximum(highest, high[new].max(axis=0))
                found[where[new]] = growing = True
            near[where] = close
    return found, near
