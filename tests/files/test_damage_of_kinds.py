"""What is said of damaged and edited files: the dataset, the attribute, the place, and long texts cut short."""

import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from support import file_commands, sample, slow_cases
from support.changes import LONG, bit_in_chunk, chunked
from support.file_commands import REFUSED, opened, plotted_dataset, said
from support.kinds_of_files import KINDS, PERIODIC

import vibro_sweep as vs


@pytest.mark.parametrize("name", ["windows", *slow_cases(*(name for name in KINDS if name != "windows"))])
def test_a_flipped_bit_names_file_and_dataset(kinds, tmp_path, monkeypatch, name):
    """In the first chunk of the last dataset that has one."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds(name), "x.h5")
    chosen = chunked(Path("x.h5"))[-1]
    bit_in_chunk(chosen)(Path("x.h5"), np.random.default_rng(1))
    assert chosen in said(["info", "x.h5"]).message
    for answer in (opened("x.h5"), plotted_dataset("x.h5")):
        assert answer.outcome == REFUSED and "x.h5" in answer.message and chosen in answer.message


def test_a_changed_digit_of_a_periodic_orbit(kinds, tmp_path):
    """Each digit of its impacts, one after the other."""
    text, path = kinds(PERIODIC).read_text(), tmp_path / "x.json"
    begin, end = text.index("unknowns"), text.index("residual")
    places = [i for i in range(begin, end) if text[i].isdigit()]
    for i in places[:: len(places) // 20]:
        changed = text[:i] + str((int(text[i]) + 1) % 10) + text[i + 1 :]
        if json.loads(changed) == json.loads(text):  # the last of seventeen digits
            continue
        path.write_text(changed)
        with pytest.raises(ValueError, match=r"x\.json: damaged: its "):
            vs.load(path)


@pytest.mark.parametrize(
    "attribute", ["kind", *slow_cases("provenance", "scene", "quantities", "parameters", "title", "format")]
)
def test_long_texts_are_shortened(kinds, tmp_path, monkeypatch, attribute):
    monkeypatch.chdir(tmp_path)
    path = Path(shutil.copy(kinds("windows"), "x.h5"))
    with h5py.File(path, "a") as file:
        file.attrs.create(attribute, LONG if attribute != "provenance" else f'{{"vibro_sweep": "{LONG}"}}')
    shutil.copy(kinds("sweep"), "sweep.h5")
    words = ["windows", "sweep.h5", "-o", "x.h5", "--quiet"]
    for answer in (said(["info", "x.h5"]), opened("x.h5"), said([*words, "--resume"])):
        assert LONG[:61] not in answer.message, answer.message


def test_a_list_of_numbers_that_is_a_text(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds("linear"), "x.h5")
    with h5py.File("x.h5", "a") as file:
        file.attrs.create("contact_normal", "no such thing")
    for words in (["info", "x.h5"], ["plot", "x.h5"]):
        answer = said(words)
        assert answer.outcome == REFUSED and "x.h5 is damaged (its attribute `contact_normal`" in answer.message


ALL_COMPUTING = (*file_commands.COMPUTING, "vs.windows")
REFUSED_LATE = {  # kind of the file, its dataset or attribute, the value in it, words of the message
    "a scene that is none": ("sweep", "scene", "no such thing", "sweep.h5: scene: scene = "),
    "a swept number out of its range": ("sweep", "b", -1e30, "sweep.h5: b: -1e+30 is not allowed"),
    "a period of a million": ("windows", "branch_period", 10**6, "windows.h5: tables over 2000000 half periods"),
    "a period of a million in branches": ("branches", "branch_period", 10**6, "branches.h5: tables over 2000000 half"),
    "a plane of no scene": ("plane", "scene", "no such thing", "plane.h5: scene: scene = "),
    "a type without a curve": ("windows", "special_type", 7, "'boundary' in windows.h5; it must be one of fold"),
}


@pytest.mark.parametrize("case", sample(1, REFUSED_LATE))
def test_what_is_refused_late_names_the_file(kinds, tmp_path, monkeypatch, case):
    """Whatever computes from it, on the command line and in Python."""
    monkeypatch.chdir(tmp_path)
    name, where, value, words = REFUSED_LATE[case]
    file = str(shutil.copy(kinds(name), f"{name}.h5"))
    file_commands.write_scenes_of_commands()
    with h5py.File(file, "a") as content:
        if where in content:
            content[where][...] = value
        else:
            content.attrs[where] = value
    for key, call in file_commands.commands(name).items():
        if key in ALL_COMPUTING:
            answer = call(file)
            assert answer.outcome == REFUSED and words in answer.message, f"{key}: {answer.message}"
            Path("made.h5.part").unlink(missing_ok=True)


def test_a_resumed_scene_of_long_text(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file_commands.write_scenes_of_commands()
    shutil.copy(kinds("linear"), "linear.h5")
    with h5py.File("linear.h5", "a") as file:
        file.attrs.create("scene", LONG)
    for option in ("--resume", "--quiet"):
        answer = said([*KINDS["linear"].command("linear"), option])
        assert answer.outcome == REFUSED and LONG[:40] in answer.message and LONG[:61] not in answer.message


def test_a_quantity_without_its_own_dimension(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds("follow"), "x.h5")
    with h5py.File("x.h5", "a") as file:
        shape = file["status"].shape
        del file["lyapunov"]
        file["lyapunov"] = np.zeros(shape)
    for words in (["info", "x.h5"], ["plot", "x.h5"]):
        answer = said(words)
        assert answer.outcome == REFUSED and "`lyapunov` and its own dimensions" in answer.message
