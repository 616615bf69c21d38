"""Options of a picture besides its kind, with the names that they have in Python and on the command line."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes

from vibro_sweep.checks.arguments import check_type, checked_flag
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import checked_path
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.plotting.figure import Panels, Picture, page, style_of
from vibro_sweep.plotting.measured import Measured, measured
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.tables.units import Display, display_of, why_no_display

if TYPE_CHECKING:
    import xarray

SIZES = (2.0, 100.0)  # inches
WIDTHS = (50.0, 2500.0)  # mm
MM = 25.4  # an inch
RESOLUTIONS = (10, 2400)  # pixels an inch
MOST_PIXELS = 10**8  # of a whole picture: 400 MB while it is drawn
A_FILE = "the path of a file, a Dataset, a branch, a curve or windows"


@dataclass(frozen=True)
class PlotOptions:
    """Options of a picture as `vibro_sweep.plot` has them; the kind of picture chooses those that are None.

    Raises `PlotError` for values that none of the kinds can use, TypeError for what is of another type.
    """

    at: Mapping[str, float] | None = None
    variable: str | None = None
    xlim: tuple[float, float] | None = None
    ylim: tuple[float, float] | None = None
    size: tuple[float, float] | None = None
    dpi: float | None = None
    windows: "Path | xarray.Dataset | None" = None
    over: "Path | xarray.Dataset | None" = None
    relative: bool = False
    width: float | None = None
    units: "str | Sequence[str] | None" = None
    points: Any = None  # columns by name, or the path of their file

    def __post_init__(self) -> None:
        check_type("variable", self.variable, (str, NoneType), "the name of a variable, or None")
        if self.units is not None and display_of(self.units) is None:
            raise PlotError(
                not_allowed("units", self.units, f"names of units, one of a kind; {why_no_display(self.units)}")
            )
        columns = None if self.points is None or isinstance(self.points, Measured) else measured(self.points)
        vars(self).update({"points": columns} if columns is not None else {})
        checked: dict[str, Any] = {"at": _place(self.at), "relative": checked_flag("relative", self.relative)}
        checked |= {name: _pair(name, getattr(self, name)) for name in ("xlim", "ylim", "size")}
        if self.dpi is not None and number_of(self.dpi) is None:
            raise PlotError(not_allowed("dpi", self.dpi, "a number of pixels an inch"))
        checked |= {"dpi": number_of(self.dpi), "width": None if self.width is None else _width(self.width)}
        if self.width is not None and self.size is not None:
            raise PlotError("width and size exclude each other: size is width and height in inches")
        beside = {name: getattr(self, name) for name in ("windows", "over")}
        checked |= {name: data_of(name, data) for name, data in beside.items() if data is not None}
        vars(self).update(checked)
        if self.points is not None and self.relative:
            raise PlotError("points and relative exclude each other: the axis of b is in parts of b*")
        for name, limits in (("xlim", self.xlim), ("ylim", self.ylim)):
            if limits and not (np.isfinite(limits).all() and limits[0] < limits[1]):
                raise PlotError(f"{name}: {_text(limits)} is not allowed; it must be two numbers, the lower one first")
        if self.size and not all(SIZES[0] <= length <= SIZES[1] for length in self.size):
            allowed = f"width and height must be {SIZES[0]:g} to {SIZES[1]:g} inches"
            raise PlotError(f"size: {_text(self.size)} is not allowed; {allowed}")
        if self.dpi is not None and not RESOLUTIONS[0] <= self.dpi <= RESOLUTIONS[1]:
            raise PlotError(f"dpi: {self.dpi:g} is not allowed; it must be {RESOLUTIONS[0]} to {RESOLUTIONS[1]}")

    def replace(self, **changes: Any) -> "PlotOptions":
        """A copy with other values."""
        return replace(self, **changes)

    @property
    def display(self) -> Display | None:
        """The units in which numbers are shown; None: those that the data say."""
        return None if self.units is None else display_of(self.units)

    @property
    def beside(self) -> "list[Path | xarray.Dataset]":
        """What is read beside the data."""
        return [data for data in (self.windows, self.over) if data is not None]

    @property
    def style(self) -> dict[str, Any]:
        """matplotlib's settings for a page of this width."""
        return style_of(self._inches)

    @property
    def _inches(self) -> float | None:
        return None if self.width is None else self.width / MM

    def draw(self, panels: Panels, ax: Axes | None = None) -> list[Axes]:
        """Draw a picture; returns its axes. ax : the caller's, which hold its only panel, or its first one. Raises
        PlotError where they are not enough."""
        with matplotlib.rc_context(self.style):
            if ax is not None:
                panels.draw(self._axes_of_caller(panels, ax))
                axes = [ax]
            else:
                figure = self._page(panels)
                figure.being_drawn = True
                if panels.figure is None:
                    grid = figure.subplots(panels.rows, panels.columns, squeeze=False, **panels.grid)
                    panels.draw(grid)
                    figure.align_ylabels(grid[:, 0])
                else:
                    panels.draw(figure)
                axes = [ax for ax in figure.axes if ax.get_label() != "<colorbar>"]
                figure.being_drawn = figure.narrow = False
            for panel in axes:
                if self.xlim:
                    panel.set_xlim(self.xlim)
                if self.ylim and panel.get_ylabel() == axes[0].get_ylabel():
                    panel.set_ylim(self.ylim)
            return axes

    def _axes_of_caller(self, panels: Panels, ax: Axes) -> np.ndarray:
        if not (self.size is None and self.dpi is None):
            raise PlotError("size and dpi: are those of a new figure; leave them out where `ax` is given")
        if panels.figure is not None:
            raise PlotError("ax: a film has a figure of its own")
        if (count := panels.rows * panels.columns) > 1 and not panels.alone:
            raise PlotError(
                f"ax: the picture has {count} panels; leave ax out, choose one orbit by at, or another kind"
            )
        if not ax.get_title():
            ax.set_title(panels.title, pad=16)  # above the legend, if that is above the axes
        return np.array([[ax]])

    def _page(self, panels: Panels) -> Picture:
        """An empty figure, of the size and the resolution that are asked for: texts find their places in these."""
        figure = page(panels.height, panels.title, self.size, self._inches, panels.figure or Picture)
        if self.dpi:
            figure.set_dpi(self.dpi)
        width, height = figure.get_size_inches() * figure.dpi
        if width * height > MOST_PIXELS:
            pixels = f"{width:.0f} x {height:.0f} pixels"
            raise PlotError(f"size and dpi: {pixels} are not allowed; there may be {MOST_PIXELS:.0e} in all")
        return figure


def is_result(value: object) -> bool:
    """Whether this is a result of this program: an orbit, a branch, a curve, windows."""
    return type(value).__module__.startswith("vibro_sweep.analysis")


def data_of(name: str, value: object) -> "Path | xarray.Dataset":
    """The path or the Dataset that an argument is. Raises ArgumentError for anything else."""
    if isinstance(value, (str, Path)):
        return checked_path(name, value)
    from xarray import Dataset  # it is imported already where it is one

    try:
        data: Any = value.to_xarray() if is_result(value) and hasattr(value, "to_xarray") else value
    except ArgumentError as error:
        raise PlotError(f"{name}: {error}") from None
    check_type(name, data, Dataset, A_FILE)
    return data


def _place(at: Mapping[str, float] | None) -> dict[str, float]:
    check_type("at", at, (Mapping, NoneType), "a mapping from names of swept numbers to values, or None")
    result = {}
    for name, value in (at or {}).items():
        check_type("at", name, str, "of names of swept numbers")
        number = number_of(value)
        if number is None or not math.isfinite(number):
            raise PlotError(not_allowed(f"at.{name}", value, "a finite number"))
        result[name] = number
    return result


def _pair(name: str, value: object) -> tuple[float, float] | None:
    values = None if value is None else array_of(value, 1)
    if value is not None and (values is None or values.shape != (2,)):
        raise PlotError(not_allowed(name, value, "two numbers"))
    return None if values is None else (float(values[0]), float(values[1]))


def _width(value: object) -> float:
    width = number_of(value)
    if width is None or not WIDTHS[0] <= width <= WIDTHS[1]:
        allowed = f"a number of mm from {WIDTHS[0]:g} to {WIDTHS[1]:g}, as 85 of one column"
        raise PlotError(not_allowed("width", value, allowed))
    return width


def _text(numbers: tuple[float, float]) -> str:
    return " ".join(f"{number:g}" for number in numbers)
