"""Branches, curves and windows as pictures take them: all arrays, and what their file says of itself."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import cut
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.opening import open_file
from vibro_sweep.files.reading import open_whole
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.source import name_of, readable
from vibro_sweep.results.declared_units import display_in, shown_dataset
from vibro_sweep.results.ragged_dataset import check
from vibro_sweep.tables.bifurcations import KINDS, TYPES
from vibro_sweep.tables.file_columns import BRANCHES, WINDOWS
from vibro_sweep.tables.units import Display, shown_unit

if TYPE_CHECKING:
    import xarray


class RaggedFile:
    """A file of branches, curves or windows, or a Dataset that `vibro_sweep.open` made of one.

    `arrays`: name -> values; `parameters`: names, that along which branches lead first; `sweep`: run id of the
    sweep whose windows they are. `display`: the units in which it gives numbers; None: those that its scene says.
    Raises PlotError for anything else.
    """

    def __init__(self, source: "str | Path | xarray.Dataset", kind: str, display: Display | None = None):
        is_users = not isinstance(source, (str, Path))
        source, holds = readable(source)
        self.name = name_of(source)
        if holds != kind and not (kind == BRANCHES and holds == WINDOWS):  # which are stable parts of branches
            raise PlotError(f"{self.name}: holds no {kind}")
        try:
            data = open_whole(Path(source)) if isinstance(source, (str, Path)) else source
            check(data)
            data = shown_dataset(data, display_in(data) if display is None else display, is_users)
            self.arrays = {str(name): variable.values for name, variable in data.variables.items()}
        except (StoreError, ArgumentError) as error:
            raise PlotError(str(error)) from error
        except (OSError, RuntimeError, ValueError) as error:
            raise PlotError(f"{self.name} does not hold all that {holds} are: {error}") from error
        self._units = {name: data[name].attrs.get("units") for name in self.arrays}
        self.parameters = [str(name) for name in np.atleast_1d(data.attrs.get("parameters", []))]
        self.title = str(data.attrs.get("title", "")).removeprefix("vibro_sweep: ")
        self.sweep = str(data.attrs.get("sweep", ""))

    def __getitem__(self, name: str) -> np.ndarray:
        return self.arrays[name]

    def unit(self, name: str) -> str:
        """The unit of a variable, for the name of an axis."""
        return shown_unit(self._units.get(name))

    def stored_unit(self, name: str) -> str | None:
        """The unit of a variable as files write it."""
        return self._units.get(name)

    def types(self) -> list[str]:
        """The types of all special points; of a graze with its kind: graze or nonsmooth_fold."""
        names = [TYPES[code].name for code in self["special_type"].tolist()]
        kinds = [KINDS[code] for code in self["special_kind"].tolist()]
        return [kind if kind == "nonsmooth_fold" else name for name, kind in zip(names, kinds, strict=True)]


def in_units_of(options: PlotOptions, path: "str | Path | xarray.Dataset") -> PlotOptions:
    """The options with the units that are shown: those asked for, else those of the data, or of the sweep below."""
    if options.units is not None:
        return options
    known = [_units_in(data) for data in (path, options.over) if data is not None]
    return options.replace(units=next(filter(None, known), ""))


def _units_in(data: "str | Path | xarray.Dataset") -> str:
    source, _ = readable(data)
    if not isinstance(source, (str, Path)):
        return str(source.attrs.get("picture_units", ""))
    with open_file(Path(source)) as file:
        return str(file.attrs.get("picture_units", ""))


def sweep_below(path: str | Path) -> "str | Path | xarray.Dataset":
    """The sweep over which branches or curves are drawn. Raises PlotError where it holds branches, curves or
    windows."""
    sweep, kind = readable(path)
    if kind is not None:
        raise PlotError(f"over: {path} holds {cut(kind)}, and no sweep")
    return sweep
