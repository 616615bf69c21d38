"""From a scene to its file: blocks of points, computed by an executor, handed to the store as they come."""

import platform
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from vibro_sweep import store
from vibro_sweep.blocks import blocks
from vibro_sweep.compute import RunError
from vibro_sweep.cost import available_cores, orbit_seconds, points_per_block
from vibro_sweep.kernels.status import MEANINGS, OK
from vibro_sweep.pool import as_computed
from vibro_sweep.scene import Scene

__all__ = ["RunError", "RunReport", "run"]

THREAD_SECONDS, SECONDS = 1.0, 4.0  # of a block: long enough for its overhead not to count, short enough to lose


@dataclass
class RunReport:
    """What `run` did: orbits in the file, how many have a bad status, how many have which, and the wall time."""

    points: int
    bad: int
    statuses: dict[str, int]
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
    workers : threads, by default one for each core; of an `executor` that does not say how many it has, its workers
    executor : any `concurrent.futures.Executor` instead
    progress : called as progress(done, total) in orbits, from this thread
    mode : "new", "resume" (continue `output`.part where it stopped) or "overwrite"

    Results do not depend on workers, executor, block size or interruptions, bit for bit. Memory is that of the blocks
    under way, whatever the size of the sweep. Raises `store.StoreError` for a file that is in the way or does not fit
    the scene, RunError where workers fail, and lets KeyboardInterrupt through once the file is safe; threads that are
    in a block then, end with it.
    """
    began = time.perf_counter()
    with store.writer(scene, Path(output), mode) as file:
        total, done = scene.n_points, file.done()
        if progress:
            progress(done, total)
        if done < total:
            with closing(_results(scene, file, workers or available_cores(), executor)) as results:
                for box, arrays in results:
                    file.write(box, arrays)
                    done += arrays["status"].size
                    if progress:
                        progress(min(done, total), total)
        seconds = time.perf_counter() - began
        threads = (workers or available_cores()) if executor is None else None
        statuses = file.finish(_provenance(scene, threads, executor, seconds))
    bad = sum(number for code, number in statuses.items() if code != OK)
    named = {MEANINGS[code]: number for code, number in statuses.items()}
    return RunReport(total, bad, named, seconds)


def _results(scene: Scene, file: store.Writer, workers: int, executor: Executor | None) -> Iterator[tuple]:
    """Results of all blocks with a point that is missing in the file, as they come."""
    cost = _off_the_main_thread(orbit_seconds, scene)
    pool = executor or ThreadPoolExecutor(workers)
    size = points_per_block(scene, cost, _worker_count(pool, workers), THREAD_SECONDS if executor is None else SECONDS)
    todo = (block for block in blocks(scene, size) if file.missing(block.box).any())
    try:
        # one block for each worker: it gets its next when the one before is safe in the file
        yield from as_computed(pool, todo, lambda: _worker_count(pool, workers))
    finally:
        if executor is None:
            pool.shutdown(wait=False, cancel_futures=True)


def _off_the_main_thread(function: Callable, *arguments):
    """Its result; meanwhile Ctrl-C is answered, which neither the compiler nor compiled code do."""
    pool = ThreadPoolExecutor(1)
    try:
        return pool.submit(function, *arguments).result()
    finally:
        pool.shutdown(wait=False)


def _worker_count(pool: Executor, default: int) -> int:
    """Blocks that an executor computes at a time, now: it may grow. mpi4py and `cluster` call it `num_workers`."""
    return getattr(pool, "num_workers", None) or getattr(pool, "_max_workers", None) or default


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
