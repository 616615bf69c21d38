"""Memory of a run, known before it is taken: how many orbits make a block, and how many blocks are under way."""

import os

import numpy as np

from vibro_sweep.analysis.single.tables import table_of
from vibro_sweep.engine.records import result_of
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.tables.flight import CHUNK, node_of
from vibro_sweep.results.layout import size
from vibro_sweep.scene import Scene
from vibro_sweep.scene.size import COPIES, fixed_numbers, sample_numbers, scratch_numbers, written_numbers

BLOCK_BYTES = 12e6  # of results; larger blocks leave the processor's cache and are not faster
BYTES_UNDER_WAY = 450e6  # of blocks and workspaces together, and
BYTES_PER_CORE = 100e6  # where there are many
LOOKS = 9  # values of each axis at which the size of the tables is looked at


def orbits_per_block(scene: Scene, workers: int) -> int:
    """Orbits whose results fit into a block, and into the share of one of so many workers."""
    each = size(scene) / scene.n_points + result_of(scene.system.masses).itemsize
    return max(1, int(min(BLOCK_BYTES, _allowed() / workers) / each))


def blocks_under_way(scene: Scene, most_orbits: int, here: bool) -> int:
    """The number of blocks that may be computed at a time; here: by threads of this process, which hold workspaces
    too."""
    orbits = min(most_orbits, scene.n_points)
    if "attractors" in scene.observe:
        orbits = max(orbits, scene.n_starts)
    results = 8 * orbits * (fixed_numbers(scene.system.masses) + written_numbers(scene))
    each = results + (_workspace_bytes(scene, orbits) if here else 0)
    written = (COPIES - 1) * results  # copies, of one block at a time
    return max(1, int((_allowed() - written) / each))


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _allowed() -> float:
    return max(BYTES_UNDER_WAY, BYTES_PER_CORE * available_cores())


def _workspace_bytes(scene: Scene, orbits: int) -> int:
    """Bytes of one thread: tables for the most cells of any point of the sweep, records of the orbits side by side."""
    axes = {}
    for key, values in scene.sweep.items():
        axes[key] = values[np.unique(np.linspace(0, len(values) - 1, LOOKS).astype(int))]
    table, kind, _ = table_of(scene.system, axes, frames=False)
    cells = int(table["cells"].max())
    tables = LANES * cells * (node_of(kind.masses).itemsize + 2 * (2 * kind.masses + 1) * 8) + LANES * CHUNK
    samples = sample_numbers(scene.system.masses) * scene.trajectory.samples if scene.trajectory else 0
    return tables + 8 * (min(orbits, LANES) * scratch_numbers(scene) + samples)
