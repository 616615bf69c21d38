"""Where a picture takes its numbers from: an HDF5 file, read in pieces, or an `xarray.Dataset` in memory."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from vibro_sweep.checks.errors import ArgumentError, ArgumentTypeError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.opening import open_file
from vibro_sweep.files.reading import sweep_in
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.units import AS_STORED, Display

if TYPE_CHECKING:
    import xarray


def readable(source: "str | Path | xarray.Dataset") -> tuple["str | Path | xarray.Dataset", str | None]:
    """What is read, and what it holds where that is branches, curves or windows. Raises PlotError."""
    if isinstance(source, (str, Path)):
        try:
            with open_file(Path(source)) as data:
                kind = data.attrs["kind"]
        except StoreError as error:
            raise PlotError(str(error)) from error
    else:
        kind = getattr(source, "attrs", {}).get("kind")
    return source, None if kind in (None, SWEEP) else str(kind)


def name_of(data: "str | Path | xarray.Dataset") -> str:
    """The name of the data in messages."""
    if isinstance(data, (str, Path)):
        return str(data)
    return getattr(data, "encoding", {}).get("source", "this dataset")


@contextmanager
def sweep_read(data: "str | Path | xarray.Dataset", display: Display | None = AS_STORED) -> Iterator[Sweep]:
    """The sweep of a file or of a Dataset, in these units. Raises PlotError where it is missing or no result."""
    if not isinstance(data, (str, Path)):
        if not hasattr(data, "data_vars"):
            raise ArgumentTypeError(not_allowed("data", data, "the path of a file, or a Dataset"))
        if "status" not in data or "sweep_dimensions" not in data.attrs:
            raise PlotError("this dataset is not from `vibro_sweep.open` or `vibro_sweep.sweep`: it has no status")
    with ExitStack() as stack:
        try:
            sweep = stack.enter_context(sweep_in(data, computes=False, display=display))
        except (StoreError, ArgumentError) as error:
            raise PlotError(str(error)) from error
        if "status" not in sweep:
            raise PlotError(f"{sweep.name} is not from `vibro_sweep.open` or `vibro_sweep.sweep`: it has no status")
        yield sweep
