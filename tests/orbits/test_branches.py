"""Each branch of tests/cases/branches.yaml: its special points, from all starts and with all steps, and its orbits."""

import copy
import functools
from types import SimpleNamespace

import pytest
from support import branch_rows, cases

SAMPLE = 24  # rows that fast tests follow with other steps and from other orbits
TABLE = {row.id: row.values[0] for row in cases.rows("branches")}
each_row = pytest.mark.parametrize("row", cases.rows("branches"))
# `tools.search branches-of-table` follows all of them so
some_rows = pytest.mark.parametrize("row", cases.rows("branches", SAMPLE, one_in=4))


@functools.cache
def followed(name: str):
    """(orbit, branch) of a row."""
    orbit = branch_rows.orbit_of(TABLE[name])
    return orbit, branch_rows.follow(TABLE[name], orbit)


@each_row
def test_special_points(row):
    _, branch = followed(row["id"])
    assert not branch_rows.differences(row, branch)
    assert not branch_rows.imprecise(row, branch)


@some_rows
def test_the_same_points_with_other_steps(row):
    assert not branch_rows.with_other_steps(row, followed(row["id"])[0])


@some_rows
def test_the_same_points_from_other_orbits_of_the_branch(row):
    _, branch = followed(row["id"])
    compared, wrong = branch_rows.from_other_orbits(row, branch)
    assert not wrong
    assert compared >= min(2, branch.points.sizes["point"] - 2)


@each_row
def test_points_are_orbits(row):
    orbit, branch = followed(row["id"])
    counted, wrong = branch_rows.not_simulated(row, branch)
    assert counted > 0
    assert not wrong
    if not (orbit.system.linear.compliant or len(orbit.sticking)):
        counted, wrong = branch_rows.against_saltation(row, branch, orbit)
        assert counted > 0
        assert not wrong


def moved(point):
    point[1] += 10 * point[2]


def retyped(point):
    point[0] = "flip"


def turned(point):
    point[3]["direction"] *= -1


@pytest.mark.parametrize("fault", [moved, retyped, turned])
@pytest.mark.parametrize("k", [0, -1])
def test_a_fault_in_a_row_is_seen(fault, k):
    row = copy.deepcopy(TABLE["symmetric orbit of the paper"])
    fault(row["special"][k])
    assert branch_rows.differences(row, followed(row["id"])[1])


def test_a_point_that_a_row_has_not_and_another_order_are_seen():
    row = TABLE["symmetric orbit of the paper"]
    _, branch = followed(row["id"])
    for special in (row["special"][:2], row["special"][1:], [row["special"][k] for k in (1, 0, 2)]):
        assert branch_rows.differences(row | {"special": special}, branch)
    assert branch_rows.imprecise(row | {"special": [[*point[:2], point[2] / 10] for point in row["special"]]}, branch)


def altered(branch, **changes):
    """A branch with other columns of its points."""
    return SimpleNamespace(
        parameter=branch.parameter, special=branch.special, orbit=branch.orbit, points=branch.points.assign(**changes)
    )


@pytest.mark.parametrize("name", ["x1", "v1", "x2", "v2", "impact_v"])
def test_a_point_that_is_no_orbit_is_seen(name):
    row = TABLE["one-sided orbit of the paper"]
    _, branch = followed(row["id"])
    assert branch_rows.not_simulated(row, altered(branch, **{name: branch.points[name] + 1e-6}))[1]


def test_other_impacts_multipliers_and_counts_are_seen():
    row = TABLE["one-sided orbit of the paper"]
    orbit, branch = followed(row["id"])
    points = branch.points
    for change in (
        {"impact_t": points.impact_t + 1e-5},
        {"impact_v": points.impact_v * 1.00001},
        {"multiplier_re": points.multiplier_re * 1.001},
        {"unstable": 2 - points.unstable},
    ):
        assert branch_rows.against_saltation(row, altered(branch, **change), orbit)[1], change


def test_a_bifurcation_that_is_left_out_is_seen_between_points():
    row = TABLE["one-sided orbit of the paper"]
    orbit, branch = followed(row["id"])
    without = altered(branch)
    without.special = [special for special in branch.special if special.type != "neimark_sacker"]
    assert branch_rows.against_saltation(row, without, orbit)[1]
