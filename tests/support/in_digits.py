"""Periodic orbits and special points as the references in many digits have them: by public names alone.

A motion is that of an orbit, or, at a point of a curve, that of a simulation from the state there.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from mpmath import mp
from reference.closed_orbit import ClosedOrbit, contacts_of, element_of
from reference.conditions import Condition
from reference.machine import machine_of, mapped, moved

import vibro_sweep as vs
from support.events import Event, events_of

CONDITIONS = {
    "fold": ["fold"],
    "flip": ["flip"],
    "pitchfork": ["flip"],
    "neimark_sacker": ["pair"],
    "cusp": ["fold", "cusp"],
    "degenerate_flip": ["flip", "third"],
    "degenerate_neimark_sacker": ["pair", "third"],
    "fold_flip": ["fold", "flip"],
    "fold_neimark_sacker": ["fold", "pair"],
    "flip_neimark_sacker": ["flip", "pair"],
    "resonance_1_1": ["fold", "double_1"],
    "resonance_1_2": ["flip", "double_-1"],
    "resonance_1_3": ["pair"],
    "resonance_1_4": ["pair"],
    "fold_graze": ["fold"],
    "flip_graze": ["flip"],
    "pitchfork_graze": ["flip"],
    "neimark_sacker_graze": ["pair"],
    "graze": [],
    "split": [],
    "double_graze": [],
    "resonant_graze": [],
}
ANGLES = {"resonance_1_3": 2 * np.pi / 3, "resonance_1_4": np.pi / 2}
OF_THE_IMPACT = ("resonant_graze", "neimark_sacker_graze")  # multipliers of the orbit with the impact without speed
SLOW = 1e-9  # of the gap's size times omega: speed of an impact that vanishes
SLOW_IN_SIMULATION = 1e-6  # rounding of the gap makes a graze as fast as its square root
NO_LENGTH = 1e-7  # of the period: a contact that short is a touch
SAMPLES = 40_000  # of a motion, between which turning points are looked for
SECTION = 0.37  # of the longest flight: in its middle a symmetric one may touch the other stop
CONVERGED = 1e-16


class Motion(NamedTuple):
    """A motion that comes back after so many forcing periods, mirrored if sigma is -1."""

    system: object
    periods: float
    sigma: int
    events: list[Event]  # within this time, in order
    sample: Callable  # states at times

    @property
    def P(self) -> float:
        return self.periods * 2 * np.pi / self.system.linear.omega

    def gap(self, times) -> np.ndarray:
        return self.sample(times)[:, ::2] @ self.system.linear.contact.normal

    def grid(self) -> np.ndarray:
        """Times of a period, from the first event on."""
        return (self.events[0].begin if self.events else 0.0) + np.linspace(0, self.P, SAMPLES + 1)


def of_orbit(orbit) -> Motion:
    parts, events = 2 if orbit.symmetric else 1, events_of(orbit)
    half = events[: len(events) // parts]
    return Motion(orbit.system, orbit.period / parts, -1 if orbit.symmetric else 1, half, orbit.sample)


def of_point(curve, k: int, orbit) -> Motion:
    """At a point of a curve; orbit: that of the special point at which the curve was begun."""
    point = curve.points.isel(point=k)
    system = orbit.system.replace(**{name: float(point[name]) for name in curve.parameters})
    names = [f"{letter}{i + 1}" for i in range(system.linear.masses) for letter in "xv"]
    symmetric = orbit.symmetric and system.linear.symmetric
    run = vs.simulate(system, np.array([float(point[name]) for name in names]), 2 * orbit.period)
    motion = Motion(system, orbit.period / (1 + symmetric), -1 if symmetric else 1, [], run.sample)
    return motion._replace(events=[event for event in events_of(run) if 0 < event.begin <= motion.P])


def vanishing(motion: Motion, slow: float = SLOW) -> list[Event]:
    """Impacts without speed and contacts without length."""
    least = slow * motion.system.linear.omega * np.ptp(motion.gap(motion.grid()))
    return [
        event
        for event in motion.events
        if (abs(event.speed) < least if event.kind == "impact" else event.end - event.begin < NO_LENGTH * motion.P)
    ]


def without(motion: Motion, gone: list[Event]) -> Motion:
    return motion._replace(events=[event for event in motion.events if event not in gone])


def turning_points(motion: Motion) -> list[tuple[float, int]]:
    """(time, side) of turning points of flights, the nearest to its stop first."""
    times, q = motion.grid(), motion.system.linear
    times = np.append(times, times[-1] + (times[1] - times[0]) * np.arange(1, 3))
    gap, near, found = motion.gap(times), 2 * (times[1] - times[0]), []
    for side, place in ((1, q.contact.high), (-1, q.contact.low)):
        height = side * gap
        (tops,) = np.nonzero((height[1:-1] > height[:-2]) & (height[1:-1] >= height[2:]))
        for k in tops + 1:
            before, here, after = height[k - 1 : k + 2]
            time = times[k] + 0.5 * (times[1] - times[0]) * (before - after) / (before - 2 * here + after)
            busy = any(event.begin - near < time - n * motion.P < event.end + near for event in motion.events
                       for n in (0, 1))  # fmt: skip
            if np.isfinite(place) and not busy:
                found.append((side * place - here, time, side))
    return [(time, side) for _, time, side in sorted(found)]


def parted(motion: Motion) -> tuple[Motion, tuple[float, int]]:
    """The motion with one contact in place of two that meet; when, and at which stop, the mass comes back within it."""
    events = motion.events
    for k, event in enumerate(events):
        after = events[(k + 1) % len(events)]
        later = motion.P * (k + 1 == len(events))
        if after.side == event.side and abs(after.begin + later - event.end) < NO_LENGTH * motion.P:
            one = event._replace(end=after.end + later)
            kept = [other for other in events if other not in (event, after)]
            return motion._replace(events=sorted([*kept, one])), (event.end, event.side)
    found = []
    for event in events:
        times = np.linspace(event.begin, event.end, 4001)[1:-1]
        depth = event.side * motion.gap(times)
        (inner,) = np.nonzero((depth[1:-1] < depth[:-2]) & (depth[1:-1] < depth[2:]))
        found += [(depth[k + 1], times[k + 1], event.side) for k in inner]
    return motion, min(found)[1:]


class Closed(NamedTuple):
    """A motion as the reference needs it, with its section in the longest flight."""

    machine: object
    of: tuple  # events, periods, sigma, begin
    guess: tuple  # state at the section, times of the events
    touching: list[float]  # times of the touches
    touched: list[int]  # stops of the touches
    legs: dict  # of each event of the motion, the number of the reference's


def closed_of(motion: Motion, touches=(), pulled: bool = False) -> Closed:
    """touches: (time, side) of turning points that touch a stop; pulled: as of `contacts_of`."""
    P, sigma, events = motion.P, motion.sigma, motion.events
    if events:
        gaps = np.array([*[event.begin for event in events[1:]], events[0].begin + P]) - [event.end for event in events]
        k = int(np.argmax(gaps))
        begin = float(events[k].end + SECTION * gaps[k])
    else:
        begin = float(touches[0][0] + P / 2) if touches else 0.0
    machine = machine_of(motion.system.linear)

    def within(time, side):
        turns = int(np.floor((time - begin) / P))
        return time - turns * P, int(side * float(sigma) ** turns)

    legs, kinds, times = {}, [], []
    for event in sorted(events, key=lambda event: within(*event[:1], event.side)[0]):
        time, side = within(event.begin, event.side)
        legs[event] = len(kinds)
        e = element_of(machine, side)
        parts = {"impact": [("impact", e)], "rest": [("rest", e), ("leave", e)]}
        kinds += parts.get(event.kind) or contacts_of(machine, [side], pulled)
        times += [time] if event.kind == "impact" else [time, time + event.end - event.begin]
    wrapped = [within(*touch) for touch in touches]
    touched = [element_of(machine, side) for _, side in wrapped]
    state = motion.sample([begin])[0]
    return Closed(
        machine, (kinds, motion.periods, sigma, begin), (state, times), [time for time, _ in wrapped], touched, legs
    )


def slope_of(system, name: str, value: float):
    """Derivatives of a `vs.types.Linear` by a number, at the same phase: by differences, as only tiny changes are
    multiplied by them."""
    step, ends = 1e-6 * max(abs(value), 1e-3), []
    for moved_by in (step, -step):
        try:
            ends.append((value + moved_by, system.replace(**{name: value + moved_by}).linear))
        except ValueError:  # beyond what is allowed
            ends.append((value, system.replace(**{name: value}).linear))
    (above, q), (below, p) = ends
    with np.errstate(invalid="ignore"):
        slope = mapped(lambda name, x, y: np.nan_to_num(np.subtract(x, y, dtype=float) / (above - below)), q, p)
    slope.tau = 0.0  # of no stop, inf - inf is 0
    return slope


def moved_by(motion: Motion, values: dict, conditions=(), touches=(), theta=None, angle=None, pulled=False):
    """By how much these numbers change until the motion fulfils the conditions: those of reference.conditions.

    conditions: with events of the motion; theta: of a pair, nearly (None: as the reference has it)
    """
    d = closed_of(motion, touches, pulled)
    conditions = [one if isinstance(one, str) else (one[0], d.legs[one[1]]) for one in conditions]
    slopes = [slope_of(motion.system, name, value) for name, value in values.items()]
    if "pair" in conditions and angle is None and theta is None:
        mu = np.array([complex(one) for one in ClosedOrbit(d.machine, *d.of).multipliers(*d.guess)])
        theta = float(np.angle(mu[np.argmin(np.where(mu.imag > 1e-9, np.abs(np.abs(mu) - 1), np.inf))]))
    q = motion.system.linear
    at = lambda changes: machine_of(moved(q, slopes, changes))  # noqa: E731
    condition = Condition(at, len(slopes), *d.of, conditions, d.touched, angle)
    off, change = condition.solve(*d.guess, d.touching, theta)
    assert change < CONVERGED, change
    return np.array(off)


def has_conditions(special) -> bool:
    """Whether `errors_of` has equations: at a corner, where a compliant stop is touched, a resonance has none."""
    corner = special.type == "resonant_graze" and special.orbit.system.linear.compliant
    return special.type in CONDITIONS and special.orbit.ok and not corner


def errors_of(special, pulled: bool = False) -> np.ndarray:
    """By how much the parameters of a special point of a branch or a curve are off."""
    motion, of_type = of_orbit(special.orbit), special.type
    if of_type in OF_THE_IMPACT and not special.touches and any(event.kind == "impact" for event in vanishing(motion)):
        return moved_by(motion, special.parameters, **with_impact(special, motion))
    conditions = CONDITIONS[of_type]
    if of_type == "split" and len(special.parameters) > 1:  # the end of a curve
        conditions = CONDITIONS[special.curve]
    count, touches = len(special.parameters) - len(conditions) - (of_type in ANGLES), []
    if of_type == "split":
        motion, touch = parted(motion)
        touches = [touch]
    elif of_type.endswith("graze"):
        motion = without(motion, vanishing(motion))
        touches = turning_points(motion)[:count]
    return moved_by(motion, special.parameters, conditions, touches, angle=ANGLES.get(of_type), pulled=pulled)


def with_impact(special, motion: Motion) -> dict:
    """Conditions where the impact without speed belongs to the orbit: where several vanish at once, the others stay in
    proportion to the first."""
    theta = critical_angle(special, motion)
    kind = "pair" if special.type == "neimark_sacker_graze" else "flip" if theta else "fold"
    return {"conditions": [kind, ("vanishing", vanishing(motion)[0])], "theta": theta}


def critical_angle(special, motion: Motion) -> float:
    """theta of the critical multiplier: 0 or pi at a resonant graze."""
    angles = [0, mp.pi] if special.type == "resonant_graze" else mp.linspace(0.01, mp.pi - 0.01, 300)
    d = closed_of(motion)
    closed = ClosedOrbit(d.machine, *d.of)
    J = closed.residual_and_jacobian([a for part in d.guess for a in part])[1]
    return float(min(angles, key=lambda angle: abs(mp.det(closed.linearised(J, mp.expj(angle))))))
