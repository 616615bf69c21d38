"""Exponents of any linear oscillator with one contact, and its units; its first events: test_events.py."""

import numpy as np
import pytest
from support.drawn_oscillators import drawn
from support.first_events import MASSES

import vibro_sweep as vs


@pytest.mark.slow
@pytest.mark.parametrize("masses", MASSES)
def test_sum_rule(masses):
    for seed in (8, 9, 10):
        system, state = drawn(seed, masses)
        exponents = vs.lyapunov(system, state, transient=50, record=500)
        hits = len(vs.simulate(system, state, 100).impacts)
        assert hits > 50 and (abs(exponents.residual) < 1e-12 or exponents[-1] == -np.inf)


def test_unequal_restitution_in_the_sum_rule():
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0.25, omega=0.63, b=2.0, offset=0.3, R=0.8, R_left=0.6)
    exponents = vs.lyapunov(system, [0.1, 0.2, 0.3, -0.1], transient=100, record=1000)
    sides = vs.simulate(system, [0.1, 0.2, 0.3, -0.1], 200).impacts["side"]
    assert set(sides) == {-1, 1} and abs(exponents.residual) < 1e-13


@pytest.mark.slow
def test_kinds_of_damping_and_of_modes():
    """Free, critical, overdamped, equal and unseen modes: without impacts the exponents are real parts of the roots."""
    chain = np.array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    eye = np.eye(3)
    kinds = {
        "free, undamped": (chain, 0 * eye),
        "free, damped inside": (chain, 0.1 * chain),
        "free, damped outside": (chain, np.diag([0, 0, 0.3])),
        "dampers alone": (0 * eye, 0.2 * chain + 0.1 * eye),
        "critical": (np.diag([1.0, 4, 9]), np.diag([2.0, 0.2, 6])),
        "overdamped": (chain + eye, np.diag([9.0, 0.1, 4])),
        "equal": (2 * eye, 0.1 * eye),
        "equal, not classical": (2 * eye, np.array([[0.3, 0.1, 0], [0.1, 0.2, 0], [0, 0, 0.1]])),
    }
    for name, (K, C) in kinds.items():
        system = vs.Oscillator(
            eye,
            K,
            C,
            contact_normal=[1, 0, 0],
            force=[1e-3, 0, 0],
            constant=[0, 1e-6, 0],
            omega=0.7,
            tau=0.0,
            b=1e6,
            R=0.8,
        )
        A = np.block([[0 * eye, eye], [-K, -C]])
        exact = np.sort(np.linalg.eigvals(A).real)[::-1]
        found = vs.lyapunov(system, np.zeros(6), transient=200, record=50)
        np.testing.assert_allclose(found, exact, atol=1e-6 if "critical" in name else 1e-7, err_msg=name)
        assert abs(found.residual) < 1e-12, name


@pytest.mark.slow
@pytest.mark.parametrize(("R", "K1"), [(0.6, 0.0), (0.6, 4.0), (0.0, 4.0)])
@pytest.mark.parametrize(("K2", "C2"), [(1.0, 0.1), (0.0, 0.0), (9.0, 0.2)])
def test_masses_that_the_contact_does_not_see(R, K1, K2, C2):
    """They keep their exponents, whatever a rest or an impact without restitution takes from the other."""
    system = vs.Oscillator(
        np.eye(3), np.diag([K1, K2, 2]), np.diag([0.02, C2, 0.06]), contact_normal=[1, 0, 0], force=[1, 0, 0],
        constant=[-1, 0, 0], omega=0.8, tau=0.0, b=0.0, R=R, stops="left",
    )  # fmt: skip
    state = np.array([0.2, 0.0, 0.1, 0.0, 0.1, 0.2])
    found, orbit = vs.lyapunov(system, state, 20, 200), vs.simulate(system, state, 200)
    alone = vs.Oscillator(
        [[1.0]],
        [[K1]],
        [[0.02]],
        contact_normal=[1],
        force=[1],
        constant=[-1],
        omega=0.8,
        tau=0.0,
        b=0.0,
        R=R,
        stops="left",
    )
    other = vs.lyapunov(alone, state[:2], 20, 200)
    assert len(orbit.impacts) > 10
    exact = np.sort([*other, -C2 / 2, -C2 / 2, -0.03, -0.03])[::-1]
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-6)


@pytest.mark.parametrize("stops", ["both", "right"])
def test_units_change_nothing(stops):
    """In units that are a power of two larger all is the same, also where the search leaves single precision."""
    K, start = np.array([[2.0, -1.0], [-1.0, 2.0]]), np.zeros(4)
    units = [2.0**k for k in (0, -300, -140, -110, 90, 120, 126, 128, 400)]
    systems = [
        vs.Oscillator(
            np.eye(2),
            K,
            0.05 * K,
            force=[unit, 0],
            contact_normal=[1, 0],
            omega=0.9,
            b=0.8 * unit,
            R=0.8,
            tau=0.0,
            stops=stops,
        )
        for unit in units
    ]
    first, *others = (vs.simulate(system, start, 60).impacts["t"] for system in systems)
    assert len(first) > 100
    for unit, times in zip(units[1:], others, strict=True):
        np.testing.assert_array_equal(times, first, f"{unit:g}")
