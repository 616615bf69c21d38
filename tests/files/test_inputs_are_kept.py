"""No output is a file that the run reads, by any name or link; a damaged file does not count as complete."""

import os
import re
from pathlib import Path

import h5py
import pytest
from support import sample, slow_cases
from support.changes import flip as change
from support.changes import place_of
from support.contents import bytes_in, numbers
from support.oscillators import PAPER_NUMBERS
from support.programs import main

import vibro_sweep as vs

SYSTEM = f"system: {{{PAPER_NUMBERS}}}\n"
SWEEP = (
    SYSTEM
    + """
sweep: {b: {values: [0.39, 0.4, 0.41]}}
orbit: {transient: 300, record: 20}
observe: [section]
"""
)
ALONG = "  parameter: {b: [0.38, 0.415]}\n  depth: 0\n"
FROM_SWEEP = f"{SYSTEM}continue:\n  from: {{sweep: s.h5}}\n{ALONG}"
FROM_BRANCHES = f"{SYSTEM}continue:\n  from: {{branches: br.h5, special: 0}}\n{ALONG}"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    before = Path.cwd()
    os.chdir(folder)
    try:
        Path("s.yaml").write_text(SWEEP)
        Path("br.yaml").write_text(FROM_SWEEP)
        vs.run(vs.load_scene("s.yaml"), "s.h5")
        vs.run(vs.load_scene("br.yaml"), "br.h5")
        vs.windows("s.h5", output="w.h5")
    finally:
        os.chdir(before)
    return folder


@pytest.fixture
def folder(made, tmp_path, monkeypatch):
    for path in made.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    monkeypatch.chdir(tmp_path)
    Path("more.yaml").write_text(FROM_BRANCHES)
    os.link("s.h5", "hard.h5")
    os.link("br.h5", "again.h5")
    os.link("s.yaml", "scene.h5")
    Path("deep").mkdir()
    return tmp_path


@pytest.mark.parametrize(
    "command",
    sample(
        5,
        [
            "run br.yaml -o s.h5 --overwrite",
            "run br.yaml -o hard.h5 --overwrite",
            "run br.yaml -o deep/../s.h5 --overwrite",
            "run more.yaml -o br.h5 --overwrite",
            "run more.yaml -o again.h5 --resume",
            "run s.yaml -o scene.h5 --overwrite",
            "run scene.h5 -o s.yaml --overwrite",
            "windows s.h5 -o s.h5 --overwrite",
            "windows s.h5 -o hard.h5 --overwrite",
            "run br.yaml -o nowhere/x.h5",
            "run s.yaml -o new/",
            "windows s.h5 -o new/",
            "plot s.h5 -o new/",
        ],
    ),
)
def test_a_command_leaves_its_inputs_alone(folder, capsys, command):
    before = bytes_in(folder)
    assert main(command.split()) == 2
    error = capsys.readouterr().err
    assert command.split()[3] in error and "Traceback" not in error
    assert bytes_in(folder) == before


def test_python_leaves_its_inputs_alone(folder):
    before = bytes_in(folder)
    scene, branches = vs.load_scene("s.yaml"), vs.load_scene("br.yaml")
    for one in (scene, scene.replace(record=30)):
        for output in ("s.yaml", "scene.h5"):
            with pytest.raises(vs.StoreError, match=re.escape(output)):
                vs.run(one, output, mode="overwrite")
    for call in (
        lambda: vs.run(scene, "new/"),
        lambda: vs.run(branches, "new/"),
        lambda: vs.windows("s.h5", output="new/"),
    ):
        with pytest.raises(
            ValueError, match="output: 'new/' is not allowed; it must be the path of a file, and of no folder"
        ):
            call()
    with pytest.raises(vs.StoreError, match=r"this run reads s\.h5"):
        vs.run(branches, "hard.h5", mode="overwrite")
    with pytest.raises(vs.StoreError, match=r"this run reads s\.h5"):
        vs.windows("s.h5", output="hard.h5", mode="overwrite")
    assert bytes_in(folder) == before


def test_a_picture_replaces_nothing_that_it_shows(folder, capsys):
    for name in ("s.h5", "w.h5"):
        os.link(name, f"{name}.png")
    before = bytes_in(folder)
    for output in ("s.h5.png", "w.h5.png"):
        assert main(["plot", "s.h5", "--windows", "w.h5", "-o", output, "--overwrite"]) == 2
        assert output in capsys.readouterr().err
    assert bytes_in(folder) == before


def flip(path, dataset) -> None:
    """One bit in the midst of its numbers."""
    begin, size = place_of(path, dataset)
    change(Path(path), begin + size // 2, 2)


@pytest.mark.parametrize(
    "name, dataset, command",
    [("w.h5", "window_lower", "windows s.h5"), *slow_cases(("br.h5", "branch_ends", "run br.yaml"))],
)
def test_a_damaged_file_is_not_complete(folder, capsys, name, dataset, command):
    whole = numbers(name)
    flip(name, dataset)
    with pytest.raises(vs.StoreError, match=f"{name} is damaged: its structure is not the one that was written"):
        vs.open(name)
    readers = (f"info {name}", f"plot {name}" if name == "br.h5" else f"plot s.h5 --windows {name}")
    for words in (*readers, f"{command} -o {name}", f"{command} -o {name} --resume"):
        assert main(words.split()) == 2
        assert f"{name} is damaged" in capsys.readouterr().err
    assert main([*command.split(), "-o", name, "--overwrite", "--quiet"]) == 0
    assert numbers(name) == whole


@pytest.mark.parametrize(
    "name, edit",
    sample(
        2,
        [
            ("br.h5", lambda file: file.__delitem__("unstable")),
            ("br.h5", lambda file: file["special_point"].__setitem__(0, 10**6)),
            ("br.h5", lambda file: file["special_type"].__setitem__(0, 99)),
            ("br.h5", lambda file: file["branch_row_size"].__setitem__(0, 1)),
            ("w.h5", lambda file: file["window_lower"].__setitem__(0, 10**6)),
            ("w.h5", lambda file: file["orbit_reason"].__setitem__(0, -1)),
            ("w.h5", lambda file: file.__delitem__("window_symmetric")),
        ],
    ),
)
def test_an_edited_file_is_refused(folder, capsys, name, edit):
    with h5py.File(name, "r+") as file:
        edit(file)
    for reader in (f"info {name}", f"plot {name}" if name == "br.h5" else f"plot s.h5 --windows {name}"):
        assert main(reader.split()) == 2
        said = capsys.readouterr()
        told = said.out + said.err
        assert ("damaged" in told or "does not hold all that" in told) and name in told
    with pytest.raises(vs.StoreError, match="does not hold all that"):
        vs.open(name)
