"""`observe: [energy]` with compliant stops: what they take, against forty digits and the balance of energy."""

import numpy as np
import pytest
from mpmath import mpf
from reference.events import simulate
from reference.machine import machine_of
from support import slow_cases

import vibro_sweep as vs

ONE = dict(k=1, zeta=0.01, F=0.5, omega=0.8, b=1, tau=0.3)
PAPER = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0.2, omega=0.63, b=3, tau=0.4)
CHAIN = dict(m=[1, 2, 1], k=[0.2, 1, 1, 0.5], c=[0, 0.1, 0.1, 0], force=[1, 0, 0.4], omega=0.9, b=0.8, tau=0.1)
LAWS = {
    "elastic": dict(k_stop=29),
    "elastic, preloaded": dict(k_stop=29, preload=0.2),
    "damped": dict(k_stop=40, c_stop=3),
    "left by force": dict(k_stop=40, c_stop=3, release="force"),
    "left by force, preloaded": dict(k_stop=40, c_stop=6, preload=0.1, release="force"),
    "stiff": dict(k_stop=1e4, c_stop=14),
    "one rigid": dict(k_stop=400, c_stop=4, R_left=0.7, release="force"),
    "the other rigid": dict(R=0.6, k_stop_left=50, c_stop_left=1, preload_left=0.3),
}
PERIODS = 6

pytestmark = pytest.mark.slow  # for this alone the kernel of energies would be compiled with compliant stops


def oscillator(masses, law):
    if masses == 2:
        return vs.System(**PAPER, **LAWS[law])
    name, numbers = ("one_mass", ONE) if masses == 1 else ("chain", CHAIN)
    return vs.Oscillator.named(name, **numbers, **LAWS[law])


def observed(system, start, transient, record, **more):
    return vs.sweep(
        system, {"omega": [system.omega]}, start=start, transient=transient, record=record, observe=["energy"], **more
    )


MASSES = [1, *slow_cases(2, 3)]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("masses", MASSES)
def test_work_on_stops_against_forty_digits(masses, law):
    system, start = oscillator(masses, law), [0.3, 0.9] + (2 * masses - 2) * [0.1]
    exact = simulate(machine_of(system.linear), [mpf(one) for one in start], periods=PERIODS)
    assert len(exact.contacts) + len(exact.impacts) >= 2 and exact.contacts
    assert (len(exact.impacts) > 0) == ("rigid" in law)
    data = observed(system, start, 0, PERIODS)
    found, wanted = float(data.impact_power[0]) * PERIODS * system.period, float(exact.taken)
    assert found == pytest.approx(wanted, rel=1e-10, abs=1e-12)
    assert (abs(wanted) > 1e-3) == ("elastic" not in law)  # unless one of them goes on at the end


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("masses", MASSES)
def test_balance_of_energy(masses, law):
    """What the force gives is what dampers and stops take, and what the masses have more at the end.

    The same samples have the mean squares and the largest sizes.
    """
    system, start, transient = oscillator(masses, law), 2 * masses * [0.2], 4
    q, T = system.linear, system.period
    data, orbit = observed(system, start, transient, PERIODS), vs.simulate(system, start, transient + PERIODS)
    begin, end = transient * T, (transient + PERIODS) * T
    cuts = [np.linspace(begin, end, 100 * PERIODS + 1), orbit.impacts["t"]]
    for touch, release in zip(orbit.contacts["t_touch"], orbit.contacts["t_release"], strict=True):
        cuts.append(np.linspace(touch, end if np.isnan(release) else release, 20))
    cuts = np.unique(np.concatenate(cuts))
    cuts = cuts[(cuts >= begin) & (cuts <= end)]
    x, w = np.polynomial.legendre.leggauss(10)
    low, length = cuts[:-1, None], np.diff(cuts)[:, None]
    times, weights = (low + length * (x + 1) / 2).ravel(), (length * w / 2).ravel()
    states = orbit.sample(times)
    v, phase = states[:, 1::2], q.omega * times + q.tau
    force = np.outer(np.sin(phase), q.sine) + np.outer(np.cos(phase), q.cosine) + q.constant
    given, damped = weights @ (force * v).sum(1), weights @ np.einsum("ti,ij,tj->t", v, q.C, v)
    before, after = (energy_of(q, orbit.section[n]) for n in (transient, transient + PERIODS))
    taken = float(data.impact_power[0]) * PERIODS * T
    assert given == pytest.approx(damped + taken + after - before, abs=1e-10)
    for name, values in zip(("x1", "v1", "x2", "v2", "x3", "v3")[: 2 * masses], states.T, strict=True):
        assert float(data[f"rms_{name}"][0]) == pytest.approx(np.sqrt(weights @ values**2 / (end - begin)), rel=1e-11)
        most = np.abs(values).max()
        assert most * (1 - 1e-8) <= float(data[f"peak_{name}"][0]) <= most * 1.005


def energy_of(q, one):
    x, v = one[0::2], one[1::2]
    return 0.5 * (x @ q.K @ x + v @ q.M @ v)


@pytest.mark.parametrize("transient", [0, 1])
@pytest.mark.parametrize("tau", [1.0, 4.0])
def test_an_orbit_that_is_followed_goes_on_with_stops_that_relax(tau, transient):
    """Two steps at the same force, each after a transient, are two periods of one orbit."""
    numbers = ONE | {"b": 0.3, "tau": tau}
    system = vs.Oscillator.named("one_mass", **numbers, k_stop=4, c_stop=20, preload=0.01, release="force")
    start, once = {"x1": 0.2, "v1": 0.9}, 1 + 1e-15
    wanted = [float(observed(system, start, n, 1).impact_power[0]) for n in (transient, 2 * transient + 1)]
    steps = vs.sweep(
        system, {"F": [0.5, 0.5 * once]}, start=start | {"follow": "up"}, transient=transient,
        record=1, observe=["energy"],
    )  # fmt: skip
    assert steps.impact_power.values == pytest.approx(wanted, rel=1e-12)


def test_energies_of_a_contact_of_millions_of_steps():
    """A mass that strikes a damper and creeps in it: the damper takes the energy with which it came."""
    system = vs.Oscillator.named(
        "one_mass", k=0, zeta=0, F=100, omega=0.1, k_stop=1000, c_stop=1e6, preload=0.3, b=0, stops="right", tau=0
    )
    start = (-0.978, -0.606)
    data = vs.sweep(system, {"F": [100.0]}, start=start, transient=1, record=4, observe=["section", "energy"])
    contacts = vs.simulate(system, start, 5).contacts
    contacts = contacts[contacts["t_touch"] > system.period]
    taken = 0.5 * (contacts["v_touch"] ** 2 - contacts["v_release"] ** 2).sum()
    assert len(contacts) == 4 and data.status.values.tolist() == [0]
    # while it creeps the force does 2e-6 of that
    assert data.impact_power.values * 4 * system.period == pytest.approx(taken, rel=3e-6)
    assert data.peak_x1.values > -data.x1.values.min() and data.rms_x1.values < data.peak_x1.values


@pytest.mark.filterwarnings("error")
def test_energies_of_a_point_that_fails_are_nan():
    system = vs.Oscillator.named(
        "one_mass",
        k=0,
        zeta=0.05,
        F=100,
        omega=1e-3,
        k_stop=1e9,
        c_stop=1e3,
        preload=1e3,
        b=0.1,
        stops="right",
        tau=1.3,
    )
    data = vs.sweep(system, {"b": [0.1]}, start=(-1.5, 0.44), transient=1, record=4, observe=["section", "energy"])
    assert data.status.values.item() != 0 and np.isnan(data.rms_x1.values).all()
