"""Files that another program wrote from one of ours, as xarray does; netCDF says by which library.

They have none of our checksums: nothing tells whether their numbers are those that were computed. So they are opened
and drawn, with a warning that says so, and no run continues them or computes anything from them.
"""

import json
import logging

import numpy as np
import xarray

from vibro_sweep.store.opening import ForeignError, StoreError


def dataset_of(found: ForeignError) -> xarray.Dataset:
    """The Dataset that xarray reads in such a file; `written_by` among its attributes says whose it is. Raises
    StoreError."""
    data = _read(found)
    data.attrs["written_by"] = found.program
    logging.getLogger("vibro_sweep").warning("%s", found)
    return data


def _read(found: ForeignError) -> xarray.Dataset:
    try:
        return xarray.open_dataset(found.path, engine="h5netcdf", decode_times=False)
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise StoreError(f"{found.path} was not written by this program, and cannot be read ({error})") from None


def described(found: ForeignError) -> str:
    """The lines of `info` about it."""
    with _read(found) as data:
        lines = [f"{found.path}: {data.attrs.get('title', '')}"]
        lines += [f"  {name:<10} ({size:,} values)" for name, size in data.sizes.items()]
        lines.append("datasets")
        for name, one in data.data_vars.items():
            shape = " x ".join(map(str, one.shape)) or "one"
            lines.append(f"  {name:<18} {shape:<16} {one.attrs.get('description', '')}")
        lines.append(f"checksums    none: written by {found.program}, not by this program")
        return "\n".join([*lines, *_made_by(data)])


def _made_by(data: xarray.Dataset) -> list[str]:
    """The lines about the file that it was made from."""
    try:
        provenance = json.loads(data.attrs.get("provenance", "{}"))
    except (TypeError, ValueError):
        provenance = {}
    known = provenance.items() if isinstance(provenance, dict) else ()
    history = "\n".join(np.atleast_1d(data.attrs.get("history", "")).astype(str))
    lines = [f"  {key:<12} {value}" for key, value in known if value is not None]
    return ["written from a file that was made by", *lines, *(f"  {entry}" for entry in history.splitlines())]
