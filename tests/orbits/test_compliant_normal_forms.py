"""Criticality of flips and Neimark-Sacker points with compliant stops."""

import numpy as np
import pytest
from mpmath import mp
from reference.closed_orbit import ClosedOrbit, contacts_of
from reference.conditions import Map
from reference.machine import machine_of
from reference.normal_forms import third_order
from scipy.linalg import expm
from support import slow_cases
from support.compliant_bifurcations import branch_of

from vibro_sweep.analysis.branches.criticality import critical_angle, cubic_terms
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import FLIP, TORUS
from vibro_sweep.engine.impulses.flow import flow


def coefficient(special) -> tuple[float, np.ndarray]:
    """Re c of a flip or Neimark-Sacker point, and the critical vector before the first touch."""
    s, kind = special.orbit._solution, FLIP if special.type == "flip" else TORUS
    linearised = Linearised(s)
    linearised.take_null_vectors(kind, np.pi if kind == FLIP else critical_angle(s))
    e = linearised.equations
    e.run_task(stepper.EXAMINE)
    (c, _), _ = cubic_terms(e.workspace, e.problem, e.place)
    return c.real, e.place.v[0, : e.n]


@pytest.mark.parametrize("name, kind, index", [
    ("one mass", "flip", 1),
    *slow_cases(
        ("one mass, damped stop", "flip", 0),
        ("one mass, left by force", "flip", 1),
        ("R", "neimark_sacker", 1),
        ("R, stiff", "neimark_sacker", 0),
    ),
])  # fmt: skip
def test_coefficient_agrees_with_differences_of_the_map_in_45_digits(name, kind, index):
    """Of orbits with one contact, from t = 0 in their flight on: there q, of length 1, is v moved back."""
    special = [one for one in branch_of(name).special if one.type == kind][index]
    s, system = special.orbit._solution, special.orbit.system
    q, (touch,), (release,) = s.family.linear, s.times, s.ends
    flight = touch + s.P - release
    start = release + 0.4 * flight
    found, v = coefficient(special)
    n = len(v)
    before = expm(-0.6 * flow(q).B * flight)[:n, :n] @ (v * np.repeat([1.0, q.omega], n // 2))
    state = orbit_of(system, s).sample([start])[0]
    machine = machine_of(q._replace(tau=float(q.tau + q.omega * start)))
    exact = ClosedOrbit(machine, contacts_of(machine, s.sides), s.half_periods / 2, s.sigma)
    state, times = exact.solve(state, [0.6 * flight, 0.6 * flight + release - touch])
    with mp.workdps(45):
        mu = -1 if kind == "flip" else mp.expj(critical_angle(s))
        expected = float(third_order(Map(exact, state, times), mu)) / (3 if kind == "flip" else 1)
    assert found == pytest.approx(expected * np.linalg.norm(before) ** 2, rel=1e-7)
    assert special.criticality == ("super" if expected < 0 else "sub")
