"""What is there of that which failed: a branch of one point, and no portrait."""

import pytest
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch import not_followed
from vibro_sweep.analysis.periodic.orbit_portrait import portrait


@pytest.mark.parametrize("name, changes", [("b", {}), ("R", {"R": 1.0})], ids=["b", "R at its last value"])
def test_a_branch_that_could_not_be_followed(tmp_path, name, changes):
    branch = not_followed(vs.periodic_orbit(PAPER.replace(b=4.0, **changes), itinerary="R"), name)
    branch.save(tmp_path / "branch.h5")
    again = vs.load(tmp_path / "branch.h5")
    assert again.status == "failed" and again.points.identical(branch.points) and repr(again) == repr(branch)


def test_an_orbit_that_does_not_exist_has_no_portrait():
    assert portrait(vs.periodic_orbit(PAPER.replace(b=50.0), itinerary="R")) == ""
