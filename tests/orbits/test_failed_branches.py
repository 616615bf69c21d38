"""Branches that cannot be followed say so, and lose nothing else."""

import numpy as np
import pytest
from support.branches import types
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches import births, branch_search, branch_start
from vibro_sweep.analysis.branches.branch_arrays import arrays_of, special_point
from vibro_sweep.analysis.continuation import first_point
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of

BOUNDS = (0.3, 6.8)
FLAT = vs.System(
    mu_m=8.379769014161136, mu_k=3.8163220400771807, zeta=0.028200222924778515, f2=0.9337335869439435,
    omega=1.2384170377684125, R=0.639, b=0.08630475621966693, tau=0.25528644319765714, offset=-0.0027889332142134425,
)  # fmt: skip


@pytest.fixture(scope="module")
def flat_flip():
    """A flip from which the doubled orbits leave with hardly any change of f2."""
    state = vs.simulate(FLAT, np.zeros(4), 600).section[-1]
    orbit = vs.periodic_orbit(FLAT, state=state, periods=19)
    branch = vs.continue_orbit(orbit, "f2", (0.8870469075967463, 0.9804202662911407))
    return [special for special in branch.special if special.type == "flip"][-1]


def test_a_branch_that_cannot_be_started_says_so(flat_flip, monkeypatch):
    """It is started a little farther off; where nothing is found there either, its orbit is all that is left of it."""
    value = flat_flip.parameters["f2"]
    bounds = (value - 1e-3, value + 1e-3)
    with monkeypatch.context() as patch:
        patch.setattr(births, "is_steady", lambda *_: True)  # at the usual amplitude
        near = births.born(flat_flip.orbit._solution, "f2", 1)
    orbit = orbit_of(FLAT.replace(f2=near.family.numbers["f2"]), near)
    assert orbit.ok and vs.continue_orbit(orbit, "f2", bounds).ok
    monkeypatch.setattr(branch_start, "FARTHER", ())
    monkeypatch.setattr(first_point, "STILL", -1.0)  # as where Newton's method does not stand still
    branch = vs.continue_orbit(orbit, "f2", bounds)
    assert branch.status == "failed" and not branch.ok
    assert branch.points.sizes["point"] == 1 and float(branch.points.f2[0]) == orbit.system.f2
    assert types(branch) == [("failed", orbit.system.f2)] and branch.begins is branch.ends
    np.testing.assert_array_equal([float(branch.points[name][0]) for name in ("x1", "v1", "x2", "v2")], orbit.state)


def test_one_branch_that_fails_loses_no_other(monkeypatch):
    """A seed whose orbit has no real neighbour within the bounds; here the first that is born at the pitchfork, whose
    mirror image is then followed."""
    orbit, count = vs.periodic_orbit(PAPER, itinerary="LR"), 0
    whole = vs.follow_branches(orbit, "b", BOUNDS)

    def second_fails(*args, **more):
        nonlocal count
        count += 1
        if count == 2:
            raise ValueError("orbit: it is a special point")
        return vs.continue_orbit(*args, **more)

    monkeypatch.setattr(branch_search, "continue_orbit", second_fails)
    found = vs.follow_branches(orbit, "b", BOUNDS)
    assert [item.branch.status for item in found] == ["ok", "ok", "failed", "ok", "ok"]
    assert [types(item.branch) for item in (*found[:2], found[4])] == [types(whole[i].branch) for i in (0, 1, 3)]
    assert types(found[3].branch) == [(kind, pytest.approx(value, abs=1e-12)) for kind, value in types(whole[2].branch)]
    assert types(found[2].branch) == [("failed", found[2].branch.begins.orbit.system.b)]
    arrays = arrays_of(found[2].branch, found[2].branch.begins.orbit.system.b)
    assert (
        arrays["branch_status"] == 1
        and len(arrays["value"]) == 1
        and arrays["branch_ends"] == arrays["branch_begins"] == 0
    )
    again = special_point(arrays, 0, "b", PAPER)
    np.testing.assert_allclose(again.orbit.state, found[2].branch.begins.orbit.state, rtol=1e-12)
