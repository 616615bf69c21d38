"""Blocks through executors of every kind: those that lose workers, grow, answer in any order, or break."""

import contextlib
import math
import multiprocessing
import pickle
import random
import signal
import subprocess
import sys
import time
import tracemalloc
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from itertools import islice
from types import SimpleNamespace

import numpy as np
import pytest
from support import sample
from support.contents import arrays_of, assert_same_bits
from support.scenes import PAPER, SCENES, scene_of

import vibro_sweep as vs
from vibro_sweep.driver import blocks, executors, memory_needed
from vibro_sweep.driver.block_size import BlockSize
from vibro_sweep.driver.compute import BlockError, compute
from vibro_sweep.engine.records import result_of
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.results.boxes import boxes

LIMIT = 60  # seconds after which something hangs
CHAINS = 3 * LANES  # in three blocks, each way
FOLLOW = SCENES["follow"].replace("values: [0.9, 0.8, 0.3]", f"start: 0.9, stop: 0.4, num: {CHAINS}")
HUGE = """
sweep: {omega: {start: 0.5, stop: 0.8, num: 4000}, zeta: {start: 0.02, stop: 0.1, num: 4000}}
start: {random: 16, seed: 1}
orbit: {transient: 60000, record: 2500}
observe: [lyapunov, impacts]"""


class Answering(Executor):
    """Answers every block at once with `reply(block)`, or with what that raises."""

    def __init__(self, reply):
        self.reply, self.sent = reply, []

    def submit(self, function, block):
        self.sent.append(block)
        future = Future()
        try:
            future.set_result(self.reply(block))
        except Exception as error:
            future.set_exception(error)
        return future


class Shuffling(Executor):
    """Answers one of the waiting blocks when no more of `total` come; has one worker, and three after ten blocks."""

    def __init__(self, total):
        self.total, self.num_workers, self.waiting, self.most, self.order = total, 1, [], {1: 0, 3: 0}, []

    def submit(self, function, block):
        future = Future()
        self.waiting.append((future, function, block))
        self.most[self.num_workers] = max(self.most[self.num_workers], len(self.waiting))
        return future

    def serve(self, stop):
        choice = random.Random(1)
        limit = time.monotonic() + 10
        while not stop:
            time.sleep(0.001)
            full = len(self.waiting) >= min(self.num_workers, self.total - len(self.order))
            if self.waiting and (full or time.monotonic() > limit):
                future, function, block = self.waiting.pop(choice.randrange(len(self.waiting)))
                self.order.append(block.box)
                self.num_workers = 3 if len(self.order) > 10 else 1
                future.set_result(function(block))


@contextlib.contextmanager
def serving(pool):
    stop = []
    with ThreadPoolExecutor(1) as thread:
        thread.submit(pool.serve, stop)
        try:
            yield pool
        finally:
            stop.append(True)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The arrays of a scene of six blocks."""
    path = tmp_path_factory.mktemp("whole") / "whole.h5"
    vs.run(scene_of(FOLLOW), path)
    return arrays_of(path)


def test_any_order_and_a_window_that_follows_the_workers(tmp_path):
    scene = scene_of(SCENES["plane"])
    vs.run(scene, tmp_path / "own.h5")
    with serving(Shuffling(35)) as pool:
        vs.run(scene, tmp_path / "out.h5", executor=pool, block=1)
    assert pool.most == {1: 1, 3: 3}
    assert len(pool.order) == 35 and pool.order != sorted(pool.order, key=str)
    assert_same_bits(arrays_of(tmp_path / "out.h5"), arrays_of(tmp_path / "own.h5"))


def test_lost_blocks_are_sent_again(tmp_path, whole):
    lost = []

    def reply(block):
        if lost.count(block.box) < 2 and block.box[1].start == LANES:
            lost.append(block.box)
            raise ConnectionError("the worker is gone")
        return compute(block)

    vs.run(scene_of(FOLLOW), tmp_path / "out.h5", executor=Answering(reply))
    assert len(lost) == 4  # in both directions, twice
    assert_same_bits(arrays_of(tmp_path / "out.h5"), whole)


@pytest.mark.parametrize(
    "error, attempts, words",
    sample(
        1,
        [
            (
                ConnectionError("the worker is gone"),
                3,
                "3 attempts at b = .*, R = 0.7.* were lost .*worker is gone",
            ),
            (ModuleNotFoundError("No module named 'vibro_sweep'"), 1, "a worker cannot load vibro_sweep .*No module"),
            (
                BlockError("worker host, failed at b = 6.5: MemoryError"),
                1,
                "worker host, failed at b = 6.5: MemoryError",
            ),
        ],
    ),
)
def test_what_ends_a_run_loses_nothing(tmp_path, whole, error, attempts, words):
    scene, output, sent = scene_of(FOLLOW), tmp_path / "out.h5", []

    def reply(block):
        if block.box[1].start == LANES:
            sent.append(block.box)
            raise error
        return compute(block)

    with pytest.raises(vs.RunError, match=words):
        vs.run(scene, output, executor=Answering(reply))
    assert sent.count(sent[0]) == attempts
    seen = []
    vs.run(scene, output, mode="resume", progress=lambda done, total: seen.append(done))
    # nine points of eight chains each way came before it, and others may have come meanwhile
    assert 9 * 2 * LANES <= seen[0] < 9 * 2 * CHAINS
    assert_same_bits(arrays_of(output), whole)


def test_an_error_in_a_block_says_where(monkeypatch):
    block = next(blocks.blocks(scene_of(SCENES["plane"]), lambda: 3))
    monkeypatch.setattr("vibro_sweep.driver.compute.table_of", lambda *_, **__: 1 / 0)
    with pytest.raises(BlockError, match=r"process \d+, failed at omega = 0.5, b = 0.3 .. 2.4\d*: ZeroDivisionError"):
        compute(block)


def test_a_worker_with_other_code_refuses():
    block = next(blocks.blocks(scene_of(SCENES["plane"]), lambda: 3))
    with pytest.raises(BlockError, match=r"has vibro_sweep .*; this program is vibro_sweep 9, code 0"):
        compute(block._replace(version="vibro_sweep 9, code 0"))


@pytest.mark.slow
def test_a_broken_process_pool_is_resumed(tmp_path, whole):
    scene, output = scene_of(FOLLOW), tmp_path / "out.h5"
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:

        def kill(done, total):
            if done:
                for process in pool._processes.values():
                    process.kill()

        with pytest.raises(vs.RunError, match="a worker process died"):
            vs.run(scene, output, executor=pool, progress=kill)
    seen = []
    vs.run(scene, output, mode="resume", progress=lambda done, total: seen.append(done))
    assert 0 < seen[0] < 9 * 2 * CHAINS
    assert_same_bits(arrays_of(output), whole)


@pytest.mark.slow
def test_ctrl_c_does_not_wait_for_a_block(tmp_path):
    """One orbit of 10^9 periods, which takes minutes."""
    (tmp_path / "long.yaml").write_text(f"system: {{{PAPER}}}\norbit: {{transient: 1.0e+9, record: 1}}\n")
    command = [sys.executable, "-m", "vibro_sweep", "run", "long.yaml"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    limit = time.monotonic() + LIMIT
    while not (tmp_path / "long.h5").exists():
        assert process.poll() is None and time.monotonic() < limit
        time.sleep(0.02)
    time.sleep(1.5)  # until it is in the block
    process.send_signal(signal.SIGINT)
    assert "--resume" in process.communicate(timeout=LIMIT)[1]
    assert process.returncode == 130


def test_a_huge_plane_is_planned_lazily():
    """The phase of grazing differs at each of its 16 million points; a megabyte of it is never held."""
    scene = scene_of(HUGE)
    tracemalloc.start()
    planned = list(islice(blocks.blocks(scene, lambda: 30), 1000))
    compute(planned[-1]._replace(plan=planned[-1].plan._replace(transient=0, warm_up=0, record=1, parts=1)))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10e6
    for block in planned[:2]:
        assert len(pickle.dumps(block)) < 1200 + 8 * (1 + 30)


def grown(scene, seconds_of_a_point: float, workers: int, missing: int | None = None, asked: int | None = None):
    """The sizes of 20 blocks, each computed before the next."""
    size = BlockSize(scene, missing or scene.n_points, workers, 4.0, asked)
    sizes = []
    for _ in range(20):
        sizes.append(size())
        (block, *_) = islice(blocks.blocks(scene, lambda: sizes[-1]), 1)
        size.learn(block, sizes[-1] * seconds_of_a_point)
    return sizes


def test_blocks_grow(monkeypatch):
    """By time, by memory, and such that all workers have some."""
    scene = scene_of(SCENES["plane"].replace("num: 5", "num: 5000").replace("num: 7", "num: 7000"))
    assert grown(scene, 1e-3, 2)[:6] == [8, 32, 128, 512, 2048, 4000]
    assert set(grown(scene, 10.0, 2)) == {8}
    assert set(grown(scene, 1e-9, 2, asked=77)) == {72}  # whole eights
    each = 32 * scene.record + result_of(2).itemsize
    assert 0.7 < grown(scene, 1e-9, 2)[-1] * each / memory_needed.BLOCK_BYTES < 1
    monkeypatch.setattr(memory_needed, "available_cores", lambda: 2)
    assert 0.7 < grown(scene, 1e-9, 1000)[-1] * each / (memory_needed.BYTES_UNDER_WAY / 1000) < 1
    small = scene_of(SCENES["plane"])
    assert set(grown(small, 1e-9, 1)) == {35 // 8} and set(grown(small, 1e-9, 1, missing=3)) == {1}


@pytest.mark.parametrize("shape", [(), (7,), (5, 7), (3, 4, 5), (1, 9, 1), (6, 1, 4)])
def test_boxes_of_any_sizes_are_the_grid(shape):
    rng = np.random.default_rng(1)
    for most in (1, 3, 8, 30, 1000):
        flat = np.arange(math.prod(shape)).reshape(shape)
        begin, end = np.sort(rng.integers(flat.size + 1, size=2)).tolist() if shape else (0, 1)
        sizes = rng.integers(1, most + 1, flat.size).tolist()
        found = list(boxes(shape, iter(sizes).__next__, begin, end))
        assert [n for box in found for n in flat[box].ravel()] == list(range(begin, end))
        assert all(flat[box].size <= size for box, size in zip(found, sizes, strict=False))


class Silent(Executor):
    """Of a scheduler that died when it was sent something: no future is ever done, or all are cancelled."""

    def __init__(self, gone):
        self._client = SimpleNamespace(status="closed" if gone else "running")  # as Dask's executor has it

    def submit(self, function, *arguments):
        future = Future()
        if self._client.status == "running":
            future.cancel()
            future.set_running_or_notify_cancel()
        return future


@pytest.mark.parametrize("gone", [True, False])
def test_a_scheduler_that_dies_ends_in_one_message(monkeypatch, tmp_path, gone):
    monkeypatch.setattr(executors, "PATIENCE", 0.01)
    with pytest.raises(vs.RunError, match="the scheduler has died"):
        list(executors.completed(Silent(gone), abs, iter([-1, None]).__next__, lambda: 1))
    with pytest.raises(vs.RunError, match="the scheduler has died"):
        vs.run(scene_of(SCENES["follow"]), tmp_path / "x.h5", executor=Silent(gone))
