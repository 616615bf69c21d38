"""`Window`, and the list of all windows of a sweep."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import special_point
from vibro_sweep.analysis.branches.branch_orbits import Arrays, orbit_at
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.periodic.itinerary import word
from vibro_sweep.analysis.periodic.orbit_portrait import portrait
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.single.result import FileResult
from vibro_sweep.analysis.windows import window_text
from vibro_sweep.analysis.windows.unvisited import Unvisited, unvisited_in
from vibro_sweep.analysis.windows.window_search import WindowSearch
from vibro_sweep.oscillator.window_families import WindowFamily, families


@dataclass(frozen=True, eq=False, repr=False)
class Window:
    """A maximal interval of the swept number on which one periodic orbit, with one itinerary, is stable.

    parameter : the number's name
    lo, hi : its values at the ends
    held : the other swept numbers, of a plane
    points : how many orbits of the sweep lie in it, mirror images among them
    other_attractor : how many orbits at values within lo .. hi went to another attractor

    Examples
    --------
    >>> import numpy as np
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> window = vs.windows(vs.sweep(system, {"b": np.linspace(3, 4.4, 8)}, transient=500, record=100))[1]
    >>> window.itinerary, window.period, round(window.lo, 6), window.lower.type
    ('R', 1, 3.221904, 'graze')
    """

    parameter: str
    lo: float
    hi: float
    held: dict[str, float]
    points: int
    other_attractor: int
    _arrays: Arrays = field(repr=False)
    _system: object = field(repr=False)

    def __repr__(self) -> str:
        return window_text.of_window(self)

    @property
    def period(self) -> int:
        """In forcing periods."""
        return int(self._arrays["branch_period"])

    @property
    def symmetric(self) -> bool:
        """Whether x(t + period T/2) = -x(t)."""
        return bool(self._arrays["branch_symmetric"])

    @property
    def itinerary(self) -> str:
        """Of the orbit with more impacts on the right, of two mirror images."""
        return word(self._arrays["impact_side"])

    @cached_property
    def orbit(self) -> PeriodicOrbit:
        """At a point of the sweep."""
        return orbit_at(self._arrays, int(self._arrays["branch_origin"]), self._system)

    @cached_property
    def lower(self) -> SpecialPoint:
        """The special point that ends the window at `lo`."""
        return special_point(self._arrays, 0, self.parameter, self._system)

    @cached_property
    def upper(self) -> SpecialPoint:
        """The special point that ends the window at `hi`."""
        return special_point(self._arrays, 1, self.parameter, self._system)


class Windows(FileResult, list[Window]):
    """The windows of a sweep, a list by rising `lo` (of a plane row by row).

    parameter : the number along which they were followed
    window : index of the window of each orbit of the sweep, (*sweep, starts), -1 where there is none
    reason : codes of `tables.outcomes.REASONS`, of the same shape; 0 in a window
    unvisited : stretches of windows on which the sweep shows other attractors only, each with a start for the window's
        orbit: .window (index), .lo, .hi, .values, .at, .orbit, .state

    Examples
    --------
    >>> import numpy as np
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> windows = vs.windows(vs.sweep(system, {"b": np.linspace(3, 4.4, 8)}, transient=500, record=100))
    >>> len(windows), windows.window.ravel().tolist()
    (2, [0, 0, 0, 0, 1, 1, 1, -1])
    """

    parameter: str
    unvisited: list[Unvisited]
    window: np.ndarray
    reason: np.ndarray
    _dataset: Callable[[], Any]  # (driver/saved_results.py)

    def __repr__(self) -> str:
        return window_text.of_windows(self)

    def _table(self) -> dict[str, list]:
        held = {name: [one.held[name] for one in self] for name in (self[0].held if self else {})}
        ends = {name: [getattr(one, name) for one in self] for name in ("lo", "hi")}
        types = {name: [getattr(one, name).type for one in self] for name in ("lower", "upper")}
        more = ("period", "itinerary", "symmetric", "points", "other_attractor")
        return held | ends | types | {name: [getattr(one, name) for one in self] for name in more}

    def _title(self) -> str:
        return f"<{window_text.title(self)}>"

    def _picture_of(self, row: int) -> str:
        return portrait(self[row].orbit)

    @property
    def families(self) -> list[WindowFamily]:
        """Windows of one itinerary whose period grows by the same step: .windows are indices of this list."""
        rows = [(one.itinerary, one.symmetric, one.period, one.lo) for one in self]
        return families(*map(list, zip(*rows, strict=True))) if rows else []


def windows_of(search: WindowSearch) -> Windows:
    """The windows of a search that is done."""
    result = Windows()
    for found, *counts in zip(search.found, search.counts.tolist(), search.other_attractor.tolist(), strict=True):
        row = search.rows[found.row]
        result.append(Window(row.parameter, *found.ends, row.held, *counts, found.arrays, found.system))
    result.parameter = search.rows[0].parameter
    result.window, result.reason = in_file_order(search)
    result.unvisited = unvisited_in(search)
    return result


def in_file_order(search: WindowSearch) -> tuple[np.ndarray, np.ndarray]:
    """Windows and reasons of all orbits, (*sweep, starts)."""
    row = search.rows[0]
    found = []
    for part in (search.window, search.reason):
        values = np.empty_like(part)
        values[:, row.places] = part
        found.append(np.moveaxis(values, 0, 1 - row.axis) if row.held else values[0])
    return found[0], found[1]
