"""Orbits, branches, curves, searches and windows are what they were in an earlier version: tests/data/golden."""

import copy

import numpy as np
import pytest
from support import slow_cases

from golden import branches, checking, curves, records, searches, windows
from golden.motions import system_of

FEW = {  # of each kind those that the fast tests compare; the others are slow, and oscillators that need kernels
    # which no other test compiles are left to the soak tests
    "branches": ("paper, symmetric, in b", "mirror image 0"),
    "curves": ("paper, symmetric, pitchfork 1",),
    "searches": ("paper, one side",),
    "windows": (),
}
MOST_MASSES = 4


def chosen(kind: str, test):
    return {name: record for name, record in records.read(kind).items() if test(record)}


def wrong(kind: str, records: dict) -> dict[str, list[str]]:
    """What differs, by the names of records."""
    assert records
    found = {name: checking.compared(kind, record) for name, record in records.items()}
    return {name: lines for name, lines in found.items() if lines}


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", [kind for kind in FEW if FEW[kind]])
def test_a_few(kind):
    assert wrong(kind, chosen(kind, lambda record: record["name"] in FEW[kind])) == {}


@pytest.mark.parametrize("kind", list(FEW))
@pytest.mark.slow
def test_oscillators_of_few_masses(kind):
    assert wrong(kind, chosen(kind, lambda record: system_of(record["system"]).masses <= MOST_MASSES)) == {}


@pytest.mark.parametrize("kind", ["branches", "curves"])
@pytest.mark.soak
def test_oscillators_of_many_masses(kind):
    assert wrong(kind, chosen(kind, lambda record: system_of(record["system"]).masses > MOST_MASSES)) == {}


def both_errors(special) -> float:
    return special["error"] + special.get("error now", special["error"])


def without_a_point(result):
    del result["special"][1]
    result["ends"] = [0, len(result["special"]) - 1]


def with_a_point_more(result):
    result["special"].insert(1, copy.deepcopy(result["special"][1]))


def with_a_point_moved(result):
    special = result["special"][1]
    name = next(iter(special["parameters"]))
    special["parameters"][name] += 2 * both_errors(special)


def with_an_end_moved(result):
    special = result["special"][0]
    special["parameters"]["b"] -= 2 * both_errors(special)


def with_another_type(result):
    result["special"][1]["type"] = "fold"


def with_another_label(result):
    special = result["special"][-1]
    special["kind"] = "nonsmooth fold" if special["kind"] == "persistence" else "persistence"


def with_another_itinerary(result):
    result["orbit"]["itinerary"] += "R"


def with_a_point_of_the_branch_moved(result):
    points = result["points"]
    points["v"][20][0] *= 1 + 3 * points["error"][20]


def with_another_multiplier(result):
    points = result["points"]
    for part in ("re", "im"):
        points[part][20][0] *= 1 + 3 * points["multiplier_error"][20]


def with_points_in_another_order(result):
    for values in result["points"].values():
        if isinstance(values, list) and len(values) > 30:
            values[10], values[20] = values[20], values[10]


CHANGES = (
    without_a_point, with_a_point_more, with_a_point_moved, with_an_end_moved, with_another_type, with_another_label,
    with_another_itinerary, with_a_point_of_the_branch_moved, with_another_multiplier, with_points_in_another_order,
)  # fmt: skip


@pytest.fixture(scope="module")
def one():
    """A record of a branch, and that branch."""
    record = records.read("branches")[FEW["branches"][0]]
    return record, branches.followed(record)


@pytest.mark.few(2)
@pytest.mark.parametrize("change", [*CHANGES[:5], *slow_cases(*CHANGES[5:])])
def test_the_comparison_sees(one, change):
    record, branch = one
    rng, changed = np.random.default_rng(1), copy.deepcopy(record["result"])
    assert branches.compared(record, changed, branch, rng) == []
    for kept, now in zip(changed["special"], branch.special, strict=True):
        kept["error now"] = now.error
    change(changed)
    assert len(branches.compared(record, changed, branch, rng)) > 0


@pytest.mark.slow
def test_the_comparison_sees_what_a_curve_lost():
    record = records.read("curves")[FEW["curves"][0]]
    made = curves.traced(record)
    for change in (without_a_point, with_a_point_moved, with_points_in_another_order):
        changed = copy.deepcopy(record["result"])
        change(changed)
        assert len(curves.compared(record, changed, made)) > 0


def test_the_comparison_sees_what_a_search_lost():
    record = records.read("searches")[FEW["searches"][0]]
    found, rng = searches.searched(record), np.random.default_rng(1)
    fewer, moved = copy.deepcopy(record["result"])[:-1], copy.deepcopy(record["result"])
    moved[-1]["parent"] += 1
    assert all(searches.compared(record, changed, found, rng) for changed in (fewer, moved))


@pytest.mark.slow
def test_the_comparison_sees_a_window_that_moved():
    record = next(iter(records.read("windows").values()))
    found = windows.windows_in(records.FOLDER / record["file"])
    changed = copy.deepcopy(record["result"])
    k = next(k for k, window in enumerate(changed["windows"]) if window["ends"][0]["type"] == "graze")
    end = changed["windows"][k]["ends"][0]
    end["parameters"][record["parameter"]] -= 2 * both_errors(end)
    assert windows.compared(record, changed, found) != [] == windows.compared(record, record["result"], found)
