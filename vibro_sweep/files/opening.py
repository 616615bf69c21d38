"""Opening a file: is it one of ours, is it whole, and are its numbers those that were written? Nothing is written."""

import json
import os
import stat
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, BinaryIO

import h5py
import numpy as np
import xarray

from vibro_sweep.files.checksum import checksums
from vibro_sweep.files.file_errors import MissingError, StoreError
from vibro_sweep.files.hdf5 import CHECKS
from vibro_sweep.files.seal import SealError, is_sealed
from vibro_sweep.model.refusals import cut
from vibro_sweep.results.boxes import boxes
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.outcomes import NOT_COMPUTED

OLD, FORMAT = 2, 3  # formats that are read; OLD has checksums of HDF5 in chunks
NETCDF = "_NCProperties"  # the attribute by which a netCDF library says that it has made the file
PART = b"\x89vibro_sweep"  # with which an interrupted run of 0.2 begins
END_BYTES = 4096  # of the record that is written when a sweep is complete
AT_ONCE = 2**24  # bytes that are verified at a time
REMEDY = "`--resume` computes that again"


def open_raw(path: Path) -> BinaryIO:
    """A regular file, for reading; a pipe is not waited for. Raises StoreError."""
    try:
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except FileNotFoundError:
        raise MissingError(path) from None
    except OSError as error:
        raise StoreError(f"{path} cannot be read: {error.strerror}") from None
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise StoreError(f"{path} is a folder, a device or a pipe; it must be a file")
    return os.fdopen(descriptor, "rb")


def open_file(path: Path) -> xarray.Dataset:
    """A file as a Dataset whose numbers are read, and not yet verified, when they are asked for.

    `encoding["sealed"]` says whether it is as this program made it. Raises StoreError.
    """
    with open_raw(path) as raw:
        if raw.read(len(PART)) == PART:
            raise StoreError(
                f"{path} is an interrupted run of vibro_sweep 0.2, which this version does not continue; run its scene "
                "again, or complete it with 0.2"
            )
        try:
            sealed = is_sealed(raw)
        except SealError as error:
            raise StoreError(f"{path} {error}; overwrite it") from None
    try:
        data = xarray.open_dataset(path, engine="h5netcdf", decode_times=False, mask_and_scale=False, cache=True)
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, AttributeError) as error:
        if path.suffix.lower() in (".yaml", ".yml"):
            raise StoreError(f"{path} is a scene, not an HDF5 file: `vibro-sweep run {path}` makes that") from None
        if "already open for write" in str(error):
            told = f"{path} was left open by a program that was killed; `h5clear -s {path}` frees it"
            raise StoreError(told) from None
        raise StoreError(f"{path} is not an HDF5 file, or it is damaged ({cut(str(error))})") from None
    try:
        return _described(data, path, sealed)
    except StoreError:
        data.close()
        raise
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, AttributeError) as error:
        data.close()
        raise StoreError(f"{path} is damaged ({cut(str(error))})") from None


def _described(data: xarray.Dataset, path: Path, sealed: bool) -> xarray.Dataset:
    """The Dataset with its texts as texts, and with what its run has noted at its end."""
    attributes = {name: _decoded(value) for name, value in data.attrs.items()}
    if not {"kind", "scene"} <= attributes.keys():
        raise StoreError(f"{path} is an HDF5 file, but none that vibro-sweep wrote")
    needed = ("title", "history", "provenance", *(["sweep_dimensions"] if attributes["kind"] == SWEEP else []))
    if lacking := [name for name in needed if name not in attributes]:
        raise StoreError(f"{path} is damaged: it has no {', '.join(lacking)}")
    if (found := attributes.get("format")) not in (OLD, FORMAT):
        raise StoreError(
            f"{path} has the format {cut(str(found))} of another version of vibro_sweep; this one reads {OLD}, {FORMAT}"
        )
    complete = True
    with h5py.File(path, "r") as h5:
        if found == OLD:
            sealed = NETCDF not in h5.attrs
        elif sealed and attributes["kind"] == SWEEP:
            end = end_of(h5)
            complete = end is not None
            if end is not None:
                attributes["history"] = "\n".join([str(attributes["history"]), *end.pop("history")])
                attributes["provenance"] = json.dumps(json.loads(str(attributes["provenance"])) | end)
    texts = {name: one.astype(str) for name, one in data.coords.items() if one.dtype.kind in "SO"}
    result = data.assign_coords(texts)
    result.set_close(data.close)
    result.attrs = attributes
    result.encoding = {"source": str(path), "sealed": sealed, "complete": complete}
    return result


def _decoded(value: Any) -> Any:
    """An attribute: texts as texts, a list of one text as that text, as xarray has them."""
    if isinstance(value, bytes):
        return value.decode()
    values = np.asarray(value)
    if values.dtype.kind in "SO" and values.ndim:
        found = [one.decode() if isinstance(one, bytes) else one for one in values.tolist()]
        return found[0] if len(found) == 1 else found
    return values.item() if values.shape in ((), (1,)) and values.dtype.kind in "biuf" else value


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


def foreign(path: object) -> str:
    """The message about a file without a seal."""
    return (
        f"{path} was written, or changed, by another program than this one: nothing tells whether its numbers are "
        "still those that were computed"
    )


def verify(data: xarray.Dataset, names: Iterable[str] | None = None) -> None:
    """Compare the numbers of variables of a file, by default of all, with their checksums. Raises StoreError."""
    if found := damage(data, names):
        raise StoreError(f"{data.encoding['source']} is damaged: {found}; {REMEDY}")


def damage(data: xarray.Dataset, names: Iterable[str] | None = None) -> str:
    """The variables of a file, of some or of all, whose numbers are not those that were written, in words."""
    if not data.encoding["sealed"]:
        return ""
    names = [str(name) for name in data.data_vars] if names is None else [*names]
    if data.attrs["format"] == OLD:
        return ", ".join(f"{name} cannot be read" for name in names if not _can_be_read(data, name))
    if data.attrs["kind"] != SWEEP:
        return ""  # its seal is of the whole file
    with h5py.File(data.encoding["source"], "r") as h5:
        if data.encoding["complete"] and np.any(h5["status"][()] == NOT_COMPUTED):
            return "status"
        found = {name: int(np.count_nonzero(wrong_points(h5, name))) for name in names if is_verified(h5, name)}
    return ", ".join(f"{name} at {count:,} point{'s' * (count > 1)}" for name, count in found.items() if count)


def _can_be_read(data: xarray.Dataset, name: str) -> bool:
    try:
        return data[name].values is not None
    except (OSError, RuntimeError):
        return False


def is_verified(h5: h5py.File, name: str) -> bool:
    """Whether a variable has checksums now: what follows from all points has them when the run is complete."""
    follows = _decoded(h5[CHECKS].attrs["following"]).split()
    return name in h5[CHECKS] and (name not in follows or end_of(h5) is not None)


def wrong_points(h5: h5py.File, name: str) -> np.ndarray:
    """Which points (bool, the shape of the sweep) have a status and not the numbers of their checksums."""
    status = np.array(h5["status"][()])  # before the numbers: another process may be writing them
    values, sums = h5[name], h5[f"{CHECKS}/{name}"]
    wrong = np.zeros(status.shape, bool)
    each = max(1, values.dtype.itemsize * values.size // max(1, status.size))
    for box in boxes(status.shape, max(1, AT_ONCE // each)):
        done = status[box] != NOT_COMPUTED
        if np.any(done):
            wrong[box] = done & (checksums(values[box], status.ndim) != sums[box])
    return wrong
