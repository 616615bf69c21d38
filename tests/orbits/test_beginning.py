"""Where a branch begins: at a special point or a bound, in a tiny range, where the parameter breaks the symmetry."""

import numpy as np
import pytest
from support.branches import same_points, types
from support.oscillators import PAPER

import vibro_sweep as vs

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("which", [0, 1, 2])
def test_a_branch_is_the_same_from_each_of_its_special_points(symmetric_branch, one_sided_branch, which):
    """From the graze, the pitchfork, the Neimark-Sacker point: none is lost, and no virtual orbit is followed."""
    for branch in (symmetric_branch, one_sided_branch):
        again = vs.continue_orbit(branch.special[which].orbit, "b", (0.3, 6.8))
        same_points(again, types(branch), 5e-14)
        assert [s.kind for s in again.special] == [s.kind for s in branch.special]


def test_a_branch_is_the_same_from_its_fold():
    orbit = vs.periodic_orbit(PAPER.replace(b=3.0, omega=0.7125), itinerary="LR")
    branch = vs.continue_orbit(orbit, "omega", (0.7121, 0.7135))
    fold = next(special for special in branch.special if special.type == "fold")
    again = vs.continue_orbit(fold.orbit, "omega", (0.7121, 0.7135))
    assert sorted(types(again)) == [(kind, pytest.approx(value, abs=1e-14)) for kind, value in sorted(types(branch))]


def test_a_graze_with_all_real_orbits_out_of_bounds_is_refused(symmetric_branch):
    graze = symmetric_branch.begins
    with pytest.raises(ValueError, match="no orbit beside it in b is real"):
        vs.continue_orbit(graze.orbit, "b", (0.3, graze.parameters["b"]))


@pytest.mark.parametrize("width", [1e-9, 1e-15])
def test_tiny_ranges_have_two_limits(width):
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (2 - width, 2 + width))
    assert [special.type for special in branch.special] == ["boundary", "boundary"] and not branch.closed
    assert [special.parameters["b"] for special in branch.special] == [2 - width, 2 + width]


@pytest.mark.parametrize(("name", "bounds"), [("offset", (-0.3, 0.3)), ("R_left", (0.7, 0.9)), ("R", (0.7, 0.9))])
def test_a_number_that_breaks_the_symmetry(name, bounds):
    """The branch of a symmetric orbit consists of orbits that are not symmetric: each is what the engine simulates."""
    orbit = vs.periodic_orbit(PAPER.replace(b=3.0, R_left=0.8), itinerary="LR")
    assert orbit.symmetric
    branch = vs.continue_orbit(orbit, name, bounds)
    points = branch.points
    assert [special.type for special in branch.special] == ["boundary", "boundary"]
    for i in np.linspace(0, points.sizes["point"] - 1, 5).astype(int):
        point = points.isel(point=i)
        state = [float(point[x]) for x in ("x1", "v1", "x2", "v2")]
        simulated = vs.simulate(orbit.system.replace(**{name: float(point[name])}), state, 1)
        assert np.abs(simulated.section[-1] - state).max() < 1e-11


@pytest.mark.parametrize(
    ("name", "bounds", "limits"),
    [("R", (-1, 3), (0.0, 1.0)), ("zeta", (-1, 0.1), (0.0, 0.1)), ("mu_k", (-2, 20), (0, 20))],
)
def test_a_branch_ends_where_a_number_is_not_allowed_any_more(name, bounds, limits):
    """The free motion far from the stops, whose branch nothing else ends, and an orbit with impacts."""
    system = PAPER.replace(b=50.0 if name == "mu_k" else 3.0)
    orbit = vs.periodic_orbit(system, itinerary="" if name == "mu_k" else "LR")
    branch = vs.continue_orbit(orbit, name, bounds)
    assert [branch.begins.type, branch.ends.type] == ["boundary", "boundary"]
    assert (branch.begins.parameters[name], branch.ends.parameters[name]) == limits


def test_no_torus_is_born_at_the_graze_of_an_undamped_motion():
    """There an undamped mode has multipliers on the unit circle, whatever the parameter."""
    orbit = vs.periodic_orbit(PAPER.replace(zeta=0.0, tau=0.0, b=3.0, stops="right"), itinerary="R")
    special = vs.continue_orbit(orbit, "mu_m", (8, 30)).special
    assert special[-1].type == "graze" and special[-1].impact == 0
    apart = [abs(s.parameters["mu_m"] - special[-1].parameters["mu_m"]) for s in special[:-1]]
    assert min(apart) > 0.1 and [s.type for s in special].count("neimark_sacker") == 3
