"""From the periodic points of a sweep to its windows, in rounds, until each point has a window or a reason.

In a round each group of neighbouring points of one period sends its middle one. The windows that come back take the
points whose recorded orbits lie on theirs; what is left forms the groups of the next round. So a window is followed
about once, however many points it has, and the rounds depend on the sweep alone.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.flat import Flat
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.windows.continued import continued
from vibro_sweep.analysis.windows.job import Job, Result
from vibro_sweep.analysis.windows.members import members
from vibro_sweep.analysis.windows.rows import Row
from vibro_sweep.model.bifurcations import ATTRACTORS, REASONS

FAR = 8  # values without a point of the same period end a group
SAME = 1e-9  # of the range: ends that differ by less, of windows of the same itinerary and period, are one
UNDECIDED = ("not_settled", "failed")  # reasons that say nothing of where an orbit went to
_CODES = {name: code for code, name in enumerate(REASONS)}

Point = tuple[int, int, int]  # row, value, start
Evaluate = Callable[[list[Point], list[Job]], list[Result]]


class Found(NamedTuple):
    """A window of a row."""

    row: int
    flat: Flat
    system: Any  # of the row, at the parameter of the orbit that the window was found from

    @property
    def ends(self) -> tuple[float, float]:
        values = self.flat["special_value"]
        return float(values[0]), float(values[-1])


class Cover:
    """Windows of rows, and for each row the window of each point (values, starts), -1: none, or the reason why.

    Orbits that are not periodic within their record are computed further first.
    """

    def __init__(self, rows: list[Row]):
        self.rows = [_decided(row) for row in rows]
        self.found: list[Found] = []
        self.window = [np.full(row.period.shape, -1, np.int32) for row in self.rows]
        self.reason = [row.reason.copy() for row in self.rows]
        self._open = [row.reason == 0 for row in self.rows]

    @one_thread()
    def search(self, evaluate: Evaluate) -> None:
        """Follow windows until no periodic point is left. evaluate : gives `window_of` of the jobs of these points."""
        while jobs := [(r, *point) for r in range(len(self.rows)) for point in self._middles(r)]:
            results = evaluate(jobs, [self._job(*at) for at in jobs])
            new = []
            for (r, i, j), result in zip(jobs, results, strict=True):
                if result.flat is None:
                    self._close(r, i, j, result.reason)
                elif (found := self._added(r, self.rows[r].values[i], result.flat)) is not None:
                    new.append(found)
            for w in new:
                self._take_points(w, self._open[self.found[w].row])
            for r, i, j in jobs:  # a point that its own window does not pass, which has moved to another orbit
                if self._open[r][i, j]:
                    self._close(r, i, j, "not_settled")
        for w in range(len(self.found)):
            self._take_back(w)
        self._sort()

    @property
    def total(self) -> int:
        """Orbits of the sweep."""
        return sum(reason.size for reason in self.reason)

    @property
    def done(self) -> int:
        """Orbits that have a window or a reason."""
        return self.total - sum(int(still.sum()) for still in self._open)

    @property
    def counts(self) -> np.ndarray:
        """Orbits of the sweep in each window."""
        windows = np.concatenate([window.ravel() for window in self.window])
        return np.bincount(windows + 1, minlength=len(self.found) + 1)[1:]

    def elsewhere(self, w: int) -> np.ndarray:
        """(values, starts) which orbits of a window's row lie at its values and went to another attractor."""
        found = self.found[w]
        row, window, (lo, hi) = self.rows[found.row], self.window[found.row], found.ends
        inside = (lo < row.values) & (row.values < hi)  # at an end the orbit attracts no more
        known = (window >= 0) | np.isin(self.reason[found.row], [_CODES[name] for name in ATTRACTORS])
        return inside[:, None] & known & (window != w)

    @property
    def missed(self) -> np.ndarray:
        """Orbits of the sweep at values within each window that went to another attractor."""
        return np.array([self.elsewhere(w).sum() for w in range(len(self.found))], int)

    def _middles(self, r: int) -> Iterator[tuple[int, int]]:
        """The middle point of each group of a row."""
        row, still = self.rows[r], self._open[r]
        for period in np.unique(row.period[still]):
            points = np.argwhere(still & (row.period == period))
            breaks = np.flatnonzero(np.diff(points[:, 0]) > FAR) + 1
            for group in np.split(points, breaks):
                i, j = group[len(group) // 2]
                yield int(i), int(j)

    def _job(self, r: int, i: int, j: int) -> Job:
        row = self.rows[r]
        system = row.system_at(row.values[i])
        return Job(system, row.states[i, j], int(row.period[i, j]), row.parameter, row.bounds)

    def _close(self, r: int, i: int, j: int, reason: str) -> None:
        self._open[r][i, j] = False
        self.reason[r][i, j] = _CODES[reason]

    def _added(self, r: int, value: float, flat: Flat) -> int | None:
        """The index of a window that is new; None where it is known."""
        found = Found(r, flat, self.rows[r].system_at(value))
        lo, hi = self.rows[r].bounds
        for known in self.found:
            if known.row == r and _same(known.flat, flat):
                ends = np.subtract(known.ends, found.ends)
                if np.abs(ends).max() <= SAME * (hi - lo):
                    return None
        self.found.append(found)
        return len(self.found) - 1

    def _take_back(self, w: int) -> None:
        """Assign to a window the points that had no window of their own, as an orbit at an end of a window, and lie in
        this one."""
        r = self.found[w].row
        left = np.isin(self.reason[r], [_CODES[name] for name in UNDECIDED]) & (self.rows[r].period > 0)
        taken = self._take_points(w, left)
        self.reason[r][taken] = _CODES["in_a_window"]

    def _take_points(self, w: int, still: np.ndarray) -> np.ndarray:
        """Assign to a window the points whose recorded orbits are its own, among those that are `still` without one:
        which, (values, starts). They are taken from `still`."""
        found = self.found[w]
        row = self.rows[found.row]
        lo, hi = found.ends
        inside = (lo <= row.values) & (row.values <= hi)
        wanted = still & inside[:, None] & (row.period % int(found.flat["branch_period"]) == 0)
        places = np.flatnonzero(wanted.any(axis=1))
        wanted[places] &= members(found.flat, row.system, row.parameter, row.values[places], row.states[places])
        still[wanted] = False
        self.window[found.row][wanted] = w
        return wanted

    def _sort(self) -> None:
        """Windows by row, then by their lower ends."""
        order = sorted(range(len(self.found)), key=lambda w: (self.found[w].row, self.found[w].ends))
        place = np.append(np.argsort(order), -1).astype(np.int32)  # the last one of no window
        self.found = [self.found[w] for w in order]
        self.window = [place[window] for window in self.window]


def _decided(row: Row) -> Row:
    """A row with states, periods and reasons of orbits that are computed further."""
    i, j = np.nonzero(row.reason == _CODES["not_settled"])
    if not len(i):
        return row
    found = continued(row, i, j)
    states, period, reason = row.states.copy(), row.period.copy(), row.reason.copy()
    states[i, j], period[i, j], reason[i, j] = found.state, found.period, found.reason
    return replace(row, states=states, period=period, reason=reason)


def _same(one: Flat, other: Flat) -> bool:
    """Whether two windows are of orbits with one itinerary and period."""
    return (
        one["branch_period"] == other["branch_period"]
        and one["branch_symmetric"] == other["branch_symmetric"]
        and np.array_equal(one["impact_side"], other["impact_side"])
    )
