"""What lies beside a file: readers change nothing, runs touch only what they have made; and a full standard output."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from support import sample, slow_cases
from support.contents import arrays_of, assert_same_bits
from support.files import OBSTACLES, SCENE, TEXT, refused, seen
from support.programs import main

import vibro_sweep as vs

# Readers write nothing


@pytest.mark.parametrize("name", sample(1, ["x.h5", "y.h5.part", "victim.h5"]))
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
def test_a_part_that_no_run_made(folder, capsys, what, option):
    OBSTACLES[what](folder / "out.h5.part")
    before = seen(folder)
    refused(capsys, ["run", "scene.yaml", "-o", "out.h5", *([option] if option else [])], "out.h5.part")
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


def test_a_part_with_a_second_name(folder, capsys):
    os.link("y.h5.part", "precious")
    before = seen(folder)
    refused(capsys, ["run", "scene.yaml", "-o", "y.h5", "--resume"], "y.h5.part", "second name")
    assert seen(folder) == before


def test_the_scene_is_not_its_own_part(folder, capsys):
    os.rename("scene.yaml", "out.h5.part")
    refused(capsys, ["run", "out.h5.part", "-o", "out.h5", "--overwrite"], "out.h5.part", "this run reads")
    assert Path("out.h5.part").read_text() == TEXT


@pytest.mark.parametrize("mode", ["append", "New", "Overwrite", "", None, 1, "a"])
@pytest.mark.parametrize("place", ["x.h5", "none.h5", "y.h5"])
def test_a_mode_that_is_none(folder, mode, place):
    before = seen(folder)
    with pytest.raises(vs.StoreError, match="'new', 'resume', 'overwrite'"):
        vs.run(SCENE, place, mode=mode)
    assert seen(folder) == before


@pytest.mark.parametrize("mode", ["new", "overwrite"])
@pytest.mark.parametrize("what", ["text", *slow_cases("dangling", "link")])
def test_what_appears_during_a_run_is_left_alone(folder, mode, what):
    """Also in place of the file that the run was to replace; the result is kept, and gets its name later."""
    place = Path("x.h5" if mode == "overwrite" else "out.h5")
    whole = arrays_of("x.h5")

    def appear(done, total):
        if done == total:
            place.unlink(missing_ok=True)
            OBSTACLES[what](place)

    with pytest.raises(vs.StoreError, match="has appeared during the run and is left alone; the result is complete in"):
        vs.run(SCENE, place, mode=mode, progress=appear)
    before = seen(folder)
    with pytest.raises(vs.StoreError, match=r"stands beside|is a link"):
        vs.run(SCENE, place, mode="resume")
    assert seen(folder) == before
    place.unlink()
    vs.run(SCENE, place, mode="resume", progress=lambda done, total: done == total or pytest.fail("computed again"))
    assert_same_bits(arrays_of(place), whole)
    assert not Path(f"{place}.part").exists()


def test_overwrite_replaces_what_it_was_told_to_also_after_a_kill(folder):
    with pytest.raises(ZeroDivisionError):
        vs.run(SCENE, "x.h5", mode="overwrite", workers=1, progress=lambda done, _: 1 / (done == 0))
    old = Path("x.h5").read_bytes()
    vs.run(SCENE, "x.h5", mode="resume")
    assert Path("x.h5").read_bytes() != old and not Path("x.h5.part").exists()


@pytest.mark.parametrize("at", ["made", "named"])
def test_killed_at_the_very_end(folder, monkeypatch, at):
    """While the file is made, or when it has its name and its part is still there: nothing is computed again."""
    whole = arrays_of("x.h5")
    name = (
        "vibro_sweep.store.writing.names.publish" if at == "made" else "vibro_sweep.store.appending.LockedPart.remove"
    )
    with monkeypatch.context() as patch:
        patch.setattr(name, lambda *_: os._exit(9))
        if (child := os.fork()) == 0:
            vs.run(SCENE, "out.h5", workers=1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
    assert Path("out.h5.part").exists() and Path("out.h5").exists() == (at == "named")
    assert any(path.name.startswith(".vibro_sweep-") for path in folder.iterdir()) == (at == "made")
    assert vs.run(SCENE, "out.h5", mode="resume").computed == 0
    assert_same_bits(arrays_of("out.h5"), whole)
    assert sorted(os.listdir()) == ["out.h5", "scene.yaml", "x.h5", "y.h5.part"]


def test_without_fcntl(folder):
    """There is none on Windows."""
    code = (
        "sys.modules['fcntl'] = None; import portalocker; from vibro_sweep.__main__ import program\n"
        "sys.argv = ['vibro-sweep', 'info', 'y.h5.part']; program()"
    )
    stand_in = "import sys, types; sys.modules['portalocker'] = types.ModuleType('portalocker')\n"
    done = subprocess.run([sys.executable, "-c", stand_in + code], capture_output=True, text=True, check=False)
    assert done.stdout.count("9 of 12") == 1, done.stderr
    assert not any("fcntl" in path.read_text() for path in Path(vs.__file__).parent.rglob("*.py"))


# Standard output
