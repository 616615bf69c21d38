"""Usual slips of new users (tests/cases/slips.yaml): each is answered, with its exit status, by words that help."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from support import cases
from support.programs import ended

NUMBER = {"scene": 34, "command": 10, "python": 8}
SLOW = {  # of the processes, those that take more than two seconds
    *("measured_points", "output_exists", "windows_without_sections"),
    *("sweep_of_an_unknown_name", "start_stop_number_as_values"),
}
ROWS = [
    pytest.param(*param.values, id=param.id, marks=[pytest.mark.slow] if param.id in SLOW else [])
    for param in cases.rows("slips")
]
PROGRAM = "\n".join(
    [f'vibro-sweep() {{ "{sys.executable}" -m vibro_sweep "$@"; }}', f'python() {{ "{sys.executable}" "$@"; }}', ""]
)
LIMIT = 200


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def answer(row) -> tuple[int, str]:
    """The exit status, and what is printed."""
    if row["kind"] == "scene":
        Path("scene.yaml").write_text(row["input"])
        status, out, err = ended("check", "scene.yaml")
        return status, out + err
    Path("slip.py").write_text(row["input"])
    command = ["bash", "-c", PROGRAM + row["input"]] if row["kind"] == "command" else [sys.executable, "slip.py"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    return done.returncode, done.stdout + done.stderr


def faults(row) -> list[str]:
    (status, text), want = answer(row), row["want"]
    found = [] if status == want["exit"] else [f"ended with {status}, not {want['exit']}"]
    found += [f"{word!r} is not said" for word in want["words"] if not re.search(word, text)]
    found += [f"{name} is not there" for name in want.get("writes", []) if not Path(name).exists()]
    return [*found, text] if found else []


@pytest.mark.parametrize("row", ROWS)
def test_a_slip_is_answered(row):
    assert faults(row) == []


def test_number_of_rows():
    assert SLOW <= {param.id for param in ROWS}
    kinds = [row["kind"] for param in ROWS for row in param.values]
    assert {kind: kinds.count(kind) for kind in NUMBER} == NUMBER and len(kinds) == sum(NUMBER.values())


TYPO = next(row for param in ROWS for row in param.values if row["name"] == "typo_of_a_key")
PLANTED = [
    ({"exit": 0}, "ended with 2, not 0"),
    ({"words": ["omgea", "another"]}, "'another' is not said"),
    ({"writes": ["scene.yaml", "scene.png"]}, "scene.png is not there"),
]


@pytest.mark.parametrize("change, fault", PLANTED)
def test_a_fault_is_seen(change, fault):
    assert faults(TYPO | {"want": TYPO["want"] | change})[0] == fault
    assert faults(TYPO) == []
