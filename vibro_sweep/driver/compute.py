"""What a worker does with a block: from its numbers to the arrays of the file's datasets."""

import os
import platform
import threading

import numpy as np

from vibro_sweep.analysis.attractors import grouping
from vibro_sweep.analysis.single.tables import table_of
from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.driver.blocks import Block, version
from vibro_sweep.driver.drawn_starts import starts_of
from vibro_sweep.driver.energy_columns import energies_of
from vibro_sweep.driver.trajectories import trajectories_of
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.motion.ensemble import Mapping
from vibro_sweep.engine.points.any_points import grazing_points
from vibro_sweep.engine.records import Kind, new_results, starts_after, starts_at
from vibro_sweep.engine.simd.kernel_cache import announce_count
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.oscillator.grid import linears
from vibro_sweep.oscillator.own_time import in_own_time, in_users_time, with_velocities
from vibro_sweep.tables import outcomes as status
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.observables import GAP


class RunError(VibroSweepError, RuntimeError):
    """A run that cannot go on. What it has computed is in the file, and `resume` continues it.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> issubclass(vs.RunError, vs.VibroSweepError)
    True
    """

    internal = False


class BlockError(RunError):
    """A block cannot be computed; the message says where in the sweep, on which worker and why."""


class InternalError(BlockError):
    """One that no input explains: a bug."""

    internal = True


CHAIN_ENDS = "chain_ends"

_local = threading.local()


def compute(block: Block) -> tuple[tuple[slice, ...], dict[str, np.ndarray]]:
    """The block's box and its arrays by dataset name; runs anywhere, needs nothing but the block.

    Where chains go on in another block, `CHAIN_ENDS` among the arrays has the starts (chains, 2 N + 3) to go on from.
    Raises BlockError, also where the program that made the block has another version.
    """
    worker = f"worker {platform.node()}, process {os.getpid()}"
    if block.version != version():
        raise BlockError(f"{worker}, has {version()}; this program is {block.version}: install the same on both")
    try:
        return block.box, _compute(block)
    except Exception as error:
        kind = BlockError if isinstance(error, MemoryError) else InternalError
        raise kind(f"{worker}, failed at {block}: {type(error).__name__}: {error}") from error


def _compute(block: Block) -> dict[str, np.ndarray]:
    plan, states = block.plan, 2 * block.system.masses
    needed = {"run_points": True, "run_energy": plan.energy, "run_trajectories": plan.periods > 0}
    announce_count([kernel for kernel, is_needed in needed.items() if is_needed])
    table, kind, rate = table_of(block.system, block.axes, frames=plan.lyapunov or plan.order > 0)
    if plan.order:
        table["graze"] = grazing_points(in_own_time(linears(block.system, block.axes), rate), block.expand_at)
    starts = starts_of(block)
    n_starts = starts.shape[1]
    if block.follow:  # chains along the first axis, one for each point of the others
        steps = np.ascontiguousarray(table.reshape(len(table), -1)[:: -1 if block.reverse else 1])
    else:
        steps = table.reshape(1, -1)
        if n_starts > 1:
            steps = np.repeat(steps, n_starts, axis=1)
    record = plan.record if _has_sections(block) else 0
    arrays = {
        "results": new_results(steps.shape, kind.masses),
        "sections": np.full((*steps.shape, record, states), np.nan),
        "phases": np.full((*steps.shape, record if plan.section_side else 0), np.nan),
        "running": np.full((*steps.shape, plan.parts if "lyapunov_running" in block.wanted else 0, states), np.nan),
    }
    anew = starts_at(starts.reshape(-1, states)[: steps.shape[1]])  # also after a point that failed
    first = anew if block.begun is None else block.begun
    first, anew = (with_velocities(places, kind.masses, 1 / rate) for places in (first, anew))
    workspace = _workspace(block, kind, int(table["cells"].max()), min(steps.shape[1], LANES))
    mapping = Mapping(plan.order) if plan.order else None
    begins = np.stack([first, anew])
    orbit_block.run_points(
        steps, begins, arrays["results"], arrays["sections"], arrays["phases"], arrays["running"],
        _without_samples(workspace), plan, mapping,
    )  # fmt: skip
    energies = energies_of(block, steps, kind, arrays["results"]) if "impact_power" in block.wanted else {}
    ends = {}
    if not block.last:
        ends[CHAIN_ENDS] = with_velocities(_ends(arrays["results"][-1], steps[-1], anew), kind.masses, rate)
    if plan.lyapunov:
        _drop_without_exponents(arrays)
    turn = -1 if block.reverse else 1
    for name, values in arrays.items():
        values = values[::turn]
        arrays[name] = values.reshape(table.size, n_starts, *values.shape[2:])
    lead = table.shape + ((n_starts,) if n_starts > 1 or len(block.box) > table.ndim else ())
    named = _by_name(block, arrays, lead) | {name: values[::turn].reshape(lead) for name, values in energies.items()}
    if plan.attractors:
        named |= _attractors(arrays["results"], lead)
    if block.samples:
        begins = with_velocities(starts, kind.masses, 1 / rate) if block.from_start else None
        named |= trajectories_of(block, table, arrays["results"], workspace, lead, begins)
        named["status"] = arrays["results"]["status"].reshape(lead)
    named = {name: values for name, values in named.items() if name in block.wanted}
    return in_users_time(named, kind.masses, rate) | ends


def _ends(last: np.ndarray, points: np.ndarray, anew: np.ndarray) -> np.ndarray:
    """The starts from which chains go on after the last results, of these points; anew: those after one that failed."""
    return np.where(status.is_valid(last["status"])[:, None], starts_after(last, points["tau"]), anew)


def _drop_without_exponents(arrays: dict[str, np.ndarray]) -> None:
    """Mark points as not finite where tangent vectors, but not the orbit, have left the range of the floats."""
    results = arrays["results"]
    lost = status.is_valid(results["status"]) & np.isnan(results["lyapunov"]).any(-1)
    if lost.any():
        results[lost] = new_results((), results["end"].shape[-1] // 2)
        results["status"][lost] = status.NOT_FINITE
        for name in ("sections", "phases", "running"):
            arrays[name][lost] = np.nan


def _workspace(block: Block, kind: Kind, cells: int, orbits: int) -> orbit_block.Workspace:
    """The workspace of the block before, if it fits."""
    key = (block.plan, block.samples, kind)
    if getattr(_local, "key", None) != key or _local.cells < cells or _local.orbits < orbits:
        _local.key = _local.workspace = None  # so that there are never two
        _local.workspace = orbit_block.new_workspace(block.plan, cells, block.samples, kind, orbits)
        _local.key, _local.cells, _local.orbits = key, cells, orbits
    return _local.workspace


def _without_samples(workspace: orbit_block.Workspace) -> orbit_block.Workspace:
    """The same workspace for motion that is not sampled: the times of a trajectory before it would be sampled again."""
    ensemble = workspace.ensemble
    records = ensemble.records._replace(times=ensemble.records.times[:0], samples=ensemble.records.samples[:0])
    return workspace._replace(ensemble=ensemble._replace(records=records))


def _attractors(results: np.ndarray, lead: tuple[int, ...]) -> dict[str, np.ndarray]:
    """The number of the attractor on which each start of a point ends."""
    label = grouping.group(results["period"], results["average"], results["average_error"])
    label[~status.is_valid(results["status"])] = grouping.BAD
    share = grouping.share(label)
    unknown = np.full(lead, grouping.BAD)  # until all points are there (attractor_ids.py)
    return {"attractor": label.reshape(lead), "share": share.reshape(lead), "attractor_id": unknown}


def _has_sections(block: Block) -> bool:
    return not block.wanted.isdisjoint({*state(block.system.masses), GAP})


def _by_name(block: Block, arrays: dict[str, np.ndarray], lead: tuple[int, ...]) -> dict[str, np.ndarray]:
    """The kernels' arrays as the file's datasets; lead: shape of the box, and of its starts if there are several."""
    results, sections = arrays["results"], arrays["sections"]
    named = {name: results[name].reshape(lead + results[name].shape[2:]) for name in results.dtype.names}
    if _has_sections(block):
        named |= {
            name: sections[..., i].reshape(lead + sections.shape[2:3])
            for i, name in enumerate(state(block.system.masses))
        }
    if GAP in block.wanted:
        gap = sections[..., 0::2] @ block.system.linear.contact.normal
        named[GAP] = gap.reshape(lead + gap.shape[2:])
    if block.plan.section_side:
        named["phase"] = arrays["phases"].reshape(lead + arrays["phases"].shape[2:])
    named["lyapunov_running"] = arrays["running"].reshape(lead + arrays["running"].shape[2:])
    return named
