"""The cost of a scene from that of its orbits (measuring.py): the time of a run, and the size of a block."""

import math
import os
import tempfile
import time
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from numba.core import event

from vibro_sweep.driver import MOST_WORKERS, measuring
from vibro_sweep.driver.blocks import Block
from vibro_sweep.driver.compute import compute
from vibro_sweep.driver.measuring import OrbitCost
from vibro_sweep.driver.memory_needed import available_cores, orbits_per_block
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.model.arguments import checked_count
from vibro_sweep.results import layout
from vibro_sweep.scene import Scene

CROWDED = 0.1  # seconds for which all workers compute, to see how they get on
FEW_BYTES, WRITTEN = 10**6, 16 * 10**6  # of a file: those that take no time worth saying; those that are written to see
TRIES = 3  # of a file, of which the least counts: others wait for the disk as well
BLOCKS_PER_WORKER = 8  # at least, so that workers end together
BLOCK_SECONDS = 1.0  # of a thread's block: long enough for its overhead not to count, short enough to lose


@dataclass
class Estimate:
    """The estimated cost of `run`, measured on a few points, for this machine's cores.

    seconds : of the run beside what else the machine does now. Part of them is what each run begins with, loading
        kernels and measuring orbits, and the writing of its file
    alone : the same if the machine did nothing else
    most : the same as `seconds` if every orbit had to go on for all periods of `settle`
    compiling : seconds for which the estimate itself had to compile kernels; they are kept, and no run needs them again

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}, "
    >>> text += "sweep: {b: {start: 6.4, stop: 6.6, num: 3}}, orbit: {transient: 100, record: 50}}"
    >>> with open("cost.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> cost = vs.load_scene("cost.yaml").estimate()
    >>> cost.orbits, cost.periods, cost.seconds > 0
    (3, 450, True)
    """

    points: int
    orbits: int
    periods: int
    bytes: int
    seconds: float
    alone: float
    most: float
    compiling: float


def estimate(scene: Scene, workers: int | None = None) -> Estimate:
    """The estimated cost of `run` with so many threads, by default one for each core. ValueError for such a number."""
    if workers is not None:
        workers = checked_count("workers", workers, 1, MOST_WORKERS)
    count, orbits, size = workers or available_cores(), scene.n_points, layout.size(scene)
    compiling: list[float] = []
    began = time.perf_counter()
    with event.install_timer("numba:compile", compiling.append):
        cost = orbit_cost(scene, count)
    beginning = max(0.0, time.perf_counter() - began - sum(compiling))
    cost = measuring.repeated(cost)
    alone = run_seconds(scene, cost, orbits, count)
    beside = alone * crowding(cost, threads_of(scene, count))
    rest = beginning + writing_seconds(size)
    periods = orbits * (scene.transient + scene.record)
    most = rest + beside * longest(scene)
    return Estimate(orbits, orbits, periods, size, rest + beside, rest + alone, most, sum(compiling))


def longest(scene: Scene) -> float:
    """So many times longer than others orbits may take that go on for all periods of `settle`."""
    return (max(scene.transient, scene.settle or 0) + scene.record) / (scene.transient + scene.record)


def writing_seconds(size: int) -> float:
    """Seconds for a file of so many bytes with its checksums, by the time of a temporary one in the current folder."""
    if size < FEW_BYTES:
        return 0.0
    some = os.urandom(FEW_BYTES) * (min(size, WRITTEN) // FEW_BYTES)
    try:
        least = min(_written(some) for _ in range(TRIES))
    except OSError:  # a full disk: the run will say so
        return 0.0
    return size / len(some) * least


def _written(some: bytes) -> float:
    """Seconds in which a temporary file with these bytes is on the disk."""
    folder = os.curdir if os.access(os.curdir, os.W_OK) else None
    began = time.perf_counter()
    with tempfile.TemporaryFile(dir=folder) as file:
        zlib.crc32(some)
        file.write(some)
        file.flush()
        os.fsync(file.fileno())
    return time.perf_counter() - began


def orbit_cost(scene: Scene, workers: int) -> OrbitCost:
    """The cost of an orbit, in blocks as large as those of the scene's run; compiles what the scene needs."""
    measuring.compile_for(scene)
    width = max(1, min(LANES, int(_fair(scene, workers))))
    cost = measuring.orbit_cost(scene, width)
    points = points_per_block(scene, cost.seconds, workers, BLOCK_SECONDS)
    return cost if points >= width else measuring.orbit_cost(scene, points)


def run_seconds(scene: Scene, cost: OrbitCost, orbits: int, workers: int) -> float:
    """Seconds that threads take for so many orbits, if the machine does nothing else."""
    return orbits * cost.seconds / threads_of(scene, workers)


def threads_of(scene: Scene, workers: int) -> int:
    """Threads that compute at the same time: more than there are cores take turns."""
    return min(side_by_side(scene, workers), available_cores())


def crowding(cost: OrbitCost, threads: int) -> float:
    """The factor by which orbits take longer if so many threads compute them, beside what else the machine does now."""
    rounds = math.ceil(CROWDED / max(cost.sample_seconds, CROWDED / 1000))

    def work(_: int) -> None:
        for block in cost.sample * rounds:
            compute(block)

    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(_begin, [cost.sample[0]] * threads))
        began = time.perf_counter()
        list(pool.map(work, range(threads)))
        seconds = time.perf_counter() - began
    return max(1.0, seconds / (rounds * cost.sample_seconds))


def _begin(block: Block) -> None:
    """A thread's first block: it allocates what the thread works on."""
    compute(block)


def side_by_side(scene: Scene, workers: int) -> int:
    """Workers that have something to do: all starts of a point, and eight chains of a `follow`, are one worker's."""
    if scene.start.kind == "follow":
        directions = scene.n_starts
        return min(workers, directions * math.ceil(math.prod(scene.sweep_shape[1:]) / LANES))
    return min(workers, scene.n_points // scene.n_starts)


def duration(seconds: float) -> str:
    """Seconds, minutes or hours, to two digits or so."""
    if seconds < 100:
        return f"{seconds:.2g} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.3g} h"


def points_per_block(scene: Scene, orbit_seconds: float, workers: int, seconds: float, asked: int | None = None) -> int:
    """Points that take about so many seconds, or as many as are asked for; fewer, where they would need too much
    memory; without being asked, where they would leave workers idle."""
    orbits = 1 if scene.start.kind == "follow" else scene.n_starts  # of a point in one block
    by_memory = orbits_per_block(scene, workers) / orbits
    if asked is not None:
        return max(1, int(min(asked, by_memory)))
    by_time = seconds / (orbits * orbit_seconds)
    count = max(1, int(min(by_time, by_memory, _fair(scene, workers))))
    return count - count % LANES if count > LANES else count  # that many orbits are computed at once


def _fair(scene: Scene, workers: int) -> float:
    """Points of a block of which each worker gets several."""
    orbits = 1 if scene.start.kind == "follow" else scene.n_starts
    return scene.n_points / orbits / (BLOCKS_PER_WORKER * workers)
