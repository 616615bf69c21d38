"""`vibro_sweep.plot`: a picture for a notebook."""

import math
from collections.abc import Mapping
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, overload

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibro_sweep.model.arguments import check_type
from vibro_sweep.model.files import checked_path
from vibro_sweep.model.real import number_of
from vibro_sweep.model.refusals import not_allowed
from vibro_sweep.plotting import Look, PlotError, figure

if TYPE_CHECKING:
    import xarray


@overload
def plot(
    data: "str | Path | xarray.Dataset",
    kind: str | None = None,
    ax: None = None,
    at: dict[str, float] | None = None,
    variable: str | None = None,
    width: float | None = None,
) -> Figure: ...


@overload
def plot(
    data: "str | Path | xarray.Dataset",
    kind: str | None = None,
    ax: Axes = ...,
    at: dict[str, float] | None = None,
    variable: str | None = None,
    width: float | None = None,
) -> Figure | None: ...


def plot(
    data: "str | Path | xarray.Dataset",
    kind: str | None = None,
    ax: Axes | None = None,
    at: dict[str, float] | None = None,
    variable: str | None = None,
    width: float | None = None,
) -> Figure | None:
    """A picture of a file, or of a Dataset of `vibro_sweep.open` or `vibro_sweep.sweep`; a matplotlib Figure.

    A notebook shows it as the value of a cell. In axes of pyplot, which shows them itself, it is not returned too.

    kind : what the command line calls --kind, by default the first that the data can show
    ax : axes to draw into, by default those of a new Figure. Of a bifurcation diagram or a plane they show the first
        panel; other kinds must have one, which `at` chooses where each orbit has its own
    at : where single orbits are drawn, as {"b": 6.6}: the nearest point; by default some, evenly spread
    variable : what is drawn, of what that kind can show, as "v1"
    width : mm, as 85 for one column of a journal, with type of 8 points; by default 178

    Raises `PlotError` where the data cannot be read or cannot show that kind; it says which can be shown.
    """
    if isinstance(data, (str, Path)):
        data = checked_path("data", data)
    else:
        from xarray import Dataset  # it is imported already where it is one

        check_type("data", data, Dataset, "the path of a file, or a Dataset")
    check_type("kind", kind, (str, NoneType), "the name of a kind of picture, or None")
    check_type("variable", variable, (str, NoneType), "the name of a variable, or None")
    check_type("at", at, (Mapping, NoneType), "a mapping from names of swept numbers to values, or None")
    chosen = {}
    for name, value in (at or {}).items():
        check_type("at", name, str, "of names of swept numbers")
        chosen[name] = number_of(value)
        if chosen[name] is None or not math.isfinite(chosen[name]):
            raise PlotError(not_allowed(f"at.{name}", value, "a finite number"))
    drawn = figure(data, kind, Look(chosen, variable, width=width), ax)
    return None if ax is not None and drawn.canvas.manager is not None else drawn
