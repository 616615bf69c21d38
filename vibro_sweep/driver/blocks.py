"""Blocks: boxes of a sweep's grid that are computed as one, by any worker, in any order."""

import itertools
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np

from vibro_sweep import __version__
from vibro_sweep.driver.code_hash import code_hash
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.variational.spectrum import BATCHES
from vibro_sweep.oscillator.grid import grid
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.results.boxes import boxes
from vibro_sweep.results.layout import quantities
from vibro_sweep.scene import Scene
from vibro_sweep.tables.exponents import RUNNING
from vibro_sweep.tables.observables import WITH_STATES, WITH_TANGENTS
from vibro_sweep.tables.outcomes import NOT_COMPUTED


class Block(NamedTuple):
    """A box of the sweep's grid, with all starts of its points or a part of those of one.

    Of a `follow`: chains along the first axis in one direction, or a part of them. What is sent to a worker: a
    kilobyte, and 8 bytes for each value along the edges of the box.
    """

    box: tuple[slice, ...]  # over the sweep's dimensions; of some of the starts, or of two directions, over `start` too
    shape: tuple[int, ...]  # of the whole sweep
    plan: orbit_block.Plan
    system: Oscillator
    axes: dict[str, np.ndarray]  # values of the swept numbers in the box, those of the start among them
    starts: np.ndarray | tuple[int, int, tuple]  # (s, 4) for all points; or (count, seed, box), drawn at each
    from_rest: bool  # at rest, and where zero is behind a stop, held by that
    part: slice  # of the starts
    begun: np.ndarray | None  # (chains, 2 N + 3): where chains go on that another block has begun
    follow: bool
    reverse: bool  # of a `follow`: along falling index
    wanted: frozenset[str]  # datasets
    samples: int
    from_start: bool  # whether the trajectory begins at t = 0
    expand_at: float | None  # clearance at which the discontinuity mapping is expanded; None: b*
    version: str  # of the program that made it, and is to compute it

    @property
    def last(self) -> bool:
        """Whether no part of its chains is left after it."""
        if not self.follow:
            return True
        along = self.box[0]
        return along.start == 0 if self.reverse else along.stop == self.shape[0]

    @property
    def parameters(self) -> dict[str, np.ndarray]:
        """Every number of the system by name, and those of the start that are swept, of the box's shape."""
        return grid(self.system, self.axes)

    @property
    def indices(self) -> np.ndarray:
        """Place of each point in the sweep, of the box's shape."""
        if not self.shape:
            return np.zeros((), np.int64)
        ranges = (np.arange(part.start, part.stop, part.step or 1) for part in self.box[: len(self.shape)])
        return np.ravel_multi_index(np.ix_(*ranges), self.shape)

    def __str__(self) -> str:
        spans = (
            f"{key} = {values[0]}" + (f" .. {values[-1]}" if len(values) > 1 else "")
            for key, values in self.axes.items()
        )
        return ", ".join(spans) or "the point of the scene"


def version() -> str:
    """Identifies the code that computes: equal versions give equal numbers on equal machines."""
    return f"vibro_sweep {__version__}, code {code_hash()}"


def plan_of(scene: Scene) -> orbit_block.Plan:
    """The plan of a scene, for the kernels."""
    side = {"right": 1.0, "left": -1.0}[scene.section.stop]
    lyapunov = not WITH_TANGENTS.isdisjoint(scene.observe)
    return orbit_block.Plan(
        transient=scene.transient,
        record=scene.record,
        warm_up=min(scene.transient, orbit_block.WARM_UP) if lyapunov else 0,
        settle=scene.settle or 0,
        states=scene.settle is not None or not WITH_STATES.isdisjoint(scene.observe),
        lyapunov=lyapunov,
        impacts="impacts" in scene.observe,
        contacts="contacts" in scene.observe,
        energy="energy" in scene.observe,
        attractors="attractors" in scene.observe,
        section_side=side if scene.section.kind == "impact" and "section" in scene.observe else 0.0,
        periods=scene.trajectory.periods if scene.trajectory else 0,
        parts=min(scene.record, RUNNING if "convergence" in scene.observe else BATCHES) if lyapunov else 0,
        order=scene.order if scene.dynamics == "map" else 0,
    )


def blocks(
    scene: Scene, size: Callable[[], int], most_orbits: int | None = None, spans: Iterable[tuple[int, ...]] = ((),)
) -> Iterator[Block]:
    """The scene, or spans of it, cut into boxes of `size()` points, in the order of the file.

    most_orbits : in a block, where that asks for parts of a point. All starts of a point stay together where
        attractors are sought among them. Of the chains of a `follow` these are the first parts; `next_part` has others
    spans : first number, and the one behind the last, of points or of the chains of a `follow`; by default all
    """
    shape, start = scene.sweep_shape, scene.start
    follow, length, least = start.kind == "follow", 1, 1
    if follow:
        least = min(LANES, most_orbits or LANES)  # so many chains take hardly longer than one
        length = min(shape[0], most_orbits // least) if most_orbits else shape[0]
    starts = (start.count, start.seed, start.box) if start.kind == "random" else np.array([start.state])
    common = {
        "shape": shape,
        "plan": plan_of(scene),
        "system": scene.system,
        "starts": starts,
        "from_rest": scene.from_rest,
        "begun": None,
        "follow": follow,
        "wanted": frozenset(quantities(scene)),
        "samples": scene.trajectory.samples if scene.trajectory else 0,
        "from_start": scene.trajectory is not None and scene.trajectory.begin == "start",
        "expand_at": scene.expand_at,
        "version": version(),
    }
    cut = (boxes(shape[int(follow) :], lambda: max(size() // length, least), *span) for span in spans)
    for rest in itertools.chain.from_iterable(cut):
        for direction, reverse in _directions(scene):
            lead = () if not follow else ((slice(shape[0] - length, shape[0]) if reverse else slice(0, length)),)
            box = lead + rest
            for which, part in _starts_cut(scene, most_orbits):
                yield Block(box=box + direction + which, axes=_cut(scene, box), part=part, reverse=reverse, **common)


def missing_spans(scene: Scene, status: np.ndarray) -> list[tuple[int, int]]:
    """Spans of points, or of chains of a `follow`, (first, end), of which orbits are not computed."""
    missing = status == NOT_COMPUTED
    if missing.ndim > len(scene.sweep_shape):
        missing = missing.any(axis=-1)
    if scene.start.kind == "follow":
        missing = missing.any(axis=0)
    ends = np.flatnonzero(np.diff(missing.ravel().astype(np.int8), prepend=0, append=0))
    return list(zip(ends[0::2].tolist(), ends[1::2].tolist(), strict=True))


def next_part(scene: Scene, block: Block, ends: np.ndarray) -> Block:
    """The part of a block's chains after it, from where they end, (chains, 2 N + 3)."""
    along, extent = block.box[0], block.shape[0]
    length = along.stop - along.start
    if block.reverse:
        along = slice(max(0, along.start - length), along.start)
    else:
        along = slice(along.stop, min(along.stop + length, extent))
    box = (along, *block.box[1:])
    return block._replace(box=box, axes=_cut(scene, box), begun=ends)


def whole_chains(block: Block) -> tuple[slice, ...]:
    """The box of a block, or of all parts of its chains."""
    return (slice(0, block.shape[0]), *block.box[1:]) if block.follow else block.box


def _cut(scene: Scene, box: tuple[slice, ...]) -> dict[str, np.ndarray]:
    """The values of the swept numbers in a box."""
    return {key: values[part] for (key, values), part in zip(scene.sweep.items(), box, strict=False)}


def _starts_cut(scene: Scene, most_orbits: int | None) -> Iterator[tuple[tuple[slice, ...], slice]]:
    """The starts of a point in parts: the place of each along `start`, and the part itself."""
    count, most = scene.start.count, most_orbits or scene.start.count
    if count <= most or "attractors" in scene.observe:
        yield (), slice(0, count)
        return
    most -= most % LANES if most > LANES else 0
    for at in range(0, count, most):
        part = slice(at, min(at + most, count))
        yield (part,), part


def _directions(scene: Scene) -> list[tuple[tuple[slice, ...], bool]]:
    """The directions of a `follow`: for each its place along `start`, and whether it is along falling index."""
    if scene.start.kind != "follow":
        return [((), False)]
    first = next(iter(scene.sweep.values()))
    falling = len(first) > 1 and bool(first[0] > first[-1])
    if scene.start.direction == "both":
        return [((slice(0, 1),), falling), ((slice(1, 2),), not falling)]
    return [((), falling == (scene.start.direction == "up"))]
