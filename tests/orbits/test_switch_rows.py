"""Each point of tests/cases/switches.yaml: the orbits that `switch` gives there, their motions, and their branches."""

import copy
import functools

import pytest
from support import branch_rows, cases, switch_rows

import vibro_sweep as vs

TABLE = {row.id: row.values[0] for row in cases.rows("switches")}
BORN = [row for row in cases.rows("switches", 8) if "special" in row.values[0]]  # others are slow
WITHOUT = ("graze of the paper", "free ball that strikes no more")  # multipliers of 1e6; no orbit
SEEN = "asymmetric orbits of the paper"


@functools.cache
def switched(name: str):
    """(special point, orbits) of a row."""
    special = switch_rows.point_of(TABLE[name])
    return special, vs.switch(special)


@functools.cache
def born(name: str):
    """The branch of the first orbit."""
    return branch_rows.follow(switch_rows.row_of_branch(TABLE[name]), switched(name)[1][0])


@pytest.mark.parametrize("row", cases.rows("switches"))
def test_what_begins_there(row):
    _, orbits = switched(row["id"])
    assert switch_rows.words(orbits) == row["born"]
    assert all(orbit.ok for orbit in orbits)
    counted, wrong = switch_rows.not_simulated(orbits)
    assert not wrong and (counted > 0 or row["id"] in WITHOUT)


@pytest.mark.parametrize("row", BORN)
def test_the_branch_that_is_born_comes_back_to_its_birth(row):
    special, branch = switched(row["id"])[0], born(row["id"])
    expected = switch_rows.row_of_branch(row)
    assert not branch_rows.differences(expected, branch)
    assert not branch_rows.imprecise(expected, branch)
    assert not switch_rows.not_back(special, branch)
    counted, wrong = branch_rows.not_simulated(expected, branch)
    assert counted and not wrong


@pytest.mark.slow
@pytest.mark.parametrize("row", BORN)
def test_the_same_branch_with_other_steps(row):
    expected = switch_rows.row_of_branch(row)
    for step in row.get("steps", switch_rows.STEPS):
        branch = branch_rows.follow(expected, switched(row["id"])[1][0], step)
        assert not branch_rows.differences(expected, branch), step


def test_rows_have_branches():
    assert len(TABLE) > len(BORN) >= 10


def test_a_fault_in_a_row_is_seen():
    row = copy.deepcopy(TABLE[SEEN])
    _, orbits = switched(SEEN)
    assert switch_rows.words(orbits[:1]) != row["born"]
    for k, value in enumerate(("LR", 2, True, True)):
        changed = copy.deepcopy(row["born"])
        changed[0][k] = value if changed[0][k] != value else None
        assert switch_rows.words(orbits) != changed
    row["special"][0][1] += 10 * row["special"][0][2]
    assert branch_rows.differences(switch_rows.row_of_branch(row), born(SEEN))
    assert switch_rows.not_back(switched("graze of the paper")[0], born(SEEN))


def test_an_orbit_that_does_not_come_back_is_seen():
    _, orbits = switched(SEEN)
    orbit = copy.copy(orbits[0])
    object.__setattr__(orbit, "system", orbit.system.replace(b=1.001 * orbit.system.b))
    assert switch_rows.not_simulated([orbit])[1]
