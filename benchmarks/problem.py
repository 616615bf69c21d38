"""The machines that are computed, and the truth about their first impacts in 30 digits.

The truth is that of tests/reference/events.py, which shares no formula with the package. An error is the largest error
of the first impact times of an orbit, or of three: early times mean something, the end of a chaotic orbit does not.
"""

import sys
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

import vibro_sweep as vs

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))

PAPER = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, tau=0.0)
RIGID = PAPER | dict(R=0.8)
PERIODIC, CHAOTIC = (6.69, 3.0, 1.0), (5.8, 4.6, 0.5)
CYCLE = {6.69: 29}  # forcing periods after which an orbit repeats itself, where this is not 1
STARTS = ((0.0, 0.0, 0.0, 0.0), (0.3, 0.05, -0.2, 0.1), (-0.5, -0.2, 0.3, 0.1))  # in units of b
COUNT = 40
NEAR = 1e-2  # an impact farther than this from the true one is another impact
STEP = 2.0**-36  # relative change of an input by which its influence is found

ONE = dict(k=1, zeta=0.05, F=0.5, omega=0.8, b=1, stops="right", tau=0.0)
DAMPED = dict(k_stop=1e4, c_stop=14)  # the damping ratio of mass 1 on the stop is 0.07
COMPLIANT = {
    "one mass, k_stop = 29": ONE | dict(k_stop=29),
    "one mass, k_stop = 1e4": ONE | dict(k_stop=1e4),
    "the paper's, b = 5, k_stop = 1e4": PAPER | DAMPED | dict(b=5),
    "the paper's, b = 3, k_stop = 1e4": PAPER | DAMPED | dict(b=3),
    "one mass, release by force": ONE | DAMPED | dict(release="force"),
    "one mass, preload": ONE | DAMPED | dict(preload=0.1),
}
MASSES = (1, 2, 3, 8)


def paper(b: float) -> vs.System:
    return vs.System(**RIGID, b=b)


def compliant(case: str):
    numbers = COMPLIANT[case]
    return vs.System(**numbers) if "mu_m" in numbers else vs.Oscillator.named("one_mass", **numbers)


def chain(masses: int) -> vs.Oscillator:
    """Equal masses and springs, the first mass driven and between two stops, the last one joined to the ground."""
    K = 2 * np.eye(masses) - np.eye(masses, k=1) - np.eye(masses, k=-1)
    K[0, 0] = 1
    first = np.eye(masses)[0]
    system = vs.Oscillator(
        np.eye(masses), K, 0.1 * K, contact_normal=first, force=first, omega=0.63, tau=0.0, b=1.0, R=0.8
    )
    swing = abs(np.linalg.solve(K * (1 + 0.063j) - 0.63**2 * np.eye(masses), first)[0])
    return system.replace(b=float(0.2 * swing))


class Error(NamedTuple):
    matched: int  # impacts before the first one that is missed, invented or elsewhere
    largest: float  # error of their times
    count: int  # of impacts that were compared

    def __str__(self) -> str:
        return f"{self.largest:.0e}" if self.matched == self.count else f"{self.matched} of {self.count} impacts"


@cache
def truth(system, state: tuple[float, ...], count: int) -> list[tuple]:
    """(time, side) of the first impacts, or contacts."""
    from reference.events import simulate
    from reference.machine import machine_of

    rigid = "k_stop" not in repr(system)
    orbit = simulate(machine_of(system.linear), state, **{"impacts" if rigid else "contacts": count})
    events = [(one.t, one.side) for one in orbit.impacts] if rigid else [(c.t_touch, c.side) for c in orbit.contacts]
    return sorted(events)[:count]


def error(system, states, count: int, fly) -> Error:
    """The worst over these orbits; fly(state, count) -> (times, sides)."""
    largest, matched = 0.0, count
    for state in states:
        times, sides = fly(np.array(state), count)
        exact, agreeing = truth(system, tuple(map(float, state)), count), 0
        for t, side, (true_t, true_side) in zip(times, sides, exact, strict=False):
            off = abs(float(true_t - float(t)))
            if side != true_side or not off < NEAR:
                break
            agreeing, largest = agreeing + 1, max(largest, off)
        matched = min(matched, agreeing)
    return Error(matched, largest, count)


def starts(b: float) -> list[tuple[float, ...]]:
    return [tuple(b * x for x in start) for start in STARTS]


def rounding(b: float) -> float:
    """What moving each input by one part in 2^53 does to the times: no method in doubles can be asked for less."""
    system, worst = paper(b), 0.0
    for state in starts(b):
        exact, moved = truth(system, state, COUNT), np.zeros(COUNT)
        for name, value in (RIGID | {"b": b}).items():
            other = truth(system.replace(**{name: value * (1 + STEP)}), state, COUNT)
            moved += [abs(float(t - u)) for (t, _), (u, _) in zip(exact, other, strict=True)]
        worst = max(worst, float(moved.max()) * 2.0**-53 / STEP)
    return worst


def width(system) -> float:
    """Starts of sweeps have x1 between -width and width."""
    return 0.4 * min(float(system.b), 1.0)


def on_attractor(system) -> np.ndarray:
    """States (8, 2 N) at t = 0 on the attractors that are reached from such starts."""
    states = np.zeros((8, 2 * system.masses))
    states[:, 0] = np.linspace(-width(system), width(system), 8)
    return np.array([vs.simulate(system, state, 1000).section[-1] for state in states])
