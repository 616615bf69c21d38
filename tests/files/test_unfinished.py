"""A file that is being written: readers see what is computed, and there is one writer."""

import pickle
import subprocess
import sys

import pytest
from support import sample
from support.files import described
from support.stored import ALL, IMPACTS, LYAPUNOV, PLANE, SECTION, SWEEP, broken_off, scene_of

import vibro_sweep as vs
from vibro_sweep import store
from vibro_sweep.driver import blocks, compute
from vibro_sweep.driver.provenance import provenance


@pytest.mark.parametrize("part", sample(1, [False, True]))
def test_what_is_opened_can_be_copied_and_sent(path, part):
    scene = scene_of(PLANE + ALL)
    path = broken_off(scene, path) if part else vs.run(scene, path) and path
    with vs.open(path) as data:
        sent = pickle.loads(pickle.dumps(data))
        assert sent.identical(data) and data.copy(deep=True).identical(data)
        sent.close()
        assert data["x1"][0, 1:, ::2].shape == (2, 2) and data.isel(b=[2, 0])["b"].values.tolist() == [6.7, 6.5]


def test_a_file_that_is_being_written_can_be_read(path):
    scene = scene_of(SWEEP)
    with store.writer(store.sweep_run(scene, provenance()), path, "new"):
        part = f"{path}.part"
        assert "computed     0 of 3" in in_another_process(
            f"from vibro_sweep.cli.info import examine; print(examine('{part}').text)"
        )
        assert "{'b': 3, 'sample': 4}" in in_another_process(
            f"import vibro_sweep as v; print(dict(v.open('{part}').sizes))"
        )


def in_another_process(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


@pytest.mark.parametrize("starts", [1, 2])
def test_what_is_missing_and_what_is_done(path, starts):
    scene = scene_of(PLANE + f"start: {{random: {starts}}}\nobserve: [impacts]")
    (*_, last) = blocks.blocks(scene, points_per_block=2)
    with store.writer(store.sweep_run(scene, provenance()), path, "new") as file:
        everything = (slice(None), slice(None))
        assert file.done() == 0 and file.missing(everything)
        file.write(*compute.compute(last))
        assert file.done() == starts
        assert file.missing(everything) and file.missing((slice(1, 2), slice(1, 3)))
        assert not file.missing((slice(1, 2), slice(2, 3)))


def test_describe_says_how_far_it_is(path):
    scene = scene_of(SWEEP + ALL)
    part = broken_off(scene, path)
    assert "computed     1 of 3 orbits (33.33 %)" in described(part)
    vs.run(scene, path, mode="resume")
    text = described(path)
    assert "computed     3 of 3 orbits (100 %)" in text and "complete" in text and "|sum of exponents" in text
    for name in SECTION | LYAPUNOV | IMPACTS | {"b"}:
        assert name in text
