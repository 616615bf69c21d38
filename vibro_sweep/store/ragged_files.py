"""Files of branches, windows and curves: ragged arrays, laid out one after another over dimensions without
coordinates."""

import io
from typing import Any, NamedTuple

import h5py
import numpy as np

from vibro_sweep.store.attributes import describe, set_flags, set_text, set_texts
from vibro_sweep.store.creating import Subject, complete, ragged_run, skeleton_of
from vibro_sweep.store.datasets import CHECKSUMS, create_length
from vibro_sweep.store.parts import new_run_id
from vibro_sweep.tables.file_columns import RAGGED
from vibro_sweep.tables.quantity import Quantity

CHUNK = 2**14  # numbers


class RaggedContents(NamedTuple):
    """All that a file holds."""

    subject: Subject
    columns: list[Quantity]
    arrays: dict[str, np.ndarray]

    def image(self, made_by: dict[str, Any]) -> io.BytesIO:
        """An HDF5 file of them, in memory."""
        image = io.BytesIO(skeleton_of(ragged_run(self.subject, made_by), new_run_id()))
        with h5py.File(image, "r+") as file:
            self.write(file)
            complete(file, {})
        return image

    def write(self, file: h5py.File) -> None:
        """Create the datasets in a file that has none yet."""
        set_texts(file, "quantities", [column.name for column in self.columns if column.name != "status"])
        lengths = {}
        for column in self.columns:
            lengths |= dict(zip(column.dimensions, self.arrays[column.name].shape, strict=True))
        for name, length in lengths.items():
            create_length(file, name, length)
        for column in self.columns:
            _create(file, column, self.arrays[column.name])


def _create(file: h5py.File, column: Quantity, values: np.ndarray) -> None:
    values = np.asarray(values, column.dtype)
    how: dict[str, Any] = {}
    if values.size:
        rows = max(1, min(len(values), CHUNK // max(1, values[0].size)))
        how = {"chunks": (rows, *values.shape[1:]), **CHECKSUMS}
    dataset = file.create_dataset(column.name, data=values, **how)
    describe(dataset, column.units, column.label, column.text)
    set_flags(dataset, column)
    for dimension, counts in RAGGED.items():
        if counts == (column.name,):  # CF, 9.3.3: contiguous ragged arrays
            set_text(dataset, "sample_dimension", dimension)
    for i, name in enumerate(column.dimensions):
        dataset.dims[i].attach_scale(file[name])
