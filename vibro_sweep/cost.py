"""What a scene costs: the time of an orbit, measured on a few, and from it the size of a block."""

import math
import os
import time
from dataclasses import dataclass, replace

import numpy as np

from vibro_sweep import store
from vibro_sweep.blocks import blocks
from vibro_sweep.compute import compute
from vibro_sweep.kernels.lanes import LANES
from vibro_sweep.kernels.points import RESULT
from vibro_sweep.scene import Scene

POINTS = 8  # that are measured, spread over the sweep
STARTS = 4
MEASURED = 0.02  # seconds that a measurement takes at least, where the scene has as many periods
BLOCKS_PER_WORKER = 8  # at least, so that workers end together
BLOCK_BYTES, BYTES_UNDER_WAY = 12e6, 1e9


@dataclass
class Estimate:
    """What `sweep.run` would do; `seconds` is measured on a few points, for this machine's cores."""

    points: int
    orbits: int
    periods: int
    bytes: int
    seconds: float


def estimate(scene: Scene) -> Estimate:
    """What `sweep.run` would do."""
    orbits = scene.n_points
    seconds = orbits * orbit_seconds(scene) / available_cores()
    return Estimate(orbits, orbits, orbits * (scene.transient + scene.record), store.size(scene), seconds)


def orbit_seconds(scene: Scene) -> float:
    """Seconds of one core for an orbit of the scene, measured on a few; compiles what the scene needs."""
    total = scene.transient + scene.record
    periods = 8
    compute(_thinned(scene, periods))  # compiles
    while True:
        periods = min(periods, total)
        block = _thinned(scene, periods)
        began = time.perf_counter()
        _, arrays = compute(block)
        seconds = time.perf_counter() - began
        if seconds >= MEASURED or periods == total:
            return seconds / arrays["status"].size * total / periods
        periods *= 4


def _thinned(scene: Scene, periods: int):
    """A block of some points and starts of the scene, spread over the sweep, with fewer periods in proportion."""
    total = scene.transient + scene.record
    record = max(1, scene.record * periods // total)
    along = round(POINTS ** (1 / max(1, len(scene.sweep))))
    few = replace(
        scene,
        sweep={key: values[_spread(len(values), along)] for key, values in scene.sweep.items()},
        start=replace(scene.start, count=min(scene.start.count, STARTS)),
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
    bytes_each = orbits * (store.size(scene) / scene.n_points + RESULT.itemsize)
    by_time = seconds / (orbits * orbit_seconds)
    by_memory = min(BLOCK_BYTES, BYTES_UNDER_WAY / workers) / bytes_each
    fair = scene.n_points / orbits / (BLOCKS_PER_WORKER * workers)
    count = max(1, int(min(by_time, by_memory, fair)))
    return count - count % LANES if count > LANES else count  # that many orbits are computed at once


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
