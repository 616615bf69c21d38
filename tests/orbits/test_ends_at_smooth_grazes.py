"""Ends of branches at which the contact with an elastic stop vanishes: its own equations are singular there."""

import numpy as np
import pytest

import vibro_sweep as vs

ELASTIC = vs.Oscillator.named("one_mass", zeta=0.05, F=0.5, omega=0.9, b=0.6, k_stop=29, stops="right", tau=0)
DAMPED = ELASTIC.replace(c_stop=0.4)


def of_the_free_motion(system):
    """exp(lambda T) of x'' + 2 zeta x' + x = 0."""
    rate = complex(-system.zeta, np.sqrt(1 - system.zeta**2))
    return np.exp(np.array([rate, rate.conjugate()]) * system.period)


@pytest.mark.parametrize("system", [ELASTIC, DAMPED], ids=["elastic", "damped"])
def test_multipliers_of_the_touch_are_those_of_the_free_motion(system):
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (0.5, 3.0))
    last, exact = branch.points.isel(point=-1), of_the_free_motion(system)
    np.testing.assert_allclose(last.multiplier_re + 1j * last.multiplier_im, exact, rtol=0, atol=1e-12)
    np.testing.assert_allclose(branch.ends.multipliers, exact, rtol=0, atol=1e-12)
    np.testing.assert_allclose(branch.ends.orbit.multipliers, exact, rtol=0, atol=1e-12)
    assert last.unstable == 0 and branch.ends.orbit.stable


def test_multipliers_jump_where_a_damped_contact_ends_by_force():
    """Of its branch they are the limit from the side with the contact, as those of its special point."""
    system = ELASTIC.replace(c_stop=0.4, release="force")
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (0.5, 3.0))
    last, orbit = branch.points.isel(point=-1), branch.ends.orbit
    assert branch.ends.type == "graze"
    np.testing.assert_allclose(orbit.multipliers, branch.ends.multipliers, rtol=0, atol=1e-12)
    np.testing.assert_allclose(last.multiplier_re + 1j * last.multiplier_im, orbit.multipliers, rtol=0, atol=1e-12)
    assert np.abs(orbit.multipliers - of_the_free_motion(system)).max() > 0.05
    apart = []
    for beside in (1e-6, 1e-8):
        bounds = 0.5, branch.ends.parameters["b"] - beside
        struck = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", bounds).ends
        apart.append(np.abs(struck.multipliers - orbit.multipliers).max())
    assert apart[0] / apart[1] == pytest.approx(10, rel=0.05)  # like the square root
