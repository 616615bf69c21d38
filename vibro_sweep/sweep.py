"""From a scene to its file: blocks of points, computed by an executor, handed to the store as they come."""

import itertools
import math
import os
import platform
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vibro_sweep import store
from vibro_sweep.blocks import Block, blocks, compute, plan_of
from vibro_sweep.kernels.status import MEANINGS, OK
from vibro_sweep.scene import Scene


@dataclass
class RunReport:
    """What `run` did: orbits in the file, how many have a bad status, how many have which, and the wall time."""

    points: int
    bad: int
    statuses: dict[str, int]
    seconds: float


@dataclass
class Estimate:
    """What `run` would do; `seconds` is measured on a few points, for this machine's cores."""

    points: int
    orbits: int
    periods: int
    bytes: int
    seconds: float


def run(
    scene: Scene,
    output: str | Path,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
    mode: str = "new",
) -> RunReport:
    """Compute a scene and write its file.

    Parameters
    ----------
    output : the HDF5 file; while it is computed it is `output`.part, readable at any moment
    workers : threads, by default one for each core
    executor : any `concurrent.futures.Executor` instead
    progress : called as progress(done, total) in orbits, from this thread
    mode : "new", "resume" (continue `output`.part where it stopped) or "overwrite"

    Results do not depend on workers, executor, block size or interruptions, bit for bit. Raises `store.StoreError`
    for a file that is in the way or does not fit the scene, and lets KeyboardInterrupt through once the file is safe.
    """
    began = time.perf_counter()
    count = workers or available_cores()
    with store.writer(scene, Path(output), mode) as file:
        missing = file.missing()
        total = scene.n_points
        done = total - int(np.count_nonzero(missing)) * scene.n_starts
        if progress:
            progress(done, total)
        pool = executor or ThreadPoolExecutor(count)
        try:
            todo = (block for block in blocks(scene, count) if missing[block.box].any())
            for box, arrays in _in_turn(pool, todo, 2 * getattr(pool, "_max_workers", count)):
                file.write(box, arrays)
                done += arrays["status"].size
                if progress:
                    progress(min(done, total), total)
        finally:
            if executor is None:
                pool.shutdown(cancel_futures=True)
        seconds = time.perf_counter() - began
        statuses = file.finish(_provenance(scene, count if executor is None else None, executor, seconds))
    bad = sum(number for code, number in statuses.items() if code != OK)
    named = {MEANINGS[code]: number for code, number in statuses.items()}
    return RunReport(total, bad, named, seconds)


def _in_turn(pool: Executor, todo: Iterator[Block], window: int):
    """Results as they come; no more than `window` blocks are under way, so that memory stays bounded."""
    under_way = {pool.submit(compute, block) for block in itertools.islice(todo, window)}
    try:
        while under_way:
            finished, under_way = wait(under_way, return_when=FIRST_COMPLETED)
            for future in finished:
                yield future.result()
            under_way |= {pool.submit(compute, block) for block in itertools.islice(todo, len(finished))}
    finally:
        for future in under_way:
            future.cancel()


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def estimate(scene: Scene) -> Estimate:
    """What `run` would do. The time is measured on at most eight points of the sweep, with at most 300 periods each."""
    orbits = scene.n_points
    periods = scene.transient + scene.record
    parameters = scene.parameters()
    pick = np.unique(np.linspace(0, math.prod(scene.sweep_shape) - 1, 8).astype(int))
    some = {name: values.reshape(-1)[pick] for name, values in parameters.items()}
    share = min(1.0, 300 / periods)
    plan = plan_of(scene)
    short = plan._replace(
        transient=int(plan.transient * share),
        record=max(1, int(plan.record * share)),
        warm_up=min(plan.warm_up, int(plan.transient * share)),
    )
    block = Block((), short, some, np.zeros((1, 4)), None, (), 0, "section" in scene.observe, False, scene.expand_at)
    compute(block)  # compiles
    began = time.perf_counter()
    compute(block)
    seconds = (time.perf_counter() - began) / len(pick) * periods / (short.transient + short.record)
    return Estimate(orbits, orbits, orbits * periods, store.size(scene), orbits * seconds / available_cores())


def _provenance(scene: Scene, threads: int | None, executor: Executor | None, seconds: float) -> dict:
    """How the file was made, as one JSON record."""
    from importlib.metadata import version

    from vibro_sweep import __version__

    packages = ("numpy", "numba", "llvmlite", "h5py")
    return {
        "vibro_sweep": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in packages},
        "cpu": _cpu_name(),
        "executor": "threads" if executor is None else type(executor).__name__,
        "threads": threads,
        "seed": scene.start.seed if scene.start.kind == "random" else None,
        "wall_time_s": round(seconds, 3),
    }


def _cpu_name() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
