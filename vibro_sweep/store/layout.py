"""What is in the HDF5 file of a scene: its quantities and coordinates, and how they are cut into chunks.

Every chunk carries two checksums that any HDF5 library compares when it reads; datasets of one number, or of a few
names, lie in their header, which HDF5 checks as well. A chunk takes its place in the file when its first block is
written: until then it reads as not computed, and costs nothing.
"""

import math

import h5py
import numpy as np

from vibro_sweep.model.built import stored_names
from vibro_sweep.model.catalogue import AXES
from vibro_sweep.model.exponents import RUNNING, periods_read
from vibro_sweep.model.observables import (
    DIMENSIONS,
    TRAJECTORY,
    Dimension,
    Variable,
    asked_for,
    averaged,
)
from vibro_sweep.model.observables import (
    dimensions as dimensions_of,
)
from vibro_sweep.model.parameters import Parameter
from vibro_sweep.scene import Scene
from vibro_sweep.store import numbers
from vibro_sweep.store.attributes import set_text

CHUNK_BYTES = 2**17  # read at once

# To Fletcher-32 two zero bytes are the same as two bytes of ones, so that 0 could become -65536 unseen. Adler-32, which
# comes with gzip, tells them apart; level 0 compresses nothing, and costs no time.
CHECKSUMS = {"fletcher32": True, "compression": "gzip", "compression_opts": 0}


def quantities(scene: Scene) -> dict[str, Variable]:
    """The datasets that a scene asks for; what it does not observe is not there."""
    asked = scene.observe | {TRAJECTORY} if scene.trajectory else scene.observe
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
    """The coordinate of a dimension that is no key of the sweep."""
    trajectory, extent = scene.trajectory, dimensions_of(scene.system.masses)[name].extent
    if name == "sample":
        return np.arange(scene.record)
    if name == "averaged":
        return np.array(averaged(scene.system.masses))
    if name == "elapsed":
        parts = min(RUNNING, scene.record)
        return np.array([periods_read(m, parts, scene.record) for m in range(parts)])
    if name == "time":
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
    stored += [(lead, "f8") for lead in numbers.dimensions(scene).values()]
    total = 0
    for lead, dtype in stored:
        shape = tuple(extents[name] for name in lead)
        chunk = chunk_shape(scene, shape, np.dtype(dtype).itemsize)
        count = math.prod(-(-extent // length) for extent, length in zip(shape, chunk, strict=True))
        total += count * math.prod(chunk) * np.dtype(dtype).itemsize
    return total + 8 * sum(extents.values())


def dimensions(scene: Scene, quantity: Variable) -> tuple[str, ...]:
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


def create(file: h5py.File, scene: Scene) -> None:
    """The scene's coordinates and datasets, with nothing computed yet."""
    axes = coordinates(scene)
    for name, values in axes.items():
        if values.dtype.kind == "U":
            _create_compact(file, name, h5py.string_dtype(), values.shape)
            file[name][...] = values.astype(object)
        else:
            file.create_dataset(name, data=values, chunks=chunk_shape(scene, values.shape, 8), **CHECKSUMS)
        file[name].make_scale(name)
        _describe(file[name], scene.system.described.get(name, AXES.get(name)))
    following = _create_following(file, scene)
    if following:
        set_text(file, "coordinates", " ".join(following))
    for name, quantity in quantities(scene).items():
        lead = dimensions(scene, quantity)
        shape = tuple(len(axes[dimension]) for dimension in lead)
        if shape:
            chunk = chunk_shape(scene, shape, np.dtype(quantity.dtype).itemsize)
            file.create_dataset(name, shape, quantity.dtype, chunks=chunk, fillvalue=quantity.fill, **CHECKSUMS)
        else:
            _create_compact(file, name, np.dtype(quantity.dtype), (), quantity.fill)
        dataset = file[name]
        _describe(dataset, quantity)
        if following:
            set_text(dataset, "coordinates", " ".join(following))
        for i, dimension in enumerate(lead):
            dataset.dims[i].attach_scale(file[dimension])
        for attribute, value in quantity.attributes.items():
            if isinstance(value, str):
                set_text(dataset, attribute, value)
            else:
                dataset.attrs[attribute] = value


def _create_following(file: h5py.File, scene: Scene) -> tuple[str, ...]:
    """The numbers that follow from swept ones, as coordinates over these. Returns their names."""
    found = numbers.dimensions(scene)
    for name, lead in found.items():
        shape = tuple(len(scene.sweep[key]) for key in lead)
        chunk = chunk_shape(scene, shape, 8)
        dataset = file.create_dataset(name, shape, "f8", chunks=chunk, fillvalue=np.nan, **CHECKSUMS)
        _describe(dataset, AXES.get(name) or stored_names(scene.system.masses)[name])
        for i, key in enumerate(lead):
            dataset.dims[i].attach_scale(file[key])
    if len(numbers.depends_on(scene)) == 1:
        write_following(file, scene)
    return tuple(found)


def write_following(file: h5py.File, scene: Scene) -> None:
    """The numbers that follow from swept ones; over a plane they are many, and wait until the run is complete."""
    found = numbers.dimensions(scene)
    for box in numbers.slabs(scene) if found else ():
        values = numbers.following(scene, box)
        for name in found:
            file[name][box] = values[name]


def _describe(dataset: h5py.Dataset, of: Parameter | Dimension | Variable) -> None:
    """`long_name` is short, for axes; `description` says more."""
    set_text(dataset, "units", of.units)
    set_text(dataset, "long_name", of.long_name)
    set_text(dataset, "description", of.text)


def _create_compact(file: h5py.File, name: str, dtype: np.dtype, shape: tuple[int, ...], fill: float | None = None):
    """A dataset within its header: one number, or a few names."""
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_layout(h5py.h5d.COMPACT)
    if fill is not None:
        how.set_fill_value(np.array(fill, dtype))
    space = h5py.h5s.create_simple(shape) if shape else h5py.h5s.create(h5py.h5s.SCALAR)
    kind = h5py.h5t.py_create(dtype, logical=True)
    h5py.h5d.create(file.id, name.encode(), kind, space, how)
