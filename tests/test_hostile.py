"""What lies beside a file, or has been put into it: readers change nothing, runs touch only what they have made."""

import os
import shutil
import stat
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from support.files import EDITS, LINKS, OBSTACLES, SCENE, TEXT, elsewhere, files, refused, seen  # noqa: F401
from support.scenes import arrays_of, assert_same_bits

import vibro_sweep as vs
from vibro_sweep import store
from vibro_sweep.cli import main
from vibro_sweep.store import StoreError, describe, parts
from vibro_sweep.store.attributes import set_text, set_texts

# Readers write nothing


def old_journal():
    """As version 0.1 had it: it wrote "hello" to the first bytes of the file beside it."""
    import struct
    import zlib

    start = struct.pack(">16sQ", bytes(16), 10)
    body = struct.pack(">QQ", 0, 5) + b"hello"
    checksum = zlib.crc32(body, zlib.crc32((2**40).to_bytes(8), zlib.crc32(start)))
    return start + struct.pack(">QQI", len(body), 2**40, checksum) + body


@pytest.mark.parametrize("beside", ["journal", "text", "link", "pipe", "folder", "loop"])
@pytest.mark.parametrize("name", ["x.h5", "y.h5.part", "victim.h5"])
def test_readers_change_nothing(folder, capsys, name, beside):
    (folder / "victim").write_text("years of work")
    (folder / "victim.h5").symlink_to("victim")
    place = folder / f"{name}.journal"
    {
        "journal": lambda: place.write_bytes(old_journal()),
        "text": lambda: place.write_text("a diary"),
        "link": lambda: place.symlink_to("victim"),
        "pipe": lambda: os.mkfifo(place),
        "folder": place.mkdir,
        "loop": lambda: place.symlink_to(place),
    }[beside]()
    before = seen(folder)
    good = name != "victim.h5"
    assert main(["info", name]) == (0 if good else 2)
    assert main(["plot", name, "-o", str(folder.parent / f"{folder.name}.png")]) == (0 if good else 2)
    if good:
        vs.open(name).close()
    else:
        with pytest.raises(StoreError):
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


@pytest.mark.parametrize("suffix", ["journal", "new"])
@pytest.mark.parametrize("what", OBSTACLES)
def test_other_names_are_left_alone(folder, what, suffix):
    """Version 0.1 wrote to them."""
    OBSTACLES[what](folder / f"out.h5.part.{suffix}")
    before = seen(folder)
    assert main(["run", "scene.yaml", "-o", "out.h5", "--quiet"]) == 0
    after = seen(folder)
    assert after.pop("out.h5") and after == before


def test_a_part_with_a_second_name(folder, capsys):
    os.link("y.h5.part", "precious")
    before = seen(folder)
    refused(capsys, ["run", "scene.yaml", "-o", "y.h5", "--resume"], "y.h5.part", "second name")
    assert seen(folder) == before


def test_the_scene_is_not_its_own_part(folder, capsys):
    os.rename("scene.yaml", "out.h5.part")
    refused(capsys, ["run", "out.h5.part", "-o", "out.h5", "--overwrite"], "out.h5.part", "the scene itself")
    assert Path("out.h5.part").read_text() == TEXT


@pytest.mark.parametrize("mode", ["append", "New", "Overwrite", "", None, 1, "a"])
@pytest.mark.parametrize("place", ["x.h5", "none.h5", "y.h5"])
def test_a_mode_that_is_none(folder, mode, place):
    before = seen(folder)
    with pytest.raises(StoreError, match="'new', 'resume', 'overwrite'"):
        vs.run(SCENE, place, mode=mode)
    assert seen(folder) == before


@pytest.mark.parametrize("mode", ["new", "overwrite"])
@pytest.mark.parametrize("what", ["text", "dangling", "link"])
def test_what_appears_during_a_run_is_left_alone(folder, mode, what):
    """Also in place of the file that the run was to replace; the result is kept, and gets its name later."""
    place = Path("x.h5" if mode == "overwrite" else "out.h5")
    whole = arrays_of("x.h5")

    def appear(done, total):
        if done == total:
            place.unlink(missing_ok=True)
            OBSTACLES[what](place)

    with pytest.raises(StoreError, match="has appeared during the run and is left alone; the result is complete in"):
        vs.run(SCENE, place, mode=mode, progress=appear)
    before = seen(folder)
    with pytest.raises(StoreError, match=r"stands beside|is a link"):
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
    name = "vibro_sweep.store.writing.names.publish" if at == "made" else "vibro_sweep.store.appending.HeldPart.remove"
    with monkeypatch.context() as patch:
        patch.setattr(name, lambda *_: os._exit(9))
        if (child := os.fork()) == 0:
            vs.run(SCENE, "out.h5", workers=1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
    assert Path("out.h5.part").exists() and Path("out.h5").exists() == (at == "named")
    assert any(path.name.startswith(".vibro_sweep-") for path in folder.iterdir()) == (at == "made")
    monkeypatch.setattr("vibro_sweep.driver.sweep.orbit_seconds", None)  # nothing is computed
    vs.run(SCENE, "out.h5", mode="resume")
    assert_same_bits(arrays_of("out.h5"), whole)
    assert sorted(os.listdir()) == ["out.h5", "scene.yaml", "x.h5", "y.h5.part"]


def test_without_fcntl(folder):
    """There is none on Windows."""
    code = (
        "import sys; sys.modules['fcntl'] = None; import portalocker, vibro_sweep.store as s\n"
        "print(s.describe('y.h5.part').count('9 of 12'))"
    )
    stand_in = "import sys, types; sys.modules['portalocker'] = types.ModuleType('portalocker')\n"
    done = subprocess.run([sys.executable, "-c", stand_in + code], capture_output=True, text=True, check=False)
    assert done.stdout == "1\n", done.stderr
    assert not any("fcntl" in path.read_text() for path in Path(store.__file__).parent.glob("*.py"))


# What is not ours in a file


def test_what_users_add_does_not_matter(folder, capsys):
    whole = arrays_of("x.h5")
    with h5py.File("x.h5", "a") as file:
        group = file.create_group("analysis")
        group.attrs["note"] = "of variable length, so that it goes into the heap"
        group["x1"] = h5py.SoftLink("/x1")
        file["b"].dims[0].label = "clearance"
        file["mine"] = np.arange(3)
        file["names"] = ["one", "two"]
        file["elsewhere"] = h5py.ExternalLink("nowhere.h5", "/x")
        file["loop"] = h5py.SoftLink("/loop")
        file.attrs["remark"] = "mine"
        file["virtual"] = np.zeros(2)
    assert main(["info", "x.h5"]) == 0 and "checksums    all hold" in capsys.readouterr().out
    assert main(["plot", "x.h5", "-o", "x.png"]) == 0
    with vs.open("x.h5") as data:
        assert "mine" not in data and np.array_equal(data["x1"], whole["x1"])
    assert vs.run(SCENE, "x.h5", mode="resume").bad == 0


@pytest.mark.parametrize("name", ["x1", "status"])
@pytest.mark.parametrize("how", LINKS)
def test_no_number_is_read_from_elsewhere(folder, capsys, how, name):
    shutil.copy("x.h5", "other.h5")
    Path("victim").write_bytes(bytes(range(256)) * 20)
    with h5py.File("x.h5", "a") as file:
        elsewhere(file, name, how)
    before = seen(folder)
    for arguments in (["info", "x.h5"], ["plot", "x.h5"], ["run", "scene.yaml", "-o", "x.h5", "--resume"]):
        refused(capsys, arguments, "x.h5", "damaged" if how == "virtual" else "x.h5")
    with pytest.raises(StoreError):
        vs.open("x.h5")
    assert seen(folder) == before


@pytest.mark.parametrize("how", LINKS)
def test_no_number_is_written_elsewhere(folder, capsys, how):
    """By a part whose skeleton leads to another file, with all its checksums right."""
    shutil.copy("x.h5", "other.h5")
    Path("victim").write_bytes(bytes(range(256)) * 20)
    with parts.open_regular(Path("y.h5.part")) as file, open("skeleton.h5", "xb") as copy:
        head = parts.read_head(file)
        parts.copy_skeleton(file, head, copy)
        file.seek(head.start + head.length)
        rest = file.read()
    with h5py.File("skeleton.h5", "a") as file:
        elsewhere(file, "x1", how)
    skeleton = Path("skeleton.h5").read_bytes()
    Path("y.h5.part").write_bytes(parts.new_head(skeleton, None, head.identity).packed() + skeleton + rest)
    before = seen(folder)
    for arguments in (["info", "y.h5.part"], ["plot", "y.h5.part"], ["run", "scene.yaml", "-o", "y.h5", "--resume"]):
        refused(capsys, arguments, "y.h5.part")
    assert seen(folder) == before


# Files that somebody has edited


@pytest.mark.parametrize("edit", EDITS)
def test_an_edited_file_is_refused(folder, capsys, edit):
    with h5py.File("x.h5", "a") as file:
        EDITS[edit](file)
    before = seen(folder)
    for arguments in (["info", "x.h5"], ["plot", "x.h5"], ["run", "scene.yaml", "-o", "x.h5", "--resume"]):
        refused(capsys, arguments, "x.h5")
    with pytest.raises(StoreError):
        vs.open("x.h5")
    assert seen(folder) == before


def test_a_missing_dataset_that_is_not_missed_by_the_file_itself(folder, capsys):
    with h5py.File("x.h5", "a") as file:
        del file["x1"]
        names = [name.decode() for name in file.attrs["quantities"] if name != b"x1"]
        set_texts(file, "quantities", names)
    refused(capsys, ["run", "scene.yaml", "-o", "x.h5", "--resume"], "it has no x1")


def test_a_status_that_nobody_knows(folder, capsys):
    with h5py.File("x.h5", "a") as file:
        file["status"][3] = 99
    assert "unknown_status_99: 1" in describe("x.h5")
    assert main(["plot", "x.h5"]) == 0
    assert main(["run", "scene.yaml", "-o", "x.h5", "--resume"]) == 1
    assert "unknown_status_99 1" in capsys.readouterr().out


def test_an_axis_of_nan(folder, capsys):
    with h5py.File("x.h5", "a") as file:
        file["b"][4] = np.nan
    refused(capsys, ["plot", "x.h5"], "axis b")
    assert main(["info", "x.h5"]) == 0


BOMB = "a: &a {x: 1}\n" + "".join(
    f"{new}: &{new} {{<<: [{', '.join([f'*{old}'] * 9)}]}}\n"
    for old, new in zip("abcdefghijkl", "bcdefghijklm", strict=True)
)


@pytest.mark.parametrize(
    "text", [BOMB, "[" * 20_000, "a: &a [*a]", "- 2001-99-99", "\0", "=: =", "!!python/name:os.system"]
)
def test_a_stored_scene_of_nonsense(folder, capsys, text):
    with h5py.File("x.h5", "a") as file:
        set_text(file, "scene", text)
    began = time.monotonic()
    for command in ("info", "plot"):
        assert main([command, "x.h5"]) == 0
    assert main(["run", "scene.yaml", "-o", "x.h5", "--resume"]) == 2
    assert "was made from another scene" in capsys.readouterr().err
    assert time.monotonic() - began < 10


# Bits


def test_a_flipped_bit_in_a_text_is_seen(folder, capsys):
    content = bytearray(Path("x.h5").read_bytes())
    content[content.index(b"omega: 0.63") + 9] ^= 1
    Path("x.h5").write_bytes(content)
    refused(capsys, ["info", "x.h5"], "damaged")


def test_zeros_in_the_heap_do_not_hang(folder):
    """Where HDF5 loops forever, and Ctrl-C is of no use."""
    whole = Path("x.h5").read_bytes()
    start = whole.index(b"GCOL")
    for place in range(start, start + 400, 8):
        for width in (8, 64):
            Path("x.h5").write_bytes(whole[:place] + bytes(width) + whole[place + width :])
            if Path("x.h5").read_bytes() != whole:
                with pytest.raises(StoreError, match="damaged"):
                    vs.open("x.h5")


# Standard output


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="a device that is always full")
@pytest.mark.parametrize("arguments", [["run", "scene.yaml", "-o", "out.h5"], ["info", "x.h5"], ["schema"]])
def test_standard_output_on_a_full_disk(folder, arguments):
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "vibro_sweep", *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr == "vibro-sweep: error: the standard output: No space left on device\n"
    if arguments[0] == "run":
        assert "12 of 12" in describe("out.h5")
