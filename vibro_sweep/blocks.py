"""Blocks: boxes of a sweep's grid that are computed as one, by any worker, in any order."""

import itertools
import math
import threading
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from vibro_sweep.discontinuity import expansion_point
from vibro_sweep.kernels import points
from vibro_sweep.kernels.observe import RUNNING
from vibro_sweep.kernels.spectrum import BATCHES
from vibro_sweep.kernels.tables import LEAST_CELLS
from vibro_sweep.orbit import points_of
from vibro_sweep.scene import Scene

BLOCK_SECONDS = 0.25  # a block is small enough to be waited for, and large enough for its overhead not to count
BLOCK_BYTES = 32e6
BLOCKS_PER_WORKER = 4  # at least, so that workers end together


class Block(NamedTuple):
    """A box of the sweep's grid, all starts included; of a `follow`, a chain or several along the first axis."""

    box: tuple[slice, ...]  # over the sweep's dimensions
    plan: points.Plan
    parameters: dict[str, np.ndarray]  # of the box's shape
    starts: np.ndarray | tuple[int, int]  # (s, 4) for all points; or (count, seed), drawn at each
    first: np.ndarray | None  # index of each point in the sweep, for drawing
    reverse: tuple[bool, ...]  # of a `follow`, for each start: along falling index
    samples: int
    section: bool
    convergence: bool
    expand_at: float | None  # clearance at which the discontinuity mapping is expanded; None: b*


def plan_of(scene: Scene) -> points.Plan:
    """What the kernels need to know of a scene."""
    side = {"right": 1.0, "left": -1.0}[scene.section.stop]
    lyapunov = "lyapunov" in scene.observe or "convergence" in scene.observe
    return points.Plan(
        transient=scene.transient,
        record=scene.record,
        warm_up=min(scene.transient, points.WARM_UP) if lyapunov else 0,
        lyapunov=lyapunov,
        impacts="impacts" in scene.observe,
        section_side=side if scene.section.kind == "impact" and "section" in scene.observe else 0.0,
        right=scene.system.stops != "left",
        left=scene.system.stops != "right",
        periods=scene.trajectory.periods if scene.trajectory else 0,
        parts=min(scene.record, RUNNING if "convergence" in scene.observe else BATCHES) if lyapunov else 0,
        order=scene.order if scene.model == "map" else 0,
    )


def blocks(scene: Scene, workers: int, points_per_block: int | None = None) -> Iterator[Block]:
    """The scene cut into boxes, in the order of the file."""
    shape, plan = scene.sweep_shape, plan_of(scene)
    size = points_per_block or _block_size(scene, workers)
    follow = scene.start.kind == "follow"
    axes = list(shape)
    lengths = []  # of a box along each axis: whole trailing axes, then a part of one, then single values
    for axis in reversed(range(len(axes))):
        whole = follow and axis == 0
        length = axes[axis] if whole else max(1, min(axes[axis], size))
        lengths.insert(0, length)
        size //= max(axes[axis], 1)
    parameters = scene.parameters()
    ranges = [range(0, extent, length) for extent, length in zip(axes, lengths, strict=True)]
    start = scene.start
    starts = (start.count, start.seed) if start.kind == "random" else np.tile(start.state, (scene.n_starts, 1))
    rising = not follow or np.all(np.diff(next(iter(scene.sweep.values()))) > 0)
    directions = {"up": (not rising,), "down": (bool(rising),), "both": (not rising, bool(rising)), None: ()}
    for corner in itertools.product(*ranges):
        box = tuple(
            slice(at, min(at + length, extent)) for at, length, extent in zip(corner, lengths, axes, strict=True)
        )
        yield Block(
            box=box,
            plan=plan,
            parameters={name: np.ascontiguousarray(values[box]) for name, values in parameters.items()},
            starts=starts,
            first=_indices(box, shape) if start.kind == "random" else None,
            reverse=directions[start.direction],
            samples=scene.trajectory.samples if scene.trajectory else 0,
            section="section" in scene.observe,
            convergence="convergence" in scene.observe,
            expand_at=scene.expand_at,
        )


def _indices(box: tuple[slice, ...], shape: tuple[int, ...]) -> np.ndarray:
    """Place of each point of a box in the sweep, of the box's shape."""
    if not shape:
        return np.zeros((), np.int64)
    return np.ravel_multi_index(np.ix_(*(np.arange(part.start, part.stop) for part in box)), shape)


def _block_size(scene: Scene, workers: int) -> int:
    """Points in a block, from a rough cost of an orbit: it only has to be right within a factor of a few."""
    cells = int(points_of({name: np.array(value) for name, value in scene.system.parameters().items()})["cells"])
    periods = scene.transient + scene.record * (1.5 if "lyapunov" in scene.observe else 1.0)
    seconds = scene.n_starts * (5e-5 + periods * (1.5e-7 * cells / LEAST_CELLS + 3e-7))
    numbers = scene.n_starts * (5 * scene.record * ("section" in scene.observe) + 16)
    if scene.trajectory:
        numbers += scene.n_starts * 4 * scene.trajectory.samples
    fair = math.prod(scene.sweep_shape) // (BLOCKS_PER_WORKER * workers)
    return max(1, min(int(BLOCK_SECONDS / seconds), int(BLOCK_BYTES / (8 * numbers)), fair))


_local = threading.local()


def compute(block: Block) -> tuple[tuple[slice, ...], dict[str, np.ndarray]]:
    """The block's box and its arrays by dataset name; runs anywhere, needs nothing but the block."""
    plan, shape = block.plan, block.parameters["b"].shape
    table = points_of(block.parameters)
    if plan.order:
        table["graze"] = expansion_point(block.parameters, block.expand_at)
    cells = int(table["cells"].max())
    key = (plan, block.samples)
    if getattr(_local, "key", None) != key or _local.cells < cells:
        _local.key, _local.cells, _local.workspace = key, cells, points.new_workspace(plan, cells, block.samples)
    n_starts = block.starts[0] if isinstance(block.starts, tuple) else len(block.starts)
    count = table.size
    if block.reverse:
        steps, places = _chains(block, table)
    else:
        steps, places = np.repeat(table.reshape(1, -1), n_starts, axis=1), None
    record = plan.record if block.section else 0
    arrays = {
        "results": points.new_results(steps.shape),
        "sections": np.full((*steps.shape, record, 4), np.nan),
        "phases": np.full((*steps.shape, record if plan.section_side else 0), np.nan),
        "running": np.full((*steps.shape, plan.parts if block.convergence else 0, 4), np.nan),
    }
    starts = _starts(block, table).reshape(-1, 4)[: steps.shape[1]]
    points.run_points(steps, starts, *arrays.values(), _local.workspace, plan, 1 if plan.order else None)
    for name, values in arrays.items():
        shape_of_one = values.shape[2:]
        arrays[name] = (values if places is None else values[places]).reshape(count, n_starts, *shape_of_one)
    named = _by_name(block, arrays, shape)
    if block.samples:
        named |= _trajectories(block, table, arrays["results"], named["status"].shape)
        named["status"] = arrays["results"]["status"].reshape(named["status"].shape)
    return block.box, named


def _trajectories(block: Block, table: np.ndarray, results: np.ndarray, lead: tuple[int, ...]) -> dict[str, np.ndarray]:
    """The motion after the last section point, by dataset name; compiled only for scenes that ask for it."""
    from vibro_sweep.kernels.trajectory import run_trajectories

    motion = np.full((*results.shape, block.samples, 4), np.nan)
    run_trajectories(table.reshape(-1), results, motion, _local.workspace, block.plan)
    return {
        f"trajectory_{name}": motion[..., i].reshape((*lead, block.samples))
        for i, name in enumerate(("x1", "v1", "x2", "v2"))
    }


def _chains(block: Block, table: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Of a `follow`, the points of all chains step by step, and at which step and in which chain each orbit is.

    A chain goes along the first axis; there is one for each point of the other axes and each direction.
    """
    n, directions = len(table), len(block.reverse)
    lines = table.reshape(n, -1)
    step = np.stack([np.arange(n)[:: -1 if reverse else 1] for reverse in block.reverse], axis=1)  # (n, directions)
    steps = np.stack([lines[step[:, s]] for s in range(directions)], axis=2).reshape(n, -1)
    chain = np.arange(steps.shape[1]).reshape(1, -1, directions)
    places = np.broadcast_arrays(step[:, None, :], chain)
    return np.ascontiguousarray(steps), tuple(place.reshape(-1) for place in places)


def _starts(block: Block, table: np.ndarray) -> np.ndarray:
    """(points, starts, 4): drawn uniformly from |x_i| < b, |v_i| < omega b, by the point's place in the sweep alone."""
    if not isinstance(block.starts, tuple):
        return np.broadcast_to(block.starts, (table.size, *block.starts.shape)).copy()
    count, seed = block.starts
    result = np.empty((table.size, count, 4))
    for n, (index, point) in enumerate(zip(block.first.flat, table.flat, strict=True)):
        draw = np.random.Generator(np.random.Philox(key=seed, counter=[0, 0, 0, int(index)]))
        result[n] = draw.uniform(-1.0, 1.0, (count, 4)) * point["b"]
        result[n, :, 1::2] *= point["omega"]
    return result


def _by_name(block: Block, arrays: dict[str, np.ndarray], shape: tuple[int, ...]) -> dict[str, np.ndarray]:
    """The kernels' arrays as the file's datasets, of the box's shape."""
    results, sections, phases, running = arrays.values()
    lead = shape + (results.shape[1:] if results.shape[1] > 1 else ())
    named = {name: results[name].reshape(lead + results[name].shape[2:]) for name in results.dtype.names}
    if block.section:
        named |= {
            name: sections[..., i].reshape(lead + sections.shape[2:3])
            for i, name in enumerate(("x1", "v1", "x2", "v2"))
        }
    if block.plan.section_side:
        named["phase"] = phases.reshape(lead + phases.shape[2:])
    named["lyapunov_running"] = running.reshape(lead + running.shape[2:])
    return named
