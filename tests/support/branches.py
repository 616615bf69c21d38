"""Branches of the paper's periodic orbits in b."""

import numpy as np
import pytest
from reference.shooting import AnyShooting, Shooting

import vibro_sweep as vs
from support.oscillators import PAPER
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.flow import contact_coordinates

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


def _located(special, name, shooting, u):
    """By shooting, from what is known of the special point."""
    value = special.parameters[name]
    if special.type == "fold":
        return shooting.where_multiplier(1, u, name, value)
    if special.type in ("flip", "pitchfork"):
        return shooting.where_multiplier(-1, u, name, value)
    if special.type == "neimark_sacker":
        return shooting.where_torus(u, name, value)
    if special.impact is None:
        _, time, side = special.orbit._solution.nearest
        return shooting.where_touching(time, side, u, name, value)
    return shooting.where_vanishing(int(np.argmin(special.orbit._solution.pushes)), u, name, value)


def exact(special, name):
    """The parameter of a special point in 40 digits, by shooting."""
    solution = special.orbit._solution
    numbers = {key: getattr(special.orbit.system, key) for key in NUMBERS}
    shooting = Shooting(numbers, solution.sigma, solution.half_periods, solution.sides)
    x1, x2, v1, v2 = solution.states[0][:4]
    u = shooting.unknowns(solution.times, (x1, v1, x2, v2))
    return _located(special, name, shooting, u)


def shooting_of(orbit):
    """(reference in many digits, its unknowns) of an orbit of an `Oscillator`."""
    solution, q = orbit._solution, orbit.system.linear
    N = len(q.normal)
    state = contact_coordinates(q).to_masses(solution.states[0]).reshape(N, 2).T.ravel()
    shooting = AnyShooting(orbit.system, solution.sigma, solution.half_periods, solution.sides)
    return shooting, shooting.unknowns(solution.times, state)


def exact_of_any(special, name):
    """The parameter of a special point of an `Oscillator`, in many digits, by shooting."""
    return _located(special, name, *shooting_of(special.orbit))
