"""A Dataset as an HDF5 file: dimension scales, attributes by CF, texts of fixed length.

HDF5 makes the file once, whole, and in memory. Numbers that are computed later are contiguous arrays, which are written
without HDF5. The structure has checksums (v108), and nothing marks the file as open for writing.
"""

from collections.abc import Collection
from typing import Any, BinaryIO

import h5py
import numpy as np
import xarray

from vibro_sweep.files.seal import Stretch
from vibro_sweep.files.sparse import SparseFile
from vibro_sweep.tables.file_columns import RAGGED

LIBVER = ("v108", "v108")
OLD, FORMAT = 2, 3  # formats that are read; OLD has checksums of HDF5 in chunks
CHECKS = "check"  # the group of what this program alone reads; netCDF programs find only variables in the root

_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable.{:10d}"  # how netCDF names a mere length


def create(
    target: SparseFile | BinaryIO,
    data: xarray.Dataset,
    later: Collection[str] = (),
    checks: xarray.Dataset | None = None,
) -> dict[Stretch, bytes]:
    """Make the HDF5 file of a Dataset in memory. Returns the stretches that are to be filled: the numbers of the
    variables `later`, and all of `checks`, which go into the group `CHECKS`."""
    with h5py.File(
        target, "w", libver=LIBVER, track_order=True, alignment_threshold=1, alignment_interval=8, meta_block_size=2**16
    ) as h5:
        for name, value in data.attrs.items():
            set_attribute(h5, str(name), value)
        for name, length in data.sizes.items():
            if name in data.variables:
                _create(h5, str(name), data[name].variable).make_scale(name)
            else:
                h5.create_dataset(name, (length,), ">f4").make_scale(_NO_VARIABLE.format(length))
        others = [str(name) for name in data.variables if name not in data.sizes]
        beside = [name for name in others if name in data.coords]
        if beside:
            set_attribute(h5, "coordinates", " ".join(beside))
        made = {name: _create(h5, name, data[name].variable, name in later) for name in (*beside, *data.data_vars)}
        if checks is not None:
            group = h5.create_group(CHECKS)
            for name, value in checks.attrs.items():
                set_attribute(group, str(name), value)
            made |= {f"{CHECKS}/{name}": _empty(group, str(name), variable.values) for name, variable in checks.items()}
        for name in others:  # after all numbers, which the heap that this makes would part
            for i, dimension in enumerate(data[name].dims):
                made[name].dims[i].attach_scale(h5[dimension])
            along = [key for key in beside if name not in beside and {*data[key].dims} <= {*data[name].dims}]
            if along:
                set_attribute(made[name], "coordinates", " ".join(along))
        filled = [handle.id for name, handle in made.items() if name in later or name.startswith(f"{CHECKS}/")]
        return {Stretch(handle.get_offset(), handle.get_storage_size()): fill_of(handle) for handle in filled}


def set_attribute(of: h5py.Group | h5py.Dataset, name: str, value: Any) -> None:
    """An attribute of a kind that netCDF has: a text or texts, which h5py reads as str, 32-bit integers, doubles."""
    values = np.asarray(value)
    if values.dtype.kind == "U":
        texts = values.astype(object) if values.ndim else str(value)
        of.attrs.create(name, texts, dtype=h5py.string_dtype("utf-8"))
    elif values.ndim and not values.size:
        of.attrs.create(name, h5py.Empty(h5py.string_dtype("utf-8", 2)))
    elif values.dtype == np.int64 and np.array_equal(values.astype(np.int32), values):
        of.attrs[name] = values.astype(np.int32)
    else:
        of.attrs[name] = value


def text_of(attribute: str | bytes) -> str:
    """An attribute that is a text; some files have it as bytes of a fixed length."""
    return attribute.decode() if isinstance(attribute, bytes) else attribute


def _create(h5: h5py.File, name: str, variable: xarray.Variable, later: bool = False) -> h5py.Dataset:
    """A dataset and what is said of it; with its values, but for those that come later."""
    if later:
        dataset = _empty(h5, name, variable.values)
    else:
        values = variable.values
        dataset = h5.create_dataset(name, data=np.char.encode(values, "utf-8") if values.dtype.kind == "U" else values)
    for attribute, value in variable.attrs.items():
        set_attribute(dataset, str(attribute), value)
    for dimension, counts in RAGGED.items():
        if counts == (name,):  # CF, 9.3.3: contiguous ragged arrays
            set_attribute(dataset, "sample_dimension", dimension)
    return dataset


def _empty(h5: h5py.Group, name: str, empty: np.ndarray) -> h5py.Dataset:
    """A contiguous dataset, whose place in the file is taken at once, of one fill value."""
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_layout(h5py.h5d.CONTIGUOUS)
    how.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    how.set_fill_time(h5py.h5d.FILL_TIME_NEVER)  # they are written when the file is on the disk
    how.set_fill_value(empty.reshape(-1)[:1].reshape(()))
    space = h5py.h5s.create_simple(empty.shape) if empty.shape else h5py.h5s.create(h5py.h5s.SCALAR)
    h5py.h5d.create(h5.id, name.encode(), h5py.h5t.py_create(empty.dtype), space, how)
    return h5[name]


def fill_of(dataset: h5py.h5d.DatasetID) -> bytes:
    """The bytes of a number of a dataset where nothing is computed."""
    fill = np.empty((), dataset.dtype)
    dataset.get_create_plist().get_fill_value(fill)
    return fill.tobytes()
