"""From a path or a Dataset to what is read of it; what is read of a file is verified, and nothing else."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import xarray

from vibro_sweep.checks.file_names import checked_path
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.opening import foreign, open_file
from vibro_sweep.files.verifying import verify
from vibro_sweep.results import ragged_dataset
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.outcomes import NOT_COMPUTED
from vibro_sweep.tables.units import AS_STORED, Display

_log = logging.getLogger("vibro_sweep")


def open_whole(path: Path) -> xarray.Dataset:
    """A file as a Dataset, every number compared with its checksum; what is not as it should be is warned of, once.
    Raises StoreError."""
    data = open_file(path)
    try:
        verify(data)
        if data.attrs["kind"] != SWEEP:
            _check_ragged(data, path)
    except StoreError:
        data.close()
        raise
    if not data.encoding["sealed"]:
        _log.warning("%s", foreign(path))
    warn_where_incomplete(data)
    return data


def warn_where_incomplete(data: xarray.Dataset) -> None:
    """Say how many orbits of a file are not computed yet."""
    if data.encoding.get("sealed") and not data.encoding.get("complete"):
        status = data["status"].values
        missing = f"{np.count_nonzero(status == NOT_COMPUTED):,} of {status.size:,}"
        _log.warning("%s is not complete: %s orbits are missing", data.encoding["source"], missing)


@contextmanager
def sweep_in(
    source: "str | Path | xarray.Dataset", computes: bool, display: Display | None = AS_STORED
) -> Iterator[Sweep]:
    """The sweep of a file, or of a Dataset, whose numbers are verified when they are read.

    computes : whether something is computed from it, and not only drawn: a file without a seal is refused then
    display : the units in which it gives numbers; None: those of its picture
    Raises StoreError, and ArgumentError for units that do not belong to it.
    """
    if isinstance(source, (str, Path)):
        path = checked_path("data", source)
        with open_file(path) as data:
            if computes and not data.encoding["sealed"]:
                raise StoreError(f"{foreign(path)}; nothing is computed from it")
            if data.attrs["kind"] != SWEEP:
                _check_ragged(data, path)
            if not data.encoding["sealed"]:
                _log.warning("%s", foreign(path))
            yield Sweep(data, str(path), lambda name: verify(data, [name]), display)
    else:
        yield Sweep(source, "this dataset", display=display)


def _check_ragged(data: xarray.Dataset, path: Path) -> None:
    try:
        ragged_dataset.check(data)
    except (OSError, RuntimeError, ValueError, KeyError, AttributeError) as error:
        if data.encoding["sealed"]:
            raise StoreError(f"{path} is damaged: {error}") from None
        raise StoreError(f"{path} does not hold all that {data.attrs['kind']} are: {error}") from None
