"""Files that somebody has edited or added to: what is ours is checked, what is not is left alone."""

import shutil
from itertools import product
from pathlib import Path

import h5py
import numpy as np
import pytest
from support import sample, slow_cases
from support.changes import LINKS, elsewhere, set_text
from support.contents import arrays_of, described
from support.edits_of_sweeps import EDITS
from support.files import SCENE, refused, seen
from support.programs import main

import vibro_sweep as vs

# What is not ours in a file


@pytest.mark.slow
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


@pytest.mark.parametrize("how, name", sample(3, product(LINKS, ["x1", "status"])))
def test_no_number_is_read_from_elsewhere(folder, capsys, how, name):
    shutil.copy("x.h5", "other.h5")
    Path("victim").write_bytes(bytes(range(256)) * 20)
    with h5py.File("x.h5", "a") as file:
        elsewhere(file, name, how)
    before = seen(folder)
    for arguments in (["info", "x.h5"], ["plot", "x.h5"], ["run", "scene.yaml", "-o", "x.h5", "--resume"]):
        refused(capsys, arguments, "x.h5", "damaged" if how == "virtual" else "x.h5")
    with pytest.raises(vs.StoreError):
        vs.open("x.h5")
    assert seen(folder) == before


# Files that somebody has edited


@pytest.mark.parametrize("edit", sample(8, EDITS))
def test_an_edited_file_is_refused(folder, capsys, edit):
    with h5py.File("x.h5", "a") as file:
        EDITS[edit](file)
    before = seen(folder)
    for arguments in (["info", "x.h5"], ["plot", "x.h5"], ["run", "scene.yaml", "-o", "x.h5", "--resume"]):
        refused(capsys, arguments, "x.h5")
    with pytest.raises(vs.StoreError):
        vs.open("x.h5")
    assert seen(folder) == before


def test_a_missing_dataset_that_is_not_missed_by_the_file_itself(folder, capsys):
    with h5py.File("x.h5", "a") as file:
        del file["x1"]
        names = [name.decode() for name in file.attrs["quantities"] if name != b"x1"]
        set_text("quantities", names)(file)
    refused(capsys, ["run", "scene.yaml", "-o", "x.h5", "--resume"], "it has no x1")


@pytest.mark.slow
def test_a_status_that_nobody_knows(folder, capsys):
    with h5py.File("x.h5", "a") as file:
        file["status"][3] = 99
    assert "unknown_status_99: 1" in described("x.h5")
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
    "text", [BOMB, *slow_cases("a: &a [*a]", "[" * 20_000, "- 2001-99-99", "\0", "=: =", "!!python/name:os.system")]
)
def test_a_stored_scene_of_nonsense(folder, capsys, text):
    with h5py.File("x.h5", "a") as file:
        set_text("scene", text)(file)
    for command in ("info", "plot"):
        assert main([command, "x.h5"]) == 0
    assert main(["run", "scene.yaml", "-o", "x.h5", "--resume"]) == 2
    assert "was made from another scene" in capsys.readouterr().err


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
                with pytest.raises(vs.StoreError, match="damaged"):
                    vs.open("x.h5")
