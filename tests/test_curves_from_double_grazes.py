"""Curves of grazes that begin where both stops are touched at once: a contact beside the touch has no length there."""

import numpy as np
import pytest

import vibro_sweep as vs

SYSTEM = vs.Oscillator.named(
    "one_mass", k=0.5, zeta=0.032426786568557305, F=1.1867729106137581, omega=1.1542366079522295,
    tau=1.7720165452593308, k_stop=254.0789290702244, c_stop=11.8530856014613, b=0.7633548349228891,
)  # fmt: skip
CRITICAL = {"fold_graze": 1.0, "flip_graze": -1.0}


def listed(curve):
    points = [(one.type, *one.parameters.values()) for one in curve.special if one.type in (*CRITICAL, "double_graze")]
    return sorted(points, key=lambda point: point[1:])


@pytest.mark.parametrize("bounds", [((0.229, 1.5), (-0.5, 0.5)), ((0.2, 1.2), (-0.3, 0.5)), ((0.3, 1.0), (-0.4, 0.4))])
def test_the_curve_is_the_same_from_a_touch_and_from_both(bounds):
    """Beside the double graze multipliers move like the square root of the distance: from 1.52 to 1 within 1.3e-8."""
    branch = vs.continue_orbit(vs.periodic_orbit(SYSTEM, itinerary="LR"), "b", (0.229, 1.5))
    both = next(one for one in branch.special if one.type == "graze")
    curve = vs.bifurcation_curve(both, ("b", "offset"), bounds)
    for one in curve.special:
        if one.type in CRITICAL:
            assert np.abs(one.multipliers - CRITICAL[one.type]).min() < 1e-6, one
    double = next(one for one in curve.special if one.type == "double_graze" and abs(one.parameters["offset"]) < 1e-12)
    beside = next(one for one in vs.switch(double) if one.type == "graze" and one.orbit.itinerary == "LLRR")
    again, once = listed(vs.bifurcation_curve(beside, ("b", "offset"), bounds)), listed(curve)
    assert [point[0] for point in once] == [point[0] for point in again] and len(once) >= 5
    np.testing.assert_allclose([point[1:] for point in once], [point[1:] for point in again], atol=1e-12)
