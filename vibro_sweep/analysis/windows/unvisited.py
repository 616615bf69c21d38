"""Where a window's orbit attracts, and no orbit of the sweep went there: coexistence that its starts missed."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.windows.members import solution_in
from vibro_sweep.analysis.windows.window_search import WindowSearch


@dataclass(frozen=True, eq=False)
class Unvisited:
    """A stretch of a window on which orbits of the sweep show other attractors, and none shows the window's.

    window : index of the window
    lo, hi : the first and the last value of the sweep that shows another attractor; the window's own end where no
        value of the sweep lies between
    values : how many values of the sweep lie within
    at : one of them, the farthest from the window's ends at which the orbit could be computed
    orbit : the window's orbit at `at`; `orbit.status` says where it could not be computed

    Examples
    --------
    From rest the sweep finds the motion "LR" up to b = 3.6, although "R" is stable from 3.2219 on.

    >>> import numpy as np
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> windows = vs.windows(vs.sweep(system, {"b": np.linspace(3, 4.4, 8)}, transient=500, record=100))
    >>> [(windows[one.window].itinerary, round(one.lo, 4), round(one.hi, 4)) for one in windows.unvisited]
    [('LR', 3.8, 3.8928), ('R', 3.2219, 3.6)]
    """

    window: int
    lo: float
    hi: float
    values: int
    at: float
    orbit: PeriodicOrbit = field(repr=False)

    @property
    def state(self) -> np.ndarray:
        """(2N,) a start at t = 0 mod T that stays on the window's orbit; NaN where none is known."""
        return self.orbit.state if self.orbit.ok else np.full(2 * self.orbit.system.masses, np.nan)


def unvisited_in(search: WindowSearch) -> list[Unvisited]:
    """All such stretches of the windows of a search that is done, by window and rising value."""
    return [found for w in range(len(search.found)) for found in _of_window(search, w)]


def _of_window(search: WindowSearch, w: int) -> Iterator[Unvisited]:
    found, values = search.found[w], search.rows[search.found[w].row].values
    ends = found.ends
    inside = np.flatnonzero((ends[0] < values) & (values < ends[1]))
    seen = (search.window[found.row][inside] == w).any(axis=1)
    others = search.on_other_attractors(w)[inside].any(axis=1) & ~seen
    for run in np.split(inside, np.flatnonzero(np.diff(seen)) + 1):
        missed = run[others[run - inside[:1]]]
        if not len(missed):
            continue
        lo, hi = values[missed[[0, -1]]].tolist()
        if 0 < missed[0] == inside[0]:
            lo = ends[0]
        if inside[-1] == missed[-1] < len(values) - 1:
            hi = ends[1]
        yield Unvisited(w, lo, hi, len(missed), *_start(search, w, values[missed]))


def _start(search: WindowSearch, w: int, values: np.ndarray) -> tuple[float, PeriodicOrbit]:
    """The value farthest from the window's ends at which its orbit is known, and the orbit there."""
    found = search.found[w]
    row, (lo, hi) = search.rows[found.row], found.ends
    order = np.argsort(-np.minimum(values - lo, hi - values), kind="stable")
    for value in values[order].tolist():
        system = row.system_at(value)
        orbit = orbit_of(system, solution_in(found.arrays, value, system))
        if orbit.ok and orbit.stable:
            return value, orbit
    first = float(values[order[0]])
    return first, PeriodicOrbit(row.system_at(first), "not_converged")
