"""A file as an `xarray.Dataset` whose numbers are read when they are asked for: what is ours in it, and nothing else.

xarray's own reader of HDF5 goes through all that is in a file, links to other files included.
"""

import h5py
import numpy as np
import xarray
from xarray.backends import BackendArray
from xarray.core import indexing

from vibro_sweep.store.attributes import attributes
from vibro_sweep.store.opening import axes_of, dimensions_of, following_of


class _Numbers(BackendArray):
    def __init__(self, dataset: h5py.Dataset):
        self._dataset = dataset
        self.shape = dataset.shape
        self.dtype = np.dtype(object) if h5py.check_string_dtype(dataset.dtype) else dataset.dtype

    def __getitem__(self, key):
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER_1VECTOR, self._read)

    def __reduce__(self):
        """Pickle the numbers themselves."""
        return indexing.NumpyIndexingAdapter, (self._read(()),)

    def _read(self, key):
        values = self._dataset.asstr()[key] if self.dtype.kind == "O" else self._dataset[key]
        return np.asarray(values, self.dtype)


class _Close:
    """Closes the file; a copy in another process has none to close."""

    def __init__(self, file: h5py.File | None = None):
        self._file = file

    def __call__(self) -> None:
        if self._file is not None:
            self._file.close()

    def __reduce__(self):
        return _Close, ()


def dataset_of(file: h5py.File) -> xarray.Dataset:
    """Closing it closes the file."""
    dimensions = dimensions_of(file)
    coordinates = {name: _variable([name], file[name]) for name in axes_of(file)}
    coordinates |= {name: _variable(along, file[name]) for name, along in following_of(file).items()}
    quantities = {name: _variable(along, file[name]) for name, along in dimensions.items()}
    result = xarray.Dataset(quantities, coordinates, attributes(file))
    result.set_close(_Close(file))
    return result


def _variable(dimensions: list[str], dataset: h5py.Dataset) -> xarray.Variable:
    lazy = indexing.LazilyIndexedArray(_Numbers(dataset))
    values = indexing.MemoryCachedArray(indexing.CopyOnWriteArray(lazy))  # as `xarray.open_dataset` has them
    return xarray.Variable(dimensions, values, attributes(dataset), fastpath=True)
