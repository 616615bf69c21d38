"""Files of branches, windows and curves: ragged arrays, laid out one after another over dimensions without
coordinates."""

from typing import Any, NamedTuple

import h5py
import numpy as np

from vibro_sweep import __version__
from vibro_sweep.model.branch_file import RAGGED
from vibro_sweep.model.column import Column
from vibro_sweep.store.attributes import describe, set_text, set_texts
from vibro_sweep.store.creating import image_of, now
from vibro_sweep.store.datasets import CHECKSUMS, create_length

CHUNK = 2**14  # numbers


class Subject(NamedTuple):
    """The subject of a file. Runs of equal subjects make equal files.

    kind : "branches" or "windows"
    scene : the YAML text that was computed; of windows that of the sweep
    attributes : numbers and texts of the file, those that tell its run from others among them
    """

    kind: str
    title: str
    scene: str
    attributes: dict[str, Any]


class RaggedContents(NamedTuple):
    """All that a file holds."""

    subject: Subject
    columns: list[Column]
    arrays: dict[str, np.ndarray]


def ragged_image(
    subject: Subject, run_id: bytes, provenance: dict, columns: list[Column], arrays: dict[str, np.ndarray]
) -> memoryview:
    """The bytes of an HDF5 file; without columns and arrays the skeleton of a run."""

    def fill(file: h5py.File) -> None:
        if columns:
            set_text(file, "history", f"{now()} made by vibro_sweep {__version__}")
        set_texts(file, "sweep_dimensions", [])
        for name, value in subject.attributes.items():
            _set(file, name, value)
        lengths = {}
        for column in columns:
            lengths |= dict(zip(column.dimensions, arrays[column.name].shape, strict=True))
        for name, length in lengths.items():
            create_length(file, name, length)
        for column in columns:
            _create(file, column, arrays[column.name])

    names = [column.name for column in columns if column.name != "status"]
    return image_of(subject.kind, subject.title, subject.scene, run_id, provenance, names, fill)


def _create(file: h5py.File, column: Column, values: np.ndarray) -> None:
    values = np.asarray(values, column.dtype)
    how: dict[str, Any] = {}
    if values.size:
        rows = max(1, min(len(values), CHUNK // max(1, values[0].size)))
        how = {"chunks": (rows, *values.shape[1:]), **CHECKSUMS}
    dataset = file.create_dataset(column.name, data=values, **how)
    describe(dataset, column.units, column.label, column.text)
    if column.flags:
        dataset.attrs["flag_values"] = np.arange(len(column.flags), dtype=column.dtype)
        set_text(dataset, "flag_meanings", " ".join(column.flags))
    for dimension, counts in RAGGED.items():
        if counts == (column.name,):  # CF, 9.3.3: contiguous ragged arrays
            set_text(dataset, "sample_dimension", dimension)
    for i, name in enumerate(column.dimensions):
        dataset.dims[i].attach_scale(file[name])


def _set(file: h5py.File, name: str, value) -> None:
    if isinstance(value, str):
        set_text(file, name, value)
    elif isinstance(value, list):
        set_texts(file, name, value)
    else:
        file.attrs[name] = value
