"""Two runs on one file, readers of a running run, and a run on the file of another scene."""

import os
import subprocess
import sys

import numpy as np
import pytest
from support import slow_cases
from support.faults import TEXT, counted
from support.files import described
from support.scene_texts import parsed

import vibro_sweep as vs
from vibro_sweep import plotting, store
from vibro_sweep.driver import blocks, compute
from vibro_sweep.driver.provenance import provenance


@pytest.mark.parametrize("option", [[], *slow_cases(["--resume"], ["--overwrite"])])
def test_two_runs_on_one_file(scene, path, tmp_path, option):
    """By the command line; HDF5's own locks are not needed."""
    text = tmp_path / "the_scene.yaml"
    text.write_text(TEXT)
    with store.writer(store.sweep_run(scene, provenance()), path, "new"):
        second = subprocess.run(
            [sys.executable, "-m", "vibro_sweep", "run", text, "-o", path, *option],
            capture_output=True,
            text=True,
            check=False,
            env=os.environ | {"HDF5_USE_FILE_LOCKING": "FALSE"},
        )
        assert second.returncode == 2
        assert second.stderr == f"vibro-sweep: error: {path}.part is being written by another run\n"
        assert counted(described(f"{path}.part")) == (0, 400, 0)
    vs.run(scene, path, mode="resume")
    assert counted(described(path)) == (400, 0, 0)


def test_readers_of_a_running_run(scene, path):
    """They see what is computed, whole blocks only, and write nothing."""
    with store.writer(store.sweep_run(scene, provenance()), path, "new") as file:
        part = path.with_name(path.name + ".part")
        first, second, *_ = blocks.blocks(scene, 40)
        file.write(*compute.compute(first))
        before = part.read_bytes(), part.stat().st_mtime_ns
        with vs.open(part) as data, plotting.sweep_result.Result(part) as result:
            assert np.count_nonzero(data["status"] != -1) == result.done.sum() == 40
            assert np.all(np.isnan(data["x1"][40:])) and np.all(data["status"][40:] == -1)
            file.write(*compute.compute(second))
            assert np.count_nonzero(data["status"] != -1) == 40  # as it was when it was opened
        assert counted(described(part))[0] == 80
        assert part.read_bytes()[: len(before[0])] == before[0] and os.listdir(path.parent) == [part.name]


# What does not belong together


def test_what_differs_is_said(scene, path):
    vs.run(scene, path)
    other = parsed(TEXT.replace("num: 400", "num: 401"))
    with pytest.raises(vs.StoreError, match="another scene") as error:
        vs.run(other, path, mode="resume")
    told = str(error.value).splitlines()[-2:]
    assert told[0].startswith("  - sweep: {b: {start: 6.5, stop: 6.9, num: 400}}")
    assert told[1].startswith("  + sweep: {b: {start: 6.5, stop: 6.9, num: 401}}")
