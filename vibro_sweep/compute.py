"""What a worker does with a block: from its numbers to the arrays of the file's datasets."""

import os
import platform
import threading

import numpy as np

from vibro_sweep import attractors
from vibro_sweep.blocks import Block, version
from vibro_sweep.discontinuity import expansion_point
from vibro_sweep.kernels import points, status
from vibro_sweep.orbit import points_of
from vibro_sweep.scene_starts import STATE, SWEPT


class RunError(RuntimeError):
    """A run that cannot go on. What it has computed is in the file, and `resume` continues it."""


class BlockError(RunError):
    """A block cannot be computed; the message says where in the sweep, on which worker and why."""


_local = threading.local()


def compute(block: Block) -> tuple[tuple[slice, ...], dict[str, np.ndarray]]:
    """The block's box and its arrays by dataset name; runs anywhere, needs nothing but the block.

    Raises BlockError, also where the program that made the block has another version.
    """
    worker = f"worker {platform.node()}, process {os.getpid()}"
    if block.version != version():
        raise BlockError(f"{worker}, has {version()}; this program is {block.version}: install the same on both")
    try:
        return block.box, _compute(block)
    except Exception as error:
        raise BlockError(f"{worker}, failed at {block}: {type(error).__name__}: {error}") from error


def _compute(block: Block) -> dict[str, np.ndarray]:
    plan, parameters = block.plan, block.parameters
    table = points_of(parameters)
    if plan.order:
        table["graze"] = expansion_point(parameters, block.expand_at)
    starts = _starts(block, table)
    n_starts = starts.shape[1]
    if block.follow:  # chains along the first axis, one for each point of the others
        steps = np.ascontiguousarray(table.reshape(len(table), -1)[:: -1 if block.reverse else 1])
    else:
        steps = np.repeat(table.reshape(1, -1), n_starts, axis=1)
    record = plan.record if "x1" in block.wanted else 0
    arrays = {
        "results": points.new_results(steps.shape),
        "sections": np.full((*steps.shape, record, 4), np.nan),
        "phases": np.full((*steps.shape, record if plan.section_side else 0), np.nan),
        "running": np.full((*steps.shape, plan.parts if "lyapunov_running" in block.wanted else 0, 4), np.nan),
    }
    first = starts.reshape(-1, 4)[: steps.shape[1]]
    workspace = _workspace(block, int(table["cells"].max()))
    points.run_points(steps, first, *arrays.values(), workspace, plan, 1 if plan.order else None)
    for name, values in arrays.items():
        values = values[:: -1 if block.reverse else 1]
        arrays[name] = values.reshape(table.size, n_starts, *values.shape[2:])
    lead = table.shape + ((n_starts,) if n_starts > 1 or len(block.box) > table.ndim else ())
    named = _by_name(block, arrays, lead)
    if plan.attractors:
        named |= _attractors(arrays["results"], lead)
    if block.samples:
        named |= _trajectories(block, table, arrays["results"], workspace, lead)
        named["status"] = arrays["results"]["status"].reshape(lead)
    return {name: values for name, values in named.items() if name in block.wanted}


def _workspace(block: Block, cells: int) -> points.Workspace:
    """That of the block before, if it serves."""
    key = (block.plan, block.samples)
    if getattr(_local, "key", None) != key or _local.cells < cells:
        _local.key, _local.cells = key, cells
        _local.workspace = points.new_workspace(block.plan, cells, block.samples)
    return _local.workspace


def _attractors(results: np.ndarray, lead: tuple[int, ...]) -> dict[str, np.ndarray]:
    """Which starts of a point end on the same attractor."""
    label = attractors.group(results["period"], results["average"], results["average_error"])
    label[results["status"] != status.OK] = attractors.BAD
    return {"attractor": label.reshape(lead), "share": attractors.share(label).reshape(lead)}


def _trajectories(
    block: Block, table: np.ndarray, results: np.ndarray, workspace: points.Workspace, lead: tuple[int, ...]
) -> dict[str, np.ndarray]:
    """The motion after the last section point, by dataset name; compiled only for scenes that ask for it."""
    from vibro_sweep.kernels.trajectory import run_trajectories

    motion = np.full((*results.shape, block.samples, 4), np.nan)
    run_trajectories(table.reshape(-1), results, motion, workspace, block.plan)
    return {f"trajectory_{name}": motion[..., i].reshape((*lead, -1)) for i, name in enumerate(STATE)}


def _starts(block: Block, table: np.ndarray) -> np.ndarray:
    """(points, starts, 4): given; or random, uniform in |x_i| < b, |v_i| < omega b, by the point's place alone."""
    if not isinstance(block.starts, tuple):
        result = np.broadcast_to(block.starts, (table.size, *block.starts.shape)).copy()
        for i, name in enumerate(SWEPT.values()):
            if name in block.axes:
                result[..., i] = block.parameters[name].reshape(-1, 1)
        return result
    count, seed = block.starts
    result = np.empty((table.size, count, 4))
    for n, (index, point) in enumerate(zip(block.indices.flat, table.flat, strict=True)):
        draw = np.random.Generator(np.random.Philox(key=seed, counter=[0, 0, 0, int(index)]))
        result[n] = draw.uniform(-1.0, 1.0, (count, 4)) * point["b"]
        result[n, :, 1::2] *= point["omega"]
    return result


def _by_name(block: Block, arrays: dict[str, np.ndarray], lead: tuple[int, ...]) -> dict[str, np.ndarray]:
    """The kernels' arrays as the file's datasets; lead: shape of the box, and of its starts if there are several."""
    results, sections, phases, running = arrays.values()
    named = {name: results[name].reshape(lead + results[name].shape[2:]) for name in results.dtype.names}
    if "x1" in block.wanted:
        named |= {name: sections[..., i].reshape(lead + sections.shape[2:3]) for i, name in enumerate(STATE)}
    if block.plan.section_side:
        named["phase"] = phases.reshape(lead + phases.shape[2:])
    named["lyapunov_running"] = running.reshape(lead + running.shape[2:])
    return named
