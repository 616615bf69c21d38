"""Orbits, branches, curves, searches and windows are what they were in an earlier version: tests/data/golden."""

import copy

import numpy as np
import pytest
from support import sample, slow_cases

from golden import births, branches, checking, curves, onsets, records, searches, windows
from golden.motions import system_of

FEW = {  # of each kind those that the fast tests compare; the others are slow, and oscillators that need kernels
    # which no other test compiles are left to `tools.golden check`
    "branches": ("paper, symmetric, in b", "mirror image 0"),
    "curves": ("paper, symmetric, pitchfork 1",),
    "searches": ("paper, one side",),
    "windows": (),
}
MOST_MASSES = 4
WITH_CONTACTS = "compliant, one mass, its clearance"  # the fast tests compile kernels of one mass with compliant stops
MOVED = 1e-11  # of contacts: more than rounding of omega does to the orbit
LATER = ("compliant_branches", "compliant_curves", "compliant_searches", "compliant_windows", "births", "onsets")


def chosen(kind: str, test):
    return {name: record for name, record in records.read(kind).items() if test(record)}


def one_in_five_of(kind: str, masses: int):
    """One in five of the records of oscillators with so many masses or fewer; `tools.golden check` compares all."""
    records = chosen(kind, lambda record: system_of(record["system"]).masses <= masses)
    return {name: records[name] for name in list(records)[::5]}


def wrong(kind: str, records: dict) -> dict[str, list[str]]:
    """What differs, by the names of records."""
    assert records
    found = {name: checking.compared(kind, record) for name, record in records.items()}
    return {name: lines for name, lines in found.items() if lines}


@pytest.mark.parametrize("kind", sample(1, [kind for kind in FEW if FEW[kind]]))
def test_a_few(kind):
    assert wrong(kind, chosen(kind, lambda record: record["name"] in FEW[kind])) == {}


@pytest.mark.parametrize("kind", list(FEW))
@pytest.mark.slow
def test_oscillators_of_few_masses(kind):
    assert wrong(kind, one_in_five_of(kind, MOST_MASSES)) == {}


def test_a_branch_with_contacts():
    assert wrong("compliant_branches", chosen("compliant_branches", lambda one: one["name"] == WITH_CONTACTS)) == {}


@pytest.mark.parametrize("kind", LATER)
@pytest.mark.slow
def test_up_to_two_masses(kind):
    """Those of more masses, which need kernels of their own, are compared by `tools.golden check`."""
    assert wrong(kind, one_in_five_of(kind, 2)) == {}


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
    ends = [result["special"][k] for k in result["ends"]]
    special = next(one for one in ends if one["type"] != "boundary")
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


def with_another_speed(result):
    result["points"]["v"][20][0] *= 1 + MOVED


def with_a_contact_that_lasts_longer(result):
    points = result["points"]
    points["contacts"][20][0][0] += MOVED


def with_another_force(result):
    points = result["points"]
    points["contacts"][20][0][2] *= 1 + MOVED


OF_CONTACTS = (with_a_contact_that_lasts_longer, with_another_force, with_another_speed)
OF_ROUNDING = (with_a_point_of_the_branch_moved,)  # by less than rounding of omega moves the orbit with contacts


@pytest.fixture(scope="module")
def one():
    """A record of a branch, and that branch."""
    record = records.read("branches")[FEW["branches"][0]]
    return record, branches.followed(record)


@pytest.fixture(scope="module")
def one_with_contacts():
    record = records.read("compliant_branches")[WITH_CONTACTS]
    return record, branches.followed(record)


@pytest.mark.parametrize("change", sample(2, CHANGES))
def test_the_comparison_sees(one, change):
    seen(*one, change)


@pytest.mark.parametrize("change", [*OF_CONTACTS, *slow_cases(*(one for one in CHANGES if one not in OF_ROUNDING))])
def test_the_comparison_sees_with_contacts(one_with_contacts, change):
    seen(*one_with_contacts, change)


def seen(record, branch, change):
    rng, changed = np.random.default_rng(1), copy.deepcopy(record["result"])
    assert branches.compared(record, changed, branch, rng) == []
    for kept, now in zip(changed["special"], branch.special, strict=True):
        kept["error now"] = now.error
    change(changed)
    assert len(branches.compared(record, changed, branch, rng)) > 0


@pytest.mark.parametrize("kind, name", [("curves", FEW["curves"][0]), ("compliant_curves", None)])
@pytest.mark.slow
def test_the_comparison_sees_what_a_curve_lost(kind, name):
    """Of compliant stops the first curve of one mass."""
    able = chosen(kind, lambda one: name in (one["name"], None) and system_of(one["system"]).masses <= 2)
    record = next(iter(able.values()))
    made = curves.traced(record)
    for change in (without_a_point, with_a_point_moved, with_points_in_another_order):
        changed = copy.deepcopy(record["result"])
        change(changed)
        assert len(curves.compared(record, changed, made)) > 0


@pytest.mark.parametrize(
    "kind, name",
    [("searches", FEW["searches"][0]), *slow_cases(("compliant_searches", "compliant 1.100003.0, one_mass"))],
)
def test_the_comparison_sees_what_a_search_lost(kind, name):
    record = records.read(kind)[name]
    found, rng = searches.searched(record), np.random.default_rng(1)
    fewer, moved = copy.deepcopy(record["result"])[:-1], copy.deepcopy(record["result"])
    moved[-1]["parent"] += 1
    assert all(searches.compared(record, changed, found, rng) for changed in (fewer, moved))


@pytest.mark.parametrize("kind", ["windows", "compliant_windows"])
@pytest.mark.slow
def test_the_comparison_sees_a_window_that_moved(kind):
    record = next(iter(records.read(kind).values()))
    found = windows.windows_in(records.FOLDER / record["file"])
    changed = copy.deepcopy(record["result"])
    k = next(k for k, window in enumerate(changed["windows"]) if window["ends"][0]["type"] == "graze")
    end = changed["windows"][k]["ends"][0]
    end["parameters"][record["parameter"]] -= 2 * both_errors(end)
    assert windows.compared(record, changed, found) != [] == windows.compared(record, record["result"], found)


def test_the_comparison_sees_what_is_born_otherwise():
    result = next(iter(records.read("births").values()))["result"]
    fewer, faster, above = result[1:], copy.deepcopy(result), copy.deepcopy(result)
    faster[0]["speeds"][0] += 3 * faster[0]["allowed"][0]
    above[0]["born"] = "above" if above[0]["born"] == "below" else "below"
    assert births.compared(result, result) == []
    assert all(births.compared(result, changed) for changed in (fewer, faster, above))


def test_the_comparison_sees_an_onset_that_moved():
    record = next(one for one in records.read("onsets").values() if any(one["result"]))
    lost, moved = copy.deepcopy(record["result"]), copy.deepcopy(record["result"])
    k = next(k for k, one in enumerate(moved) if one is not None)
    lost[k] = None
    moved[k]["parameters"][record["parameter"]] += 3 * moved[k]["error"]
    assert onsets.compared(record, record["result"], record["result"]) == []
    assert all(onsets.compared(record, changed, record["result"]) for changed in (lost, moved))
