"""A new file on the disk: HDF5 makes it in memory; it is written whole, sealed, and gets its name when it is there."""

import os
from collections.abc import Collection, Mapping
from pathlib import Path

import xarray

from vibro_sweep.files.disk import faults_said, publish, write_all
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.hdf5 import create
from vibro_sweep.files.seal import Stretch, seal
from vibro_sweep.files.sparse import SparseFile

AT_ONCE = 2**20  # bytes of fill values that are written at a time


def make(
    path: Path,
    data: xarray.Dataset,
    later: Collection[str] = (),
    checks: xarray.Dataset | None = None,
    replaces: bool = False,
) -> None:
    """Write the file of a Dataset; its variables `later`, and `checks`, have their fill values. Raises StoreError, also
    where a file stands there already that it does not replace."""
    made, new = SparseFile(), Path(f"{path}.new")
    filled = create(made, data, later, checks)
    seal(made, list(filled))
    with faults_said(path, "the file is not made"):
        try:
            with open(new, "wb") as file:
                _pour(made, filled, file.fileno())
                os.fsync(file.fileno())
            publish(new, path, replaces)
        except FileExistsError:
            raise StoreError(f"{path} has appeared meanwhile and is left alone; move it away, then `resume`") from None
        finally:
            new.unlink(missing_ok=True)


def _pour(made: SparseFile, filled: Mapping[Stretch, bytes], descriptor: int) -> None:
    """Write a file that was made in memory, and fill values. Raises OSError."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(descriptor, 0, made.size)  # room for what is computed later, too
    for at, page in made.pages.items():
        write_all(descriptor, memoryview(page)[: made.size - at], at)
    for (offset, size), fill in filled.items():
        whole = fill * (AT_ONCE // len(fill))
        for at in range(0, size, len(whole)) if any(fill) else ():
            write_all(descriptor, memoryview(whole)[: size - at], offset + at)
