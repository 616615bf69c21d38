"""The cost of an orbit of a scene, measured on a few of its orbits.

It does not grow with the periods alone: an orbit has tables to be filled, and a record to be looked through. So orbits
are computed from beginning to end where that takes a moment, and otherwise over two lengths, of which only the
difference is multiplied, after each has been measured twice. Seconds are CPU time of the thread, which does not pass
while other processes run.
"""

import math
import time
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibro_sweep.driver.blocks import Block, blocks
from vibro_sweep.driver.compute import compute
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.scene import Scene

PLACES = 8  # of the sweep, at which is measured
MEASURED = 0.01  # seconds that a measurement takes at least, where the scene has as many periods and points
GROWN = 1.5  # so many times longer than the shorter one the longer of two measurements takes
LONGER = 4  # times as many periods, or places, in the next measurement
SAME = 1.1  # times longer than the one before: a measurement in which periods do not count yet
AT_ONCE = 0.1  # seconds of the first period, up to which more than one orbit is measured
SHORT = 1.0  # seconds of a measurement that is made twice, at most
TIMES = 3  # the orbits of an estimate are measured once more
EASY = 1e9  # forcing frequency


class OrbitCost(NamedTuple):
    """seconds : of one core for an orbit. sample : blocks of such orbits, which took `sample_seconds`."""

    seconds: float
    sample: list[Block]
    sample_seconds: float


class _Sample(NamedTuple):
    """Orbits that are measured: places of the sweep, neighbouring points at each, starts of a point, periods."""

    places: int
    beside: int
    starts: int
    periods: int


class _Measured(NamedTuple):
    sample: list[Block]
    periods: int
    orbits: int
    seconds: float

    @property
    def each(self) -> float:
        return self.seconds / self.orbits


def compile_for(scene: Scene) -> None:
    """Compile, or load, what the scene needs: with a period so short that nothing is stiff."""
    if "omega" in scene.system.described:  # else a function made it, which may have no such number
        sweep = {key: np.array([EASY]) if key == "omega" else values for key, values in scene.sweep.items()}
        scene = replace(scene, sweep=sweep, system=scene.system.replace(omega=EASY))
    _timed(_blocks(scene, _Sample(1, 1, 1, 1)))


def orbit_cost(scene: Scene, width: int) -> OrbitCost:
    """The cost of an orbit of the scene where so many neighbouring points of the sweep make a block."""
    total = scene.transient + scene.record
    sample = _affordable(scene, width)
    before, now = None, _measured(scene, sample)
    while now.periods < total:
        if before is not None and _is_longer(now, before):
            before, now = _again(before), _again(now)
            if _is_longer(now, before):
                break
        quick = now.seconds < MEASURED / LONGER or (before is not None and now.seconds < SAME * before.seconds)
        sample = sample._replace(periods=min((LONGER**2 if quick else LONGER) * now.periods, total))
        before, now = now, _measured(scene, sample)
    while now.periods == total and now.seconds < MEASURED / 2:
        sample = sample._replace(places=LONGER * sample.places)
        more = _measured(scene, sample)
        if more.orbits == now.orbits:  # all that there are
            break
        now = more
    seconds = now.each
    if now.periods < total:
        seconds += max(0.0, now.each - before.each) / (now.periods - before.periods) * (total - now.periods)
    return OrbitCost(seconds, now.sample, now.seconds)


def repeated(cost: OrbitCost) -> OrbitCost:
    """The same from the least of several measurements of its orbits: in one of a few milliseconds a pause of the
    processor counts as half of it."""
    times = range(TIMES if cost.sample_seconds < SHORT else 0)
    least = min([cost.sample_seconds, *(_timed(cost.sample)[1] for _ in times)])
    return OrbitCost(cost.seconds * least / cost.sample_seconds, cost.sample, least)


def _is_longer(now: _Measured, before: _Measured) -> bool:
    """Whether periods, and not what a call takes in any case, make the longer of two measurements long."""
    return now.seconds >= max(MEASURED, GROWN * before.seconds)


def _affordable(scene: Scene, width: int) -> _Sample:
    """The orbits to begin with: eight side by side at each place, or fewer where their tables take long."""
    alone = _Sample(1, 1, 1, 1)
    first = _measured(scene, alone)
    starts = min(scene.start.count, LANES)
    beside = min(width, math.ceil(LANES / starts))
    many = PLACES * beside * starts
    if first.seconds * many > AT_ONCE:
        first = _again(first)
    if first.seconds * many <= AT_ONCE:
        return _Sample(PLACES, beside, starts, 1)
    return _Sample(PLACES, 1, 1, 1) if first.seconds * PLACES <= AT_ONCE else alone


def _measured(scene: Scene, sample: _Sample) -> _Measured:
    made = _blocks(scene, sample)
    return _Measured(made, sample.periods, *_timed(made))


def _again(one: _Measured) -> _Measured:
    """The less of two measurements: the first call allocates, and fills the processor's cache."""
    return one._replace(seconds=min(one.seconds, _timed(one.sample)[1])) if one.seconds < SHORT else one


def _timed(made: list[Block]) -> tuple[int, float]:
    """The number of orbits of blocks, and their seconds."""
    began = time.thread_time()
    orbits = sum(compute(block)[1]["status"].size for block in made)
    return orbits, time.thread_time() - began


def _blocks(scene: Scene, sample: _Sample) -> list[Block]:
    """Blocks of some points and starts of the scene, with fewer periods in proportion.

    One for all of them, where they fill the lanes as those of the whole scene do; else one for each place.
    """
    total, follow = scene.transient + scene.record, scene.start.kind == "follow"
    record = max(1, scene.record * sample.periods // total)
    along = round(sample.places ** (1 / max(1, len(scene.sweep))))
    beside = [1] * (len(scene.sweep) - 1) + [sample.beside]
    sweep = {
        key: values[_spread(len(values), along, near)]
        for (key, values), near in zip(scene.sweep.items(), beside, strict=False)
    }
    shown = scene.trajectory
    few = replace(
        scene,
        sweep=sweep,
        start=replace(scene.start, count=min(scene.start.count, sample.starts)),
        transient=min(scene.transient, max(0, sample.periods - record)),
        settle=None,
        record=record,
        trajectory=shown and replace(
            shown,
            periods=max(1, shown.periods * sample.periods // total),
            samples=max(2, shown.samples * sample.periods // total),
        ),
    )  # fmt: skip
    if follow:
        return [next(blocks(few, math.prod(few.sweep_shape)))]
    narrow = sample.beside * sample.starts < LANES
    return list(blocks(few, sample.beside if narrow else math.prod(few.sweep_shape)))


def _spread(extent: int, places: int, beside: int) -> np.ndarray:
    """Indices around the middles of equal parts of an axis, so many beside each other."""
    beside = min(beside, extent)
    first = ((np.arange(places) + 0.5) * extent / places - beside / 2).round().astype(int).clip(0, extent - beside)
    return np.unique(first[:, None] + np.arange(beside))
