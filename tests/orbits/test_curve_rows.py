"""Each curve of tests/cases/curves.yaml: its points of codimension two, from all starts, with all steps, in digits."""

import copy
import functools
from types import SimpleNamespace

import pytest
from support import cases, curve_rows

SAMPLE = 8  # rows that fast tests follow with other steps and from other points
TABLE = {row.id: row.values[0] for row in cases.rows("curves")}
each_row = pytest.mark.parametrize("row", cases.rows("curves", SAMPLE))
# `tools.search curves-of-table` follows all of them so
some_rows = pytest.mark.parametrize("row", cases.rows("curves", SAMPLE, one_in=4))
SEEN = "folds from a degenerate flip"


@functools.cache
def followed(name: str):
    """(special point, curve) of a row."""
    special = curve_rows.first_point(TABLE[name])
    return special, curve_rows.follow(TABLE[name], special)


@each_row
def test_points_of_codimension_two(row):
    _, curve = followed(row["id"])
    assert not curve_rows.differences(row, curve)
    assert not curve_rows.imprecise(row, curve)


@some_rows
def test_the_same_points_with_other_steps(row):
    assert not curve_rows.with_other_steps(row, followed(row["id"])[0])


@some_rows
def test_the_same_points_from_other_points_of_the_curve(row):
    special, curve = followed(row["id"])
    compared, wrong = curve_rows.from_other_points(row, curve, special)
    assert not wrong
    assert compared >= row.get("least_starts", 1)


@pytest.mark.slow
@some_rows
def test_points_in_30_digits(row):
    special, curve = followed(row["id"])
    counted, wrong = curve_rows.points_off(row, curve, special)
    assert counted >= min(row.get("points", curve_rows.POINTS), 3)
    assert not wrong
    counted, wrong = curve_rows.off_in_digits(row, curve)
    assert counted >= row.get("least_in_digits", 0)
    assert not wrong


def moved(point):
    point[1][0] += 10 * point[2]


def retyped(point):
    point[0] = "cusp" if point[0] != "cusp" else "fold_flip"


@pytest.mark.parametrize("fault", [moved, retyped])
@pytest.mark.parametrize("k", [0, 2, -1])
def test_a_fault_in_a_row_is_seen(fault, k):
    row = copy.deepcopy(TABLE[SEEN])
    fault(row["special"][k])
    assert curve_rows.differences(row, followed(SEEN)[1])


def test_a_point_that_a_row_has_not_and_another_order_are_seen():
    row, (_, curve) = TABLE[SEEN], followed(SEEN)
    special = row["special"]
    for other in (special[:-1], special[1:], [*special[1:2], *special[:1], *special[2:]]):
        assert curve_rows.differences(row | {"special": other}, curve)
    assert curve_rows.differences(row | {"closed": True}, curve)
    assert curve_rows.imprecise(row | {"special": [[*point[:2], point[2] / 10] for point in special]}, curve)


def altered(curve, **changes):
    """A curve with other columns of its points."""
    return SimpleNamespace(
        type=curve.type, parameters=curve.parameters, special=curve.special, points=curve.points.assign(**changes)
    )


@pytest.mark.slow
@pytest.mark.parametrize("change", ["b", "x1", "multiplier_re", "unstable"])
def test_points_that_are_off_are_seen(change):
    name = "pitchforks of the paper over R"
    special, curve = followed(name)
    other = altered(curve, **{change: curve.points[change] * (1 + 1e-4) + (change == "unstable")})
    assert curve_rows.points_off(TABLE[name] | {"points": 2}, other, special)[1]


@pytest.mark.slow
def test_the_distance_from_the_stops_is_that_of_single_orbits():
    """What is farther from the stops than at the point before is not looked at along a curve."""
    compared = 0
    for name in ("pitchforks of the paper", "pairs of the paper"):
        special, curve = followed(name)
        counted, wrong = curve_rows.margins_off(curve, special)
        assert not wrong
        compared += counted
    assert compared >= 8
