"""Contacts that last, or have a fast mode beside them: a series of the slow motion takes the place of thousands.

The exponents of a mass that never leaves the stop are those of a linear oscillator; contacts that end are compared with
those in many digits.
"""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of
from support import compliant_exponents, sample, slow_cases

import vibro_sweep as vs

LAWS = [(1e8, 0.5), (1e8, 1.5), (1e6, 0.05), (1e6, 20), (1e4, 10), (50, 20), (5, 50)]  # k_stop, damping ratio


def chain(masses, k, z, release, **numbers):
    """A chain, whose first mass a constant force presses on its stop."""
    K = 2 * np.eye(masses) - np.eye(masses, k=1) - np.eye(masses, k=-1)
    first = np.eye(masses)[0]
    given = dict(force=0.1 * np.arange(1, masses + 1), omega=0.9, b=0.1, tau=0.3, stops="right", constant=5 * first)
    damping = 2 * z * k**0.5
    law = dict(k_stop=k, c_stop=damping, release=release, contact_normal=first)
    return vs.Oscillator(np.diag(np.arange(1.0, masses + 1)), K, 0.2 * K, **(given | law | numbers))


def exponents(system):
    """Real parts of the eigenvalues of motion in contact, in forty digits, the largest one first."""
    q, N = system.linear, system.masses
    with mp.workdps(40):
        M, K, C = (mp.matrix([[mpf(float(x)) for x in row] for row in one]) for one in (q.M, q.K, q.C))
        law = q.contact.law(1)
        normal = [mpf(float(a)) for a in q.contact.normal]
        for i in range(N):
            for j in range(N):
                K[i, j] += mpf(float(law.k)) * normal[i] * normal[j]
                C[i, j] += mpf(float(law.c)) * normal[i] * normal[j]
        inverse, A = M**-1, mp.zeros(2 * N, 2 * N)
        A[:N, N:], A[N:, :N], A[N:, N:] = mp.eye(N), -inverse * K, -inverse * C
        return np.array(sorted((float(mp.re(one)) for one in mp.eig(A)[0]), reverse=True))


@pytest.mark.parametrize("masses", [*slow_cases(2, 3), 1])
@pytest.mark.parametrize(
    "k, z, release", sample(4, [(*law, release) for law in LAWS for release in ("displacement", "force")])
)
def test_exponents_of_a_mass_that_stays_on_its_stop(masses, k, z, release):
    system = chain(masses, k, z, release)
    data = vs.sweep(
        system, {"omega": [0.9]}, start=[0.0] * (2 * masses), transient=3000, record=20, workers=1,
        observe=["section", "lyapunov", "contacts"],
    ).isel(omega=0)  # fmt: skip
    assert data.status == 0 and data.period == 1 and data.contact_time == pytest.approx(1, abs=1e-12)
    exact = exponents(system)
    error = np.abs(data.lyapunov.values - exact)
    assert np.all(error <= 3e-13 * np.maximum(1e-2, np.abs(exact)))
    assert np.all(error <= 3 * data.lyapunov_error.values)


@pytest.mark.parametrize("masses", [*slow_cases(3), 1])
@pytest.mark.parametrize("k, z", [(400, 0.3), *slow_cases((400, 1.5), (16, 5))])
@pytest.mark.parametrize("release", ["displacement", *slow_cases("force")])
def test_exponents_of_long_contacts_that_end(masses, k, z, release):
    """A force presses the mass on its stop, and tears it off each period."""
    force = 6 * np.eye(masses)[0]
    system = chain(masses, k, z, release, force=force, constant=2 * np.eye(masses)[0])
    report = compliant_exponents.compared_at([0.1], system)
    assert report.period and report.share > 0.25
    assert np.all(report.errors <= 3 * report.stated) and report.stated.max() < 1e-11


def circuit(L, **numbers):
    """A mass that drives a circuit with a small inductance L: a damped mode 2/L times as fast as the others."""
    given = dict(force=[0.3, 0], omega=1.1, tau=0.0, contact_normal=[1, 0], b=0.3, stops="right", k_stop=25, c_stop=0.2)
    return vs.Oscillator(
        [[1, 0], [0, L]], [[1.3, -1], [-1, 10 / 3]], [[0.02, 0], [0, 2]], **(given | numbers)
    )  # fmt: skip


@pytest.mark.parametrize("L", [1e-2, 1e-3, *slow_cases(1e-4)])
@pytest.mark.parametrize(
    "law", [{}, {"k_stop": 5, "c_stop": 1, "release": "force"}, {"k_stop": 1e3, "c_stop": 3, "preload": 0.1}]
)
def test_contacts_beside_a_fast_damped_mode(L, law):
    """Against a flight in thirty digits; the fast mode fades in each contact, and the slow motion is followed alone."""
    system = circuit(L, **law)
    true = simulate(machine_of(system.linear), [0, 0, 0, 0], contacts=3, digits=30).contacts
    for found, contact in zip(vs.simulate(system, [0, 0, 0, 0], 8).contacts, true, strict=False):
        assert found["t_touch"] == pytest.approx(float(contact.t_touch), abs=5e-15)
        assert found["t_release"] == pytest.approx(float(contact.t_release), abs=5e-15)
        assert found["v_release"] == pytest.approx(float(contact.v_release), rel=5e-15)
        assert found["max_force"] == pytest.approx(float(contact.max_force), rel=5e-15)


@pytest.mark.parametrize("L", [1e-2, 1e-5])
@pytest.mark.parametrize("k, c", [(25, 0.2), (400, 4), (25, 60)])
def test_exponents_of_a_mass_on_its_stop_beside_a_fast_damped_mode(L, k, c):
    """The one of the fast mode is -inf where a flight over a cell takes it below the rounding of the others."""
    system = circuit(L, constant=[5, 0], k_stop=k, c_stop=c)
    data = vs.sweep(
        system, {"omega": [1.1]}, start=[0.0] * 4, transient=600, record=20, workers=1, observe=["lyapunov", "contacts"]
    ).isel(omega=0)  # fmt: skip
    assert data.status == 0 and data.contact_time == pytest.approx(1, abs=1e-11)
    count = 4 if L == 1e-2 else 3
    exact, found = exponents(system)[:count], data.lyapunov.values[:count]
    assert np.all(np.abs(found - exact) <= 1e-12 * np.abs(exact))
    assert np.all(np.abs(found - exact) <= data.lyapunov_error.values[:count])


@pytest.mark.slow
def test_growth_beside_a_mass_that_is_held_and_damped_strongly():
    """Of a chaotic orbit whose contacts end: the first exponent against the distance of two orbits, from a time on at
    which all directions have turned into the one that grows most."""
    masses, periods, record = (0.7013, 2.188, 1.488), 40, 40
    system = vs.Oscillator(
        np.diag(masses), [[3.538, -1.102, 1.304], [-1.102, 1.087, 1.47], [1.304, 1.47, 3.407e9]],
        [[0.07076, -0.02205, 0.02609], [-0.02205, 0.02174, 0.0294], [0.02609, 0.0294, 2.136e6]],
        contact_normal=[-0.7291, -1.036, 0.2231], force=[-0.8169, 1.347, 1.208], omega=1.923, tau=1.155, b=0.09109,
        stops="right", k_stop=121400,
    )  # fmt: skip
    state = np.array([-0.0104, -0.7588, -0.01479, -0.1239, 0.003184, 0.0])
    states, growth = vs.simulate(system, state, periods + record).section, 0.0
    aside = np.array([1.0, 0, 0, 0, 0, 0])
    for n in range(periods + record):
        two = [vs.simulate(system, states[n] + sign * 1e-7 * aside, 1).section[-1] for sign in (1, -1)]
        aside = (two[0] - two[1]) / 2e-7
        aside[4:] = 0.0  # rounding of a mass that hardly moves
        length = np.linalg.norm(aside)
        growth, aside = growth + np.log(length) * (n >= periods), aside / length
    found = vs.lyapunov(system, state, periods, record)[0]
    assert found == pytest.approx(growth / (record * system.period), abs=1.5e-3)


def test_samples_of_long_contacts():
    """Samples do not ask whether the fast motion is followed; they join the states at the sections."""
    system = chain(1, 1e6, 1.0, "force", force=[6], constant=[2])
    orbit = vs.simulate(system, (0, 0), 4)
    at_sections = orbit.sample(np.arange(5) * system.period)
    assert np.allclose(at_sections, orbit.section, rtol=0, atol=1e-14)
    times = np.linspace(0, 4 * system.period, 4001)
    x, v = orbit.sample(times).T
    slope = (x[2:] - x[:-2]) / (times[2] - times[0])
    smooth = np.abs(np.diff(v, 2)) < 1e-3  # no touch in between
    assert smooth.mean() > 0.9 and np.abs(slope - v[1:-1])[smooth].max() < 1e-3
