"""Curves of orbits with contacts as arrays and files: their points have the same orbits again."""

import numpy as np
import pytest
from support import compliant_curves, slow_cases
from support.compliant_branches import drawn_case, follow

import vibro_sweep as vs
from vibro_sweep.analysis.curves.curve_arrays import arrays_of, curve_of
from vibro_sweep.analysis.curves.curve_search import Curves, seed_at


@pytest.mark.slow  # four masses, whose kernels no fast test compiles
def test_a_curve_that_begins_at_a_flip_has_its_contacts_where_the_phase_of_the_force_moves():
    """With tau = "grazing" an end has a phase of the force of its own; half of its doubled orbit is as it was."""
    special = next(one for one in follow(drawn_case(194)).special if one.type == "graze")
    curve = vs.bifurcation_curve(special, ("b", "omega"), ((0.1, 0.14), (0.65, 0.76)))
    assert curve.begins.type == "flip_graze"
    arrays, alone = arrays_of(curve), curve.begins.orbit.contacts
    touch, *lengths = np.sort(arrays["impact_t_off"] - arrays["impact_t"], axis=1).T
    assert abs(touch[0]) < 1e-12
    twice = np.sort(np.tile(alone["t_release"] - alone["t_touch"], 2))
    np.testing.assert_allclose([length[0] for length in lengths], twice, rtol=1e-9)
    assert np.isfinite(curve.points.multiplier_re.values[0]).all()


def test_curves_of_contacts_come_back_from_files_and_know_their_own_points(tmp_path):
    """They came back as impacts, and a search did not see that a point lies on a curve."""
    system = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=0.5, omega=0.8, b=1, tau=0.0, stops="right", k_stop=29)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "omega", (0.3, 3))
    flip = next(one for one in branch.special if one.type == "flip")
    names, bounds = ("omega", "k_stop"), np.array(((0.3, 3), (5, 100)))
    curve = vs.bifurcation_curve(flip, names, bounds)
    curve.save(tmp_path / "curve.h5")
    for one, again in zip(curve.special, vs.load(tmp_path / "curve.h5").special, strict=True):
        assert np.abs(one.orbit.state - again.orbit.state).max() < 1e-12
        assert len(one.orbit.contacts) == len(again.orbit.contacts) > 0
        assert np.abs(one.multipliers - again.multipliers).max() < 1e-9
    assert Curves(names, bounds, ()).passes(arrays_of(curve), seed_at(flip, names))


THREE_MASSES = slow_cases((6, {"closed"}))  # each number of masses compiles kernels of its own


@pytest.mark.slow
@pytest.mark.parametrize("seed, types", [*THREE_MASSES, (8, {"flip_graze"}), (26, {"resonant_graze"})])
def test_points_of_codimension_two_are_the_same_from_their_arrays(seed, types):
    """Those at the birth of doubled orbits, where a touch vanishes, and where a curve comes back to its first point."""
    case, met = drawn_case(seed), set()
    for special in [one for one in follow(case).special if one.type in compliant_curves.TYPES][:3]:
        names = case.name, "b" if case.name != "b" else "omega"
        values = special.parameters[case.name], special.orbit.system.numbers[names[1]]
        bounds = [(0.6 * value, 1.4 * value) for value in values]
        curve = vs.bifurcation_curve(special, names, bounds)
        for one, again in zip(
            curve.special, curve_of(arrays_of(curve), names, special.orbit.system).special, strict=True
        ):
            met.add(one.type)
            for name in ("itinerary", "period", "status"):
                assert getattr(one.orbit, name) == getattr(again.orbit, name)
            assert (one.type, one.stop, one.impact, one.touches) == (
                again.type,
                again.stop,
                again.impact,
                again.touches,
            )
            least = np.abs(one.multipliers[:, None] - again.multipliers).min(axis=1)
            assert np.all((least < 1e-6) | (np.abs(one.multipliers) > 1e6))
    assert types <= met
