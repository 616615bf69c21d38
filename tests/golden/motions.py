"""Oscillators and periodic orbits as records, and by how much two orbits differ."""

import dataclasses

import numpy as np
from scipy.optimize import linear_sum_assignment

import vibro_sweep as vs

ROUNDING = 2.0**-52
AGAIN = ((0, 0.0), (0, 1e-9), (8, 1e-9), (-8, 1e-9))  # an orbit is found again: the change of the parameter, in units
# of its rounding, and that of the impacts from which it is found, relative
SAFETY = 10.0  # errors are so many times the largest movement that was seen
LEAST_ERROR = 64 * ROUNDING
LEAST_MULTIPLIER_ERROR = 1e-9  # relative
SMALLEST = 1e-300  # size of what is 0
NEAR = 1e-6  # motions farther apart are others
ZERO = 1e-30  # smaller multipliers are not told apart


def system_record(system) -> dict:
    """What `system_of` makes the oscillator of."""
    return {"type": system.model.name} | {name: _plain(value) for name, value in system.arguments.items()}


def system_of(record: dict):
    numbers = dict(record)
    return vs.Oscillator.named(numbers.pop("type"), **numbers)


def _plain(value):
    """As JSON has it: numbers and lists."""
    if isinstance(value, (np.ndarray, np.generic, tuple)):
        return np.asarray(value).tolist()
    return value


def rows_of(t, sides, v) -> list:
    """As `periodic_orbit` takes a guess."""
    return [[float(a), int(side), float(b)] for a, side, b in zip(t, sides, v, strict=True)]


def start_of(orbit) -> dict:
    """Arguments of `periodic_orbit` which give this orbit."""
    starts = motion_of(orbit).starts()
    return next((start for start in starts if orbit_from(orbit.system, start).ok), starts[-1])


def orbit_from(system, start: dict):
    return vs.periodic_orbit(system, **start)


def labels(orbit) -> dict:
    names = "period", "itinerary", "symmetric"
    return {name: getattr(orbit, name) for name in names} | {"rests": len(orbit.sticking)}


@dataclasses.dataclass
class Motion:
    """Impacts of a whole period, from which rests follow, and contacts with compliant stops, at their touch; the state
    at t = 0, of use where there are none.

    compliant : whether a stop is
    contacts : (impacts, 3) duration of each contact in forcing periods, speed of the gap at the release, largest force;
        0 for impacts. None where they are not known, or all stops are rigid.
    """

    omega: float
    periods: int
    t: np.ndarray
    side: np.ndarray
    v: np.ndarray
    state: np.ndarray
    multipliers: np.ndarray
    compliant: bool = False
    contacts: np.ndarray | None = None

    def starts(self, rng=None, noise: float = 0.0) -> list[dict]:
        """Arguments of `periodic_orbit` which give this orbit, the best first; with noise not quite its numbers.

        Touches of compliant stops do not tell how long contacts last: there the state comes first.
        """
        if not len(self.t):
            return [{"itinerary": ""}]
        t, v, state = self.t, self.v, self.state
        if rng is not None:
            change = noise * rng.standard_normal((len(t), 2))
            t, v = t + change[:, 0] / self.omega, v * (1 + change[:, 1])
        starts = [{"guess": rows_of(t, self.side, v), "periods": self.periods}]
        if self.compliant:
            if rng is not None:
                state = state * (1 + noise * rng.standard_normal(len(state)))
            starts.insert(0, {"state": state.tolist(), "periods": self.periods})
        return starts

    def found_again(self, system, rng=None, noise: float = 0.0):
        """The orbit of this oscillator near the motion; its status says whether there is any."""
        for start in self.starts(rng, noise):
            orbit = orbit_from(system, start)
            if orbit.status in ("ok", "inadmissible"):
                break
        return orbit


def motion_of(orbit) -> Motion:
    i, omega = orbit.impacts, orbit.system.omega
    if not len(orbit.contacts):
        t, side, v, compliant = i["t"], i["side"], i["v1"], orbit.system.linear.compliant
        return Motion(omega, orbit.period, t, side, v, orbit.state, orbit.multipliers, compliant)
    c, length = orbit.contacts, orbit.period * orbit.system.period
    duration = (c["t_release"] - c["t_touch"]) * omega / (2 * np.pi)
    t, side = np.append(i["t"], c["t_touch"]) % length, np.append(i["side"], c["side"])
    v = np.append(i["v1"], c["side"] * c["v_touch"])
    contacts = np.vstack([np.zeros((len(i), 3)), np.column_stack([duration, c["v_release"], c["max_force"]])])
    order = np.argsort(t)
    events = t[order], side[order], v[order]
    return Motion(omega, orbit.period, *events, orbit.state, orbit.multipliers, True, contacts[order])


def contacts_of(found: Motion, motion: Motion) -> np.ndarray | None:
    """Those of the motion `found`, counted as the impacts of `motion` are; None where it is another motion."""
    apart = [np.inf]
    if found.contacts is not None and len(found.t) == len(motion.t):
        apart = [_distance(motion, found, first) for first in range(len(motion.t))]
    return np.roll(found.contacts, -int(np.argmin(apart)), axis=0) if min(apart) < NEAR else None


def distance(one: Motion, other: Motion) -> float:
    """Of two motions, relative to their size; impacts may be counted from any one of them, and from any period."""
    if one.periods != other.periods or len(one.t) != len(other.t):
        return np.inf
    if not len(one.t):
        size = np.abs(one.state).max()
        return float(np.abs(one.state - other.state).max() / size) if size else float(np.abs(other.state).max())
    return min(_distance(one, other, first) for first in range(len(one.t)))


def _distance(one: Motion, other: Motion, first: int) -> float:
    if not np.array_equal(one.side, np.roll(other.side, -first)):
        return np.inf
    turns = (np.roll(other.t, -first) * other.omega - one.t * one.omega) / (2 * np.pi)
    turns -= np.round(turns[0])
    turns -= one.periods * np.round(turns / one.periods)
    v = np.roll(other.v, -first) - one.v
    size = np.abs(one.v).max()
    apart = [np.abs(turns).max(), np.abs(v).max() / size if size else np.abs(v).max()]
    if one.contacts is not None and other.contacts is not None:
        moved = np.abs(np.roll(other.contacts, -first, axis=0) - one.contacts).max(axis=0)
        apart += list(moved / [1.0, *np.maximum(np.abs(one.contacts).max(axis=0)[1:], SMALLEST)])
    return float(max(apart))


def multiplier_distance(one: Motion, other: Motion) -> float:
    """The largest relative difference of two that belong together."""
    a, b = one.multipliers, other.multipliers
    if len(a) != len(b):
        return np.inf
    apart = np.abs(a[:, None] - b) / np.maximum(np.abs(a[:, None]), ZERO)
    small = (np.abs(a) < ZERO)[:, None] & (np.abs(b) < ZERO)
    apart = np.minimum(np.where(small, 0.0, apart), 1e9)
    return float(apart[linear_sum_assignment(apart)].max(initial=0.0))


def errors_of(system, name: str, value: float, motion: Motion, rng) -> tuple[float, float] | None:
    """By how much the orbit at `value` of the number `name`, and its multipliers, may differ from `motion`.

    It is found again, from impacts that are not quite its own, and at neighbouring values. None where it is not found.
    """
    moved, multipliers = [], []
    for shift, noise in AGAIN:
        there = value * (1 + shift * ROUNDING)
        try:
            found = motion.found_again(system.replace(**{name: there}), rng, noise)
        except ValueError:  # the value is at the end of its range
            continue
        if found.status not in ("ok", "inadmissible"):
            return None
        moved.append(distance(motion, motion_of(found)))
        multipliers.append(multiplier_distance(motion, motion_of(found)))
    if not moved or max(moved) > NEAR:  # another orbit
        return None
    return max(SAFETY * max(moved), LEAST_ERROR), max(SAFETY * max(multipliers), LEAST_MULTIPLIER_ERROR)
