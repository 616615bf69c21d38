"""Lyapunov spectra, against closed forms, multipliers of Jacobians by differences, and the sum rule.

A Jacobian knows nothing of the saltation matrix: it is the difference of orbits that strike the stops.
"""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.events import simulate
from reference.machine import machine_of

import vibro_sweep as vs

PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
REST = (0.0, 0.0, 0.0, 0.0)
STEP = 1e-5  # of the differences: truncation and rounding both leave 1e-10


def settled(system, start=REST, periods=3000):
    """The section point at which an orbit has arrived."""
    orbit = vs.simulate(system, start, periods)
    assert orbit.status == "ok"
    return orbit.section[-1]


def jacobian(flow, X, step):
    """Of a flow from state to state, by central differences: column i is the answer to x_i."""
    columns = []
    for i in range(4):
        there, back = list(X), list(X)
        there[i] += step
        back[i] -= step
        columns.append([(p - q) / (2 * step) for p, q in zip(flow(there), flow(back), strict=True)])
    return np.array(columns, float).T


def metric(system):
    """(4, 4): from (x1, v1, x2, v2) to (g xi, xi' + eta xi) of each mode, where free flight turns tangent vectors."""
    rows, mass = [], np.array([1, system.mu_m])
    for j, (square, eta) in enumerate(zip(system.modes.omega_squared, system.eta, strict=True)):
        to_mode = system.modes.psi[:, j] * mass
        g = math.sqrt(abs(square - eta**2))
        rows += [np.kron(g * to_mode, [1, 0]), np.kron(to_mode, [eta, 1])]
    return np.array(rows)


def of_multipliers(matrix, time):
    """ln|multiplier|/time, descending."""
    return np.log(np.sort(abs(np.linalg.eigvals(matrix)))[::-1]) / time


def free_exponents(system):
    """The two exponents of each mode without impacts: roots of s^2 + 2 eta s + omega_j^2."""
    roots = [np.roots([1, 2 * system.zeta * square, square]).real for square in system.modes.omega_squared]
    return np.sort(np.concatenate(roots))[::-1]


def test_without_impacts():
    """b = 6.8 from rest: -eta_1, -eta_1, -eta_2, -eta_2."""
    system = PAPER.replace(b=6.8)
    assert len(vs.simulate(system, settled(system), 100).impacts) == 0
    expected = -np.repeat(np.sort(system.eta), 2)
    np.testing.assert_allclose(vs.lyapunov(system, REST), expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("changes", [dict(zeta=1.0), dict(zeta=3.0), dict(zeta=1.5, mu_m=0.5), dict(zeta=40.0)])
def test_overdamped_without_impacts(changes):
    """-eta +- sqrt(eta^2 - omega_j^2): one mode overdamped, or both."""
    system = PAPER.replace(b=100, **changes)
    assert np.any(system.eta**2 > system.modes.omega_squared)
    np.testing.assert_allclose(vs.lyapunov(system, REST, record=100), free_exponents(system), rtol=1e-9)


FAR_APART = {
    "modes that begin in the wrong order": dict(mu_m=1.0, mu_k=1.0, zeta=10.0, omega=0.01),
    "multipliers of 1e-8 and 1e-237": dict(mu_m=4469.557, mu_k=70.271, zeta=0.455548, omega=0.00524343),
    "multipliers of 1e-8 and 1e-168": dict(mu_m=0.470989, mu_k=8.226366, zeta=0.0151352, omega=0.00485748),
    "e^-1880 in a cell": dict(mu_m=0.002090458, mu_k=68.28828, zeta=6.063975, omega=0.654213),
}


@pytest.mark.parametrize("numbers", FAR_APART.values(), ids=FAR_APART)
def test_modes_far_apart_without_impacts(numbers):
    """After records of any length; -inf for what vanishes within a cell."""
    system = vs.System(f2=0.6, R=0.8, b=1e9, tau=0.0, **numbers)
    for transient, periods in ((300, 2), (300, 50)):
        exponents = vs.lyapunov(system, (0.3, 0.2, 0.1, 0.4), transient, periods)
        known = ~np.isneginf(exponents)
        assert known[:3].all()
        np.testing.assert_allclose(exponents[known], free_exponents(system)[known], rtol=1e-9)


@pytest.mark.slow  # kernels of two kinds
@pytest.mark.parametrize("b, omega", [(0.5, 1.0), (1.0, 0.5)])
def test_a_mode_that_no_impact_reaches(b, omega):
    """With impacts and without: the exponents of the two masses, each alone. The unseen one, whose exponents lie e^1000
    apart in a period, is the first mode."""
    told = dict(omega=omega, b=b, R=0.5, tau=0.0)
    both = vs.Oscillator(np.eye(2), np.diag([1, 3]), np.diag([200, 0.2]), force=[2, 2], contact_normal=[0, 1], **told)
    seen = vs.Oscillator([[1]], [[3]], [[0.2]], force=[2], contact_normal=[1], **told)
    assert (len(vs.simulate(seen, (0, 0), 100).impacts) > 0) == (b < 1)
    exponents = vs.lyapunov(both, REST, transient=2000, record=200)
    alone = np.concatenate([vs.lyapunov(seen, (0, 0), transient=2000, record=200), np.roots([1, 200, 1])])
    np.testing.assert_allclose(exponents, np.sort(alone)[::-1], rtol=1e-11)
    assert abs(exponents.residual) < 1e-12


@pytest.mark.parametrize(
    "changes, count", [(dict(b=3), 4), (dict(b=1), 4), (dict(zeta=1.2, mu_m=0.5, b=0.3, omega=1.5), 3)], ids=str
)
def test_symmetric_orbit(changes, count):
    """One impact on each side a period, half a period apart; exponents are those of the multipliers, but for one of
    the overdamped system that is 10^-52."""
    system = PAPER.replace(**changes)
    X = settled(system)
    orbit = vs.simulate(system, X, 1)
    np.testing.assert_allclose(orbit.section[1], X, atol=1e-13)
    np.testing.assert_allclose(orbit.sample(system.period / 2)[0], -X, atol=1e-13)
    (t1, t2), (v1, v2) = orbit.impacts["t"], orbit.impacts["v1"]
    assert sorted(orbit.impacts["side"]) == [-1, 1]
    assert (t2 - t1, v2) == (pytest.approx(system.period / 2, abs=1e-12), pytest.approx(-v1, abs=1e-12))

    J = jacobian(lambda x: vs.simulate(system, x, 1).section[-1], X, STEP)
    expected = of_multipliers(J, system.period)[:count]
    np.testing.assert_allclose(vs.lyapunov(system, REST)[:count], expected, rtol=0, atol=1e-9)


def test_symmetric_orbit_in_thirty_digits():
    """The same, with a Jacobian of which the package computes nothing but the point where it is taken."""
    system = PAPER.replace(b=3)
    with mp.workdps(40):
        J = jacobian(
            lambda x: naive.simulate(system.parameters(), x, periods=1, digits=30).section[-1],
            [mpf(x) for x in settled(system)],
            mpf("1e-9"),
        )
    np.testing.assert_allclose(vs.lyapunov(system, REST), of_multipliers(J, system.period), rtol=0, atol=1e-12)


@pytest.mark.parametrize("b, period", [(6.69, 29), (6.6, 13)])
def test_long_periodic_orbits(b, period):
    """The leading two; differences cannot tell multipliers below 1e-7 from 0."""
    system = PAPER.replace(b=b)
    X = settled(system)
    np.testing.assert_allclose(vs.simulate(system, X, period).section[-1], X, atol=1e-11)
    J = jacobian(lambda x: vs.simulate(system, x, period).section[-1], X, STEP)
    expected = of_multipliers(J, period * system.period)
    np.testing.assert_allclose(vs.lyapunov(system, REST)[:2], expected[:2], rtol=0, atol=1e-8)


def test_chaos():
    """b = 6.68: the first exponent is the rate at which two near orbits part, over the same periods; but for
    near grazes, where they are not near enough. In another metric the ends of the record differ by 1e-5."""
    system, warm_up, count, gap = PAPER.replace(b=6.68), 100, 2000, 1e-8
    X = settled(system)
    exponent = vs.lyapunov(system, X, warm_up, count)[0]
    W = metric(system)
    beside, logs = X + gap / 2, []
    for _ in range(warm_up + count):
        X, beside = (vs.simulate(system, x, 1).section[1] for x in (X, beside))
        distance = np.linalg.norm(W @ (beside - X))
        logs.append(math.log(distance / gap))
        beside = X + (beside - X) * (gap / distance)
    assert exponent > 1e-3
    assert sum(logs[warm_up:]) / (count * system.period) == pytest.approx(exponent, abs=1e-5)


@pytest.mark.parametrize(
    "changes",
    [
        dict(b=6.68),
        dict(omega=0.1, b=1.0, R=0.95),
        dict(zeta=0.0, R=0.9, b=3.0, tau=1.0),
        dict(stops="right", b=2.0, R=0.9),
        dict(stops="left", b=0.2, omega=1.3, tau=0.4, R=0.95),
        dict(zeta=1.2, mu_m=0.5, b=0.3, omega=1.5),
    ],
    ids=["chaos", "chaos in slow forcing", "undamped", "right stop", "left stop", "overdamped"],
)
def test_sum_rule(changes):
    """Sum of the exponents = -tr(M^-1 C) + 2 nu ln R, with nu counted by `simulate`; orbits are chaotic or of period 1.

    Overdamped, the first vector would outgrow the last by 10^51 within a period, were they not kept apart.
    """
    system = PAPER.replace(**changes)
    transient, periods = 300, 2000
    spectrum = vs.lyapunov(system, REST, transient, periods)
    orbit = vs.simulate(system, REST, transient + periods)
    assert np.all(np.diff(spectrum) <= 0) and len(orbit.sticking) == 0
    recorded = np.count_nonzero(orbit.impacts["t"] > transient * system.period)
    assert recorded > 100
    trace = 2 * system.zeta * (1 + (1 + system.mu_k) / system.mu_m)
    exact = -trace + 2 * recorded / (periods * system.period) * math.log(system.R)
    assert abs(spectrum.sum() - exact) < 1e-12


def test_sticking_loses_two_dimensions():
    """M1 rests on each stop once a period. Two multipliers vanish, and the others are those of the differences."""
    system = PAPER.replace(b=0.5, R=0.3, tau=0.3)
    X = settled(system)
    orbit = vs.simulate(system, X, 1)
    assert sorted(orbit.sticking["side"]) == [-1, 1] and abs(X[0]) < 0.45
    J = jacobian(lambda x: vs.simulate(system, x, 1).section[-1], X, STEP)
    assert np.sort(abs(np.linalg.eigvals(J)))[1] < 1e-6
    spectrum = vs.lyapunov(system, REST)
    np.testing.assert_allclose(spectrum[:2], of_multipliers(J, system.period)[:2], rtol=0, atol=1e-6)
    assert np.all(spectrum[2:] == -np.inf)


@pytest.mark.parametrize(
    "changes, X",
    [
        (dict(R=0.8), (-2.0, 0.4, 0.3, 0.1)),
        (dict(R=0.1, f2=0.4), (-2.0, 0.4, 0.3, 0.1)),
        (dict(R=0.9, mu_m=0.5, stops="left"), (-1.0, -0.9, 0.1, 0.2)),
    ],
    ids=str,
)
def test_tangent_vectors_across_one_impact(changes, X):
    """Over one period the four vectors grow by the diagonal of R in J = Q R, in their own metric."""
    system = PAPER.replace(b=3.0, tau=1.0, **changes)
    orbit = vs.simulate(system, X, 1)
    assert len(orbit.impacts) == 1
    J = jacobian(lambda x: vs.simulate(system, x, 1).section[-1], X, STEP)
    machine = machine_of(system.linear)
    hits = simulate(machine, list(X), periods=1).impacts
    closed = ClosedOrbit(machine, impacts_of(machine, [hit.side for hit in hits]), 1)  # it need not be closed
    exact = np.array(closed.closure(list(X), [hit.t for hit in hits]).tolist(), float)
    np.testing.assert_allclose(exact, J, atol=1e-8)
    trace = 2 * system.zeta * (1 + (1 + system.mu_k) / system.mu_m)
    assert np.linalg.det(J) == pytest.approx(system.R**2 * math.exp(-trace * system.period), rel=1e-4)

    W = metric(system)
    growth = np.log(abs(np.diag(np.linalg.qr(W @ exact @ np.linalg.inv(W)).R)))
    exponents = vs.lyapunov(system, X, transient=0, record=1)
    np.testing.assert_allclose(exponents * system.period, np.sort(growth)[::-1], rtol=0, atol=1e-9)


def test_a_rest_on_the_way_to_an_attractor_costs_no_exponent():
    """b = 0.1: from rest the transient sticks for a while, the attractor does not."""
    system = PAPER.replace(b=0.1)
    early = vs.simulate(system, REST, 200).sticking
    late = vs.simulate(system, vs.simulate(system, REST, 200).section[-1], 1000).sticking
    assert len(early) > 0 and len(late) == 0
    elsewhere = vs.lyapunov(system, (0.05, 1.0, 0.0, 0.0))
    np.testing.assert_allclose(vs.lyapunov(system, REST, transient=200), elsewhere, rtol=0, atol=1e-9)


def test_no_restitution_costs_one_exponent():
    """R = 0: v1 is forgotten at every impact."""
    system = PAPER.replace(b=4.0, R=0.0)
    spectrum = vs.lyapunov(system, REST)
    assert np.isfinite(spectrum[:3]).all() and spectrum[3] == -np.inf
