"""Opening a file: is it one of ours, and what does it hold? Its numbers are not looked at yet."""

import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray

from vibro_sweep.checks.refusals import cut
from vibro_sweep.files.disk import open_raw
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.hdf5 import FORMAT, OLD
from vibro_sweep.files.seal import SealError, is_sealed
from vibro_sweep.files.verifying import end_of
from vibro_sweep.tables.file_columns import SWEEP

NETCDF = "_NCProperties"  # the attribute by which a netCDF library says that it has made the file
PART = b"\x89vibro_sweep"  # with which an interrupted run of 0.2 begins


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
            advice = f"{path} was left open by a program that was killed; `h5clear -s {path}` frees it"
            raise StoreError(advice) from None
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
    if (stored := attributes.get("format")) not in (OLD, FORMAT):
        version = f"the format {cut(str(stored))} of another version of vibro_sweep"
        raise StoreError(f"{path} has {version}; this one reads {OLD}, {FORMAT}")
    complete = True
    with h5py.File(path, "r") as h5:
        if stored == OLD:
            sealed = NETCDF not in h5.attrs
        elif sealed and attributes["kind"] == SWEEP:
            end = end_of(h5)
            complete = end is not None
            if end is not None:
                attributes["history"] = "\n".join([str(attributes["history"]), *end.pop("history")])
                attributes["provenance"] = json.dumps(json.loads(str(attributes["provenance"])) | end)
    texts = {name: values.astype(str) for name, values in data.coords.items() if values.dtype.kind in "SO"}
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
        texts = [text.decode() if isinstance(text, bytes) else text for text in values.tolist()]
        return texts[0] if len(texts) == 1 else texts
    return values.item() if values.shape in ((), (1,)) and values.dtype.kind in "biuf" else value


def foreign(path: object) -> str:
    """The message about a file without a seal."""
    return (
        f"{path} was written, or changed, by another program than this one: nothing tells whether its numbers are "
        "still those that were computed"
    )
