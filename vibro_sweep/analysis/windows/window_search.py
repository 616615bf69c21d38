"""From the periodic points of a sweep to its windows, in rounds, until each point has a window or a reason.

In a round each group of neighbouring points of one period sends its middle one. The windows that come back take the
points whose recorded orbits lie on theirs; what is left forms the groups of the next round. So a window is followed
about once, however many points it has, and the rounds depend on the sweep alone.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import Arrays
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.windows.continued import continued
from vibro_sweep.analysis.windows.job import Job
from vibro_sweep.analysis.windows.members import members
from vibro_sweep.analysis.windows.rows import REASON_CODES, Row
from vibro_sweep.tables.outcomes import ATTRACTORS

FAR = 8  # values without a point of the same period end a group
SAME = 1e-9  # of the range: ends that differ by less, of windows of the same itinerary and period, are one
UNDECIDED = ("not_settled", "failed")  # reasons that say nothing of where an orbit went to


class RowWindow(NamedTuple):
    """A window of a row."""

    row: int
    arrays: Arrays
    system: Any  # of the row, at the parameter of the orbit that the window was found from

    @property
    def ends(self) -> tuple[float, float]:
        values = self.arrays["special_value"]
        return float(values[0]), float(values[-1])


class WindowSearch:
    """Windows of rows, and for each point (rows, values, starts) its window, -1: none, or the reason why.

    Orbits that are not periodic within their record are computed further first.
    """

    def __init__(self, rows: list[Row]):
        self.rows = [_decided(row) for row in rows]
        self.found: list[RowWindow] = []
        self.reason = np.stack([row.reason for row in self.rows])
        self.window = np.full(self.reason.shape, -1, np.int32)

    @one_thread()
    def search(self, evaluate: Callable[[list[str], list[Job]], Iterable[Arrays]]) -> None:
        """Follow windows until no periodic point is left. evaluate : gives `window_of` of jobs by their names."""
        while points := list(self._middles()):
            results = evaluate([":".join(map(str, at)) for at in points], [self._job(*at) for at in points])
            before = len(self.found)
            for (r, i, j), arrays in zip(points, results, strict=True):
                if "reason" in arrays:
                    self.reason[r, i, j] = arrays["reason"]
                else:
                    self._add(RowWindow(r, arrays, self.rows[r].system_at(self.rows[r].values[i])))
            for w in range(before, len(self.found)):
                self._take_points(w, self._open[self.found[w].row])
            for at in points:  # a point that its own window does not pass, which has moved to another orbit
                if self._open[at]:
                    self.reason[at] = REASON_CODES["not_settled"]
        undecided = [REASON_CODES[name] for name in UNDECIDED]
        for w, found in enumerate(self.found):  # points without a window of their own, as an orbit at an end of one
            r = found.row
            self._take_points(w, np.isin(self.reason[r], undecided) & (self.rows[r].period > 0))
        self._sort()

    @property
    def _open(self) -> np.ndarray:
        """Points that have neither a window nor a reason."""
        return (self.reason == 0) & (self.window < 0)

    @property
    def total(self) -> int:
        """Orbits of the sweep."""
        return self.reason.size

    @property
    def done(self) -> int:
        """Orbits that have a window or a reason."""
        return self.total - np.count_nonzero(self._open)

    @property
    def counts(self) -> np.ndarray:
        """Orbits of the sweep in each window."""
        return np.bincount(self.window.ravel() + 1, minlength=len(self.found) + 1)[1:]

    def on_other_attractors(self, w: int) -> np.ndarray:
        """(values, starts) which orbits of a window's row lie at its values and went to another attractor."""
        found = self.found[w]
        row, window, (lo, hi) = self.rows[found.row], self.window[found.row], found.ends
        inside = (lo < row.values) & (row.values < hi)  # at an end the orbit attracts no more
        known = (window >= 0) | np.isin(self.reason[found.row], [REASON_CODES[name] for name in ATTRACTORS])
        return inside[:, None] & known & (window != w)

    @property
    def other_attractor(self) -> np.ndarray:
        """Orbits of the sweep at values within each window that went to another attractor."""
        return np.array([self.on_other_attractors(w).sum() for w in range(len(self.found))], int)

    def _middles(self) -> Iterator[tuple[int, int, int]]:
        """Row, value and start of the middle point of each group."""
        for r, (row, still) in enumerate(zip(self.rows, self._open, strict=True)):
            for period in np.unique(row.period[still]):
                points = np.argwhere(still & (row.period == period))
                breaks = np.flatnonzero(np.diff(points[:, 0]) > FAR) + 1
                for group in np.split(points, breaks):
                    i, j = group[len(group) // 2]
                    yield r, int(i), int(j)

    def _job(self, r: int, i: int, j: int) -> Job:
        row = self.rows[r]
        system = row.system_at(row.values[i])
        return Job(system, row.states[i, j], int(row.period[i, j]), row.parameter, row.bounds)

    def _add(self, found: RowWindow) -> None:
        """Keep a window, unless it is known: another orbit may have the same itinerary and the same bounds."""
        row, middle = self.rows[found.row], len(found.arrays["value"]) // 2
        value, state = found.arrays["value"][[middle]], found.arrays["state"][[middle], None]
        if not any(
            known.row == found.row
            and _same(known.arrays, found.arrays)
            and np.allclose(known.ends, found.ends, 0, SAME * np.ptp(row.bounds))
            and members(known.arrays, row.system, row.parameter, value, state)[0, 0]
            for known in self.found
        ):
            self.found.append(found)

    def _take_points(self, w: int, still: np.ndarray) -> None:
        """Assign to a window the points (values, starts) whose recorded orbits are its own, among those that are
        `still` without one."""
        found = self.found[w]
        row = self.rows[found.row]
        lo, hi = found.ends
        inside = (lo <= row.values) & (row.values <= hi)
        wanted = still & inside[:, None] & (row.period % int(found.arrays["branch_period"]) == 0)
        places = np.flatnonzero(wanted.any(axis=1))
        wanted[places] &= members(found.arrays, row.system, row.parameter, row.values[places], row.states[places])
        self.window[found.row][wanted], self.reason[found.row][wanted] = w, REASON_CODES["in_a_window"]

    def _sort(self) -> None:
        """Windows by row, then by their lower ends."""
        order = sorted(range(len(self.found)), key=lambda w: (self.found[w].row, self.found[w].ends))
        place = np.append(np.argsort(order), -1).astype(np.int32)  # the last one of no window
        self.found = [self.found[w] for w in order]
        self.window = place[self.window]


def _decided(row: Row) -> Row:
    """A row with states, periods and reasons of orbits that are computed further."""
    i, j = np.nonzero(row.reason == REASON_CODES["not_settled"])
    if not len(i):
        return row
    found = continued(row, i, j)
    states, period, reason = row.states.copy(), row.period.copy(), row.reason.copy()
    states[i, j], period[i, j], reason[i, j] = found.state, found.period, found.reason
    return replace(row, states=states, period=period, reason=reason)


def _same(one: Arrays, other: Arrays) -> bool:
    """Whether two windows are of orbits with one itinerary and period."""
    return (
        one["branch_period"] == other["branch_period"]
        and one["branch_symmetric"] == other["branch_symmetric"]
        and np.array_equal(one["impact_side"], other["impact_side"])
    )
