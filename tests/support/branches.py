"""Branches of the paper's periodic orbits in b."""

import numpy as np
import pytest

import vibro_sweep as vs
from support.oscillators import PAPER


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
