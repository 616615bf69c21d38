"""Reading a file: as an `xarray.Dataset`, or as arrays."""

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py

from vibro_sweep.model.files import checked_path
from vibro_sweep.store import checks
from vibro_sweep.store.arrays import Contents
from vibro_sweep.store.opening import REMEDY, ForeignError, StoreError, open_file

if TYPE_CHECKING:
    import xarray


def open(path: str | Path) -> "xarray.Dataset":  # the name that users of xarray expect
    """An HDF5 file, or what is computed in a part, as a Dataset; `vibro_sweep.open` (driver/any_file.py) says more."""
    from vibro_sweep.store import foreign, lazy

    try:
        data = _whole(path, lazy.dataset_of)
        data.encoding["source"] = str(path)  # as xarray says it
        return data
    except ForeignError as found:
        return foreign.dataset_of(found)


@contextlib.contextmanager
def contents(path: str | Path) -> Iterator[Contents]:
    """The same as `open`, for code that computes with the numbers: files without checksums are refused."""
    try:
        file = _whole(path, lambda file: file)
    except ForeignError as found:
        raise StoreError(f"{found}; nothing is computed from it") from None
    with file:
        yield Contents(file)


def _whole(path: str | Path, made: Callable[[h5py.File], Any]) -> Any:
    """The result made of a file, if it is not damaged."""
    path = checked_path("path", path)
    file, lost = open_file(path)
    try:
        if found := checks.damage(file, lost):
            raise StoreError(f"{path} is damaged: {found}; {REMEDY}")
        return made(file)
    except (OSError, RuntimeError, ValueError) as error:
        file.close()
        raise error if isinstance(error, StoreError) else StoreError(f"{path} is damaged ({error})") from None
