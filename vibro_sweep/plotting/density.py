"""Point clouds too thick for points: how many fall into each cell of a fine grid, and periodic orbits as lines.

A column is one swept value, or a whole number of them where there are more values than pixels: columns
that hold now one value and now two would stripe the picture.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.ticker import LogFormatter

from vibro_sweep.plotting.style import INK, density_colours, edges, type_size

COLUMNS, ROWS = 1200, 450  # a cell is about a pixel wide and a hair line high
BLOCK = 2**20  # points counted at a time, which stay in the cache
REACH = 0.03  # of the extent: a branch that moves further from one column to the next ends, and another begins
_LINE = {"lw": 0.8, "rasterized": True, "zorder": 0.6, "gid": "periodic"}


class Cloud(NamedTuple):
    """Section points (values, starts, samples) over rising values (n,), NaN where there are none.

    repeats : (values, starts), the points after which those of a periodic orbit repeat; 0 where they do not
    extent : of all points, also beyond the limits of the picture
    """

    values: np.ndarray
    points: np.ndarray
    repeats: np.ndarray
    extent: float


def counts(points, low, high, group, counted=None) -> np.ndarray:
    """Points in each cell, shape (ROWS, columns), of points (values, ...) between low and high.

    A column holds `group` values, the last one maybe fewer. counted : (values, starts) of points (values, starts,
    samples), where they are counted; by default everywhere.
    """
    columns = -(-len(points) // group)
    cells = np.zeros((ROWS, columns), int)
    step = max(1, BLOCK // (group * points[0].size))
    for first in range(0, columns, step):
        rows = slice(first * group, (first + step) * group)
        height = (points[rows] - low) * (ROWS / (high - low))
        inside = (height >= 0) & (height <= ROWS)
        if counted is not None:
            inside &= counted[rows, :, None]
        column = np.arange(len(height), dtype=np.int32) // group
        column = np.broadcast_to(column.reshape(-1, *[1] * (points.ndim - 1)), height.shape)[inside]
        row = np.minimum(height[inside].astype(np.int32), ROWS - 1)
        width = min(step, columns - first)
        hits = np.bincount(column * ROWS + row, minlength=ROWS * width)
        cells[:, first : first + width] = hits.reshape(width, ROWS).T
    return cells


def of_all(ax, cloud: Cloud):
    """The density on a logarithmic colour scale, white where there are no points; periodic orbits as lines."""
    x, y, group = _grid(ax, cloud.values)
    lines = _repeated(cloud.repeats, group)
    cells = counts(cloud.points, y[0], y[-1], group, ~_spread(lines > 0, group, len(cloud.values)))
    drawn = [curve for start in range(lines.shape[1]) for curve in _curves(cloud, start, lines[:, start], x, group)]
    filled = np.ma.masked_equal(cells, 0)
    most = max([filled.max() if filled.count() else 2, 2, *(group * curve.visits for curve in drawn)])
    norm, colours = LogNorm(1, most), density_colours()
    image = ax.pcolorfast(x, y, filled, cmap=colours, norm=norm, zorder=0.5)
    for curve in drawn:
        ax.plot(curve.x, curve.y, color=colours(norm(group * curve.visits)), **_LINE)
    bar = ax.figure.colorbar(image, cax=ax.inset_axes([1.012, 0, 0.016, 1]), format=LogFormatter())
    bar.set_label("section points per cell", fontsize=type_size(9))


def two(ax, cloud: Cloud, colours):
    """Two starts printed over each other in two colours: dark where both are. Periodic orbits as lines."""
    x, y, group = _grid(ax, cloud.values)
    lines = _repeated(cloud.repeats, group)
    counted = ~_spread(lines > 0, group, len(cloud.values))
    paper = np.ones((ROWS, len(x) - 1, 3))
    for i, colour in enumerate(colours):
        cells = counts(cloud.points[:, i : i + 1], y[0], y[-1], group, counted[:, i : i + 1])
        thick = np.log1p(cells) / np.log1p(max(cells.max(), 1))
        ink = np.where(cells > 0, 0.55 + 0.45 * thick, 0)
        paper *= 1 - ink[:, :, None] * (1 - np.array(to_rgb(colour)))
    ax.pcolorfast(x, y, paper, zorder=0.5)
    same = _same_orbit(cloud, lines, group, (y[-1] - y[0]) / ROWS)
    for start, where, colour in ((0, ~same, colours[0]), (1, ~same, colours[1]), (0, same, INK)):
        for curve in _curves(cloud, start, np.where(where, lines[:, start], 0), x, group):
            ax.plot(curve.x, curve.y, color=colour, **_LINE)


class _Curve(NamedTuple):
    """Orbits that repeat after equally many points: lines with NaN between them, and the visits to each point."""

    x: np.ndarray
    y: np.ndarray
    visits: float


def _grid(ax, values):
    group = -(-len(values) // COLUMNS)
    borders = edges(values)
    x = np.append(borders[:-1:group], borders[-1])
    low, high = ax.get_ylim()
    return x, np.linspace(low, high, ROWS + 1), group


def _repeated(repeats, group) -> np.ndarray:
    """The number of points, (columns, starts), after which all orbits of a column repeat; 0 where they differ."""
    missing = -len(repeats) % group
    columns = np.pad(repeats, ((0, missing), (0, 0)), mode="edge").reshape(-1, group, repeats.shape[1])
    return np.where((columns == columns[:, :1]).all(axis=1), columns[:, 0], 0)


def _spread(columns, group, n) -> np.ndarray:
    """What holds for columns, for each of the n values in them."""
    return np.repeat(columns, group, axis=0)[:n]


def _curves(cloud: Cloud, start: int, repeats, borders, group) -> Iterator[_Curve]:
    """The periodic orbits of a start. repeats : (columns,), 0 where no line is to be drawn.

    From column to column points are joined in their order, which is the least displacement in all.
    """
    middle = np.minimum(np.arange(len(repeats)) * group + group // 2, len(cloud.values) - 1)
    for n in np.unique(repeats[repeats > 0]):
        columns = np.flatnonzero(repeats == n)
        points, known = _orbit(cloud, middle[columns], start, n)
        joined = (np.diff(columns) == 1) & (np.abs(np.diff(points, axis=0)).max(axis=1) <= REACH * cloud.extent)
        before, after = np.append(False, joined), np.append(joined, False)
        left, right = borders[columns], borders[columns + 1]
        # a window's first and last orbit reach to the borders of their columns
        x = np.stack([left, (left + right) / 2, right, np.full(len(columns), np.nan)], axis=1)
        keep = np.stack([~before, np.ones(len(columns), bool), ~after, ~after], axis=1)
        y = np.repeat(points.T[:, :, None], 4, axis=2)
        yield _Curve(np.tile(x[keep], n), y[:, keep].ravel(), known / n)


def _orbit(cloud: Cloud, rows, start, n) -> tuple[np.ndarray, float]:
    """The last n points of orbits, (rows, n), in rising order; and how many points such an orbit has in the file."""
    points = cloud.points[rows, start]
    known = np.isfinite(points).sum(axis=1)
    last = (known - n)[:, None] + np.arange(n)
    return np.sort(np.take_along_axis(points, last, axis=1), axis=1), float(np.median(known))


def _same_orbit(cloud: Cloud, lines, group, tolerance) -> np.ndarray:
    """The columns in which both starts end on one periodic orbit."""
    same = (lines[:, 0] == lines[:, 1]) & (lines[:, 0] > 0)
    for n in np.unique(lines[same, 0]):
        columns = np.flatnonzero(same & (lines[:, 0] == n))
        rows = np.minimum(columns * group + group // 2, len(cloud.values) - 1)
        (up, _), (down, _) = (_orbit(cloud, rows, start, n) for start in (0, 1))
        same[columns] = np.abs(up - down).max(axis=1) <= tolerance
    return same
