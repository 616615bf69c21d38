"""The same numbers, bit for bit, by any workers, blocks and executors, and after an interruption."""

import math
import multiprocessing
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from support import sample, slow_cases
from support.scene_texts import parsed
from support.scenes import ALL, EVERY, PAPER, arrays_of, assert_same_bits, done, run, scene_of

import vibro_sweep as vs
from vibro_sweep.driver import blocks, compute
from vibro_sweep.driver.drawn_starts import starts_of

SMALL = ("random", "attractors")


@pytest.mark.parametrize(
    "name",
    [
        "random",
        *slow_cases("follow", "attractors", "compliant", "plane", "basins", "compliant, follow", "compliant, force"),
    ],
)
def test_workers_do_not_matter(tmp_path, name):
    one = run(tmp_path, *EVERY[name], workers=1)
    assert np.isin(one["status"], (0, 6)).all()
    for workers in (2, 3):
        assert_same_bits(run(tmp_path, *EVERY[name], workers=workers), one)


@pytest.mark.parametrize("model", ["", "mu_c: 2, "])
def test_tables_do_not_depend_on_those_in_whose_place_they_come(model):
    """What an oscillator shares with the one before it in its lane (cells, phase, all but the stops) stays there."""
    text = f"""
system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, {model}R: 0.8, b: 6}}
sweep:
  tau: {{values: [0.1, 0.2, 0.3]}}
  omega: {{values: [0.2, 0.21, 0.6, 0.61, 0.62, 0.63, 0.64, 0.65, 0.66, 0.67, 0.7, 0.71]}}
orbit: {{transient: 20, record: 10}}
observe: [section, lyapunov, impacts]
"""
    scene = parsed(text)
    ((_, together),) = (compute.compute(block) for block in blocks.blocks(scene, points_per_block=100))
    for block in blocks.blocks(scene, points_per_block=1):
        with ThreadPoolExecutor(1) as fresh:  # a thread has its own tables
            box, alone = fresh.submit(compute.compute, block).result()
        for key, values in alone.items():
            assert together[key][box].tobytes() == values.tobytes(), (box, key)


@pytest.mark.parametrize("name", sample(1, ["random", "compliant"]))
def test_a_trajectory_leaves_all_else_as_it_is(tmp_path, name):
    text, *system = EVERY[name]
    asked = "trajectory: {periods: 2, samples: 50}\n"
    assert asked in text
    found, alone = run(tmp_path, text, *system), run(tmp_path, text.replace(asked, ""), *system)
    assert alone.keys() < found.keys()
    assert_same_bits({key: found[key] for key in alone}, alone)


@pytest.mark.parametrize("name", [*SMALL, *slow_cases(*[name for name in EVERY if name not in SMALL])])
def test_block_size_does_not_matter(tmp_path, name):
    scene, whole = scene_of(*EVERY[name]), run(tmp_path, *EVERY[name])
    blocks_of = {}
    for size in (1, 4, 1000):
        steps = []
        again = run(tmp_path, *EVERY[name], block=size, progress=lambda done, _, steps=steps: steps.append(done))
        blocks_of[size] = len(steps) - 1  # it is called before the first block, too
        assert_same_bits(again, whole)
    # of a `follow`, the axis that it follows is never cut, and each direction is a block of its own
    assert (blocks_of[1], blocks_of[1000]) == ((2, 2) if "follow" in name else (math.prod(scene.sweep_shape), 1))


@pytest.mark.parametrize("name", slow_cases("random", "compliant, force"))
def test_executors_do_not_matter(tmp_path, name):
    own = run(tmp_path, *EVERY[name])
    with ThreadPoolExecutor(2) as pool:
        assert_same_bits(run(tmp_path, *EVERY[name], executor=pool), own)
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert_same_bits(run(tmp_path, *EVERY[name], executor=pool), own)


def test_random_starts(tmp_path):
    """They depend on the seed and on the place in the sweep, and are spread over |x_i| < b, |v_i| < omega b."""
    text = "sweep: {b: {values: [1, 2]}}\nstart: {random: 500, seed: SEED}\norbit: {transient: 0, record: 1}"
    (block,) = blocks.blocks(scene_of(text.replace("SEED", "1")), points_per_block=2)
    starts = starts_of(block) / np.array([1, 0.63, 1, 0.63])
    assert starts.shape == (2, 500, 4) and len(np.unique(starts)) == starts.size
    for b, drawn in zip((1, 2), starts / np.array([[[1]], [[2]]]), strict=True):
        assert np.all(abs(drawn) < 1), b
        np.testing.assert_allclose(drawn.mean(axis=0), 0, atol=0.1)
        np.testing.assert_allclose((drawn**2).mean(axis=0), 1 / 3, atol=0.05)
    one, same, other = (run(tmp_path, text.replace("SEED", seed))["x1"] for seed in "112")
    assert np.array_equal(one, same) and not np.any(one == other)


@pytest.fixture(scope="module")
def long_scene(tmp_path_factory):
    """A scene of some seconds, in several blocks, and its numbers."""
    folder = tmp_path_factory.mktemp("long")
    path = folder / "long.yaml"
    text = f"sweep: {{b: {{start: 6.5, stop: 6.8, num: 300}}}}\norbit: {{transient: 200000, record: 200}}\n{ALL}\n"
    path.write_text(f"system: {{{PAPER}}}\n{text}")
    return path, run(folder, text)


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGINT, *slow_cases(signal.SIGKILL)])
def test_interrupted_and_resumed(tmp_path, long_scene, how):
    scene, whole = long_scene
    output, part = tmp_path / "out.h5", tmp_path / "out.h5.part"
    command = [sys.executable, "-m", "vibro_sweep", "run", scene, "-o", output, "--workers", "1", "--quiet"]

    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    limit = time.monotonic() + 60
    while not done(output):
        assert process.poll() is None and time.monotonic() < limit
        time.sleep(0.02)
    process.send_signal(how)
    error = process.communicate()[1]
    assert process.returncode == (130 if how == signal.SIGINT else -signal.SIGKILL)
    assert ("--resume" in error) == (how == signal.SIGINT)
    assert 0 < done(output) < 300 and not output.exists()

    seen = []
    vs.run(vs.load_scene(scene), output, progress=lambda *progress: seen.append(progress), mode="resume")
    assert seen[0][0] > 0 and seen[-1] == (300, 300)
    assert not part.exists()
    assert_same_bits(arrays_of(output), whole)
