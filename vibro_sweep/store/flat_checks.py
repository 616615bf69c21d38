"""Whether a file of branches, windows or curves holds what such a file must: columns, lengths, indices, codes.

Its checksums say only that nothing has changed since somebody wrote it.
"""

import h5py
import numpy as np

from vibro_sweep.model.branch_file import BRANCHES, CHART, OF_EDGES, RAGGED, UNSEEN, WINDOWS, Column, columns
from vibro_sweep.model.state import state
from vibro_sweep.store.attributes import check_dataset, text, texts

KINDS = (BRANCHES, WINDOWS, CHART)
LATER = {column.dimensions[0] for column in (*OF_EDGES, *UNSEEN.values())}  # dimensions that a file need not have


def damage_of(file: h5py.File) -> str:
    """What is wrong with the datasets of a file, in words; nothing where all of it can be read."""
    if "status" not in file:  # a run that has not ended has no datasets
        return ""
    try:
        for name in ("status", *texts(file, "quantities")):
            _values(file, name)
        _check(file)
    except (OSError, RuntimeError, ValueError, KeyError, AttributeError) as error:
        return str(error)
    return ""


def _check(file: h5py.File) -> None:
    """Raise ValueError, KeyError or OSError for a complete file that nobody could read."""
    kind = text(file, "kind")
    if kind not in KINDS:
        raise ValueError(f"its kind {kind!r} is unknown")
    for name in texts(file, "quantities"):
        check_dataset(file, name)
    masses = len(file["multiplier"]) // 2
    for column in (*columns(kind, texts(file, "parameters"), list(state(masses))), *OF_EDGES):
        if column.name in file:
            _check_column(file, column)
        elif column.dimensions[0] not in LATER:
            raise ValueError(f"`{column.name}` is missing")
    for dimension, counts in RAGGED.items():
        if all(name in file for name in (dimension, *counts)):
            numbers = np.prod([_values(file, name).astype(np.int64) for name in counts], axis=0)
            if np.any(numbers < 0) or numbers.sum() != len(file[dimension]):
                raise ValueError(f"its datasets do not fit together: {', '.join(counts)} and `{dimension}`")


def _check_column(file: h5py.File, column: Column) -> None:
    dataset = file[column.name]
    if dataset.dtype.kind not in "if":
        raise ValueError(f"`{column.name}` holds no numbers")
    found = tuple(dimension[0].name.removeprefix("/") for dimension in dataset.dims)
    if found != column.dimensions or dataset.shape != tuple(len(file[name]) for name in found):
        raise ValueError(f"its datasets do not fit together: `{column.name}` and its dimensions")
    if column.index_in:
        least, most = -1 if column.optional else 0, len(file[column.index_in]) - 1
    elif column.flags:
        least, most = 0, len(column.flags) - 1
    else:
        return
    values = _values(file, column.name)
    wrong = values[~((values >= least) & (values <= most))]
    if wrong.size:
        raise ValueError(f"`{column.name}` has {wrong.flat[0]}; it must be from {least} to {most}")


def _values(file: h5py.File, name: str) -> np.ndarray:
    """Raises OSError, which names the dataset, where its checksum is wrong."""
    try:
        return file[name][()]
    except OSError:
        raise OSError(f"`{name}` cannot be read: its checksum is wrong") from None
