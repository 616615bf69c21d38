"""Orbits that follow each other go on at the phase that the force had, wherever their sections lie."""

import itertools

import numpy as np
import pytest

import vibro_sweep as vs

STOPS = {
    "rigid": {"R": 0.8},
    "compliant": {"k_stop": 100.0, "c_stop": 0.5},
    "relaxing": {"k_stop": 3.0, "c_stop": 20.0, "release": "force", "preload": 0.01},
}
NAMES = ("x1", "v1", "x2", "v2")


@pytest.mark.parametrize("direction", ["up", "down"])
@pytest.mark.parametrize("stops", ["rigid", "compliant"])
def test_each_step_is_the_motion_from_where_the_last_one_ended(stops, direction):
    """tau: grazing turns by pi over the antiresonance of mass 1; each step is simulated from the phase of the last."""
    system = vs.System(mu_m=1.0, mu_k=1.5, zeta=0.003, f2=0.0, b=0.3, omega=1.0, tau="grazing", **STOPS[stops])
    omega = np.linspace(0.9, 1.2, 9) * np.sqrt(2.5)
    data = vs.sweep(system, {"omega": omega}, start={"follow": direction}, transient=0, record=4, observe=["section"])
    tau, order = data.tau.values, np.arange(9) if direction == "up" else np.arange(9)[::-1]
    assert np.abs(np.diff(np.unwrap(tau))).max() > 1
    for last, here in itertools.pairwise(order.tolist()):
        begin = (tau[last] - tau[here]) % (2 * np.pi) / omega[here]
        state = [data[name].values[last, -1] for name in NAMES]
        one = system.replace(omega=float(omega[here]), tau=float(tau[here]))
        wanted = vs.simulate(one, state, 4, start_time=begin).section[:4]
        found = np.stack([data[name].values[here] for name in NAMES], axis=-1)
        assert np.abs(found - wanted).max() < 1e-11


@pytest.mark.parametrize("stops", STOPS)
def test_a_chain_along_tau_looks_at_one_motion(stops):
    """The section moves and the motion stays: each point is one of the same orbit."""
    system = vs.System(mu_m=1.0, mu_k=1.5, zeta=0.03, f2=0, omega=1.9, b=0.3, tau=0.0, **STOPS[stops])
    tau = np.linspace(-3, 9, 25)
    data = vs.sweep(
        system, {"tau": tau}, start={"follow": "up"}, transient=300, record=60, observe=["section", "energy"]
    )
    assert (data.status == 0).all() and (data.period == data.period[0]).all() and data.period[0] > 0
    assert np.abs(data.rms_x1 / data.rms_x1[0] - 1).max() < 1e-12 and np.ptp(data.x1[:, -1].values) > 0.1
