"""Where a picture takes its numbers from: an HDF5 file, read in pieces, or an `xarray.Dataset` in memory."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.model.errors import ArgumentTypeError, VibroSweepError
from vibro_sweep.model.refusals import not_allowed
from vibro_sweep.store.attributes import is_flat, quantities_of, text, texts
from vibro_sweep.store.opening import ForeignError, StoreError, is_dataset, open_file, opened
from vibro_sweep.tables.file_columns import SWEEP

if TYPE_CHECKING:
    import xarray


class PlotError(VibroSweepError, ValueError):
    """A picture cannot be drawn; the message says what can.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": [6.4, 6.5]}, transient=100, record=50)
    >>> try:
    ...     vs.plot(data, "basins")
    ... except vs.PlotError as error:
    ...     print(error)
    kind 'basins': this dataset can show bifurcation, lyapunov, iteration, poincare (or all)
    """


def readable(given: "str | Path | xarray.Dataset") -> tuple["str | Path | xarray.Dataset", str | None]:
    """What is read, and what it holds where that is branches, curves or windows. Raises PlotError.

    A file that another program wrote from one of ours is read as a Dataset.
    """
    if not isinstance(given, (str, Path)):
        kind = getattr(given, "attrs", {}).get("kind")
        return given, None if kind in (None, SWEEP) else str(kind)
    try:
        with opened(Path(given), (), content=False) as (file, _):
            return given, text(file, "kind") if is_flat(file) else None
    except ForeignError as found:
        return readable(_dataset_of(found))
    except StoreError as error:
        raise PlotError(str(error)) from error


def _dataset_of(found: ForeignError) -> "xarray.Dataset":
    from vibro_sweep.store import foreign  # xarray takes long to be imported

    try:
        return foreign.dataset_of(found)
    except StoreError as error:
        raise PlotError(str(error)) from error


def name_of(given: "str | Path | xarray.Dataset") -> str:
    """The name of the data in messages."""
    if isinstance(given, (str, Path)):
        return str(given)
    return getattr(given, "encoding", {}).get("source", "this dataset")


class FileSource:
    """A file of a run, or the part of one that is not complete. Raises StoreError where there is none."""

    def __init__(self, path: str | Path):
        self.name = str(path)
        self._file = open_file(Path(path)).file

    def close(self) -> None:
        self._file.close()

    @property
    def sweep(self) -> list[str]:
        """Names of the sweep's dimensions, in order."""
        return texts(self._file, "sweep_dimensions")

    @property
    def quantities(self) -> list[str]:
        return quantities_of(self._file)

    @property
    def attributes(self) -> dict[str, Any]:
        """The attributes of the file, texts as `str`."""
        return {key: _decoded(value) for key, value in self._file.attrs.items()}

    def attribute(self, name: str, key: str) -> Any:
        """An attribute of a dataset; None where it has no such."""
        return _decoded(self._file[name].attrs.get(key))

    def __contains__(self, name: str) -> bool:
        return is_dataset(self._file, name)

    def dimensions(self, name: str) -> tuple[str, ...]:
        return tuple(one[0].name.rpartition("/")[2] for one in self._file[name].dims)

    def number_of_dimensions(self, name: str) -> int:
        return self._file[name].ndim

    def read(self, name: str, index=()) -> np.ndarray:
        try:
            return self._file[name][index]
        except OSError as error:  # h5py's word for what it cannot read back
            raise PlotError(f"{self.name}: `{name}` cannot be read, it is damaged or being written") from error


class DatasetSource:
    """What `vibro_sweep.open` or `vibro_sweep.sweep` returned, or a part of it that `sel` and the like have cut out."""

    def __init__(self, data: "xarray.Dataset"):
        if not hasattr(data, "data_vars"):
            raise ArgumentTypeError(not_allowed("data", data, "the path of a file, or a Dataset"))
        if "status" not in data or "sweep_dimensions" not in data.attrs:
            raise PlotError("this dataset is not from `vibro_sweep.open` or `vibro_sweep.sweep`: it has no status")
        self._data, self.name = data, name_of(data)

    def close(self) -> None:
        """Do nothing: it stays open for its owner."""

    @property
    def sweep(self) -> list[str]:
        return [name for name in np.atleast_1d(self._data.attrs["sweep_dimensions"]) if name in self._data.dims]

    @property
    def quantities(self) -> list[str]:
        return [str(name) for name in self._data.data_vars]

    @property
    def attributes(self) -> dict[str, Any]:
        chosen = {name: one.item() for name, one in self._data.coords.items() if one.ndim == 0}
        return dict(self._data.attrs) | chosen

    def attribute(self, name: str, key: str) -> Any:
        return self._data[name].attrs.get(key)

    def __contains__(self, name: str) -> bool:
        return name in self._data.variables and not (name in self._data.coords and self._data[name].ndim == 0)

    def dimensions(self, name: str) -> tuple[str, ...]:
        return self._in_order(name).dims

    def number_of_dimensions(self, name: str) -> int:
        return self._data[name].ndim

    def read(self, name: str, index=()) -> np.ndarray:
        try:
            return np.asarray(self._in_order(name).values[index])
        except (OSError, RuntimeError) as error:  # of a file that it reads from
            raise PlotError(f"{self.name}: `{name}` cannot be read, it is damaged or closed") from error

    def _in_order(self, name: str):
        """The dimensions as files have them."""
        lead = [one for one in (*self.sweep, "start") if one in self._data[name].dims]
        return self._data[name].variable.transpose(*lead, ...)


def source_of(given) -> FileSource | DatasetSource:
    """A path or a Dataset. Raises PlotError where it is missing or no result."""
    if not isinstance(given, (str, Path)):
        return DatasetSource(given)
    try:
        return FileSource(given)
    except ForeignError as found:
        return DatasetSource(_dataset_of(found))
    except StoreError as error:
        raise PlotError(str(error)) from error


def _decoded(value):
    return value.decode() if isinstance(value, bytes) else value
