"""Two runs on one file, readers of a running run, and a run on the file of another scene."""

import os
import subprocess
import sys

import numpy as np
import pytest
import xarray
from support import slow_cases
from support.contents import described
from support.faults import BLOCK, TEXT, counted
from support.scene_texts import parsed

import vibro_sweep as vs


@pytest.mark.parametrize("option", [[], *slow_cases(["--resume"], ["--overwrite"])])
def test_two_runs_on_one_file(scene, path, tmp_path, option):
    """By the command line; HDF5's own locks are not needed."""
    text, messages = tmp_path / "the_scene.yaml", []
    text.write_text(TEXT)

    def begin_another(done, _):
        if done == 0:
            second = subprocess.run(
                [sys.executable, "-m", "vibro_sweep", "run", text, "-o", path, *option],
                capture_output=True,
                text=True,
                check=False,
                env=os.environ | {"HDF5_USE_FILE_LOCKING": "FALSE"},
            )
            messages.append((second.returncode, second.stderr, counted(described(path))))

    vs.run(scene, path, progress=begin_another)
    assert messages == [(2, f"vibro-sweep: error: {path} is being written by another run\n", (0, 400, 0))]
    assert counted(described(path)) == (400, 0, 0)


def test_readers_of_a_running_run(scene, path, monkeypatch):
    """They see what is computed, and write nothing."""
    monkeypatch.setattr("vibro_sweep.files.sweep_file.SECONDS", 0.0)  # each block is committed at once
    read = []

    def look(done, _):
        if done == BLOCK:
            before = path.read_bytes()
            data = vs.open(path)
            read.append(data)
            assert computed(data) == BLOCK and vs.plot(path).axes
            assert np.all(np.isnan(data["x1"][BLOCK:])) and np.all(data["status"][BLOCK:] == -1)
            with xarray.open_dataset(path) as plain:
                assert computed(plain) == BLOCK and next(iter(plain.data_vars)) == "status"
            assert path.read_bytes() == before
        elif done == 2 * BLOCK:
            assert computed(read[0]) == BLOCK  # as it was when it was opened
            assert counted(described(path))[0] == 2 * BLOCK
            assert sorted(os.listdir(path.parent)) == [path.name, f"{path.name}.lock"]
            read[0].close()
            read.append("to the end")

    vs.run(scene, path, workers=1, block=BLOCK, progress=look)
    assert read[-1] == "to the end"


def computed(data) -> int:
    return np.count_nonzero(data["status"] != -1)


# What does not belong together


def test_what_differs_is_said(scene, path):
    vs.run(scene, path)
    other = parsed(TEXT.replace("num: 400", "num: 401"))
    with pytest.raises(vs.StoreError, match="another scene") as error:
        vs.run(other, path, mode="resume")
    told = str(error.value).splitlines()[-2:]
    assert told[0].startswith("  - sweep: {b: {start: 6.5, stop: 6.9, num: 400}}")
    assert told[1].startswith("  + sweep: {b: {start: 6.5, stop: 6.9, num: 401}}")
