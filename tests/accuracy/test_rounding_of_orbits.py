"""Errors of exponents and multipliers of periodic orbits include the rounding of the orbit: against 30 digits."""

import numpy as np
import pytest
from support import slow_cases
from support.rounded_orbits import WANTED, study
from support.searching import searched

import vibro_sweep as vs


def test_an_orbit_of_period_eleven():
    """Rounding of its state by 1e-16 moves the logarithm of its largest multiplier by 1e-10."""
    g = 2.4260713206414097e-09
    numbers = dict(omega=1.6577062622064886, R=0.6939439053540507, b=0.10154257757748547, tau=0.3)
    system = vs.Oscillator(
        M=np.eye(2), K=np.eye(2), C=[[0.3, -g], [-g, 0.3]], contact_normal=[1, -1], force=[1, 0.5], **numbers
    )
    data = vs.sweep(system, {"b": [system.b]}, observe=WANTED, transient=1300, record=200).isel(b=0)
    assert data.period == 11
    far = abs(float(data.lyapunov[0]) + 0.03375634201447768)
    assert far <= 2 * data.lyapunov_error[0] < 1e-10 and far > 1e-13


@pytest.mark.parametrize("count", slow_cases(2, 12))
def test_random_orbits(count):
    """Three in a hundred may be off by more than twice the error."""
    counted, wrong = searched(study, range(20, 20 + count))
    assert wrong == [] and counted["exponents"] >= count
    for name in ("exponents", "multipliers"):
        assert counted[f"{name} up to 5"] <= 0.03 * counted[name]
