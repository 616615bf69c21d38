"""What is in the HDF5 file of a scene: its quantities and coordinates, and how they are cut into chunks."""

import math

import numpy as np

from vibro_sweep.scene import Scene, resolved_numbers
from vibro_sweep.tables.exponents import RUNNING, periods_read
from vibro_sweep.tables.observables import DIMENSIONS, SETTLE, TRAJECTORY, asked_for, averaged
from vibro_sweep.tables.observables import dimensions as dimensions_of
from vibro_sweep.tables.quantity import Observable

CHUNK_BYTES = 2**17  # read at once


def quantities(scene: Scene) -> dict[str, Observable]:
    """The datasets that a scene asks for; what it does not observe is not there."""
    asked = scene.observe | ({TRAJECTORY} if scene.trajectory else set()) | ({SETTLE} if scene.settle else set())
    system = scene.system
    return asked_for(asked, scene.section.kind == "impact", system.masses, not system.gap_is_x1)


def coordinates(scene: Scene) -> dict[str, np.ndarray]:
    """Every dimension of the scene's file, in order, with its coordinate."""
    result = dict(scene.sweep)
    if scene.n_starts > 1:
        both = scene.start.direction == "both"
        result["start"] = np.array(["up", "down"]) if both else np.arange(scene.n_starts)
    used = {dimension for quantity in quantities(scene).values() for dimension in quantity.dimensions}
    return result | {name: _own_axis(scene, name) for name in DIMENSIONS if name in used}


def _own_axis(scene: Scene, name: str) -> np.ndarray:
    """The coordinate of a dimension that is not a key of the sweep."""
    trajectory, extent = scene.trajectory, dimensions_of(scene.system.masses)[name].extent
    if name == "sample":
        return np.arange(scene.record)
    if name == "averaged":
        return np.array(averaged(scene.system.masses))
    if name == "elapsed":
        parts = min(RUNNING, scene.record)
        return np.array([periods_read(m, parts, scene.record) for m in range(parts)])
    if name == "t_over_T":
        return np.linspace(0.0, trajectory.periods, trajectory.samples)
    if name == "trajectory_section":
        return np.arange(trajectory.periods + 1)
    if name == "trajectory_impact":
        return np.arange(trajectory.samples)
    return np.arange(1, extent + 1)


def size(scene: Scene) -> int:
    """Bytes of the scene's file, but for its structure: some kilobytes, and 20 bytes a chunk."""
    extents = {name: len(values) for name, values in coordinates(scene).items()}
    stored = [(dimensions(scene, quantity), quantity.dtype) for quantity in quantities(scene).values()]
    stored += [(lead, "f8") for lead in resolved_numbers.dimensions(scene).values()]
    total = 0
    for lead, dtype in stored:
        shape = tuple(extents[name] for name in lead)
        chunk = chunk_shape(scene, shape, np.dtype(dtype).itemsize)
        count = math.prod(-(-extent // length) for extent, length in zip(shape, chunk, strict=True))
        total += count * math.prod(chunk) * np.dtype(dtype).itemsize
    return total + 8 * sum(extents.values())


def dimensions(scene: Scene, quantity: Observable) -> tuple[str, ...]:
    """Names of a dataset's dimensions, in order."""
    return (*scene.sweep, *(["start"] if scene.n_starts > 1 else []), *quantity.dimensions)


def chunk_shape(scene: Scene, shape: tuple[int, ...], itemsize: int) -> tuple[int, ...]:
    """Axes are taken whole, from the last one on, while they fit; the first that does not is cut into equal parts.

    Blocks of points are cut in the same way, so that one touches few chunks; of a `follow`, whose blocks hold the whole
    first axis, that one comes first of the sweep's.
    """
    axes = list(reversed(range(len(shape))))
    if scene.start.kind == "follow":
        axes.insert(len(axes) - len(scene.sweep), axes.pop())
    room = CHUNK_BYTES // itemsize
    chunk = [1] * len(shape)
    for axis in axes:
        parts = -(-shape[axis] // max(1, room))
        chunk[axis] = -(-shape[axis] // parts)
        room //= chunk[axis]
    return tuple(chunk)
