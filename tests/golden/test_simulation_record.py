"""Simulated motions, exponents and discontinuity maps are what they were in an earlier version: tests/data/golden."""

import copy

import numpy as np
import pytest

from golden import checking, kept_numbers, records
from golden.kept_numbers import Table
from golden.motions import system_of

KINDS = "simulations", "exponents", "maps"
COMPILED = "paper", "two masses, rigid", "one mass, compliant"  # groups whose kernels other fast tests compile as well
SAMPLE = {"simulations": 40, "exponents": 12, "maps": 8}  # that the fast tests compare
MOST_MASSES = 3  # that slow tests compare; `python -m tools.golden check` compares all
ROW, COLUMN = 2, 2


def sample_of(kind: str) -> list[dict]:
    compiled = [record for record in records.read(kind).values() if record["group"] in COMPILED]
    chosen = np.random.default_rng(44).permutation(len(compiled))[: SAMPLE[kind]]
    return [compiled[k] for k in chosen]


def wrong(kind: str, compared: list[dict]) -> dict[str, list[str]]:
    """What differs, by the names of records."""
    assert sum(kept_numbers.count(record) for record in compared) > 5 * len(compared)
    found = {record["name"]: checking.compared(kind, record) for record in compared}
    return {name: lines for name, lines in found.items() if lines}


@pytest.mark.parametrize("kind", KINDS)
def test_a_sample(kind):
    compared = sample_of(kind)
    assert len(compared) == SAMPLE[kind]
    assert wrong(kind, compared) == {}


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "least"), [("simulations", 170), ("exponents", 85), ("maps", 20)])
def test_oscillators_of_few_masses(kind, least):
    compared = [one for one in records.read(kind).values() if system_of(one["system"]).masses <= MOST_MASSES]
    assert len(compared) >= least
    assert wrong(kind, compared) == {}


@pytest.mark.parametrize("kind", KINDS)
def test_another_damping_is_seen(kind):
    """The whole way, from the oscillator to the words."""
    record = copy.deepcopy(next(one for one in sample_of(kind) if one["group"] == "paper"))
    assert checking.compared(kind, record) == []
    record["system"]["zeta"] *= 1 + 1e-6
    assert len(checking.compared(kind, record)) > 0


# --- faults that are planted: what is computed now is the record itself, but for one thing


def record_with(name: str, kind: str = "simulations") -> dict:
    """The first record that has several rows in the table `name`."""
    return next(one for one in records.read(kind).values() if len(one["result"]["tables"][name]["rows"]) > ROW + 1)


def as_computed(stored: dict) -> dict[str, Table]:
    return {name: Table(np.array(kept["rows"], float), np.ones(1)) for name, kept in stored["tables"].items()}


def differences(stored: dict, **changes) -> list[str]:
    words = changes.pop("words", {})
    tables = as_computed(stored) | {name.replace("_", " "): Table(rows, np.ones(1)) for name, rows in changes.items()}
    return kept_numbers.differences(stored, stored["words"] | words, tables)


def left_out(kept):
    return np.delete(kept["rows"], ROW, axis=0)


def left_out_at_the_end(kept):
    return np.array(kept["rows"])[:-1]


def added(kept):
    return np.insert(kept["rows"], ROW, kept["rows"][ROW], axis=0)


def moved(kept):
    rows = np.array(kept["rows"])
    rows[ROW, 0] += 2 * kept["allowed"][ROW][0]
    return rows


def not_a_number(kept):
    rows = np.array(kept["rows"])
    rows[ROW, 0] = np.nan
    return rows


FAULTS = left_out, left_out_at_the_end, added, moved, not_a_number


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("name", ["impacts", "states at impacts", "contacts", "rests", "section", "samples"])
def test_a_planted_fault_is_seen(name, fault):
    stored = record_with(name)["result"]
    assert differences(stored) == []
    lines = differences(stored, **{name.replace(" ", "_"): fault(stored["tables"][name])})
    assert len(lines) == 1
    assert lines[0].startswith(name)


@pytest.mark.parametrize(("name", "column"), [("impacts", 1), ("contacts", 2), ("rests", 2)])
def test_another_side_is_seen(name, column):
    stored = record_with(name)["result"]
    rows = np.array(stored["tables"][name]["rows"])
    assert set(np.unique(rows[:, column])) <= {-1.0, 1.0}
    rows[ROW, column] *= -1
    assert len(differences(stored, **{name: rows})) == 1


@pytest.mark.parametrize("name", ["impacts", "contacts", "rests"])
def test_an_event_after_the_last_is_seen(name):
    stored = next(one["result"] for one in records.read("simulations").values() if whole(one["result"], name))
    rows = np.array(stored["tables"][name]["rows"])
    assert len(differences(stored, **{name: np.vstack([rows, rows[-1:]])})) == 1


def whole(stored: dict, name: str) -> bool:
    return stored["tables"][name]["whole"] and len(stored["tables"][name]["rows"]) > 0


def test_a_table_that_is_missing_is_seen():
    """As `samples` of an orbit that fails."""
    stored = record_with("samples")["result"]
    tables = as_computed(stored)
    del tables["samples"]
    assert kept_numbers.differences(stored, stored["words"], tables) == ["samples: none now"]


def test_other_words_are_seen():
    stored = record_with("impacts")["result"]
    assert stored["words"] == {"status": "ok", "chatters": 0}
    assert differences(stored, words={"status": "not_finite"}) == ["status: 'ok', now 'not_finite'"]
    assert differences(stored, words={"chatters": 1}) == ["chatters: 0, now 1"]


@pytest.mark.parametrize("kind", KINDS)
def test_each_number_may_move_by_its_allowance_and_not_by_two(kind):
    stored, counted = sample_of(kind)[0]["result"], 0
    for name, kept in stored["tables"].items():
        rows = np.array(kept["rows"], float)
        for at in zip(*np.nonzero(np.isfinite(rows)), strict=True):
            inside, beyond = rows.copy(), rows.copy()
            inside[at] += 0.9 * kept["allowed"][at[0]][at[1]]
            beyond[at] += 2.0 * kept["allowed"][at[0]][at[1]]
            assert differences(stored, **{name.replace(" ", "_"): inside}) == []
            assert len(differences(stored, **{name.replace(" ", "_"): beyond})) == 1
            counted += 1
    assert counted >= 5
