"""Rates farther apart than any grid resolves; others, event by event: test_events.py."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.flow import matrix_of
from reference.gmp import expm
from reference.machine import machine_of

import vibro_sweep as vs

PAPER = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=1.0)


def test_farther_apart_than_any_grid():
    """mu_m = 1e-6: the small mass follows the large one within 1e-6, and the orbit is that of one degree of freedom."""
    system = vs.System(**{**PAPER, "mu_m": 1e-6})
    orbit = vs.simulate(system, (0.1, 0.2, 0.1, -0.3), 5)
    slower = vs.simulate(system.replace(mu_m=1e-5), (0.1, 0.2, 0.1, -0.3), 5)
    assert orbit.status == "ok" and len(orbit.impacts) == len(slower.impacts) > 5
    np.testing.assert_allclose(orbit.impacts["t"], slower.impacts["t"], atol=1e-3)
    spectrum = vs.lyapunov(system, (0.1, 0.2, 0.1, -0.3), 5, 20)
    assert np.isfinite(spectrum[:3]).all() and spectrum[3] == -np.inf  # -6e5: gone within a cell


def test_refused_beyond_reason():
    """In a sweep such a point has a status: test_sweep.py."""
    with pytest.raises(vs.ParameterError, match="fastest rate"):
        vs.simulate(vs.System(**{**PAPER, "mu_m": 1e-9, "omega": 1e-5, "zeta": 10.0}), (0, 0, 0, 0), 1)


def test_three_masses_of_which_two_are_held_together():
    """A flight without impacts, against the matrix exponential in 40 digits; a cell takes several series."""
    chain = {"m": [1, 2, 3], "k": [1, 1e8, 1, 1], "c": 4 * [0.1], "force": [1, 0, 0], "omega": 0.7, "b": 50.0}
    system, state = vs.Oscillator.named("chain", **chain, R=0.8, tau=0.3), (0.1, 0.2, 0.1001, 0.2, 0.3, -0.1)
    section = vs.simulate(system, state, 2).section
    with mp.workdps(40):
        flow = expm(matrix_of(machine_of(system.linear))[:8, :8] * (2 * mp.pi / mpf(system.omega)))
        z = mp.matrix([*map(mpf, state), mp.sin(mpf(system.tau)), mp.cos(mpf(system.tau))])
        for found in section[1:]:
            z = flow * z
            np.testing.assert_allclose(found, [float(one) for one in z[:6]], atol=1e-6)
