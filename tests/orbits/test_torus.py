"""Criticality of Neimark-Sacker points."""

import numpy as np
import pytest
from mpmath import mp
from reference.closed_orbit import ClosedOrbit
from reference.conditions import Map
from reference.machine import machine_of
from reference.normal_forms import third_order
from scipy.linalg import expm
from support import slow_cases
from support.branches import closed_of
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.criticality import critical_angle, cubic_terms
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import TORUS
from vibro_sweep.engine.impulses.flow import flow


@pytest.mark.parametrize("omega", [PAPER.omega, *slow_cases(0.62)])
def test_coefficient_agrees_with_differences_of_the_map_in_50_digits(omega):
    """Of orbits with one impact: there q, of length 1 in the middle of the flight, is v moved back by half of it."""
    orbit = vs.periodic_orbit(PAPER.replace(b=4.2, omega=omega), itinerary="R")
    special = next(s for s in vs.continue_orbit(orbit, "b", (4.2, 4.7)).special if s.type == "neimark_sacker")
    s = special.orbit._solution
    linearised, theta = Linearised(s), critical_angle(s)
    linearised.take_null_vectors(TORUS, theta)
    e = linearised.equations
    e.run_task(stepper.EXAMINE)
    (found, _), _ = cubic_terms(e.workspace, e.problem, e.place)
    back = expm(-flow(s.family.linear).B * s.P / 2)[:4, :4]
    size = np.linalg.norm(back @ (e.place.v[0, :4] * [1, 1, s.family.linear.omega, s.family.linear.omega]))
    with mp.workdps(50):
        d = closed_of(s)  # with its section in the middle of the flight
        closed = ClosedOrbit(machine_of(d.q), *d.of, digits=50)
        expected = float(third_order(Map(closed, *closed.solve(*d.guess)), mp.expj(theta)))
    assert found.real == pytest.approx(expected * size**2, rel=1e-8)
    assert special.criticality == ("super" if expected < 0 else "sub")


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
