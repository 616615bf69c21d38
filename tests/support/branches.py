"""Branches of the paper's periodic orbits in b."""

from typing import NamedTuple

import numpy as np
import pytest
from mpmath import mpf
from reference.closed_orbit import element_of
from reference.conditions import Condition
from reference.machine import machine_of, moved

import vibro_sweep as vs
from support.oscillators import PAPER
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution

NUMBERS = ("mu_m", "mu_k", "zeta", "f2", "omega", "R", "b", "tau")  # of the reference: both stops alike, offset 0


def types(branch):
    return [(special.type, special.parameters[branch.parameter]) for special in branch.special]


def same_points(branch, expected, tolerance=1e-12):
    found = types(branch)
    assert [kind for kind, _ in found] == [kind for kind, _ in expected]
    assert [value for _, value in found] == pytest.approx([value for _, value in expected], abs=tolerance)


@pytest.fixture(scope="session")
def symmetric_branch():
    return vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (0.3, 6.8))


@pytest.fixture(scope="session")
def one_sided_branch():
    return vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (0.3, 6.8))


def recorded(b, n, seed=1):
    """A state on an attractor of period n > 1 at this clearance."""
    rng, system = np.random.default_rng(seed), PAPER.replace(b=b)
    for _ in range(60):
        start = [rng.uniform(-b, b), *(rng.normal(size=3) * (3, 3, 1))]
        section = vs.simulate(system, start, 3000).section
        if np.abs(section[-1] - section[-1 - n]).max() < 1e-7 and np.abs(section[-1] - section[-2]).max() > 1e-3:
            return system, section[-1]
    raise AssertionError("no such attractor was met")


def branch_of(b, n, bounds=(6.3, 6.9)):
    system, state = recorded(b, n)
    return vs.continue_orbit(vs.periodic_orbit(system, state=state, periods=n), "b", bounds)


def repeated(orbit, times):
    """The orbit as one of `times` its period: as many impacts more."""
    s = orbit._solution.whole()
    shifts = np.repeat(np.arange(times) * s.P, s.K)
    u = np.concatenate([np.tile(s.times, times) + shifts, np.tile(s.jumps, times)])
    return Solution(s.family, 1, s.half_periods * times, s.sides * times, u)


class Closed(NamedTuple):
    """An orbit with impacts as the reference needs it, with its section in the longest flight."""

    q: object  # the Linear
    of: tuple  # events, periods, sigma, begin
    guess: tuple  # state at the section, times of the impacts
    first: int  # number of the impact that is the first from the section on


def closed_of(s: Solution) -> Closed:
    q, times, first = s.family.linear, np.array(s.times), 0
    begin = s.nearest[1] - s.P / 2 if not s.K else 0.0
    if s.K:
        flights = np.append(times[1:], times[0] + s.P) - times
        first = (int(np.argmax(flights)) + 1) % s.K
        begin = float(times[first - 1] + flights[first - 1] / 2) - (s.P if first == 0 else 0.0)
    order = np.roll(np.arange(s.K), -first)
    later = order < first  # these are the next period's
    machine, sides = machine_of(q), np.array(s.sides, int)[order] * np.where(later, s.sigma, 1)
    events = [("impact", element_of(machine, side)) for side in sides]
    state = PeriodicOrbit(None, "ok", s, (0, 0)).sample([begin])[0]
    return Closed(q, (events, s.half_periods / 2, s.sigma, begin), (state, times[order] + s.P * later), first)


def angle_of(s: Solution) -> float:
    """The angle of the pair of multipliers that is nearest to the unit circle."""
    mu = s.multipliers
    return float(np.angle(mu[np.argmin(np.where(mu.imag > 1e-9, np.abs(np.abs(mu) - 1), np.inf))]))


def located(s: Solution, names, conditions, touching=(), theta=None, angle=None):
    """By how much these numbers change until the orbit fulfils the conditions: those of reference.conditions.

    conditions : with numbers of impacts as of the orbit; touching : (time, side) of turning points that touch a stop
    """
    d, P = closed_of(s), s.P
    conditions = [one if isinstance(one, str) else (one[0], (one[1] - d.first) % s.K) for one in conditions]
    turns = [int(np.floor((time - d.of[3]) / P)) for time, _ in touching]
    times = [time - n * P for (time, _), n in zip(touching, turns, strict=True)]
    machine = machine_of(d.q)
    touches = [element_of(machine, int(side) * s.sigma**n) for (_, side), n in zip(touching, turns, strict=True)]
    slopes = [s.family.derivative(name)._replace(tau=0.0) for name in names]
    at = lambda changes: machine_of(moved(d.q, slopes, changes))  # noqa: E731
    theta = angle_of(s) if "pair" in conditions and angle is None and theta is None else theta
    condition = Condition(at, len(slopes), *d.of, conditions, touches, angle)
    off, change = condition.solve(*d.guess, times, theta)
    assert change < 1e-14, change
    return off


def exact(special, name):
    """The parameter of a special point in many digits."""
    s = special.orbit._solution
    kinds = {"fold": ["fold"], "flip": ["flip"], "pitchfork": ["flip"], "neimark_sacker": ["pair"]}
    conditions, touching = kinds.get(special.type, []), []
    if special.type not in kinds and special.impact is None:
        touching = [s.nearest[1:]]
    elif special.type not in kinds:
        conditions = [("vanishing", int(np.argmin(s.pushes)))]
    (off,) = located(s, [name], conditions, touching)
    return special.parameters[name] + mpf(off)
