"""The caller's axes in place of a page."""

import numpy as np
from matplotlib.axes import Axes

from vibro_sweep.plotting.source import PlotError


class Panel:
    """The part of the interface of a page that drawing functions use, for a picture of one panel, which these axes
    hold."""

    def __init__(self, ax: Axes, title: str):
        self.ax, self.axes = ax, [ax]
        ax.set_title(title, pad=16)  # above the legend, if that is above the axes

    def subplots(self, rows: int = 1, columns: int = 1, squeeze: bool = True, **_) -> Axes | np.ndarray:
        """The axes, or an array of them (1, 1). Raises PlotError where they are not enough."""
        if rows * columns > 1:
            raise PlotError(
                f"ax: the picture has {rows * columns} panels; leave ax out, choose one orbit by at, or another kind"
            )
        return self.ax if squeeze else np.array([[self.ax]])

    def legend(self, *handles, **options) -> None:
        """Draw the legend inside the axes, since the figure around them is not ours. One that the axes have stays."""
        if old := self.ax.get_legend():
            self.ax.add_artist(old)
        self.ax.legend(*handles, **options | {"loc": "best", "ncols": 1, "frameon": True})

    def align_ylabels(self, _) -> None:
        """Do nothing: there is one label."""
