"""The help of the program and of each command is what it was in an earlier version: tests/data/golden."""

import pytest

from golden import checking, records, texts

RECORDS = records.read("texts")


@pytest.mark.parametrize("name", RECORDS, ids=lambda name: name or "the program")
def test_help(name):
    assert checking.compared("texts", RECORDS[name]) == []


def test_each_command_has_a_record():
    assert [*RECORDS] == texts.commands() and len(RECORDS) == 13


CHANGES = [
    ("run", lambda text: text.replace("Compute a scene", "Compute"), "-  Compute and write its HDF5 file."),
    ("run", lambda text: text + "another line\n", "-another line"),
    ("run", lambda text: text.partition("Options:")[0], "+Options:"),
    ("start", lambda text: text, "LookupError: start --help ended with 2: vibro-sweep: error: there is no command"),
]


@pytest.mark.parametrize("name, change, line", CHANGES)
def test_a_change_is_seen(name, change, line):
    record = {"name": name, "commands": [], "text": change(RECORDS["run"]["text"])}
    assert any(found.startswith(line) for found in checking.compared("texts", record))


def test_another_list_of_commands_is_seen():
    record = RECORDS[""] | {"commands": RECORDS[""]["commands"][:-1]}
    assert len(checking.compared("texts", record)) == 1
