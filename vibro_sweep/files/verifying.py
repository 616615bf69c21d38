"""Are the numbers of a file those that were written, and is it complete? Nothing is written."""

import json
import zlib
from collections.abc import Iterable
from typing import Any

import h5py
import numpy as np
import xarray

from vibro_sweep.files.checksum import checksums
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.hdf5 import CHECKS, OLD, text_of
from vibro_sweep.results.boxes import boxes
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.outcomes import NOT_COMPUTED

END_BYTES = 4096  # of the record that is written when a sweep is complete
AT_ONCE = 2**24  # bytes that are verified at a time
REMEDY = "`--resume` computes that again"


def end_of(h5: h5py.File) -> dict[str, Any] | None:
    """What a complete sweep says of its run; None where that is not written yet, or is not what was written."""
    raw = h5[f"{CHECKS}/end"][()].tobytes()
    length, checksum = (int.from_bytes(raw[at : at + 4], "little") for at in (0, 4))
    text = raw[8 : 8 + length]
    return json.loads(text) if text and zlib.crc32(text) == checksum else None


def end_record(about: dict[str, Any]) -> np.ndarray:
    """The bytes that `end_of` reads."""
    text = json.dumps(about).encode()[: END_BYTES - 8]
    raw = len(text).to_bytes(4, "little") + zlib.crc32(text).to_bytes(4, "little") + text
    return np.frombuffer(raw.ljust(END_BYTES, b"\0"), np.uint8)


def verify(data: xarray.Dataset, names: Iterable[str] | None = None) -> None:
    """Compare the numbers of variables of a file, by default of all, with their checksums. Raises StoreError."""
    if damaged := damage(data, names):
        raise StoreError(f"{data.encoding['source']} is damaged: {damaged}; {REMEDY}")


def damage(data: xarray.Dataset, names: Iterable[str] | None = None) -> str:
    """The variables of a file, of some or of all, whose numbers are not those that were written, in words."""
    return in_words(damaged_points(data, names)) or unreadable(data, names)


def in_words(damaged: dict[str, np.ndarray]) -> str:
    """Which variables are damaged, and at how many points."""
    counts = {name: int(np.count_nonzero(wrong)) for name, wrong in damaged.items()}
    return ", ".join(f"{name} at {count:,} point{'s' * (count > 1)}" for name, count in counts.items())


def damaged_points(data: xarray.Dataset, names: Iterable[str] | None = None) -> dict[str, np.ndarray]:
    """The points (bool, the shape of the sweep) at which the numbers of variables are not those that were written: of
    some or of all variables, those that are damaged. Other files than those of sweeps have one seal of the whole."""
    if not data.encoding["sealed"] or data.attrs["format"] == OLD or data.attrs["kind"] != SWEEP:
        return {}
    names = [str(name) for name in data.data_vars] if names is None else [*names]
    with h5py.File(data.encoding["source"], "r") as h5:
        lost = h5["status"][()] == NOT_COMPUTED
        if data.encoding["complete"] and lost.any():
            return {"status": lost}
        wrong_of = {name: wrong_points(h5, name) for name in names if is_verified(h5, name)}
    return {name: wrong for name, wrong in wrong_of.items() if wrong.any()}


def unreadable(data: xarray.Dataset, names: Iterable[str] | None = None) -> str:
    """Of a file of format 2, whose checksums HDF5 looks at: which variables cannot be read."""
    if not data.encoding["sealed"] or data.attrs["format"] != OLD:
        return ""
    names = [str(name) for name in data.data_vars] if names is None else names
    return ", ".join(f"{name} cannot be read" for name in names if not _can_be_read(data, name))


def _can_be_read(data: xarray.Dataset, name: str) -> bool:
    try:
        return data[name].values is not None
    except (OSError, RuntimeError):
        return False


def is_verified(h5: h5py.File, name: str) -> bool:
    """Whether a variable has checksums now: what follows from all points has them when the run is complete."""
    follows = text_of(h5[CHECKS].attrs["following"]).split()
    return name in h5[CHECKS] and (name not in follows or end_of(h5) is not None)


def wrong_points(h5: h5py.File, name: str) -> np.ndarray:
    """Which points (bool, the shape of the sweep) have a status and not the numbers of their checksums."""
    status = np.array(h5["status"][()])  # before the numbers: another process may be writing them
    values, sums = h5[name], h5[f"{CHECKS}/{name}"]
    wrong = np.zeros(status.shape, bool)
    each = max(1, values.dtype.itemsize * values.size // max(1, status.size))
    for box in boxes(status.shape, lambda: AT_ONCE // each):
        done = status[box] != NOT_COMPUTED
        if np.any(done):
            wrong[box] = done & (checksums(values[box], status.ndim) != sums[box])
    return wrong
