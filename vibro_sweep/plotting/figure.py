"""The figure of a picture, which notebooks show, as wide as a page or as one of its columns; and what it is made of.

On a narrow page all type has one size that is still read, the title has more lines, and panels that stand side by side
elsewhere stand below each other.
"""

import io
import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from vibro_sweep.plotting.style import STYLE, TYPE

WIDTH = 7.0  # inches: a page's text width
NARROW = 4.7  # inches: two panels side by side need more
LEAST_HEIGHT = 0.6  # of that on a wide page: a narrow one is lower, but not as much as it is narrower
STACKED = 1.25  # so much higher is one with several panels: names of axes stand beside low ones
ON_SCREEN = 110  # pixels an inch in a notebook
EDGE = 0.97  # of the width of a narrow page may be filled by a title
SMALL = dict.fromkeys(
    (
        *("font.size", "axes.titlesize", "axes.labelsize", "xtick.labelsize", "ytick.labelsize"),
        *("legend.fontsize", "legend.title_fontsize", "figure.titlesize"),
    ),
    TYPE,
)


def style_of(width: float | None) -> dict:
    """matplotlib's settings for a page so many inches wide."""
    return STYLE | SMALL if width is not None and width < NARROW else STYLE


class Picture(Figure):
    """A figure that a notebook shows as the value of a cell, once: pyplot does not know it, and need not be loaded."""

    being_drawn = False  # after that it is the caller's, as are its axes
    grows = True  # whether its height is ours to choose
    narrow = False  # whether it was asked for by a width at which panels do not stand side by side

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        """The picture as IPython asks for it, and the number of pixels of the screen that it takes."""
        content = io.BytesIO()
        with matplotlib.rc_context(STYLE):
            self.savefig(content, format="png", dpi=self.dpi)
        width, height = self.get_size_inches() * ON_SCREEN
        return content.getvalue(), {"width": round(width), "height": round(height)}

    def subplots(self, nrows: int = 1, ncols: int = 1, *, squeeze: bool = True, **options):
        """The subplots as of any figure; on a narrow page all in one column, the rows of each column one after the
        other where these share their ordinates, else row after row."""
        if self.narrow and self.grows:
            self.set_figheight(self.get_figheight() * ncols * (STACKED if nrows > 1 else 1))
        if not (self.narrow and ncols > 1):
            return super().subplots(nrows, ncols, squeeze=squeeze, **options)
        by_column, ratios = options.get("sharey") == "row", options.pop("height_ratios", None)
        options.pop("width_ratios", None)
        if by_column:
            options["sharey"] = False
        if ratios is not None:
            options["height_ratios"] = [*ratios] * ncols if by_column else np.repeat(ratios, ncols)
        grid = super().subplots(nrows * ncols, 1, squeeze=False, **options)[:, 0]
        grid = grid.reshape(ncols, nrows).T if by_column else grid.reshape(nrows, ncols)
        for row in grid if by_column else ():
            for ax in row[1:]:
                ax.sharey(row[0])
        return np.squeeze(grid) if squeeze else grid

    def entitle(self, title: str) -> None:
        """The title above all panels, in as many lines as it takes."""
        if self.narrow:
            title = "\n".join(line for whole in title.split("\n") for line in self._wrapped(whole))
        self.suptitle(title)

    def _wrapped(self, line: str) -> list[str]:
        """The text in lines as wide as the page, broken behind commas and semicolons, else between words."""
        lines = [""]
        for part in re.split(r"(?<=[,;]) (?=\S)", line):
            for piece in [part] if self._fits(part) else part.split(" "):
                longer = f"{lines[-1]} {piece}".strip()
                if lines[-1] and not self._fits(longer):
                    lines.append(piece)
                else:
                    lines[-1] = longer
        return lines

    def _fits(self, line: str) -> bool:
        text = self.text(0, 0, line, size=matplotlib.rcParams["figure.titlesize"])
        try:
            return text.get_window_extent().width <= EDGE * self.bbox.width
        finally:
            text.remove()


class Panels(NamedTuple):
    """What a picture is made of.

    height : of a figure of it, in inches; draw : draws into its axes, (rows, columns); grid : more options of
    `subplots`; alone : whether it may be drawn into the first of its axes only; figure : a kind of figure that `draw`
    gets in place of axes; measurable : numbers of axes in which measured points may lie
    """

    title: str
    height: float
    draw: Callable[[Any], None]
    rows: int = 1
    columns: int = 1
    grid: Mapping[str, Any] = MappingProxyType({})
    alone: bool = False
    figure: type[Picture] | None = None
    measurable: tuple[str, ...] = ()


def page(
    height: float, title: str, size: tuple[float, float] | None = None, width: float | None = None, kind=Picture
) -> Picture:
    """An empty figure of the page's width, or so many inches wide; of this size, where one is given. It needs no
    display."""
    lower = 1.0 if width is None else max(LEAST_HEIGHT, min(1.0, width / WIDTH))
    fig = kind(figsize=size or (width or WIDTH, lower * height), layout="constrained")
    fig.grows, fig.narrow = size is None, width is not None and width < NARROW
    fig.entitle(title)
    return fig
