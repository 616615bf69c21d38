"""Contacts that last and are fast: what takes too long says so, and ends at Ctrl-C; numbers too large for squares."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import vibro_sweep as vs

SYSTEM = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=0.5, omega=0.8, b=1, tau=0, k_stop=5, c_stop=1)


@pytest.mark.slow
@pytest.mark.parametrize("damping", [1e9, 1e12])
def test_a_strong_damper_costs_no_steps(damping):
    """The mass creeps. Left by force the stop is a rigid one with R = 0; by displacement it holds the mass until what
    pulls has done as much as what pushed."""
    start, rigid = (0, 2), SYSTEM.replace(c_stop=None, k_stop=None, R=0)
    by_force, other = SYSTEM.replace(c_stop=damping, release="force"), vs.simulate(rigid, start, 200)
    orbit = vs.simulate(by_force, start, 200)
    assert orbit.status == "ok" and np.abs(orbit.section - other.section).max() < 1e3 / damping + 1e-12
    held = vs.simulate(by_force.replace(release="displacement"), start, 200)
    assert held.status == "ok" and len(held.contacts) == 400
    first = held.contacts[0]
    t = np.linspace(first["t_touch"], first["t_release"], 10_001)
    pull = 0.5 * np.sin(0.8 * t) - 1  # the spring: the mass is at the stop
    assert first["v_touch"] + np.trapezoid(pull, t) == pytest.approx(first["v_release"], abs=1e-7)
    assert abs(first["v_release"]) * damping == pytest.approx(-pull[-1], rel=1e-6)


RINGING = SYSTEM.replace(b=-1, stops="right", c_stop=0)  # a stop without a damper, on which the mass lies


@pytest.mark.slow
def test_a_contact_of_too_many_steps_says_so():
    system = RINGING.replace(k_stop=1e14)
    orbit = vs.simulate(system, (-1, 0), 5)
    assert orbit.status == "rates_too_far_apart" and np.isnan(orbit.section[-1]).all()
    assert np.isnan(vs.lyapunov(system, (-1, 0), 2, 3)).all()
    data = vs.sweep(RINGING, {"k_stop": [100.0, 1e14]}, start=(-1, 0), transient=2, record=2, workers=1)
    assert data["status"].values.tolist() == [0, 3] and np.isnan(data["x1"].values[1]).all()


@pytest.mark.slow
def test_ctrl_c_ends_a_long_contact():
    system = RINGING.replace(k_stop=1e9)
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    vs.simulate(system, (-1, 0), 1)  # compiled
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        vs.simulate(system, (-1, 0), 10_000)
    threads = threading.active_count()
    time.sleep(0.5)
    assert threading.active_count() <= threads - 1  # the kernel has ended, too


@pytest.mark.parametrize("place", [1e99, 1e150, 1e300])
def test_a_start_too_far_inside_a_stop(place):
    orbit = vs.simulate(SYSTEM, (place, 0), 1)
    assert orbit.status == ("ok" if place < 1e100 else "not_finite")


def test_a_preload_too_large():
    with pytest.raises(ValueError, match=r"preload: 1e\+160 is not allowed; .* from 0 to 1e100"):
        SYSTEM.replace(preload=1e160)


def test_orbits_with_contacts_of_too_many_steps_are_not_computed():
    """A stop that gives way for many periods, with a rate of 10^9 that each step would resolve: said within seconds."""
    system = vs.Oscillator.named(
        "one_mass", k=1, zeta=0.05, F=0.5, omega=0.8, k_stop=1e8, c_stop=1e9, b=1, stops="right", tau=0.0
    )
    assert str(vs.periodic_orbit(system, itinerary="R").status) == "too_stiff"


@pytest.mark.parametrize("numbers", [{"k_stop": 1e160, "c_stop": 0}, {"k_stop": 1, "c_stop": 1e160}], ids=str)
def test_stops_whose_rates_are_beyond_all_say_so(numbers):
    system = SYSTEM.replace(**numbers)
    assert vs.simulate(system, (0, 0), 10).status == "not_finite"
    assert vs.periodic_orbit(system, itinerary="R").status == "too_stiff"
