"""Compliant stops against closed forms, and the rigid ones that they come near to; sweeps of them.

Their first contacts in many digits: tests/cases/events.yaml.
"""

import math
from itertools import product

import numpy as np
import pytest
from mpmath import mp
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from support import sample
from support.soft_stops import ELASTIC, FREE, PAPER, one_mass

import vibro_sweep as vs

# --- closed forms


def restitution_of(z, release):
    """Of a free mass on a stop on which its damping ratio is z; None where it never leaves the stop."""
    if z < 1:
        root = math.sqrt(1 - z * z)
        turn = math.pi if release == "displacement" else 2 * math.atan2(root, z)
        return math.exp(-z / root * turn)
    if release == "displacement":
        return None
    root = math.sqrt(z * z - 1)
    return math.exp(-2.0) if z == 1 else math.exp(-2 * z / root * math.atanh(root / z))


@pytest.mark.parametrize("z, stiffness", sample(6, product([0.0, 0.07, 0.5, 0.99, 1.0, 2.0], [1.0, 1e4, 1e8])))
def test_restitution_of_a_free_mass(stiffness, z):
    for release in ("displacement", "force"):
        system = one_mass(**FREE, k_stop=stiffness, c_stop=2 * z * math.sqrt(stiffness), release=release)
        expected = restitution_of(z, release)
        contact = vs.simulate(system, (0, 1), 1 if expected is None else 10).contacts[0]
        if expected is None:
            assert math.isnan(contact["t_release"])
        else:
            assert -contact["v_release"] / contact["v_touch"] == pytest.approx(expected, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("stiffness, release", sample(3, product([1.0, 1e2, 1e4, 1e6, 1e8], ["displacement", "force"])))
def test_restitution_in_a_plane_of_clearance_and_damping(stiffness, release):
    ratios = np.array([0, 0.01, 0.1, 0.3, 0.6, 0.9, 0.99, 1, 1.01, 1.5, 2, 3, 4])
    ratios = ratios[(ratios < 1) | (release == "force")]
    system = one_mass(**FREE | {"omega": 0.2}, k_stop=stiffness, c_stop=0, release=release)
    axes = {"b": np.linspace(0.1, 3, 7), "c_stop": 2 * ratios * math.sqrt(stiffness)}
    data = vs.sweep(system, axes, start={"v1": 1}, transient=0, record=1, observe=["contacts"])
    expected = [restitution_of(z, release) for z in ratios]
    assert np.all(data.contacts_right == 1)
    np.testing.assert_allclose(data.restitution_mean, np.tile(expected, (7, 1)), rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("z", [0.01, 0.07, 0.3])
@pytest.mark.parametrize("b", [1, 2, 3, 4])
def test_stiff_stops_come_near_to_rigid_ones(b, z):
    """At a fixed z orbits differ from those with the restitution exp(-pi z/sqrt(1 - z^2)) like k^(-1/2)."""
    start, stiffness = (0.4 * b, 2.0, 0.5, 0.0), np.logspace(5, 9, 9)
    rigid = vs.System(**PAPER, b=b, R=restitution_of(z, "displacement"))
    wanted, apart = vs.simulate(rigid, start, 3).section[3], []
    for k in stiffness:
        soft = vs.System(**PAPER, b=b, k_stop=k, c_stop=2 * z * math.sqrt(k))
        apart.append(np.abs(vs.simulate(soft, start, 3).section[3] - wanted).max())
    order = np.polyfit(np.log(stiffness), np.log(apart), 1)[0]
    assert order == pytest.approx(-0.5, abs=0.02), apart


ORDERS = [
    (1.5, {}),
    (1.5, dict(release="force")),
    (1.5, dict(c_stop=0.4)),
    (1.0, dict(c_stop=0.4, release="force")),
    (0.5, dict(preload=0.3)),
    (0.5, dict(preload=0.3, c_stop=0.4, release="force")),
]


def fitted_order(order, change):
    """The power of the depth of a touch with which what it does grows: change(depth)."""
    depths = np.logspace(-9 if order < 1.5 else -7.5, -6.5 if order < 1.5 else -5.5, 5)
    return np.polyfit(np.log(depths), np.log([change(depth) for depth in depths]), 1)[0]


@pytest.mark.slow
@pytest.mark.parametrize("order, stop", ORDERS)
def test_order_of_what_a_grazing_touch_does(order, stop):
    """What a touch does to the state after it, by how far the mass would have gone beyond the stop without it."""
    thrown = FREE | {"constant": -1.0}  # it turns back at 1 + depth

    def change(depth):
        start = 0.0, math.sqrt(2 * (1 + depth))
        touches, passes = one_mass(**thrown, k_stop=29, **stop), one_mass(**thrown | {"b": 3}, k_stop=29)
        ends = [vs.simulate(one, start, 1).sample([3.0])[0] for one in (touches, passes)]
        return np.abs(ends[0] - ends[1]).max()

    assert fitted_order(order, change) == pytest.approx(order, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("order, stop", ORDERS)
def test_order_of_what_a_grazing_touch_of_two_masses_does(order, stop):
    """The free motion under the force turns back at a known place, and the stop is so far before it."""
    start, far = (0.0, 1.2, 0.3, 0.0), vs.simulate(vs.System(**PAPER, b=50, k_stop=29), (0.0, 1.2, 0.3, 0.0), 1)
    top = brentq(lambda t: far.sample([t])[0, 1], 0.1, 3.0, xtol=1e-15)
    height, after = far.sample([top])[0, 0], far.sample([top + 0.5])[0]

    def change(depth):
        touches = vs.simulate(vs.System(**PAPER, b=height - depth, k_stop=29, **stop), start, 1)
        assert touches.contacts["side"][0] == 1 and touches.contacts["t_touch"][0] < top
        return np.abs(touches.sample([top + 0.5])[0] - after).max()

    assert fitted_order(order, change) == pytest.approx(order, abs=0.02)


# --- sweeps


def test_what_a_sweep_observes_is_what_an_orbit_has():
    system = one_mass(**ELASTIC, k_stop=29, c_stop=0.5)
    data = vs.sweep(
        system, {"omega": [0.9, 0.8]}, transient=100, record=50, start={"x1": 0.3}, observe=["contacts", "section"]
    )
    for i, omega in enumerate((0.9, 0.8)):
        one = system.replace(omega=omega)
        orbit = vs.simulate(one, (0.3, 0), 150)
        T = one.period
        touched = orbit.contacts[orbit.contacts["t_touch"] >= 100 * T]
        ended = touched[~np.isnan(touched["t_release"])]
        assert data.contacts_right[i] == len(touched) > 20 and data.contacts_left[i] == 0
        assert float(data.penetration_max[i]) == pytest.approx(touched["max_penetration"].max(), rel=1e-9)
        assert float(data.contact_force_max[i]) == pytest.approx(touched["max_force"].max(), rel=1e-9)
        assert float(data.restitution_mean[i]) == pytest.approx(
            np.mean(-ended["v_release"] / ended["v_touch"]), rel=1e-2
        )
        assert 0 < float(data.contact_time[i]) < 1


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.0, 0.3])
def test_a_sweep_has_the_largest_force_and_penetration_to_rounding(ratio):
    """Orbits side by side find peaks in closed form, single orbits in series of their own."""
    numbers = PAPER | dict(b=3, k_stop=3700, c_stop=2 * ratio * math.sqrt(3700))
    start, tones = (0.1, 0.2, 0.3, 0.1), np.linspace(0.6, 0.68, 8)
    data = vs.sweep(vs.System(**numbers), {"omega": tones}, transient=0, record=8, start=start, observe=["contacts"])
    for i, omega in enumerate(tones):
        touched = vs.simulate(vs.System(**numbers | dict(omega=omega)), start, 8).contacts
        assert len(touched) > 2
        for found, name in ((data.penetration_max, "max_penetration"), (data.contact_force_max, "max_force")):
            assert float(found[i]) == pytest.approx(np.nanmax(touched[name]), rel=2e-14)


@pytest.mark.slow
@pytest.mark.parametrize("place", [0, 1])
def test_a_rest_on_a_preload_ends_by_being_pressed_in(place):
    """The first contact after it, against an integration from where the force of rest is the preload."""
    k, c, p, F = 25.0, 1.0, 1.5, 0.6
    system = vs.Oscillator.named(
        "one_mass",
        k=0,
        zeta=0,
        constant=-1,
        F=F,
        omega=1,
        k_stop=k,
        c_stop=c,
        preload=p,
        stops="left",
        b=place,
        tau=0.0,
    )
    orbit = vs.simulate(system, (-place, 0), 3)
    assert orbit.status == "ok"
    begin = math.pi + math.asin((p - 1) / F)  # 1 - F sin t = p
    assert orbit.sticking["t_off"][0] == pytest.approx(begin, rel=1e-14)
    back = solve_ivp(
        lambda t, y: (y[1], 1 - F * math.sin(t) - k * y[0] - c * y[1] - p), (begin + 1e-6, 7), (1e-20, 1e-13),
        events=_leaves, rtol=1e-11, atol=1e-14, max_step=0.02,
    )  # fmt: skip
    assert orbit.contacts["t_touch"][0] == pytest.approx(begin, rel=1e-14)
    assert orbit.contacts["t_release"][0] == pytest.approx(back.t_events[0][0], abs=1e-8)
    assert orbit.contacts["v_release"][0] == pytest.approx(back.y_events[0][0][1], abs=1e-8)


def _leaves(t, y):
    return y[0]


_leaves.terminal, _leaves.direction = True, -1


@pytest.mark.slow
def test_bits_do_not_depend_on_workers_or_on_other_points():
    system, axes = vs.System(**PAPER, b=4, k_stop=1e3, c_stop=2), {"b": np.linspace(3, 7, 40)}
    how = dict(transient=50, record=30, observe=["section", "lyapunov", "contacts"])
    whole, pair = vs.sweep(system, axes, workers=1, **how), vs.sweep(system, axes, workers=2, **how)
    part = vs.sweep(system, {"b": axes["b"][7:12]}, **how)
    for name in whole.data_vars:
        assert whole[name].values.tobytes() == pair[name].values.tobytes(), name
        assert whole[name].values[7:12].tobytes() == part[name].values.tobytes(), name


def test_a_start_inside_a_stop_is_in_contact():
    orbit = vs.simulate(one_mass(**ELASTIC, k_stop=29), (1.5, 0), 3)
    assert orbit.contacts["t_touch"][0] == 0 and orbit.contacts["max_penetration"][0] >= 0.5


@pytest.mark.slow
def test_rest_on_a_preloaded_stop():
    """A mass that is pressed on with less than the preload stays, held by the force itself."""
    system = one_mass(k=0, zeta=0, F=0.2, constant=0.3, omega=1, b=1, stops="right", tau=0.0, k_stop=50, preload=1)
    orbit = vs.simulate(system, (1, 0), 5)
    assert len(orbit.contacts) == 0 and orbit.sticking["t_on"][0] == 0 and np.all(orbit.section[:, 0] == 1)
    heavy = vs.simulate(system.replace(constant=0.9), (1, 0), 1)  # its largest pull exceeds the preload
    assert heavy.contacts["t_touch"][0] == pytest.approx(math.asin(0.5), abs=1e-12)


def test_a_stop_that_loses_its_damper_along_a_chain_is_relaxed_at_once():
    system = one_mass(**ELASTIC | {"b": 0.3, "tau": 0.8}, k_stop=4, c_stop=20, release="force")
    data = vs.sweep(
        system, {"c_stop": [20.0, 0.0]}, start={"x1": 0.2, "v1": 0.9, "follow": "down"}, transient=0, record=1
    )
    begin = float(data.x1[0, 0]), float(data.v1[0, 0])
    there = vs.simulate(system.replace(c_stop=0), begin, 1)
    assert begin[0] < 0.3 and there.contacts["t_touch"][0] < 1
    assert there.section[1] == pytest.approx([float(data.x1[1, 0]), float(data.v1[1, 0])], abs=1e-14)


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_trajectories_and_samples_go_on_from_a_contact_or_a_relaxing_stop(release):
    system = one_mass(**ELASTIC | {"tau": 1.3}, k_stop=29, c_stop=6, release=release)
    orbit = vs.simulate(system, (0.3, 0), 44)
    T = system.period
    held = [t for t in orbit.section_times[:40] if orbit.section[round(t / T), 0] > 1]
    assert held  # some sections lie in a contact
    data = vs.sweep(
        system, {"omega": [0.8]}, transient=20, record=20, start={"x1": 0.3}, trajectory={"periods": 2, "samples": 41}
    )
    assert data.trajectory_x1.values[0] == pytest.approx(orbit.sample(np.linspace(40, 42, 41) * T)[:, 0], abs=1e-10)
    fine = vs.simulate(system, (0.3, 0), 10).sample(np.linspace(0, 10, 2001) * T)
    assert np.abs(np.diff(fine[:, 0])).max() < 1.1 * np.abs(fine[:, 1]).max() * T / 200


@pytest.mark.parametrize(("stiffness", "preload", "start"), [(1.0, 1e6, (2.5, -0.6)), (29.0, 1.0, (1e-4, -1e-4))])
def test_a_contact_that_the_preload_ends_long_before_the_stiffness_would(stiffness, preload, start):
    """x'' + c x' = 0 before and after it, x'' + c x' + k x = p in it, in 40 digits."""
    omega, c, (x, v) = 0.5, mp.mpf("0.1"), map(mp.mpf, start)
    with mp.workdps(40):
        k, p = mp.mpf(stiffness), mp.mpf(preload)
        touch = -mp.log(1 + c * x / v) / c
        v *= mp.exp(-c * touch)
        root = mp.sqrt(k - c * c / 4)

        def within(u):
            decay, cos, sin = mp.exp(-c * u / 2), mp.cos(root * u), mp.sin(root * u)
            place = p / k + decay * (-p / k * cos + (v - c * p / (2 * k)) / root * sin)
            return place, decay * (v * cos + (p - c * v / 2) / root * sin)

        length = mp.findroot(lambda u: within(u)[0] / u, -2 * v / p)
        left = 2 * 2 * mp.pi / omega - touch - length
        expected = within(length)[1] * (1 - mp.exp(-c * left)) / c
    system = vs.Oscillator.named(
        "one_mass", k_stop=stiffness, preload=preload, omega=omega, zeta=0.05, tau=0, b=0, stops="left", k=0, F=0
    )
    swept = vs.sweep(system, {"b": [0.0]}, observe=["section"], start=start, transient=0, record=2)
    assert float(swept.x1.values.ravel()[-1]) == pytest.approx(float(expected), rel=1e-13)
    assert vs.simulate(system, start, 2).section[-1, 0] == pytest.approx(float(expected), rel=1e-13)
