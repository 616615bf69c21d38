"""The same numbers, bit for bit, by any way to compute them: workers, blocks, executors, and after an interruption."""

import math
import multiprocessing
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from support import sample, slow_cases
from support.clusters import Cluster
from support.contents import arrays_of, assert_same_bits
from support.scenes import ALL, EVERY, PAPER, done, run, scene_of

import vibro_sweep as vs

SAMPLE = ("random", "follow", "basins", "compliant, attractors", "compliant, follow")
EXECUTORS = ("threads", "spawned processes", "Dask")
# (a number of workers or an executor, points of a block; None: as many as take a moment)
WAYS = [(workers, block) for workers in (1, 2, 3) for block in (1, 4, None)] + [(how, 4) for how in EXECUTORS]
FAST = [("random", 2, 1), ("follow", 3, 4), ("basins", 2, 4)]
SLOW = [(name, *way) for name in SAMPLE for way in WAYS if (name, *way) not in FAST]
SLOW += [(name, 3, block) for name in EVERY if name not in SAMPLE for block in (1, 4)]


class Expected:
    """The arrays of each scene, computed when they are first asked for: by one worker, in blocks of its own choice."""

    def __init__(self, folder):
        self.folder, self.arrays = folder, {}

    def __call__(self, name: str) -> dict:
        if name not in self.arrays:
            self.arrays[name] = run(self.folder, *EVERY[name], workers=1)
            assert np.isin(self.arrays[name]["status"], (0, 6)).all()
        return self.arrays[name]


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return Expected(tmp_path_factory.mktemp("expected"))


class Executors:
    """Executors with two workers each, begun when they are first asked for."""

    def __init__(self, folder):
        self.folder, self.begun, self.cluster = folder, {}, None

    def __call__(self, how: str) -> Executor:
        if how not in self.begun:
            self.begun[how] = {
                "threads": lambda: ThreadPoolExecutor(2),
                "spawned processes": lambda: ProcessPoolExecutor(2, multiprocessing.get_context("spawn")),
                "Dask": self.dask,
            }[how]()
        return self.begun[how]

    def dask(self) -> Executor:
        distributed = pytest.importorskip("distributed")
        self.cluster = Cluster(self.folder)
        for _ in range(2):
            self.cluster.worker()
        self.cluster.wait_for_workers(2)
        self.client = distributed.Client(self.cluster.address, set_as_default=False)
        return self.client.get_executor()

    def end(self) -> None:
        for executor in self.begun.values():
            executor.shutdown()
        if self.cluster:
            self.client.close()
            self.cluster.end()


@pytest.fixture(scope="module")
def executors(tmp_path_factory):
    executors = Executors(tmp_path_factory.mktemp("cluster"))
    yield executors
    executors.end()


class Interruption(Exception):  # noqa: N818
    pass


@pytest.mark.parametrize("name, workers, block", [*FAST, *slow_cases(*SLOW)])
def test_the_same_bits(tmp_path, expected, executors, name, workers, block):
    """At once; and interrupted after the first block, and resumed."""
    how = {"executor": executors(workers)} if workers in EXECUTORS else {"workers": workers}
    assert_same_bits(run(tmp_path, *EVERY[name], block=block, **how), expected(name))

    steps = []

    def stop(done, total):
        steps.append(done)
        if 0 < done < total:
            raise Interruption

    scene, path = scene_of(*EVERY[name]), tmp_path / "interrupted.h5"
    try:
        vs.run(scene, path, block=block, progress=stop, **how)
    except Interruption:
        report = vs.run(scene, path, block=block, mode="resume", **how)
        assert 0 < report.computed < report.points
    else:
        assert len(steps) == 2  # there was one block
    assert_same_bits(arrays_of(path), expected(name))


@pytest.mark.parametrize("name", ["random", "follow"])
def test_a_block_has_so_many_points(tmp_path, name):
    """Of a `follow` the axis that it follows is never cut, and each direction is a block of its own."""
    blocks, points = [], math.prod(scene_of(*EVERY[name]).sweep_shape)
    for size in (1, 1000):
        steps = []
        run(tmp_path, *EVERY[name], block=size, progress=lambda done, _, steps=steps: steps.append(done))
        blocks.append(len(steps) - 1)  # it is called before the first block, too
    assert blocks == ([2, 2] if name == "follow" else [points, 1])


class FreshThreads(Executor):
    """Each block in a thread of its own, which begins with tables of its own."""

    def submit(self, function, *arguments):
        with ThreadPoolExecutor(1) as thread:
            return thread.submit(function, *arguments)


@pytest.mark.parametrize("model", ["", "mu_c: 2, "])
def test_tables_do_not_depend_on_those_in_whose_place_they_come(tmp_path, model):
    """What an oscillator shares with the one before it in its lane (cells, phase, all but the stops) stays there."""
    text = f"""
sweep:
  tau: {{values: [0.1, 0.2, 0.3]}}
  omega: {{values: [0.2, 0.21, 0.6, 0.61, 0.62, 0.63, 0.64, 0.65, 0.66, 0.67, 0.7, 0.71]}}
orbit: {{transient: 20, record: 10}}
{ALL}
"""
    system = f"{model}{PAPER}".replace("b: 6.6", "b: 6")
    together = run(tmp_path, text, system, block=100, workers=1)
    assert_same_bits(run(tmp_path, text, system, block=1, executor=FreshThreads()), together)


@pytest.mark.parametrize("name", sample(1, ["random", "compliant"]))
def test_a_trajectory_leaves_all_else_as_it_is(tmp_path, name):
    text, *system = EVERY[name]
    asked = "trajectory: {periods: 2, samples: 50}\n"
    assert asked in text
    found, alone = run(tmp_path, text, *system), run(tmp_path, text.replace(asked, ""), *system)
    assert alone.keys() < found.keys()
    assert_same_bits({key: found[key] for key in alone}, alone)


def test_starts_depend_on_the_seed_alone(tmp_path):
    text = "sweep: {b: {values: [1, 2]}}\nstart: {random: 500, seed: SEED}\norbit: {transient: 0, record: 1}"
    same, again, other = (run(tmp_path, text.replace("SEED", seed))["x1"] for seed in "112")
    assert np.array_equal(same, again) and not np.any(same == other)


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
    output = tmp_path / "out.h5"
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
    assert 0 < done(output) < 300

    seen = []
    vs.run(vs.load_scene(scene), output, progress=lambda *progress: seen.append(progress), mode="resume")
    assert seen[0][0] > 0 and seen[-1] == (300, 300)
    assert [path.name for path in tmp_path.iterdir()] == ["out.h5"]
    assert_same_bits(arrays_of(output), whole)
