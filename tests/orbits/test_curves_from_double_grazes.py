"""Both stops are touched at once: curves of grazes that begin there, and the kind of the graze."""

import numpy as np
import pytest
from support import sample

import vibro_sweep as vs

SYSTEM = vs.Oscillator.named(
    "one_mass", k=0.5, zeta=0.032426786568557305, F=1.1867729106137581, omega=1.1542366079522295,
    tau=1.7720165452593308, k_stop=254.0789290702244, c_stop=11.8530856014613, b=0.7633548349228891,
)  # fmt: skip
CRITICAL = {"fold_graze": 1.0, "flip_graze": -1.0}


def listed(curve):
    points = [(one.type, *one.parameters.values()) for one in curve.special if one.type in (*CRITICAL, "double_graze")]
    return sorted(points, key=lambda point: point[1:])


@pytest.mark.parametrize(
    "b, offset",
    sample(1, [((0.229, 1.5), (-0.5, 0.5)), ((0.2, 1.2), (-0.3, 0.5)), ((0.3, 1.0), (-0.4, 0.4))]),
)
def test_the_curve_is_the_same_from_a_touch_and_from_both(b, offset):
    """Beside the double graze multipliers move like the square root of the distance: from 1.52 to 1 within 1.3e-8."""
    branch = vs.continue_orbit(vs.periodic_orbit(SYSTEM, itinerary="LR"), "b", (0.229, 1.5))
    both = next(one for one in branch.special if one.type == "graze")
    curve = vs.bifurcation_curve(both, ("b", "offset"), (b, offset))
    for one in curve.special:
        if one.type in CRITICAL:
            assert np.abs(one.multipliers - CRITICAL[one.type]).min() < 1e-6, one
    double = next(one for one in curve.special if one.type == "double_graze" and abs(one.parameters["offset"]) < 1e-12)
    beside = next(one for one in vs.switch(double) if one.type == "graze" and one.orbit.itinerary == "LLRR")
    again, once = listed(vs.bifurcation_curve(beside, ("b", "offset"), (b, offset))), listed(curve)
    assert [point[0] for point in once] == [point[0] for point in again] and len(once) >= 5
    np.testing.assert_allclose([point[1:] for point in once], [point[1:] for point in again], atol=1e-12)


UNEQUAL = [{"k_stop": 30, "k_stop_left": 10}, {"R": 0.7, "R_left": 0.5}, {"k_stop": 30, "R_left": 0.7}]


@pytest.mark.parametrize("stops", UNEQUAL, ids=str)
def test_a_curve_of_the_free_motion_that_touches_unequal_stops_begins_beside_them(stops):
    """It ends at the double graze where virtual points are left out, as it does from an offset."""
    system = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=0.5, omega=0.8, b=3.0, tau=0.0, **stops)
    graze = vs.continue_orbit(vs.periodic_orbit(system, itinerary=""), "b", (0.2, 6)).begins
    bounds = (0.2, 6), (-0.5, 0.5)
    curve = vs.bifurcation_curve(graze, ("b", "offset"), bounds, virtual=False)
    assert sorted(one.type for one in curve.special) == ["boundary", "double_graze"]
    assert not curve.points.virtual.any()
    (double,) = (one for one in curve.special if one.type == "double_graze")
    assert abs(double.parameters["offset"]) < 1e-14 and double.error < 1e-12
    whole = vs.bifurcation_curve(graze, ("b", "offset"), bounds)
    assert sorted(one.type for one in whole.special) == ["boundary", "boundary", "double_graze"]


def test_the_kind_of_a_graze_of_both_stops_does_not_depend_on_where_the_branch_begins():
    system = vs.Oscillator.named(
        "one_mass", k=0.5, zeta=0.07195170259931487, F=1.3839478009091324, R_left=0.9, k_stop=833.8719642355869,
        c_stop=2.9163163898819127, b=1.2738354238473273, tau="grazing", omega=1.7,
    )  # fmt: skip
    starts = [vs.periodic_orbit(system.replace(omega=omega), itinerary="") for omega in (1.6372444640215726, 1.9, 2.2)]
    ends = [vs.continue_orbit(start, "omega", (0.82, 2.95)).begins for start in starts]
    assert {(end.type, end.kind, end.stop, round(end.parameters["omega"], 12)) for end in ends} == {
        ("graze", "nonsmooth fold", -1, 1.253539559454)
    }
