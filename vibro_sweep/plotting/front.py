"""`vibro_sweep.plot`: a picture for a notebook."""

from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibro_sweep.plotting import Look, figure

if TYPE_CHECKING:
    import xarray


def plot(
    data: "str | Path | xarray.Dataset",
    kind: str | None = None,
    ax: Axes | None = None,
    at: dict[str, float] | None = None,
    variable: str | None = None,
) -> Figure:
    """A picture of a file, or of a Dataset of `vibro_sweep.open` or `vibro_sweep.sweep`; a matplotlib Figure.

    kind : what the command line calls --kind, by default the first that the data can show
    ax : axes to draw into, by default those of a new Figure. Of a bifurcation diagram or a plane they show the first
        panel; other kinds must have one, which `at` chooses where each orbit has its own
    at : where single orbits are drawn, as {"b": 6.6}: the nearest point; by default some, evenly spread
    variable : what is drawn, of what that kind can show, as "v1"

    Raises `PlotError` where the data cannot be read or cannot show that kind; it says which can be shown.
    """
    return figure(data, kind, Look(at or {}, variable), ax)
