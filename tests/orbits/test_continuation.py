"""`continue_orbit`: what rows of tests/cases/branches.yaml do not say."""

import numpy as np
import pytest
from support.oscillators import LONG_CHAIN, ONE_MASS, PAPER

import vibro_sweep as vs

B_STAR = 6.7057167409730219272  # |e_1.(K - omega^2 M + i omega C)^-1 P| in 40 digits


def test_what_begins_at_the_double_graze_of_the_free_motion():
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=6.8), itinerary=""), "b", (6.3, 6.9))
    born = vs.switch(branch.begins)
    assert sorted(orbit.itinerary for orbit in born) == ["L", "LR", "R"]
    assert all(orbit.system.b < B_STAR for orbit in born)


def test_one_mass_oscillator_of_the_literature():
    """arXiv 2510.16218 (evidence.md); the impact speed at the flip and the fold, and zero at the graze."""
    for omega, kind, F, speed in (
        (0.81, "flip", 0.347533397, 0.0653039433),
        (0.799, "fold", 0.362836202, 0.1240873449),
    ):
        orbit = vs.periodic_orbit(ONE_MASS.replace(F=0.37, omega=omega), itinerary="R", periods=2)
        branch = vs.continue_orbit(orbit, "F", (0.3, 0.6))
        special = next(special for special in branch.special if special.type == kind)
        assert special.parameters["F"] == pytest.approx(F, abs=1e-9)
        assert special.orbit.impacts["v1"] == pytest.approx(speed, abs=1e-9)
        assert abs(branch.begins.orbit.impacts["v1"][0]) < 1e-13 and branch.begins.impact == 0


def test_shorter_steps_give_more_points(one_sided_branch):
    orbit = vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R")
    finer = vs.continue_orbit(orbit, "b", (0.3, 6.8), step=0.25)
    assert finer.points.sizes["point"] > 2 * one_sided_branch.points.sizes["point"]


@pytest.mark.parametrize("k", [1, 12, -2])
def test_the_orbit_at_a_point_is_that_of_newtons_method(symmetric_branch, k):
    """And its state, its impacts and its oscillator are those of the point."""
    point, orbit = symmetric_branch.points.isel(point=k), symmetric_branch.orbit(k)
    assert orbit.ok and orbit.symmetric and orbit.itinerary == "LR" and orbit.system.b == float(point.b)
    state = [float(point[name]) for name in ("x1", "v1", "x2", "v2")]
    assert orbit.state == pytest.approx(state, rel=1e-9)  # the point is recorded as steps have left it
    again = vs.periodic_orbit(orbit.system, itinerary="LR")
    assert np.sort(orbit.impacts["v1"]) == pytest.approx(np.sort(again.impacts["v1"]), rel=1e-9)


def test_a_point_that_a_branch_has_not(symmetric_branch):
    count = symmetric_branch.points.sizes["point"]
    with pytest.raises(ValueError, match=f"point: {count} is not allowed; it must be a whole number >= -{count}"):
        symmetric_branch.orbit(count)


@pytest.mark.parametrize(("name", "bounds"), [("omega", (0.75, 0.9)), ("damping", (0.0, 0.2))])
def test_the_unit_of_length_does_not_matter(name, bounds):
    """With force and clearance as many times as large every number of the branch is the same, but for rounding."""

    def branch(scale):
        system = ONE_MASS.replace(F=0.37 * scale, b=scale, omega=0.799)
        return vs.continue_orbit(vs.periodic_orbit(system, itinerary="R", periods=2), name, bounds)

    expected = branch(1.0)
    for scale in (2.0**-40, 2.0**40):  # of which no product is rounded
        found = branch(scale)
        assert found.points.sizes == expected.points.sizes
        assert [one.type for one in found.special] == [one.type for one in expected.special]
        for one, other in zip(found.special, expected.special, strict=True):
            assert one.parameters[name] == pytest.approx(other.parameters[name], abs=max(one.error, 1e-300), rel=0)


@pytest.mark.slow
def test_what_is_born_of_eight_masses():
    graze = vs.continue_orbit(vs.periodic_orbit(LONG_CHAIN, itinerary=""), "b", (0.01, 60)).begins
    (symmetric,) = (orbit for orbit in vs.switch(graze) if orbit.symmetric)
    assert symmetric.itinerary == "LR" and symmetric.system.numbers["b"] > graze.parameters["b"]
    (born,) = (item for item in vs.born_at_grazing(LONG_CHAIN, 1) if item.itinerary == "LR")
    assert born.born == "above" and born.orbit.ok


def test_no_other_branch_begins_at_a_bound():
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    branch = vs.continue_orbit(orbit, "b", (1.9, 2.1))
    assert [special.type for special in branch.special] == ["boundary", "boundary"]
    with pytest.raises(ValueError, match="boundary"):
        vs.switch(branch.ends)


def test_a_graze_with_all_real_orbits_out_of_bounds_is_refused(symmetric_branch):
    graze = symmetric_branch.begins
    with pytest.raises(ValueError, match="no orbit beside it in b is real"):
        vs.continue_orbit(graze.orbit, "b", (0.3, graze.parameters["b"]))


@pytest.mark.parametrize("damping", [{}, {"c_stop": 3.0}, {"c_stop": 3.0, "release": "force"}, {"preload": 2.0}])
def test_the_largest_force_along_a_branch(damping, tmp_path):
    """Against the motion in a fine grid of times, of which a parabola through three has the maximum."""
    soft = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, k_stop=100.0, b=4.0, **damping)
    orbit = vs.periodic_orbit(soft, itinerary="R")
    branch = vs.continue_orbit(orbit, "b", (3.9, 4.1), observe=["contacts"])
    for k in (0, len(branch.points.b) // 2, -1):
        one = branch.orbit(k)
        touch, release = (one.contacts[name][0] for name in ("t_touch", "t_release"))
        inside = np.linspace(touch, release, 20001)
        times = inside if inside[0] > 0 else inside + 2 * np.pi / soft.omega
        x, v = one.sample(times)[:, :2].T
        depth = x - one.system.b
        force = 100.0 * depth + damping.get("c_stop", 0.0) * v + damping.get("preload", 0.0)
        assert branch.points.penetration_max[k].item() == pytest.approx(depth.max(), rel=1e-7)
        assert branch.points.contact_force_max[k].item() == pytest.approx(force[1:-1].max(), rel=1e-3)
        assert branch.points.contact_force_max[k].item() >= force[1:-1].max() * (1 - 1e-12)
    loaded = vs.load(branch.save(tmp_path / "branch.h5"))
    assert loaded.points.identical(branch.points)
    assert loaded.save(tmp_path / "again.h5") and "observe: [contacts]" in vs.open(tmp_path / "again.h5").attrs["scene"]


def test_branches_without_contacts_have_no_force():
    orbit = vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R")
    for wrong in (["contacts"], "contacts", ["impacts"], [3], 5, [["contacts"]]):
        with pytest.raises(ValueError, match="observe: "):
            vs.continue_orbit(orbit, "b", (3.9, 4.1), observe=wrong)
    soft = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, k_stop=100.0, b=9.0)
    free = vs.continue_orbit(vs.periodic_orbit(soft, itinerary=""), "b", (8.9, 9.1), observe=["contacts"])
    assert np.isnan(free.points.contact_force_max).all() and np.isnan(free.points.penetration_max).all()
