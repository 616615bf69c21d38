"""Files that another program wrote from one of ours, as xarray does; netCDF says by which library.

They have none of our checksums: nothing tells whether their numbers are those that were computed. So they are opened
and drawn, with a warning that says so, and no run continues them or computes anything from them.
"""

import logging

import xarray

from vibro_sweep.store.opening import ForeignError, StoreError


def dataset_of(found: ForeignError) -> xarray.Dataset:
    """The Dataset that xarray reads in such a file; `written_by` among its attributes says whose it is. Raises
    StoreError."""
    data = undoubted(found)
    data.attrs["written_by"] = found.program
    logging.getLogger("vibro_sweep").warning("%s", found)
    return data


def undoubted(found: ForeignError) -> xarray.Dataset:
    """The same without the warning."""
    try:
        return xarray.open_dataset(found.path, engine="h5netcdf", decode_times=False)
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise StoreError(f"{found.path} was not written by this program, and cannot be read ({error})") from None
