"""Where a mass rests on a stop: in planes, over a parameter, and along a motion."""

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Patch

from vibro_sweep.plotting.spectrum_panel import spans
from vibro_sweep.plotting.style import SPECIAL
from vibro_sweep.results.motion import Motion

COLOUR, TINT = SPECIAL["sticking"][3], "#d3e6cf"
NAME, NOUN = "rests on a stop for a part of the time", "a rest on a stop"


def cells(ax, result, columns, rows, corners) -> None:
    """Mark the cells of a plane at which an orbit rests on a stop for a part of the time.

    columns, rows : the order of the values; corners : of the cells, (columns + 1,) and (rows + 1,), or both
    (rows + 1, columns + 1)
    """
    if "sticking_time" not in result:
        return
    resting = (result.array("sticking_time") > 0).any(axis=-1)[np.ix_(columns, rows)].T
    if not resting.any():
        return
    X, Y = np.meshgrid(*corners) if corners[0].ndim == 1 else corners
    upright = [(slice(i, i + 2), j + 1) for i, j in np.argwhere(resting[:, 1:] != resting[:, :-1])]
    level = [(i + 1, slice(j, j + 2)) for i, j in np.argwhere(resting[1:] != resting[:-1])]
    lines = [np.column_stack([X[at], Y[at]]) for at in (*upright, *level)]
    for colour, width in (("white", 2.0), (COLOUR, 1.0)):
        style = {"colors": colour, "linewidths": width, "capstyle": "projecting", "gid": "rest"}
        ax.add_collection(LineCollection(lines, **style), autolim=False)
    bars = []
    for i, row in enumerate(resting):
        for first, end in np.diff(row, prepend=False, append=False).nonzero()[0].reshape(-1, 2):
            low, high = (np.column_stack([X[at, first : end + 1], Y[at, first : end + 1]]) for at in (i, i + 1))
            bars.append(np.concatenate([low, high[::-1]]))
    ax.add_collection(PolyCollection(bars, **_HATCHED, gid="rest"), autolim=False)


def patch() -> Patch:
    """The patch of marked cells for a legend."""
    return Patch(**_HATCHED | {"linewidth": 1.0}, label=NAME)


_HATCHED = {"facecolor": "none", "edgecolor": COLOUR, "linewidth": 0, "hatch": ".."}


def tint(ax, result, values, order) -> None:
    """Mark the values of a sweep at which an orbit rests on a stop for a part of the time."""
    if "sticking_time" in result:
        resting = (result.array("sticking_time")[order] > 0).any(axis=1)
        spans(ax, values, resting, color=TINT, gid="rest")


def along(ax, motion: Motion, x: str, y: str) -> None:
    """Mark the rests of a motion in the plane of two of its numbers, or over its time "t"."""
    resting = motion.rests
    if resting.any():
        values = [np.where(resting, motion[name], np.nan) for name in (x, y)]
        style = {"marker": "o", "ms": 6, "mew": 0} if y in ("v1", "gap_velocity") else {}
        ax.plot(*values, color=COLOUR, lw=2.4, zorder=2.2, solid_capstyle="butt", label=NOUN, gid="rest", **style)


def handle() -> Patch:
    """The handle of the tint for a legend."""
    return Patch(color=TINT, label=NAME)
