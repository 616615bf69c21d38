"""What is refused is refused in one message, which is that of tests/cases/messages.yaml, with the exit status there."""

from pathlib import Path

import pytest
from support import cases, refusals

import vibro_sweep as vs

NUMBER = {"scene": 282, "command": 75, "call": 511}
ROWS = cases.rows("messages")


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("row", ROWS)
def test_refusal(row):
    assert refusals.faults(row) == []


def test_python_says_the_same_of_a_scene():
    """Of every eighth one: it is the same reader."""
    scenes = [row for param in ROWS for row in param.values if "scene" in row and "command" not in row][::8]
    for row in scenes:
        Path(refusals.SCENE).write_text(refusals.text_of(row))
        with pytest.raises(vs.SceneError) as caught:
            vs.load_scene(refusals.SCENE)
        assert str(caught.value) == row["message"], row["id"]
    assert len(scenes) > 30


def test_number_of_rows():
    rows = [row for param in ROWS for row in param.values]
    inputs = [next(key for key in ("call", "command", "scene") if key in row) for row in rows]
    assert {key: inputs.count(key) for key in ("scene", "command", "call")} == NUMBER
    assert all(len(row["why"]) > 20 and row.keys() & {"message", "has"} for row in rows)


GOOD = refusals.FILES["good.yaml"].decode()
BAD = {"scene": GOOD + "dynamics: 3", "status": 2, "message": "scene.yaml: dynamics = 3: allowed: flow, map (line 5)"}


ROOT = {"call": "math.sqrt(-1)", "raises": "ValueError", "message": "math domain error"}
PLANTED = [
    (BAD | {"status": 70}, "ended with 2"),
    (BAD | {"message": "another"}, "said 'scene.yaml: "),
    (BAD | {"has": ["orbit", "another"]}, "'another' is not in 'scene.yaml: "),
    (BAD | {"scene": GOOD}, "accepted: 0"),
    ({"command": "check good.yaml", "status": 2, "message": ""}, "accepted: 0"),
    ({"command": "run none.yaml", "status": 70, "has": [" "]}, "ended with 2"),
    (ROOT | {"call": "math.sqrt(4)"}, "accepted: 2.0"),
    (ROOT | {"raises": "VibroSweepError, ValueError"}, "ended with 'ValueError'"),
    (ROOT | {"call": "vs.load_scene('')"}, "ended with 'VibroSweepError, ValueError'"),
    (ROOT | {"call": "(Path('x').touch(), math.sqrt(-1))"}, "left the files ['x']"),
]


@pytest.mark.parametrize("row", [BAD, ROOT])
def test_rows_are_right_in_which_a_fault_is_planted(row):
    assert refusals.faults(row) == []


@pytest.mark.parametrize("row, fault", PLANTED)
def test_a_fault_is_seen(row, fault):
    assert any(fault in line for line in refusals.faults(row))
