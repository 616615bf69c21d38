"""Files that another program has written or changed: they have no seal, which is said once; nothing continues them."""

import shutil

import h5py
import numpy as np
import pytest
import xarray
from support.contents import arrays_of
from support.files import SCENE, refused
from support.programs import ended, main

import vibro_sweep as vs

WRITTEN = "was written, or changed, by another program"


def edited():
    """By a user's script, in place."""
    with h5py.File("x.h5", "a") as file:
        file["mine"] = np.arange(3)


def rewritten():
    """By a tool that makes the same file anew."""
    shutil.move("x.h5", "old.h5")
    with xarray.open_dataset("old.h5") as old:
        old.to_netcdf("x.h5", engine="h5netcdf")


@pytest.mark.parametrize("change", [edited, rewritten])
def test_it_is_read_with_one_warning(folder, caplog, change):
    whole = arrays_of("x.h5")
    change()
    with vs.open("x.h5") as data:
        assert all(np.array_equal(data[name], whole[name], equal_nan=True) for name in ("x1", "lyapunov", "status"))
    assert [record.message.count(WRITTEN) for record in caplog.records] == [1]
    told = ended("info", "x.h5")
    assert told.status == 0 and "checksums    none: written, or changed, by another program" in told.out
    told = ended("plot", "x.h5", "-o", "x.png")
    assert told.status == 0 and told.err.count(WRITTEN) == 1


@pytest.mark.parametrize("change", [edited, rewritten])
def test_nothing_is_computed_from_it(folder, capsys, change):
    change()
    for words in (["windows", "x.h5", "-o", "w.h5"], ["run", "scene.yaml", "-o", "x.h5", "--resume"]):
        if words[0] == "windows" or change is rewritten:
            refused(capsys, words, "x.h5")
    with pytest.raises(vs.StoreError, match=WRITTEN):
        vs.windows("x.h5")


def test_an_unfinished_file_that_was_edited_is_not_continued(folder):
    with h5py.File("y.h5", "a") as file:
        file.attrs["mine"] = 1
    with pytest.raises(vs.StoreError, match="no run continues it"):
        vs.run(SCENE, "y.h5", mode="resume")


@pytest.mark.parametrize("name", ["title", "history", "scene", "provenance", "sweep_dimensions", "format"])
def test_what_is_missing_is_said(folder, name):
    with h5py.File("x.h5", "a") as file:
        del file.attrs[name]
    for words in (["info", "x.h5"], ["plot", "x.h5", "-o", "x.png"], ["windows", "x.h5"]):
        told = ended(*words)
        assert "Traceback" not in told.err and told.status in (0, 2)


def test_an_axis_of_nan(folder, capsys):
    with h5py.File("x.h5", "a") as file:
        file["b"][4] = np.nan
    assert main(["plot", "x.h5"]) == 2
    assert "axis b" in capsys.readouterr().err


def test_a_status_that_nobody_knows(folder):
    with h5py.File("x.h5", "a") as file:
        file["status"][3] = 99
    assert "unknown_status_99: 1" in ended("info", "x.h5").out
    assert main(["plot", "x.h5"]) == 0
