"""Exponents with compliant stops: multipliers against many digits, and the sum rule."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of
from support import sample
from support.soft_stops import ELASTIC, PAPER, one_mass

import vibro_sweep as vs


@pytest.mark.parametrize(
    "stop",
    sample(
        1, [dict(k_stop=29), dict(k_stop=29, c_stop=1.0), dict(k_stop=1e4, c_stop=14, preload=0.2), dict(k_stop=1e8)]
    ),
)
def test_multipliers_against_differences_in_forty_digits(stop):
    """The monodromy matrix of a periodic orbit, by differences of orbits 1e-20 apart."""
    system = one_mass(**{**ELASTIC, "zeta": 0.1, "tau": 1.0}, **stop)
    data = vs.sweep(system, {"omega": [0.8]}, transient=2000, record=20, observe=["section", "multipliers"])
    period = int(data.period[0])
    assert period > 0
    start, columns = [float(data.x1[0, -1]), float(data.v1[0, -1])], []
    with mp.workdps(50):
        end = simulate(machine_of(system.linear), start, periods=period).section[period]
        for j in range(2):
            beside = [mpf(one) for one in start]
            beside[j] += mpf(10) ** -20
            moved = simulate(machine_of(system.linear), beside, periods=period).section[period]
            columns.append([float((a - b) * mpf(10) ** 20) for a, b in zip(moved, end, strict=True)])
    exact = np.linalg.eigvals(np.array(columns).T)
    found = data.multiplier_re.values[0] + 1j * data.multiplier_im.values[0]
    for one in found:
        assert np.abs(exact - one).min() < 1e-9 * np.abs(exact).max()


@pytest.mark.slow
@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("b", [3.0, 5.0, 6.4])
def test_sum_rule(release, b):
    system = vs.System(**PAPER, b=b, k_stop=1e4, c_stop=14, k_stop_left=400, c_stop_left=3, release=release)
    exponents = vs.lyapunov(system, (0, 0, 0, 0), 300, 600)
    assert abs(exponents.residual) < 1e-12 and np.all(np.isfinite(exponents))


def test_the_fastest_direction_is_not_lost_in_a_long_contact():
    """Two rates far apart, k/c and c: within a cell of time the one vector shrinks by e^-100 beside the other."""
    k, c = 5e3, 297.0
    system = one_mass(**ELASTIC | {"zeta": 0.05, "F": 0.8, "omega": 0.7, "b": 0.3}, k_stop=k, c_stop=c)
    exponents, orbit = vs.lyapunov(system, (0, 0), 30, 30), vs.simulate(system, (0, 0), 40)
    held = (orbit.contacts["t_release"] - orbit.contacts["t_touch"])[-1]
    assert exponents.sum() == pytest.approx(-0.1 - c * held / system.period, rel=1e-10)
    assert abs(exponents.residual) < 1e-11 and exponents[1] < -c * 0.3


@pytest.mark.slow
def test_one_rigid_and_one_compliant_stop_have_a_sum_rule():
    system = vs.System(**PAPER, b=3, R=0.8, k_stop_left=100, c_stop_left=2)
    orbit = vs.simulate(system, (0, 0, 0, 0), 200)
    assert np.all(orbit.impacts["side"] == 1) and np.all(orbit.contacts["side"] == -1)
    assert len(orbit.impacts) > 50 and len(orbit.contacts) > 50
    assert abs(vs.lyapunov(system, (0, 0, 0, 0), 300, 600).residual) < 1e-12


def test_exponents_do_not_depend_on_where_the_section_is():
    """In contact or not: tau = pi/2 has its sections in contacts."""
    numbers = dict(k=1, zeta=0.01, base=True, F=0.9 / 1.26, omega=1.1, k_stop=29, b=1, stops="right")
    found = []
    for tau in (math.pi / 2, 0.3):
        system = vs.Oscillator.named("one_mass", **numbers, tau=tau)
        data = vs.sweep(system, {"b": [1.0]}, transient=600, record=60, observe=["section", "lyapunov"])
        assert data.status[0] == 0
        found.append(data.lyapunov.values.ravel())
    for exponents in found:
        assert exponents == pytest.approx([-0.01, -0.01], abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("release, c_stop", [("force", 1.0), ("force", 4.0), ("displacement", 1.0)])
def test_volumes_through_stops_that_relax(release, c_stop):
    """The sum of the exponents over a period is the logarithm of the determinant of differences in eighty digits."""
    soft = ELASTIC | {"k": 25, "omega": 1.5, "b": 0.02, "stops": "both"}
    system = one_mass(**soft, constant=0.3, k_stop=4, c_stop=c_stop, preload=0.01, release=release)
    start, step = [mpf("0.01"), mpf("1.5")], mpf(10) ** -30
    how = dict(periods=1, digits=80)
    with mp.workdps(80):
        end = simulate(machine_of(system.linear), start, **how)
        columns = []
        for j in range(2):
            beside = [one + step * (i == j) for i, one in enumerate(start)]
            moved = simulate(machine_of(system.linear), beside, **how).section[1]
            columns.append([(a - b) / step for a, b in zip(moved, end.section[1], strict=True)])
        wanted = float(mp.log(abs(mp.det(mp.matrix(columns)))))
    exponents = vs.lyapunov(system, [float(one) for one in start], 0, 1)
    assert len(end.contacts) >= 3
    assert exponents.sum() * system.period == pytest.approx(wanted, abs=1e-9)
    assert abs(exponents.residual) < 1e-12
