"""Whether a file of branches, windows or curves holds what such a file must: columns, lengths, indices, codes.

Its checksums say only that nothing has changed since somebody wrote it.
"""

from collections.abc import Mapping
from typing import NamedTuple

import h5py
import numpy as np

from vibro_sweep.model.refusals import cut, shown
from vibro_sweep.store.attributes import check_dataset, quantities_of, scales_of, text, texts
from vibro_sweep.tables.file_columns import BRANCHES, CHART, OF_EDGES, RAGGED, WINDOWS, columns
from vibro_sweep.tables.quantity import Quantity

KINDS = (BRANCHES, WINDOWS, CHART)


class Stored(NamedTuple):
    """A variable as a file or a Dataset has it."""

    dimensions: tuple[str, ...]
    values: np.ndarray


def damage_of(file: h5py.File) -> str:
    """The damage of the datasets of a file, in words; empty where all of it can be read."""
    if "status" not in file:  # a run that has not ended has no datasets
        return ""
    try:
        names = quantities_of(file)
        for name in names:
            check_dataset(file, name)
        found = {name: Stored(tuple(scales_of(file[name])), _values(file, name)) for name in names}
        check(text(file, "kind"), texts(file, "parameters"), found)
    except (OSError, RuntimeError, ValueError, KeyError, AttributeError) as error:
        return str(error)
    return ""


def check(kind: str, parameters: list[str], found: Mapping[str, Stored]) -> None:
    """Raise ValueError for branches, windows or curves that cannot be read."""
    if kind not in KINDS:
        raise ValueError(f"its kind {shown(kind)} is unknown")
    lengths = {}
    for name, one in found.items():
        if len(one.dimensions) != one.values.ndim:
            raise ValueError(f"its datasets do not fit together: `{name}` and its dimensions")
        for dimension, length in zip(one.dimensions, one.values.shape, strict=True):
            if lengths.setdefault(dimension, length) != length:
                raise ValueError(f"its datasets do not fit together: `{name}` and the dimension `{dimension}`")
    masses = lengths.get("multiplier", 0) // 2
    for column in (*columns(kind, parameters, masses), *OF_EDGES):
        if column.name in found:
            _check_column(column, found[column.name], lengths)
        elif column not in OF_EDGES:  # which only curves of a plane have
            raise ValueError(f"`{cut(column.name)}` is missing")
    for dimension, counts in RAGGED.items():
        if dimension in lengths and all(name in found for name in counts):
            numbers = np.prod([found[name].values.astype(np.int64) for name in counts], axis=0)
            if np.any(numbers < 0) or numbers.sum() != lengths[dimension]:
                raise ValueError(f"its datasets do not fit together: {', '.join(counts)} and `{dimension}`")


def _check_column(column: Quantity, one: Stored, lengths: Mapping[str, int]) -> None:
    if one.values.dtype.kind not in "if":
        raise ValueError(f"`{column.name}` holds no numbers")
    if one.dimensions != column.dimensions:
        raise ValueError(f"its datasets do not fit together: `{column.name}` and its dimensions")
    limits = column.limits(lengths)
    if limits is None:
        return
    least, most = limits
    wrong = one.values[~((one.values >= least) & (one.values <= most))]
    if wrong.size:
        raise ValueError(f"`{column.name}` has {wrong.flat[0]}; it must be from {least} to {most}")


def _values(file: h5py.File, name: str) -> np.ndarray:
    """Raises OSError, which names the dataset, where its checksum is wrong."""
    try:
        return file[name][()]
    except OSError:
        raise OSError(f"`{name}` cannot be read: its checksum is wrong") from None
