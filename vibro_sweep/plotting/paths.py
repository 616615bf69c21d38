"""The continuous motion of an orbit, sampled, with its impacts put in: there the velocity jumps, and a line ends."""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from vibro_sweep.plotting.sweep_result import Point, Result
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.observables import jumping

GAP = {"gap": "x", "gap_velocity": "v"}  # what is formed of the positions, and of the velocities


class Path(NamedTuple):
    """A sampled motion: t in forcing periods (n,), with NaN in each jump.

    `states`: name -> (n,), NaN where not stored; `gap` and `gap_velocity` beside them where the gap is not x1. `jumps`:
    rows (gap, gap velocity before, after), one an impact. `stops`: the gap at each.
    """

    t: np.ndarray
    states: dict[str, np.ndarray]
    jumps: np.ndarray
    stops: tuple[float, ...] = ()

    def __getitem__(self, name: str) -> np.ndarray:
        return self.t if name == "t" else self.states[name]

    @property
    def rests(self) -> np.ndarray:
        """Whether the mass rests on a stop, bool (n,)."""
        gap, rate = ("gap", "gap_velocity") if "gap" in self.states else ("x1", "v1")
        return np.isin(self[gap], self.stops) & (self[rate] == 0)

    def joined(self) -> "Path":
        """Without the gaps in the jumps: positions go on through an impact, and velocities that it does not change."""
        there = np.isfinite(self["x1"])
        return self._replace(t=self.t[there], states={name: values[there] for name, values in self.states.items()})

    def finer(self, gap: str, rate: str, T: float, times: int) -> "Path":
        """A joined motion with so many times the samples, of the gap and its velocity alone: cubic between samples, so
        that contacts begin and end where they do."""
        t, x, v = T * self.t, self[gap], self[rate]
        parts = np.split(np.arange(len(t)), np.flatnonzero(np.diff(t) <= 0) + 1)
        splines = [CubicHermiteSpline(t[one], x[one], v[one]) for one in parts if len(one) > 1]
        at = [np.interp(np.arange((len(s.x) - 1) * times + 1) / times, np.arange(len(s.x)), s.x) for s in splines]
        values = ([s(t, n) for s, t in zip(splines, at, strict=True)] for n in (0, 1))
        return self._replace(
            t=np.concatenate(at) / T, states=dict(zip((gap, rate), map(np.concatenate, values), strict=True))
        )


def path(result: Result, point: Point) -> Path:
    """The trajectory of an orbit, as the file holds it."""
    t, along = result.coordinate("t_over_T"), result.contact_normal
    names = state(result.masses)
    motion = {name: _stored(result, f"trajectory_{name}", point, len(t)) for name in names}
    velocity = jumping(along is not None)
    when, side, speed, after = (
        result.one(f"trajectory_impact_{name}", point) for name in ("t_over_T", "side", velocity, f"{velocity}_after")
    )
    hits = np.isfinite(when)
    at_impact = {name: _stored(result, f"trajectory_impact_{name}", point, len(when))[hits] for name in names}
    when, side, speed, after = (values[hits] for values in (when, side, speed, after))
    stops = result.stops(point.place)
    stop = np.array([stops.get(one, np.nan) for one in side.tolist()])
    gap = np.full(len(when), np.nan)
    rows = {name: (values, gap, values) for name, values in at_impact.items()}
    if along is None:
        rows |= {"x1": (stop, gap, stop), "v1": (speed, gap, after)}
    else:
        motion |= {name: gap_of(motion, along, letter) for name, letter in GAP.items()}
        rows |= {name: (at_impact[name], gap, gap) for name in names[1::2]}  # after it: from the next sample on
        rows |= {"gap": (stop, gap, stop), "gap_velocity": (speed, gap, after)}
    at = np.repeat(np.searchsorted(t, when), 3)
    rows["t"] = (when, when, when)
    put = {
        name: np.insert(values, at, np.stack(rows[name], axis=1).ravel())
        for name, values in (motion | {"t": t}).items()
    }
    return Path(put.pop("t"), put, np.stack([stop, speed, after], axis=1), tuple(stops.values()))


def gap_of(motion: dict[str, np.ndarray], along: np.ndarray, letter: str) -> np.ndarray:
    """n.x, or of velocities n.v."""
    return sum(n * motion[f"{letter}{i}"] for i, n in enumerate(along, 1))


def _stored(result: Result, name: str, point: Point, count: int) -> np.ndarray:
    return result.one(name, point) if name in result else np.full(count, np.nan)
