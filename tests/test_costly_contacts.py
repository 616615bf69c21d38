"""Contacts that last and are fast: what takes too long says so, and ends at Ctrl-C; numbers too large for squares."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import vibro_sweep as vs

SYSTEM = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=0.5, omega=0.8, b=1, tau=0, k_stop=5, c_stop=1)


@pytest.mark.parametrize("damping", [1e9, 1e12])
def test_a_contact_of_too_many_steps_says_so(damping):
    system = SYSTEM.replace(c_stop=damping)
    orbit = vs.simulate(system, (0, 2), 5)
    assert orbit.status == "rates_too_far_apart" and np.isnan(orbit.section[-1]).all()
    assert np.isnan(vs.lyapunov(system, (0, 2), 2, 3)).all()
    data = vs.sweep(SYSTEM, {"c_stop": [1.0, damping]}, start=(0, 2), transient=2, record=2, workers=1)
    assert data["status"].values.tolist() == [0, 3] and np.isnan(data["x1"].values[1]).all()


def test_ctrl_c_ends_a_long_contact():
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    vs.simulate(SYSTEM, (0, 2), 1)  # compiled
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        vs.simulate(SYSTEM.replace(c_stop=5e5), (0, 2), 10_000)
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
