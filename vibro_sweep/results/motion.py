"""The continuous motion of an orbit as arrays: states over time, impacts, and stops with their forces."""

from dataclasses import dataclass, replace

import numpy as np

from vibro_sweep.oscillator.contact_laws.compliant import StopLaw
from vibro_sweep.oscillator.stop_force import force_of


@dataclass(frozen=True)
class Motion:
    """A sampled motion. Where the velocity jumps there are three samples: before the impact, NaN, and after it.

    t : (m,), in units of `unit`
    states : x1, v1, ... -> (m,), NaN where not known; `gap` and `gap_velocity` beside them where the gap is not x1
    impacts : rows (t, side, velocity of the gap before, after), (k, 4)
    stops : side (+1 right, -1 left) -> where the stop stands
    laws : side -> law of a compliant stop
    by_force : whether a contact ends where its force is zero
    """

    t: np.ndarray
    unit: float
    states: dict[str, np.ndarray]
    impacts: np.ndarray
    stops: dict[int, float]
    laws: dict[int, StopLaw]
    by_force: bool

    def __getitem__(self, name: str) -> np.ndarray:
        return self.t if name == "t" else self.states[name]

    @property
    def names(self) -> tuple[str, str]:
        """Of the gap, and its velocity."""
        return ("gap", "gap_velocity") if "gap" in self.states else ("x1", "v1")

    @property
    def rests(self) -> np.ndarray:
        """Whether the mass rests on a stop, bool (m,)."""
        gap, rate = (self[name] for name in self.names)
        return np.isin(gap, list(self.stops.values())) & (rate == 0)

    def scaled(self, length: float, velocity: float, time: float, force: float) -> "Motion":
        """The same motion in other units: what its numbers are multiplied by."""
        of = {"x": length, "v": velocity}
        states = {
            name: values * (velocity if name == "gap_velocity" else of.get(name[0], length))
            for name, values in self.states.items()
        }
        laws = {
            side: law._replace(k=law.k * force / length, c=law.c * force / velocity, p=law.p * force)
            for side, law in self.laws.items()
        }
        stops = {side: stop * length for side, stop in self.stops.items()}
        impacts = self.impacts * np.array([time, 1.0, velocity, velocity])
        return replace(self, t=self.t * time, states=states, impacts=impacts, stops=stops, laws=laws)

    def joined(self) -> "Motion":
        """Without the gaps in the jumps: positions go on through an impact, and velocities that it does not change."""
        there = np.isfinite(self["x1"])
        return replace(self, t=self.t[there], states={name: values[there] for name, values in self.states.items()})

    def finer(self, times: int) -> "Motion":
        """A joined motion with so many times the samples, of the gap and its velocity alone: cubic between samples, so
        that contacts begin and end where they do."""
        from scipy.interpolate import CubicHermiteSpline  # slow to import

        t, x, v = self.unit * self.t, *(self[name] for name in self.names)
        parts = np.split(np.arange(len(t)), np.flatnonzero(np.diff(t) <= 0) + 1)
        splines = [CubicHermiteSpline(t[stretch], x[stretch], v[stretch]) for stretch in parts if len(stretch) > 1]
        at = [np.interp(np.arange((len(s.x) - 1) * times + 1) / times, np.arange(len(s.x)), s.x) for s in splines]
        values = ([s(t, n) for s, t in zip(splines, at, strict=True)] for n in (0, 1))
        states = dict(zip(self.names, map(np.concatenate, values), strict=True))
        return replace(self, t=np.concatenate(at) / self.unit, states=states)

    def force(self, side: int) -> tuple[np.ndarray, np.ndarray]:
        """The force of the stop on this side, and by how much it is pressed in, (m,); of a rigid one 0."""
        gap, rate = (self[name] for name in self.names)
        delta, speed = side * (gap - self.stops[side]), side * rate
        return force_of(self.unit * self.t, delta, speed, self.laws.get(side), self.by_force)


def with_jumps(t: np.ndarray, states: dict[str, np.ndarray], at: dict[str, tuple]) -> dict[str, np.ndarray]:
    """Sampled states, and t, with three rows put in at each impact.

    at : name -> its values before, in the jump, and after, (k,) each, of all states and of t
    """
    place = np.repeat(np.searchsorted(t, at["t"][0]), 3)
    return {
        name: np.insert(values, place, np.stack(at[name], axis=1).ravel())
        for name, values in (states | {"t": t}).items()
    }
