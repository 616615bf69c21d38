"""Ends of branches at which the contact with an elastic stop vanishes: its own equations are singular there."""

import numpy as np
import pytest
from support import sample
from support.drawn_branches import Case
from support.same_branch import follow

import vibro_sweep as vs

ELASTIC = vs.Oscillator.named("one_mass", zeta=0.05, F=0.5, omega=0.9, b=0.6, k_stop=29, stops="right", tau=0)
DAMPED = ELASTIC.replace(c_stop=0.4)


def of_the_free_motion(system):
    """exp(lambda T) of x'' + 2 zeta x' + x = 0."""
    rate = complex(-system.zeta, np.sqrt(1 - system.zeta**2))
    return np.exp(np.array([rate, rate.conjugate()]) * system.period)


@pytest.mark.parametrize("system", [ELASTIC, DAMPED], ids=["elastic", "damped"])
@pytest.mark.parametrize("upper", sample(1, [2.5, 2.6, 3.0, 4.0]))
def test_all_bifurcations_are_kept_whatever_the_bounds(system, upper):
    """Where rounding made the last equations singular to the last bit all flips before were taken back."""
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (0.5, upper))
    special = {one.type: one for one in branch.special}
    assert [one.type for one in branch.special] == ["boundary", "flip", "flip", "graze"]
    assert special["graze"].parameters["b"] == pytest.approx(float(vs.grazing(system).b_right), abs=1e-14)
    assert all(one.error < 1e-13 for one in branch.special)


@pytest.mark.parametrize("system", [ELASTIC, DAMPED], ids=["elastic", "damped"])
@pytest.mark.parametrize("before", sample(1, [1e-4, 1e-6, 1e-8, 1e-10]))
def test_bounds_just_before_the_graze_hold(system, before):
    """A step over the graze, at which the branch turns, ends within the bounds again."""
    upper = float(vs.grazing(system).b_right) - before
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (0.5, upper))
    assert [one.type for one in branch.special] == ["boundary", "flip", "flip", "boundary"]
    assert branch.ends.parameters["b"] == upper and branch.points.b.max() == upper


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


def test_rounding_beside_the_graze_at_which_a_branch_cannot_go_on_is_no_fold():
    """With shorter steps both contacts had vanished at the last point, and a fold was listed there."""
    system = vs.Oscillator.named(
        "one_mass", k=1.5406729141375952, zeta=0.08334301017306767, F=0.2817480531964948, omega=1.397073462083662,
        k_stop=69.08732688701915, c_stop=0.0, k_stop_left=27.360630054753283, c_stop_left=0.3473744701999591,
        b=0.4856720359594633, tau=3.5999475395669833,
    )  # fmt: skip
    case = Case(vs.periodic_orbit(system, itinerary="LR"), "omega", (0.419122039, 4.19122039))
    for factor in (0.5, 1.0):
        assert [one.type for one in follow(case, factor).special] == ["graze", "flip", "fold", "fold", "graze"]
