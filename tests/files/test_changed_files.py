"""Files, damaged, before every command: a few cases; every kind of file, and more, by `tools.search files`."""

import os
import time
from pathlib import Path

import numpy as np
import pytest
from support import slow_cases
from support.changes import ANY, SAME, Case
from support.file_commands import HALF, READ, REFUSED, Said
from support.fuzz_files import Tried, fuzz, fuzz_kind, judged
from support.worker import Worker


@pytest.mark.parametrize("name", [HALF, *slow_cases("sweep")])
def test_changed_files(kinds, files, name):
    """A case of each kind of damage, before commands that compute nothing; with the others by `tools.search files`."""
    counts, failures = fuzz_kind(kinds, files, name, 1, slow=False, seed=1)
    assert not failures, "\n".join(failures[:20])
    assert counts.total() > 20


# What the search sees


def behaves(what: str):
    """An answer to a command, and what becomes of a worker."""
    if what == "hang":
        time.sleep(60)
    if what == "die":
        os._exit(9)
    return what


def test_a_worker_that_hangs_or_dies_is_replaced():
    worker = Worker(behaves)
    try:
        assert worker("well", seconds=60) == "well"
        assert worker("hang", seconds=1) == "it hung for 1 s"
        assert worker("die", seconds=60) == "the process died"
        assert worker("well", seconds=60) == "well"
    finally:
        worker.close()


NUMBERS = {"status": np.array([0, 0, 0]), "x1": np.array([1.0, 2.0, 3.0])}
OTHER = NUMBERS | {"x1": np.array([1.0, 2.0, 4.0])}
FEWER = {"status": np.array([0, 0, -1]), "x1": np.array([1.0, 2.0, np.nan])}


@pytest.mark.parametrize(
    "name, key, may_give, said, words",
    [
        ("sweep", "open", SAME, Said(READ, "", NUMBERS), None),
        ("sweep", "open", SAME, Said(READ, "", OTHER), "another result, and no word"),
        ("sweep", "open", SAME, Said(READ, "", FEWER), "another result, and no word"),
        ("sweep", "open", ANY, Said(READ, "", OTHER), None),
        ("sweep", "info", SAME, Said(READ, "", "4 orbits"), "another result, and no word"),
        ("sweep", "open", SAME, Said(REFUSED, "x.h5 is damaged: x1"), None),
        ("sweep", "open", SAME, Said(REFUSED, "x1 is damaged"), "the file is not named"),
        ("sweep", "open", SAME, Said(REFUSED, "x.h5: x1: " + "a long text " * 9), "a long text"),
        ("sweep", "open", ANY, "Traceback", "Traceback"),
        (HALF, "run --resume", SAME, Said(READ, "", FEWER), "another result, and no word"),
    ],
)
def test_wrong_answers_are_seen(name, key, may_give, said, words):
    whole = Said(READ, "", "3 orbits" if key == "info" else NUMBERS)
    tried = Tried(name, "x.h5", [key], {key: whole})
    wrong = judged(tried, Case("a change", lambda *_: None, may_give), key, said)
    assert len(wrong) == (words is not None) and all(line.startswith(words) for line in wrong), wrong


@pytest.mark.parametrize(
    "touch, words",
    [
        (lambda: Path("x.h5").write_text("mine"), "x.h5 was changed"),
        (lambda: Path("scene.yaml").unlink(), "scene.yaml was changed"),
        (lambda: Path("new.h5").touch(), "new.h5 was changed"),
        (lambda: Path("x.h5").read_text(), None),
    ],
)
def test_a_command_that_writes_is_seen(tmp_path, monkeypatch, touch, words):
    monkeypatch.chdir(tmp_path)
    for name in ("x.h5", "scene.yaml"):
        Path(name).write_text(name)

    def call(*_, seconds):
        touch()
        return Said(READ, "", "")

    tried = Tried("sweep", "x.h5", ["info"], {"info": Said(READ, "", "")})
    nothing = Case("no change", lambda *_: None)
    counts, failures = fuzz(tried, [nothing], call, seed=1)
    assert counts.total() == 1 and len(failures) == (words is not None)
    assert all(words in line for line in failures), failures
