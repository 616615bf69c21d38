"""The datasets of a scene's file, created with nothing computed yet.

Every chunk carries two checksums that any HDF5 library compares when it reads; datasets of one number, or of a few
names, lie in their header, which HDF5 checks as well. A chunk takes its place in the file when its first block is
written: until then it reads as not computed, and costs nothing.
"""

import h5py
import numpy as np

from vibro_sweep.model.built import stored_names
from vibro_sweep.model.catalogue import AXES
from vibro_sweep.scene import Scene, resolved_numbers
from vibro_sweep.store.attributes import MATRIX, describe, set_flags, set_text
from vibro_sweep.store.layout import chunk_shape, coordinates, dimensions, quantities
from vibro_sweep.tables.quantity import Quantity
from vibro_sweep.tables.units import unit_in

# To Fletcher-32 two zero bytes are the same as two bytes of ones, so that 0 could become -65536 unseen. Adler-32, which
# comes with gzip, distinguishes them; level 0 compresses nothing, and costs no time.
CHECKSUMS = {"fletcher32": True, "compression": "gzip", "compression_opts": 0}

_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable.{:10d}"  # how netCDF names a mere length


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
        _describe(file[name], scene.system.described.get(name, AXES.get(name)), scene)
    following = _create_following(file, scene)
    if named := (*following, *_create_matrices(file, scene)):
        set_text(file, "coordinates", " ".join(named))
    for name, quantity in quantities(scene).items():
        lead = dimensions(scene, quantity)
        shape = tuple(len(axes[dimension]) for dimension in lead)
        if shape:
            chunk = chunk_shape(scene, shape, np.dtype(quantity.dtype).itemsize)
            file.create_dataset(name, shape, quantity.dtype, chunks=chunk, fillvalue=quantity.fill, **CHECKSUMS)
        else:
            _create_compact(file, name, np.dtype(quantity.dtype), (), quantity.fill)
        dataset = file[name]
        _describe(dataset, quantity, scene)
        if following:
            set_text(dataset, "coordinates", " ".join(following))
        for i, dimension in enumerate(lead):
            dataset.dims[i].attach_scale(file[dimension])
        set_flags(dataset, quantity)
        for attribute, value in quantity.attributes.items():
            dataset.attrs[attribute] = value


def _create_following(file: h5py.File, scene: Scene) -> tuple[str, ...]:
    """The numbers that follow from swept ones, as coordinates over these. Returns their names."""
    found = resolved_numbers.dimensions(scene)
    for name, lead in found.items():
        shape = tuple(len(scene.sweep[key]) for key in lead)
        chunk = chunk_shape(scene, shape, 8)
        dataset = file.create_dataset(name, shape, "f8", chunks=chunk, fillvalue=np.nan, **CHECKSUMS)
        _describe(dataset, AXES.get(name) or stored_names(scene.system.masses)[name], scene)
        for i, key in enumerate(lead):
            dataset.dims[i].attach_scale(file[key])
    if len(resolved_numbers.depends_on(scene)) == 1:
        write_following(file, scene)
    return tuple(found)


def _create_matrices(file: h5py.File, scene: Scene) -> tuple[str, ...]:
    """Create the matrices of a system that is given by them. Returns their names."""
    found = resolved_numbers.matrices(scene)
    for name, values in found.items():
        _create_compact(file, name, values.dtype, values.shape)
        file[name][...] = values
        option = next(one for one in scene.system.model.options if one.name == name)
        units = unit_in(option.units, scene.system.units)
        describe(file[name], units, f"matrix {name}", option.text)
        for axis, length in zip(MATRIX, values.shape, strict=True):
            if axis not in file:
                create_length(file, axis, length)
        for i, axis in enumerate(MATRIX):
            file[name].dims[i].attach_scale(file[axis])
    return tuple(found)


def create_length(file: h5py.File, name: str, length: int) -> None:
    """A dimension that has no coordinate."""
    file.create_dataset(name, (length,), ">f4").make_scale(_NO_VARIABLE.format(length))


def write_following(file: h5py.File, scene: Scene) -> None:
    """The numbers that follow from swept ones; over a plane they are many, and wait until the run is complete."""
    found = resolved_numbers.dimensions(scene)
    for box in resolved_numbers.slabs(scene) if found else ():
        values = resolved_numbers.following(scene, box)
        for name in found:
            file[name][box] = values[name]


def _describe(dataset: h5py.Dataset, of: Quantity, scene: Scene) -> None:
    describe(dataset, unit_in(of.units, scene.system.units), of.long_name, of.text)


def _create_compact(file: h5py.File, name: str, dtype: np.dtype, shape: tuple[int, ...], fill: float | None = None):
    """A dataset within its header: one number, or a few names."""
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_layout(h5py.h5d.COMPACT)
    if fill is not None:
        how.set_fill_value(np.array(fill, dtype))
    space = h5py.h5s.create_simple(shape) if shape else h5py.h5s.create(h5py.h5s.SCALAR)
    kind = h5py.h5t.py_create(dtype, logical=True)
    h5py.h5d.create(file.id, name.encode(), kind, space, how)
