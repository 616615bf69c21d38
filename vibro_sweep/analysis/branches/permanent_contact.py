"""The end of a branch at which a contact never ends: the mass no longer leaves its stop.

A mass that is always pressed belongs to a linear oscillator, with the spring and the damper of the stop. Its steady
motion is known in closed form, and so is its least displacement into the stop: the branch ends where that is zero.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.periodic.steady_gap import SteadyGap, steady_gap
from vibro_sweep.engine.impulses.free_modes import ResonanceError
from vibro_sweep.oscillator.linear import Linear

SHORT = 1e-3  # of 1/omega: the flight between two contacts of an orbit that is about to leave its stop no more
STEPS = np.geomspace(1e-12, 1e-2, 21)  # of the parameter's unit, from the last orbit that leaves its stop
NEAR = 0.1  # of 1/omega, from the touch of that orbit
ROUNDING = 2.0**-50  # of the gap


class PermanentContact(NamedTuple):
    value: float  # of the parameter
    error: float
    solution: Solution
    multipliers: np.ndarray  # (2 N,)


def permanent_contact(s: Solution, name: str, unit: float) -> PermanentContact | None:
    """Where the one contact of this orbit at the end of its branch never ends; None where it does."""
    q = s.family.linear
    if s.K != 1 or s.sigma != 1 or not s.rests or not s.contacts[0]:
        return None
    side, last = s.sides[0], s.family.free[name]
    law = q.contact.law(side)
    leaves_by_force = q.contact.by_force and law.c > 0 and not law.p > 0  # before it is back at the stop's place
    if leaves_by_force or not q.omega * (s.times[0] + s.P - s.ends[0]) < SHORT:
        return None

    def least(value: float) -> float:
        return _least(s.family.replace(**{name: value}).linear, side)[0]

    try:
        here = least(last)
        other = next(
            one for step in STEPS for one in (last + step * unit, last - step * unit) if least(one) * here <= 0
        )
        value = brentq(least, last, other, xtol=1e-300, rtol=1e-15)
    except (StopIteration, ResonanceError, ValueError):  # none; or the parameter is beyond its range
        return None
    family = s.family.replace(**{name: value})
    q = family.linear
    _, gap = _least(q, side)
    touch = ((np.pi if side > 0 else 0.0) - np.angle(gap.swing) - q.tau) / q.omega
    touch += round((s.times[0] - touch) / s.P) * s.P
    if not q.omega * abs(touch - s.times[0]) < NEAR:
        return None
    step = 1e-6 * unit
    slope = abs(least(value + step) - least(value - step)) / (2 * step)
    error = ROUNDING * (abs(value) + (abs(gap.mean) + abs(gap.swing)) / slope)
    found = replace(s, family=family, u=np.array([touch, 0.0, touch + s.P]))
    return PermanentContact(value, error, found, _multipliers(pressed(q, side), s.P))


def pressed(q: Linear, side: int) -> Linear:
    """The oscillator that never leaves the stop on this side: M x'' + (C + c n n^T) x' + (K + k n n^T) x = ..."""
    law, normal = q.contact.law(side), q.contact.normal
    both, force = np.outer(normal, normal), law.k * float(q.contact.stop(side)) - side * law.p
    return q._replace(K=q.K + law.k * both, C=q.C + law.c * both, constant=q.constant + force * normal)


def _least(q: Linear, side: int) -> tuple[float, SteadyGap]:
    """The least displacement into the stop of the motion that never leaves it, and this motion."""
    gap = steady_gap(pressed(q, side))
    return side * (gap.mean - float(q.contact.stop(side))) - abs(gap.swing), gap


def _multipliers(q: Linear, P: float) -> np.ndarray:
    """Those of a linear oscillator over the time P, by falling modulus."""
    N = q.masses
    rates = np.linalg.eigvals(np.block([[np.zeros((N, N)), np.eye(N)], [np.linalg.solve(q.M, -np.hstack([q.K, q.C]))]]))
    return np.array(sorted(np.exp(rates * P), key=lambda mu: (-abs(mu), -mu.imag)))
