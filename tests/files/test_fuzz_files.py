"""The fuzz of files and parts: a few cases always, a sample with `-m slow`, all of them with `-m soak`."""

import collections
import os

import pytest
from support.fuzz_files import COMMANDS, OUTCOMES, fuzz

NAMES = "whole.h5", "half.h5.part"


@pytest.mark.parametrize(
    ("name", "few"),
    [
        pytest.param("whole.h5", 1, id="few"),
        *(pytest.param(name, 8, id=f"sample of {name}", marks=pytest.mark.slow) for name in NAMES),
        *(pytest.param(name, None, id=f"all of {name}", marks=pytest.mark.soak) for name in NAMES),
    ],
)
def test_damaged_files(files, tmp_path, monkeypatch, capsys, name, few):
    monkeypatch.chdir(tmp_path)
    counts, failures = fuzz(files, files / name, few)
    if few is None:
        with capsys.disabled():
            print(f"\n{name}\n{table(counts)}")
    assert not failures, "\n".join(failures[:20])
    assert os.listdir() == []


def table(counts: collections.Counter) -> str:
    rows = ["| | command | " + " | ".join(OUTCOMES) + " |", "| --- | --- |" + " ---: |" * len(OUTCOMES)]
    for kind in dict.fromkeys(kind for kind, _, _ in counts):
        for command in COMMANDS:
            found = [counts[kind, command, outcome] for outcome in OUTCOMES]
            rows.append(f"| {kind} | {command} | {' | '.join(map(str, found))} |")
    return "\n".join(rows)
