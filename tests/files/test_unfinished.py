"""A file that is being written: readers see what is computed, and there is one writer."""

import pickle
import subprocess
import sys

import numpy as np
import pytest
from support import sample
from support.contents import described
from support.stored import ALL, IMPACTS, LYAPUNOV, PLANE, SECTION, SWEEP, broken_off, scene_of

import vibro_sweep as vs


@pytest.mark.parametrize("unfinished", sample(1, [False, True]))
def test_what_is_opened_can_be_copied_and_sent(path, unfinished):
    scene = scene_of(PLANE + ALL)
    path = broken_off(scene, path) if unfinished else vs.run(scene, path) and path
    with vs.open(path) as data:
        sent = pickle.loads(pickle.dumps(data))
        assert sent.identical(data) and data.copy(deep=True).identical(data)
        sent.close()
        assert data["x1"][0, 1:, ::2].shape == (2, 2) and data.isel(b=[2, 0])["b"].values.tolist() == [6.7, 6.5]


def test_a_file_that_is_being_written_can_be_read(path):
    """By another process."""
    printed = []

    def read(done, _):
        if done == 0:
            printed.append(in_another_process("-m", "vibro_sweep", "info", str(path)))
            printed.append(in_another_process("-c", f"import vibro_sweep as v; print(dict(v.open('{path}').sizes))"))

    vs.run(scene_of(SWEEP), path, progress=read)
    assert "computed     0 of 3" in printed[0] and "{'b': 3, 'sample': 4}" in printed[1]


def in_another_process(*arguments):
    done = subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


@pytest.mark.parametrize("starts", [1, 2])
def test_what_is_missing_and_what_is_done(path, starts):
    """Whole points, of all their starts; a run that goes on computes the others alone."""
    scene = scene_of(PLANE + f"start: {{random: {starts}}}\nobserve: [impacts]")
    with vs.open(broken_off(scene, path)) as data:
        done = data["status"].values.reshape(6, starts) != -1
        assert done.all(axis=1).tolist() == done.any(axis=1).tolist() and 0 < done.sum() < 6 * starts
        assert np.isnan(data["sticking_time"].values.reshape(6, starts)[~done]).all()
    assert vs.run(scene, path, mode="resume").computed == 6 * starts - done.sum()


def test_describe_says_how_far_it_is(path):
    scene = scene_of(SWEEP + ALL)
    broken_off(scene, path)
    assert "computed     1 of 3 orbits (33.33 %)" in described(path)
    vs.run(scene, path, mode="resume")
    text = described(path)
    assert "computed     3 of 3 orbits (100 %)" in text and "complete" in text and "|sum of exponents" in text
    for name in SECTION | LYAPUNOV | IMPACTS | {"b"}:
        assert name in text
