"""What a scene costs: the time of an orbit, measured on a few, and from it the size of a block."""

import math
import time
from dataclasses import dataclass, replace

import numpy as np

from vibro_sweep import store
from vibro_sweep.driver.blocks import Block, blocks
from vibro_sweep.driver.compute import compute
from vibro_sweep.driver.memory import available_cores, orbits_per_block
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.scene import Scene

POINTS = 8  # that are measured, spread over the sweep
STARTS = 4
MEASURED = 0.02  # seconds of this thread that a measurement takes at least, where the scene has as many periods
LOADING = 1.0  # seconds that kernels take to be loaded from the cache, at most
WRITING = 5e7  # bytes a second: results are written into the part, and from there into the file
EASY = 1e9  # forcing frequency
BLOCKS_PER_WORKER = 8  # at least, so that workers end together


@dataclass
class Estimate:
    """What `sweep.run` would do; `seconds` is measured on a few points, for this machine's cores.

    Part of it is what each run begins with, loading kernels and measuring orbits, and the writing of its file.
    """

    points: int
    orbits: int
    periods: int
    bytes: int
    seconds: float


def estimate(scene: Scene, workers: int | None = None) -> Estimate:
    """What `sweep.run` would do with so many threads, by default one for each core."""
    orbits, size = scene.n_points, store.size(scene)
    began = time.perf_counter()
    each = orbit_seconds(scene)
    beginning = min(time.perf_counter() - began, LOADING)  # more than that was compiling
    seconds = beginning + orbits * each / side_by_side(scene, workers or available_cores()) + size / WRITING
    return Estimate(orbits, orbits, orbits * (scene.transient + scene.record), size, seconds)


def side_by_side(scene: Scene, workers: int) -> int:
    """Workers that have something to do: those of a `follow` take chains, each point of which waits for the last."""
    return min(workers, scene.n_points // (scene.sweep_shape[0] if scene.start.kind == "follow" else 1))


def duration(seconds: float) -> str:
    """Seconds, minutes or hours, to two digits or so."""
    if seconds < 100:
        return f"{seconds:.2g} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.3g} h"


def orbit_seconds(scene: Scene) -> float:
    """Seconds of one core for an orbit of the scene, measured on a few; compiles what the scene needs.

    One orbit over one period first, which may take seconds where the oscillator is stiff, and then is enough.
    """
    total = scene.transient + scene.record
    compute(_thinned(_eased(scene), 1, 1, 1))  # compiles
    seconds, orbits = _measured(_thinned(scene, 1, 1, 1))
    if seconds >= MEASURED:
        return seconds / orbits * total
    points, starts, periods = POINTS, STARTS, 1
    while True:
        seconds, orbits = _measured(_thinned(scene, points, starts, periods))
        if seconds >= MEASURED or periods == total:
            return seconds / orbits * total / periods
        periods = min(8 * periods, total)


def _eased(scene: Scene) -> Scene:
    """The scene with a period so short that nothing is stiff: the kernels that it needs are the same."""
    if "omega" not in scene.system.described:  # made by a function, which may have no such number
        return scene
    sweep = {key: np.array([EASY]) if key == "omega" else values for key, values in scene.sweep.items()}
    return replace(scene, sweep=sweep, system=scene.system.replace(omega=EASY))


def _measured(block: Block) -> tuple[float, int]:
    """Seconds that a block takes, and its orbits."""
    began = time.thread_time()
    _, arrays = compute(block)
    return time.thread_time() - began, arrays["status"].size


def _thinned(scene: Scene, points: int, starts: int, periods: int) -> Block:
    """A block of some points and starts of the scene, spread over the sweep, with fewer periods in proportion."""
    total = scene.transient + scene.record
    record = max(1, scene.record * periods // total)
    along = round(points ** (1 / max(1, len(scene.sweep))))
    few = replace(
        scene,
        sweep={key: values[_spread(len(values), along)] for key, values in scene.sweep.items()},
        start=replace(scene.start, count=min(scene.start.count, starts)),
        transient=min(scene.transient, max(0, periods - record)),
        record=record,
        trajectory=scene.trajectory and replace(scene.trajectory, periods=1, samples=2),
    )
    return next(blocks(few, math.prod(few.sweep_shape)))


def _spread(extent: int, count: int) -> np.ndarray:
    return np.unique(np.linspace(0, extent - 1, count).astype(int))


def points_per_block(scene: Scene, orbit_seconds: float, workers: int, seconds: float) -> int:
    """Points that take about so many seconds; fewer, where they would need too much memory or leave workers idle."""
    orbits = 1 if scene.start.kind == "follow" else scene.n_starts  # of a point in one block
    by_time = seconds / (orbits * orbit_seconds)
    by_memory = orbits_per_block(scene, workers) / orbits
    fair = scene.n_points / orbits / (BLOCKS_PER_WORKER * workers)
    count = max(1, int(min(by_time, by_memory, fair)))
    return count - count % LANES if count > LANES else count  # that many orbits are computed at once
