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
from vibro_sweep.model.linear import family_of

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


def closed_of(orbit) -> Closed:
    s, q = orbit._solution, family_of(orbit.system).linear
    times, first = np.array(s.times), 0
    begin = s.nearest[1] - s.P / 2 if not s.K else 0.0
    if s.K:
        flights = np.append(times[1:], times[0] + s.P) - times
        first = (int(np.argmax(flights)) + 1) % s.K
        begin = float(times[first - 1] + flights[first - 1] / 2) - (s.P if first == 0 else 0.0)
    order = np.roll(np.arange(s.K), -first)
    later = order < first  # these are the next period's
    machine, sides = machine_of(q), np.array(s.sides, int)[order] * np.where(later, s.sigma, 1)
    events = [("impact", element_of(machine, side)) for side in sides]
    state = PeriodicOrbit(orbit.system, "ok", s, (0, 0)).sample([begin])[0]
    return Closed(q, (events, s.half_periods / 2, s.sigma, begin), (state, times[order] + s.P * later), first)


def exact(special, name):
    """The parameter of a special point in many digits."""
    s, d = special.orbit._solution, closed_of(special.orbit)
    slope = family_of(special.orbit.system).derivative(name)._replace(tau=0.0)
    conditions, touches, touching, theta = (
        {"fold": ["fold"], "neimark_sacker": ["pair"]}.get(special.type),
        [],
        [],
        None,
    )
    if special.type in ("flip", "pitchfork"):
        conditions = ["flip"]
    elif special.type == "neimark_sacker":
        mu = s.multipliers
        theta = float(np.angle(mu[np.argmin(np.where(mu.imag > 1e-9, np.abs(np.abs(mu) - 1), np.inf))]))
    elif conditions is None and special.impact is None:
        _, time, side = s.nearest
        turns = int(np.floor((time - d.of[3]) / s.P))
        conditions, touching = [], [time - turns * s.P]
        touches = [element_of(machine_of(d.q), int(side) * s.sigma**turns)]
    elif conditions is None:
        conditions = [("vanishing", (int(np.argmin(s.pushes)) - d.first) % s.K)]
    at = lambda changes: machine_of(moved(d.q, [slope], changes))  # noqa: E731
    off, change = Condition(at, 1, *d.of, conditions, touches).solve(*d.guess, touching, theta)
    assert change < 1e-13, change
    return special.parameters[name] + mpf(off[0])
