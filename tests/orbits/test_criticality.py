"""Criticality of flips, pitchforks and Neimark-Sacker points: the sign of the cubic coefficient, by the reference."""

import functools

import numpy as np
import pytest
from mpmath import mp
from reference.closed_orbit import ClosedOrbit
from reference.conditions import OF_THIRD, THIRD, Map
from reference.normal_forms import third_order
from support import branch_rows, cases, compliant_bifurcations, sample
from support.in_digits import closed_of, of_orbit
from support.oscillators import PAPER

import vibro_sweep as vs

ROWS = {row.id: row.values[0] for row in cases.rows("branches")}
RIGID = ("symmetric orbit of the paper", "one-sided orbit of the paper", "four impacts of the paper")
COMPLIANT = ("one mass", "one mass, damped stop", "one mass, left by force", "R", "R, stiff", "LR")
TYPES = ("flip", "pitchfork", "neimark_sacker")


@functools.cache
def points(name: str) -> list:
    """Special points of a branch that have a criticality."""
    if name in RIGID:
        branch = branch_rows.follow(ROWS[name], branch_rows.orbit_of(ROWS[name]))
    else:
        branch = compliant_bifurcations.branch_of(name)
    return [special for special in branch.special if special.type in TYPES]


def cubic_coefficient(special, digits: int = OF_THIRD) -> float:
    """Its real part, for a critical vector of the reference's choice: the sign does not depend on it."""
    with mp.workdps(digits):
        d = closed_of(of_orbit(special.orbit))
        closed = ClosedOrbit(d.machine, *d.of, digits=digits)
        mu = special.multipliers
        pair = mu[np.argmin(np.where(mu.imag > 1e-9, np.abs(np.abs(mu) - 1), np.inf))]
        critical = mp.expj(np.angle(pair)) if special.type == "neimark_sacker" else -1
        return float(third_order(Map(closed, *closed.solve(*d.guess)), critical, THIRD))


@pytest.mark.parametrize("name", sample(2, [*RIGID, *COMPLIANT]))
def test_criticality_is_the_sign_of_the_cubic_coefficient(name):
    counted = 0
    for special in points(name):
        assert special.criticality == ("super" if cubic_coefficient(special) < 0 else "sub"), special
        counted += 1
    assert counted


def test_circle_beyond_the_point_attracts(one_sided_branch):
    """Supercritical: beyond it, orbits that start nearer and farther come to one distance, like its square root."""
    special = one_sided_branch.special[1]
    assert special.type == "neimark_sacker" and special.criticality == "super"
    distances = []
    for beyond in (5e-4, 2e-3):
        orbit = vs.periodic_orbit(PAPER.replace(b=special.parameters["b"] + beyond), itinerary="R")
        assert not orbit.stable
        reached = []
        for size in (0.05, 0.8):
            start = orbit.state + np.array([0, size, 0.3 * size, 0.2 * size])
            section = vs.simulate(orbit.system, start, 40_000).section
            reached.append(np.abs(section[-500:] - orbit.state).max())
        assert reached[0] == pytest.approx(reached[1], rel=0.02)
        distances.append(reached[0])
    assert distances[1] / distances[0] == pytest.approx(2, rel=0.1)
