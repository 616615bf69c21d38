"""Curves of orbits with contacts in files: their points have the same orbits again."""

import numpy as np
import pytest
import xarray as xr
from support import compliant_curves, slow_cases
from support.compliant_branches import drawn_case, follow
from support.scene_texts import parsed

import vibro_sweep as vs


@pytest.mark.slow  # four masses, whose kernels no fast test compiles
def test_a_curve_that_begins_at_a_flip_has_its_contacts_where_the_phase_of_the_force_moves(tmp_path):
    """With tau = "grazing" an end has a phase of the force of its own; half of its doubled orbit is as it was."""
    special = next(one for one in follow(drawn_case(194)).special if one.type == "graze")
    curve = vs.bifurcation_curve(special, ("b", "omega"), ((0.1, 0.14), (0.65, 0.76)))
    assert curve.begins.type == "flip_graze"
    alone = curve.begins.orbit.contacts
    with xr.open_dataset(curve.save(tmp_path / "curve.h5"), engine="h5netcdf") as data:
        lengths = (data["impact_t_off"] - data["impact_t"]).values.reshape(data.sizes["point"], -1)
    touch, *others = np.sort(lengths[0])
    assert abs(touch) < 1e-12
    np.testing.assert_allclose(others, np.sort(np.tile(alone["t_release"] - alone["t_touch"], 2)), rtol=1e-9)
    assert np.isfinite(curve.points.multiplier_re.values[0]).all()


def test_curves_of_contacts_come_back_from_files(tmp_path):
    """They came back as impacts."""
    system = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=0.5, omega=0.8, b=1, tau=0.0, stops="right", k_stop=29)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "omega", (0.3, 3))
    flip = next(one for one in branch.special if one.type == "flip")
    curve = vs.bifurcation_curve(flip, ("omega", "k_stop"), ((0.3, 3), (5, 100)))
    again = vs.load(curve.save(tmp_path / "curve.h5"))
    for one, other in zip(curve.special, again.special, strict=True):
        assert np.abs(one.orbit.state - other.orbit.state).max() < 1e-12
        assert len(one.orbit.contacts) == len(other.orbit.contacts) > 0
        assert np.abs(one.multipliers - other.multipliers).max() < 1e-9


SEARCH = """
system: {type: one_mass, k: 1, zeta: 0.05, F: 0.5, omega: 0.8, b: 1, tau: 0, stops: right, k_stop: 29}
continue: {from: {itinerary: R}, parameter: {omega: [0.3, 3], F: [0.05, 1.5]}, of: [fold], depth: 0}
"""


@pytest.mark.slow
def test_a_search_follows_a_curve_of_contacts_once(tmp_path):
    """Its branch has two folds, and both lie on one curve: a search did not see that the second is known."""
    vs.run(parsed(SEARCH), tmp_path / "curves.h5")
    (curve,) = vs.load(tmp_path / "curves.h5")
    assert curve.type == "fold" and "cusp" in [one.type for one in curve.special]


THREE_MASSES = slow_cases((6, {"closed"}))  # each number of masses compiles kernels of its own


@pytest.mark.slow
@pytest.mark.parametrize("seed, types", [*THREE_MASSES, (8, {"flip_graze"}), (26, {"resonant_graze"})])
def test_points_of_codimension_two_are_the_same_from_a_file(seed, types, tmp_path):
    """Those at the birth of doubled orbits, where a touch vanishes, and where a curve comes back to its first point."""
    case, met = drawn_case(seed), set()
    for special in [one for one in follow(case).special if one.type in compliant_curves.TYPES][:3]:
        names = case.name, "b" if case.name != "b" else "omega"
        values = special.parameters[case.name], special.orbit.system.numbers[names[1]]
        bounds = [(0.6 * value, 1.4 * value) for value in values]
        curve = vs.bifurcation_curve(special, names, bounds)
        saved = vs.load(curve.save(tmp_path / f"{len(met)}-{special.parameters[case.name]}.h5"))
        for one, again in zip(curve.special, saved.special, strict=True):
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
