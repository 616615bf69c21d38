"""Ends of curves in the preload of a stop: at zero, and where the contact vanishes with it."""

import numpy as np
import pytest
from support import sample

import vibro_sweep as vs


def machine(**numbers):
    return vs.Oscillator.named("one_mass", b=1, tau=0, **{"stops": "right"} | numbers)


def curves_in_preload(system, itinerary="R"):
    """(type, curve) of the special points of its branch in omega."""
    bounds = 0.6 * system.omega, 1.6 * system.omega
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary=itinerary), "omega", bounds)
    for one in branch.special:
        if one.type in ("fold", "flip", "pitchfork", "graze"):
            yield one.type, vs.bifurcation_curve(one, ("omega", "preload"), (bounds, (0, 0.5)))


def passes_its_stop_by(system, omega):
    return float(vs.grazing(system.replace(omega=omega)).b_right) - 1


def longest_contact(orbit):
    return np.max(orbit.contacts["t_release"] - orbit.contacts["t_touch"])


@pytest.mark.parametrize(
    ("system", "itinerary", "kind"),
    sample(
        1,
        [
            (machine(k_stop=3, zeta=0.05, F=0.5, omega=0.79, preload=0.01, release="force"), "R", "flip"),
            (machine(k_stop=29, c_stop=1, zeta=0.02, F=1, omega=1.007, preload=0.01), "R", "fold"),
            (
                machine(k_stop=3, c_stop=2, zeta=0.05, F=0.5, omega=0.8224, preload=0.05, stops="both"),
                "LR",
                "pitchfork",
            ),
        ],
    ),
)
def test_where_preload_and_contact_vanish_the_free_motion_touches_the_stop(system, itinerary, kind):
    lost = []
    for of_type, curve in curves_in_preload(system, itinerary):
        assert {"failed"}.isdisjoint(one.type for one in curve.special)
        ends = [one for one in curve.special if one.type == "boundary" and one.parameters["preload"] == 0]
        lost += [one for one in ends if of_type == kind and longest_contact(one.orbit) < 1e-6]
    assert lost
    for one in lost:
        assert abs(passes_its_stop_by(system, one.parameters["omega"])) < 1e-13
        assert longest_contact(one.orbit) < 1e-13


@pytest.mark.parametrize("c_stop", sample(1, [0.0, 1.0]))
@pytest.mark.parametrize("release", ["displacement", "force"])
def test_curves_of_grazes_do_not_know_of_the_preload(c_stop, release):
    """They are straight, and end at both of its bounds; without a damper and by force they ended before zero."""
    system, counted = (
        machine(k_stop=290, c_stop=c_stop, zeta=0.02, F=0.5, omega=0.894, preload=0.05, release=release),
        0,
    )
    for of_type, curve in curves_in_preload(system):
        if of_type == "graze" and len(curve.special[0].orbit.contacts) == 1:
            ends = [one.parameters for one in curve.special if one.type == "boundary"]
            assert sorted(one["preload"] for one in ends) == [0, 0.5]
            assert ends[0]["omega"] == pytest.approx(ends[1]["omega"], abs=1e-13)
            counted += 1
    assert counted
