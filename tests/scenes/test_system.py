"""Parameters, modes, steady response and Theorem 1, against scipy, complex numpy and 40-digit arithmetic."""

import math

import numpy as np
import pytest
import scipy.linalg
from mpmath import mp, mpf
from reference import naive
from support import oscillators, slow_cases

import vibro_sweep as vs

PAPER = oscillators.PAPER.replace(b=6.6)
ORDINARY = [(10, 5), (1, 1), (0.2, 3), (30, 0.1)]
PHYSICAL = dict(M1=2, M2=6, K1=8, K2=12, C1=0.4, C2=0.6, P1=3, P2=1, Omega=1.5, R=0.7, B=2)


def matrices(mu_m, mu_k):
    return np.diag([1.0, mu_m]), np.array([[1.0, -1.0], [-1.0, 1.0 + mu_k]])


def complex_response(system):
    """x = Im(X e^{i(omega t + tau)}) from (K - omega^2 M + i omega C) X = P with C = 2 zeta K."""
    M, K = matrices(system.mu_m, system.mu_k)
    impedance = K * (1 + 2j * system.zeta * system.omega) - system.omega**2 * M
    return np.linalg.solve(impedance, [1 - system.f2, system.f2])


@pytest.mark.parametrize("mu_m, mu_k", ORDINARY)
def test_modes_are_those_of_scipy(mu_m, mu_k):
    M, K = matrices(mu_m, mu_k)
    values, vectors = scipy.linalg.eigh(K, M)
    psi, omega_squared = PAPER.replace(mu_m=mu_m, mu_k=mu_k, tau=0).modes
    np.testing.assert_allclose(omega_squared, values, rtol=1e-13)
    np.testing.assert_allclose(psi, vectors * np.sign(vectors[0] * psi[0]), rtol=1e-13)


@pytest.mark.parametrize("mu_k", [1e-3, 5, 1e3])
@pytest.mark.parametrize("mu_m", [1e-6, 1, 1e6])
def test_modes_keep_every_digit_when_the_masses_are_far_apart(mu_m, mu_k):
    """Each eigenvalue and each component of a mode by itself, to a few units in the last place."""
    psi, omega_squared = PAPER.replace(mu_m=mu_m, mu_k=mu_k, tau=0).modes
    with mp.workdps(60):
        root = mp.sqrt(mpf(mu_m))
        exact, vectors = mp.eigsy(mp.matrix([[1, -1 / root], [-1 / root, (1 + mpf(mu_k)) / mpf(mu_m)]]))
        for j in range(2):
            assert abs(omega_squared[j] / exact[j] - 1) < 1e-15
            sign = mp.sign(vectors[0, j] * psi[0, j])
            assert abs(psi[0, j] / (sign * vectors[0, j]) - 1) < 2e-15
            assert abs(psi[1, j] / (sign * vectors[1, j] / root) - 1) < 2e-15


@pytest.mark.parametrize("changes", [{}, dict(f2=0.3), dict(zeta=3.0, omega=1.4), dict(mu_m=0.2, f2=1, omega=2)])
def test_grazing_is_the_extreme_of_the_complex_response(changes):
    system = PAPER.replace(**changes)
    X = complex_response(system)
    touch = vs.grazing(system)
    turned = X * np.exp(1j * touch.tau)  # at t = 0: x = Im, v = omega Re
    assert touch.b == pytest.approx(abs(X[0]), rel=1e-14)
    expected = [turned[0].imag, system.omega * turned[0].real, turned[1].imag, system.omega * turned[1].real]
    np.testing.assert_allclose(touch.state, expected, atol=1e-13 * abs(X).max())
    assert touch.satisfied and system.phase == touch.tau


def test_grazing_of_the_paper_and_its_errata():
    touch = vs.grazing(PAPER)
    assert touch.b == pytest.approx(6.70571674097302, abs=2e-14)
    assert touch.tau == pytest.approx(2.229306509033, abs=1e-12)
    assert 0 < abs(touch.tau - 2.229311) < 1e-5  # as printed: right to five digits
    assert touch.b / 6.7107356 - 1 == pytest.approx(-0.00075, abs=1e-5)  # as printed: 0.075 % too high
    X = complex_response(PAPER)[0]  # d = Re X, e = Im X of eq. (7)
    assert math.atan2(X.real, -X.imag) == pytest.approx(0.912286, abs=1e-6)  # B_j with the sign printed in eq. (7)


def random_systems(count):
    """From nearly undamped to overdamped in both modes, from a feather to a million times M1."""
    random = np.random.default_rng(2)
    for mu_m, mu_k, zeta, omega, f2 in random.uniform([-3, -3, -4, -2, 0], [6, 3, 1, 2, 1], (count, 5)):
        yield vs.System(mu_m=10**mu_m, mu_k=10**mu_k, zeta=10**zeta, omega=10**omega, f2=f2, R=0.8, b=1.0)


@pytest.mark.parametrize("count", [200, *slow_cases(1000)])
def test_grazing_of_random_systems(count):
    """Against 40 digits. The worst are near an antiresonance, where the modes cancel."""
    systems = list(random_systems(count))
    overdamped = [np.count_nonzero(system.eta**2 > system.modes.omega_squared) for system in systems]
    assert min(overdamped.count(number) for number in (0, 1, 2)) > count / 20
    errors = []
    for system in systems:
        touch = vs.grazing(system)
        b, tau = naive.grazing(system.parameters())
        with mp.workdps(40):
            errors.append((float(abs(touch.b / b - 1)), float(abs(mp.sin(touch.tau - tau)))))
    assert np.max(errors) < 1e-13
    assert np.quantile(errors, 0.99) < 1e-14
    assert np.median(errors) < 3e-16


def test_motion_from_the_grazing_state_is_the_grazing_motion():
    """b cos(omega t): the state that `grazing` gives, carried over half a period by the simulator."""
    touch = vs.grazing(PAPER)
    system = PAPER.replace(b=touch.b * (1 + 1e-9))
    times = np.linspace(0, system.period, 51)
    states = vs.simulate(system, touch.state, periods=1).sample(times)
    np.testing.assert_allclose(states[:, 0], touch.b * np.cos(system.omega * times), atol=1e-13)
    np.testing.assert_allclose(states[25], -np.array(touch.state), atol=1e-13)


def test_undamped_resonance_has_no_grazing():
    system = PAPER.replace(zeta=0, tau=0.0)
    resonant = system.replace(omega=float(np.sqrt(system.modes.omega_squared[0])))
    assert not vs.grazing(resonant).satisfied and vs.grazing(system).satisfied
    assert resonant.replace(tau="grazing").phase == 0


def test_physical_units():
    """Every quotient of eq. (4) and section 2, by numbers worked out by hand."""
    system = vs.System.physical(**PHYSICAL, tau=0.3, stops="left")
    expected = dict(mu_m=3, mu_k=1.5, zeta=0.05, f2=0.25, omega=0.75, R=0.7, b=4, tau=0.3)
    expected |= dict(offset=0, R_left=0.7, mu_c=1.5)
    assert system.parameters() == pytest.approx(expected, rel=1e-15)
    assert system.stops == "left"


def test_physical_units_describe_the_same_motion():
    """M X'' + C X' + K X = P sin(Omega T) in physical units, and its amplitude B K1/(P1 + P2) in the other."""
    p = PHYSICAL
    K = np.array([[p["K1"], -p["K1"]], [-p["K1"], p["K1"] + p["K2"]]])
    C = np.array([[p["C1"], -p["C1"]], [-p["C1"], p["C1"] + p["C2"]]])
    M = np.diag([p["M1"], p["M2"]])
    X = np.linalg.solve(K - p["Omega"] ** 2 * M + 1j * p["Omega"] * C, [p["P1"], p["P2"]])
    touch = vs.grazing(vs.System.physical(**p))
    assert touch.b == pytest.approx(abs(X[0]) * p["K1"] / (p["P1"] + p["P2"]), rel=1e-13)


def test_the_ends_of_the_allowed_ranges():
    for changes in (dict(zeta=0, tau=0), dict(f2=0, R=0), dict(f2=1, R=1), dict(mu_m=1e-300, tau=1)):
        assert PAPER.replace(**changes).replace(b=1) == PAPER.replace(**changes, b=1.0)


def test_frozen_and_replace():
    with pytest.raises(AttributeError, match="is not changed"):
        PAPER.b = 7.0
    other = PAPER.replace(b=np.float64(7), mu_m=np.int64(3))
    assert (other.b, other.mu_m, other.R, PAPER.b) == (7.0, 3.0, 0.8, 6.6)
    assert type(other.b) is float and type(other.mu_m) is float
    assert other.phase != PAPER.phase  # `grazing` is a wish, kept until the number is needed
    assert PAPER.replace(b=6.6) == PAPER and hash(PAPER.replace(b=6.6)) == hash(PAPER)
