"""What lies beside a file: readers change nothing, runs touch only what they have made; and a full standard output."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from support import sample
from support.files import OBSTACLES, SCENE, refused, seen
from support.programs import main

import vibro_sweep as vs

# Readers write nothing


@pytest.mark.parametrize("name", sample(1, ["x.h5", "y.h5", "victim.h5"]))
def test_readers_change_nothing(folder, capsys, name):
    (folder / "victim").write_text("years of work")
    (folder / "victim.h5").symlink_to("victim")
    before = seen(folder)
    good = name != "victim.h5"
    assert main(["info", name]) == (0 if good else 2)
    assert main(["plot", name, "-o", str(folder.parent / f"{folder.name}.png")]) == (0 if good else 2)
    if good:
        vs.open(name).close()
    else:
        with pytest.raises(vs.StoreError):
            vs.open(name)
    assert seen(folder) == before and "Traceback" not in capsys.readouterr().err


def test_readers_of_pipes_and_devices_do_not_wait(folder, capsys):
    os.mkfifo("pipe.h5")
    os.symlink("/dev/zero", "zero.h5")
    for name in ("pipe.h5", "zero.h5"):
        for command in ("info", "plot"):
            refused(capsys, [command, name], name, "must be a file")


# A run touches only what it made itself


@pytest.mark.parametrize("option", [None, "--resume", "--overwrite"])
@pytest.mark.parametrize("what", OBSTACLES)
def test_pieces_that_no_run_made(folder, capsys, what, option):
    OBSTACLES[what](folder / "out.h5.pieces")
    before = seen(folder)
    refused(capsys, ["run", "scene.yaml", "-o", "out.h5", *([option] if option else [])], "out.h5.pieces")
    assert seen(folder) == before


@pytest.mark.parametrize("name", ["out.h5.new", "out.h5.lock"])
@pytest.mark.parametrize("what", ["link", "dangling", "pipe", "folder", "device"])
def test_names_beside_the_output_that_are_no_files(folder, capsys, what, name):
    OBSTACLES[what](folder / name)
    before = seen(folder)
    refused(capsys, ["run", "scene.yaml", "-o", "out.h5"], name)
    assert seen(folder) == before


@pytest.mark.parametrize("what", ["link", "dangling", "pipe", "folder", "device"])
def test_an_output_that_is_no_file(folder, capsys, what):
    OBSTACLES[what](folder / "out.h5")
    before = seen(folder)
    for option in ([], ["--resume"], ["--overwrite"]):
        refused(capsys, ["run", "scene.yaml", "-o", "out.h5", *option], "out.h5")
    assert seen(folder) == before


@pytest.mark.skipif(not hasattr(os, "mknod") or os.geteuid() != 0, reason="device nodes can be made by root alone")
def test_a_device_is_not_replaced(folder, capsys):
    os.mknod("out.h5", 0o666 | stat.S_IFCHR, os.makedev(1, 3))
    refused(capsys, ["run", "scene.yaml", "-o", "out.h5", "--overwrite"], "out.h5", "device")
    assert stat.S_ISCHR(os.stat("out.h5").st_mode)


@pytest.mark.parametrize("mode", ["append", "New", "Overwrite", "", None, 1, "a"])
@pytest.mark.parametrize("place", ["x.h5", "none.h5", "y.h5"])
def test_a_mode_that_is_none(folder, mode, place):
    before = seen(folder)
    with pytest.raises(vs.StoreError, match="'new', 'resume', 'overwrite'"):
        vs.run(SCENE, place, mode=mode)
    assert seen(folder) == before


def test_killed_when_the_file_has_its_name(folder, monkeypatch):
    """Of windows, whose pieces are still there: nothing is computed again."""
    with monkeypatch.context() as patch:
        patch.setattr("vibro_sweep.files.pieces.Pieces.drop", lambda *_: os._exit(9))
        if (child := os.fork()) == 0:
            vs.windows("x.h5", output="w.h5")
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
    assert Path("w.h5").exists() and Path("w.h5.pieces").exists()
    made = Path("w.h5").read_bytes()
    assert main(["windows", "x.h5", "-o", "w.h5", "--resume", "--quiet"]) == 0
    assert Path("w.h5").read_bytes() == made and not Path("w.h5.pieces").exists()


def test_without_fcntl(folder):
    """There is none on Windows: files are read, and a run is refused."""
    code = "import sys; sys.modules['fcntl'] = None; from vibro_sweep.__main__ import program; program()"
    for words, told in {
        ("info", "y.h5"): "9 of 12",
        ("run", "scene.yaml"): "runs need the locks of Linux or macOS",
    }.items():
        done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
        assert (done.stdout + done.stderr).count(told) == 1, done.stderr
    assert not Path("scene.h5").exists()


# Standard output
