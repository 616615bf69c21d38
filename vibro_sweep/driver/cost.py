"""The time that a scene will take, from a few of its orbits over a few of their periods."""

import math
import time
from dataclasses import dataclass, replace

import numpy as np
from numba.core import event

from vibro_sweep.checks.arguments import check_type, checked_count, names_its_arguments
from vibro_sweep.driver import MOST_WORKERS
from vibro_sweep.driver.block_size import BlockSize
from vibro_sweep.driver.blocks import blocks
from vibro_sweep.driver.compute import compute
from vibro_sweep.driver.memory_needed import available_cores
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.results import layout
from vibro_sweep.scene import Scene

ALWAYS = 0.2  # seconds of a run of any length: making the file, loading kernels
PLACES = 8  # of the sweep, at which orbits are computed, at most
ENOUGH = 0.1  # seconds of a measurement from which it may be the last one
LONGEST = 0.6  # seconds of all of them from which no other one begins
SHORT = 0.3  # seconds that one period of all these orbits may take
GROWN = 1.5  # times longer than the one before the last one takes, so that periods count in it
MANY = 8 * LANES  # orbits side by side at a place, at most
LONGER = 4  # times as many periods in the next measurement


@dataclass
class Estimate:
    """What `run` will take on this machine, by a few orbits; beside other work it may take twice as long, or more.

    most : the same as `seconds` if every orbit had to go on for all periods of `settle`
    compiling : seconds for which the estimate itself had to compile kernels; they are kept, and no run needs them again

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}, "
    >>> text += "sweep: {b: {start: 6.4, stop: 6.6, num: 3}}, orbit: {transient: 100, record: 50}}"
    >>> with open("cost.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> cost = vs.estimate(vs.load_scene("cost.yaml"))
    >>> cost.orbits, cost.periods, cost.seconds > 0
    (3, 450, True)
    """

    orbits: int
    periods: int
    bytes: int
    seconds: float
    most: float
    compiling: float


@names_its_arguments
def estimate(scene: Scene, workers: int | None = None) -> Estimate:
    """Orbits, bytes and seconds that `run` will take with so many threads, by default one for each core.

    Some orbits are computed for that. Of branches and curves it is known when they are followed. Raises TypeError for
    what is not a scene of orbits.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 3}, "
    >>> text += "orbit: {transient: 1.0e+9, record: 100}}"
    >>> with open("long.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> vs.estimate(vs.load_scene("long.yaml")).seconds > 60
    True
    """
    check_type("scene", scene, Scene, "a Scene of orbits, as of `load_scene`")
    if workers is not None:
        workers = checked_count("workers", workers, 1, MOST_WORKERS)
    periods, compiling = scene.transient + scene.record, []
    with event.install_timer("numba:compile", compiling.append):
        _timed(scene, 1, 1, 1)
    workers = workers or available_cores()
    work = scene.n_points * orbit_seconds(scene, workers) / threads_of(scene, workers)
    longest = (max(scene.transient, scene.settle or 0) + scene.record) / periods
    seconds, most = ALWAYS + work, ALWAYS + work * longest
    return Estimate(scene.n_points, scene.n_points * periods, layout.size(scene), seconds, most, sum(compiling))


def threads_of(scene: Scene, workers: int) -> int:
    """Threads that compute at the same time: all starts of a point, or eight chains of a `follow`, are one thread's."""
    if scene.start.kind == "follow":
        jobs = scene.n_starts * math.ceil(math.prod(scene.sweep_shape[1:]) / LANES)
    else:
        jobs = scene.n_points // scene.n_starts
    return min(workers, available_cores(), jobs)


def orbit_seconds(scene: Scene, workers: int) -> float:
    """CPU seconds of an orbit in the blocks of a run.

    A block has tables to be filled, and an orbit a record to be looked through, besides its periods: their time is that
    of one period of a large block. That of periods follows from orbits spread over the sweep: the time of a few is
    compared with that of more, until these take a moment, and the difference alone is multiplied.
    """
    total, most = scene.transient + scene.record, BlockSize(scene, scene.n_points, workers, 1.0, None).most
    beside, (now, orbits) = 1, _timed(scene, 1, 1, 1)
    while now < ENOUGH / PLACES and beside < most:
        beside = min(LANES * beside, most)
        now, orbits = _timed(scene, 1, beside, 1)
    once, block, beside = now / orbits, now * min(1.0, MANY / beside), min(beside, MANY)
    places = max(1, int(min(PLACES, SHORT / max(block, 1e-9))))
    (now, orbits), periods, shorter, before, slope = _timed(scene, places, beside, 1), 1, 1, 0.0, 0.0
    spent = now
    while periods < total and (periods == 1 or (now < max(ENOUGH, GROWN * before) and spent < LONGEST)):
        longer = min(LONGER * periods, total)
        before, (now, _) = now, _timed(scene, places, beside, longer)
        slope, periods, shorter, spent = max(0.0, now - before) / (longer - periods), longer, periods, spent + now
    if spent < LONGEST:  # once more: something else may have run meanwhile
        now = min(now, _timed(scene, places, beside, periods)[0])
        slope = max(0.0, now - before) / (periods - shorter) if periods > shorter else 0.0
    return once + slope * (total - 1) / orbits


def _timed(scene: Scene, places: int, beside: int, periods: int) -> tuple[float, int]:
    """CPU seconds of blocks of so many points at some places, over so many periods; and how many orbits they have."""
    short, start = _shortened(scene, periods), scene.start
    few = replace(short, start=replace(start, kind="state")) if start.kind == "follow" else short
    points = math.prod(scene.sweep_shape)
    begins = np.unique(((np.arange(places) + 0.5) * points / places).astype(int)).tolist()
    made = [next(blocks(few, lambda: beside, spans=[(begin, points)])) for begin in begins]
    began = time.thread_time()
    orbits = sum(compute(block)[1]["status"].size for block in made)
    return time.thread_time() - began, orbits


def _shortened(scene: Scene, periods: int) -> Scene:
    """The scene over so many periods, with a record and a trajectory in proportion."""
    share = periods / (scene.transient + scene.record)
    record, shown = max(1, math.floor(share * scene.record)), scene.trajectory
    if shown:
        part = max(1, math.floor(share * shown.periods))
        shown = replace(shown, periods=part, samples=max(2, math.floor(share * shown.samples)))
    transient = min(scene.transient, periods - record)
    return replace(scene, transient=transient, settle=None, record=record, trajectory=shown)


def duration(seconds: float) -> str:
    """Seconds, minutes or hours, to two digits or so."""
    if seconds < 100:
        return f"{seconds:.2g} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.3g} h"
