"""Systems whose two modes have nearly the same frequency: flights against 50-digit matrix exponentials."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.flow import matrix_of
from reference.gmp import expm
from reference.machine import machine_of

import vibro_sweep as vs


def flown(system, state, times):
    """Free flights from t = 0 in 50 digits, (times, 4)."""
    A = matrix_of(machine_of(system.linear)._replace(contacts=()))
    y = mp.matrix([*map(mpf, state), mp.sin(mpf(system.tau)), mp.cos(mpf(system.tau)), 1])
    return [(expm(A * mpf(t)) * y)[:4] for t in times]


@pytest.mark.parametrize("mu", [1e2, 1e4, 1e6, 1e8, 1e10])
def test_an_orbit_over_a_period(mu):
    system = vs.System(mu_m=mu, mu_k=mu, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=1e5, tau=0.3)
    orbit = vs.simulate(system, (0.3, 0.2, 0.5, -0.4), 1)
    with mp.workdps(50):
        (end,) = flown(system, (0.3, 0.2, 0.5, -0.4), [2 * mp.pi / mpf(system.omega)])
        np.testing.assert_allclose(orbit.section[1], [float(x) for x in end], rtol=0, atol=4e-15)


@pytest.mark.parametrize("zeta", [1e3, 1e4])
def test_a_stiff_flight_beside_a_stop_keeps_its_digits(zeta):
    """The same flight far from the stops and next to one, where every cell is looked into."""
    system = vs.System(mu_m=2.0, mu_k=1.0, zeta=zeta, f2=0.0, omega=1.0, R=0.8, b=1e5, tau=0.3)
    far = vs.simulate(system, (0.3, 0.01, 0.2, -0.01), 2)
    reach = np.abs(far.sample(np.linspace(0.0, 2 * system.period, 4001))[:, 0]).max()
    near = vs.simulate(system.replace(b=reach * (1 + 1e-6)), (0.3, 0.01, 0.2, -0.01), 2)
    assert len(near.impacts) == 0
    np.testing.assert_allclose(near.section, far.section, rtol=0, atol=2e-16)
