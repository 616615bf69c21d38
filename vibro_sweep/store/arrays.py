"""A file's numbers as arrays, for what computes with them: xarray, which `open` gives, takes long to be imported."""

from collections.abc import Sequence
from functools import cached_property

import h5py
import numpy as np

from vibro_sweep.store.attributes import attributes, quantities_of
from vibro_sweep.store.opening import axes_of, dimensions_of


class Contents:
    """The contents of a file by the words of an `xarray.Dataset`; numbers are read when asked for."""

    def __init__(self, file: h5py.File):
        self._file = file
        self.attrs = attributes(file)
        self.chosen: dict[str, float] = {}  # swept numbers of which one value is left: of a file none

    @cached_property
    def names(self) -> list[str]:
        """The names of what is computed."""
        return quantities_of(self._file)

    def __contains__(self, name: str) -> bool:
        return name in self.names

    @cached_property
    def _dimensions(self) -> dict[str, list[str]]:
        return dimensions_of(self._file)

    def dims(self, name: str) -> list[str]:
        """Names of the dimensions of a quantity."""
        return self._dimensions[name]

    @cached_property
    def sizes(self) -> dict[str, int]:
        """The sizes of all dimensions."""
        found = {axis: len(self._file[axis]) for axis in axes_of(self._file)}
        for name in self.names:
            found |= zip(self.dims(name), self._file[name].shape, strict=True)
        return found

    def values(self, name: str, first: Sequence[str] = ()) -> np.ndarray:
        """The values of a quantity or a dimension, with these dimensions first, in their order."""
        values = self._file[name][()]
        if not first:
            return values
        dims = self.dims(name)
        lead = [dims.index(dim) for dim in first]
        return values.transpose(*lead, *(i for i in range(len(dims)) if i not in lead))
