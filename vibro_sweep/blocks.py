"""Blocks: boxes of a sweep's grid that are computed as one, by any worker, in any order."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from vibro_sweep import __version__
from vibro_sweep.kernels import points
from vibro_sweep.kernels.jit import source_hash
from vibro_sweep.kernels.lanes import LANES
from vibro_sweep.kernels.observe import RUNNING
from vibro_sweep.kernels.spectrum import BATCHES
from vibro_sweep.scene import Scene, grid
from vibro_sweep.store import quantities
from vibro_sweep.system import System


class Block(NamedTuple):
    """A box of the sweep's grid, all starts included; of a `follow`, chains along the first axis in one direction.

    What is sent to a worker: a kilobyte, and 8 bytes for each value along the edges of the box.
    """

    box: tuple[slice, ...]  # over the sweep's dimensions; of a `follow` in both directions also over `start`
    shape: tuple[int, ...]  # of the whole sweep
    plan: points.Plan
    system: System
    axes: dict[str, np.ndarray]  # values of the swept numbers in the box, those of the start among them
    starts: np.ndarray | tuple[int, int]  # (s, 4) for all points; or (count, seed), drawn at each
    follow: bool
    reverse: bool  # of a `follow`: along falling index
    wanted: frozenset[str]  # datasets
    samples: int
    expand_at: float | None  # clearance at which the discontinuity mapping is expanded; None: b*
    version: str  # of the program that made it, and is to compute it

    @property
    def parameters(self) -> dict[str, np.ndarray]:
        """Every number of the system by name, and those of the start that are swept, of the box's shape."""
        return grid(self.system, self.axes)

    @property
    def indices(self) -> np.ndarray:
        """Place of each point in the sweep, of the box's shape."""
        if not self.shape:
            return np.zeros((), np.int64)
        ranges = (np.arange(part.start, part.stop) for part in self.box)
        return np.ravel_multi_index(np.ix_(*ranges), self.shape)

    def __str__(self) -> str:
        spans = (
            f"{key} = {values[0]}" + (f" .. {values[-1]}" if len(values) > 1 else "")
            for key, values in self.axes.items()
        )
        return ", ".join(spans) or "the point of the scene"


def version() -> str:
    """Identifies the code that computes: equal versions give equal numbers on equal machines."""
    return f"vibro_sweep {__version__}, kernels {source_hash()}"


def plan_of(scene: Scene) -> points.Plan:
    """What the kernels need to know of a scene."""
    side = {"right": 1.0, "left": -1.0}[scene.section.stop]
    lyapunov = not scene.observe.isdisjoint(("lyapunov", "convergence", "attractors"))
    return points.Plan(
        transient=scene.transient,
        record=scene.record,
        warm_up=min(scene.transient, points.WARM_UP) if lyapunov else 0,
        states=lyapunov or "section" in scene.observe,
        lyapunov=lyapunov,
        impacts="impacts" in scene.observe,
        attractors="attractors" in scene.observe,
        section_side=side if scene.section.kind == "impact" and "section" in scene.observe else 0.0,
        right=scene.system.stops != "left",
        left=scene.system.stops != "right",
        periods=scene.trajectory.periods if scene.trajectory else 0,
        parts=min(scene.record, RUNNING if "convergence" in scene.observe else BATCHES) if lyapunov else 0,
        order=scene.order if scene.model == "map" else 0,
    )


def blocks(scene: Scene, points_per_block: int) -> Iterator[Block]:
    """The scene cut into boxes, in the order of the file. A `follow` never cuts the axis that it follows."""
    shape, start, size = scene.sweep_shape, scene.start, points_per_block
    follow = start.kind == "follow"
    lengths = list(shape)  # of a box along each axis: whole trailing axes, then a part of one, then single values
    if follow:
        size = max(size // shape[0], LANES)  # chains: so many take hardly longer than one
    for axis in reversed(range(int(follow), len(shape))):
        lengths[axis] = max(1, min(shape[axis], size))
        size //= shape[axis]
    counts = [-(-extent // length) for extent, length in zip(shape, lengths, strict=True)]
    starts = (start.count, start.seed) if start.kind == "random" else np.array([start.state])
    common = {
        "shape": shape,
        "plan": plan_of(scene),
        "system": scene.system,
        "starts": starts,
        "follow": follow,
        "wanted": frozenset(quantities(scene)),
        "samples": scene.trajectory.samples if scene.trajectory else 0,
        "expand_at": scene.expand_at,
        "version": version(),
    }
    for n in range(math.prod(counts)):  # itertools.product would hold all of them along an axis
        corner = [int(at) * length for at, length in zip(np.unravel_index(n, counts), lengths, strict=True)]
        box = tuple(
            slice(at, min(at + length, extent)) for at, length, extent in zip(corner, lengths, shape, strict=True)
        )
        axes = {key: values[part] for (key, values), part in zip(scene.sweep.items(), box, strict=True)}
        for which, reverse in _directions(scene):
            yield Block(box=box + which, axes=axes, reverse=reverse, **common)


def _directions(scene: Scene) -> list[tuple[tuple[slice, ...], bool]]:
    """Of a `follow`, for each direction its place along `start`, and whether it is along falling index."""
    if scene.start.kind != "follow":
        return [((), False)]
    first = next(iter(scene.sweep.values()))
    falling = len(first) > 1 and bool(first[0] > first[-1])
    if scene.start.direction == "both":
        return [((slice(0, 1),), falling), ((slice(1, 2),), not falling)]
    return [((), falling == (scene.start.direction == "up"))]
