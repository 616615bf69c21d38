"""The continuous motion of an orbit, sampled, with its impacts put in: there the velocity jumps, and a line ends."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.model.state import state
from vibro_sweep.plotting.result import Point, Result


class Path(NamedTuple):
    """A sampled motion, (n,) each: t in forcing periods, x1, v1, x2, v2 (NaN where not stored), with NaN in each jump.

    `jumps`: rows (x1, v1 before, v1 after), one an impact. `complete`: they are in the file.
    """

    t: np.ndarray
    x1: np.ndarray
    v1: np.ndarray
    x2: np.ndarray
    v2: np.ndarray
    jumps: np.ndarray
    complete: bool

    def joined(self) -> "Path":
        """Without the gaps in the jumps: all but v1 go on through an impact."""
        there = np.isfinite(self.x1)
        states = (values[there] for values in (self.t, self.x1, self.v1, self.x2, self.v2))
        return Path(*states, self.jumps, self.complete)


def path(result: Result, point: Point) -> Path:
    """The trajectory of an orbit, as the file holds it."""
    t = result.coordinate("time")
    stored = [f"trajectory_{name}" for name in state(2)]
    states = [result.one(name, point) if name in result else np.full(len(t), np.nan) for name in stored]
    if "trajectory_impacts" not in result:  # of version 0.1
        return Path(t, *states, np.empty((0, 3)), False)
    when, side, before, after = (
        result.one(f"trajectory_impact_{name}", point) for name in ("time", "side", "v1", "v1_after")
    )
    stored = [f"trajectory_impact_{name}" for name in ("x2", "v2")]
    x2, v2 = (result.one(name, point) if name in result else np.full(len(when), np.nan) for name in stored)
    hits = np.isfinite(when)
    when, side, before, after, x2, v2 = (values[hits] for values in (when, side, before, after, x2, v2))
    stops = result.stops(point.place)
    stop = np.array([stops.get(one, np.nan) for one in side.tolist()])
    at = np.repeat(np.searchsorted(t, when), 3)
    gap = np.full(len(when), np.nan)
    rows = [(when, when, when), (stop, gap, stop), (before, gap, after), (x2, gap, x2), (v2, gap, v2)]
    values = [
        np.insert(values, at, np.stack(new, axis=1).ravel()) for values, new in zip((t, *states), rows, strict=True)
    ]
    return Path(*values, np.stack([stop, before, after], axis=1), True)
