"""Options of a picture besides its kind."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.checks.real import number_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.plotting.page import Picture, page, style_of
from vibro_sweep.plotting.source import PlotError

if TYPE_CHECKING:
    import xarray

SIZES = (2.0, 100.0)  # inches
WIDTHS = (50.0, 2500.0)  # mm
MM = 25.4  # an inch
RESOLUTIONS = (10, 2400)  # pixels an inch
MOST_PIXELS = 10**8  # of a whole picture: 400 MB while it is drawn


@dataclass(frozen=True)
class PlotOptions:
    """Options of a picture; the kind of picture chooses those that are None.

    at: swept key -> value, where single orbits are drawn; variable: what is drawn; xlim, ylim: ranges of the axes, of
    several panels those of the first and of all that show the same; size: inches; width: mm, the height follows; dpi:
    pixels an inch; windows: the sweep's windows, which are shown below it or on its plane; over: a sweep over which
    branches or curves are drawn; relative: whether charts and planes show b in parts of the grazing
    clearance b*.
    Raises `PlotError` for values that none of the kinds can use.
    """

    at: Mapping[str, float] = field(default_factory=dict)
    variable: str | None = None
    xlim: tuple[float, float] | None = None
    ylim: tuple[float, float] | None = None
    size: tuple[float, float] | None = None
    dpi: float | None = None
    windows: "Path | xarray.Dataset | None" = None
    over: "Path | xarray.Dataset | None" = None
    relative: bool = False
    width: float | None = None

    def __post_init__(self):
        for name, limits in (("xlim", self.xlim), ("ylim", self.ylim)):
            if limits and not (np.isfinite(limits).all() and limits[0] < limits[1]):
                raise PlotError(f"{name}: {_text(limits)} is not allowed; it must be two numbers, the lower one first")
        if self.size and not all(SIZES[0] <= length <= SIZES[1] for length in self.size):
            raise PlotError(
                f"size: {_text(self.size)} is not allowed; width and height must be {SIZES[0]:g} to {SIZES[1]:g} inches"
            )
        if self.width is not None:
            self._check_width()
        if self.dpi is not None and not RESOLUTIONS[0] <= self.dpi <= RESOLUTIONS[1]:
            raise PlotError(f"dpi: {self.dpi:g} is not allowed; it must be {RESOLUTIONS[0]} to {RESOLUTIONS[1]}")

    def _check_width(self) -> None:
        width = number_of(self.width)
        if width is None or not WIDTHS[0] <= width <= WIDTHS[1]:
            allowed = f"a number of mm from {WIDTHS[0]:g} to {WIDTHS[1]:g}, as 85 of one column"
            raise PlotError(not_allowed("width", self.width, allowed))
        if self.size:
            raise PlotError("width and size exclude each other: size is width and height in inches")
        object.__setattr__(self, "width", width)

    @property
    def inches(self) -> float | None:
        """The width that is asked for."""
        return None if self.width is None else self.width / MM

    @property
    def style(self) -> dict:
        """matplotlib's settings for a page of that width."""
        return style_of(self.inches)

    def page(self, height: float, title: str, kind=Picture) -> Picture:
        """An empty figure, of the size and the resolution that are asked for: texts find their places in these."""
        fig = page(height, title, self.size, self.inches, kind)
        if self.dpi:
            fig.set_dpi(self.dpi)
        width, height = fig.get_size_inches() * fig.dpi
        if width * height > MOST_PIXELS:
            pixels = f"{width:.0f} x {height:.0f} pixels"
            raise PlotError(f"size and dpi: {pixels} are not allowed; there may be {MOST_PIXELS:.0e} in all")
        return fig

    def applied(self, fig) -> None:
        """Give a figure that is drawn its limits."""
        panels = [ax for ax in fig.axes if ax.get_label() != "<colorbar>"]
        for ax in panels:
            if self.xlim:
                ax.set_xlim(self.xlim)
            if self.ylim and ax.get_ylabel() == panels[0].get_ylabel():
                ax.set_ylim(self.ylim)


def _text(numbers) -> str:
    return " ".join(f"{number:g}" for number in numbers)
