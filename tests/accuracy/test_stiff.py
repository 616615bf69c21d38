"""Rates farther apart than any grid resolves; others, event by event: test_events.py."""

import numpy as np
import pytest

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
