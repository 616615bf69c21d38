"""Point clouds too thick for points: how many fall into each cell of a fine grid.

A column is one swept value, or a whole number of them where there are more values than pixels: columns
that hold now one value and now two would stripe the picture.
"""

import numpy as np
from matplotlib.colors import LogNorm, to_rgb

from vibro_sweep.plotting.style import density_colours, edges

COLUMNS, ROWS = 1200, 450  # a cell is about a pixel wide and a hair line high


def counts(points, low, high, group) -> np.ndarray:
    """Points in each cell, shape (ROWS, columns), of points (values, ...) between low and high.

    A column holds `group` values, the last one maybe fewer.
    """
    flat = points.reshape(len(points), -1)
    columns = -(-len(flat) // group)
    there = np.isfinite(flat)
    row = ((flat[there] - low) / (high - low) * ROWS).astype(int).clip(0, ROWS - 1)
    column = np.broadcast_to(np.arange(len(flat))[:, None] // group, flat.shape)[there]
    return np.bincount(row * columns + column, minlength=ROWS * columns).reshape(ROWS, columns)


def one(ax, values, points):
    """The density of points (values, ...) on a logarithmic colour scale, white where there are none."""
    x, y, group = _grid(ax, values)
    cells = counts(points, y[0], y[-1], group)
    filled = np.ma.masked_equal(cells, 0)
    norm = LogNorm(1, max(filled.max(), 2))
    image = ax.pcolorfast(x, y, filled, cmap=density_colours(), norm=norm, zorder=0.5)
    bar = ax.figure.colorbar(image, cax=ax.inset_axes([1.012, 0, 0.016, 1]))
    bar.set_label("points per cell", fontsize=9)


def two(ax, values, points, colours):
    """Two densities, points (values, 2, ...), printed over each other in two colours: dark where both are."""
    x, y, group = _grid(ax, values)
    paper = np.ones((ROWS, len(x) - 1, 3))
    for i, colour in enumerate(colours):
        cells = counts(points[:, i], y[0], y[-1], group)
        thick = np.log1p(cells) / np.log1p(max(cells.max(), 1))
        ink = np.where(cells > 0, 0.55 + 0.45 * thick, 0)
        paper *= 1 - ink[:, :, None] * (1 - np.array(to_rgb(colour)))
    ax.pcolorfast(x, y, paper, zorder=0.5)


def _grid(ax, values):
    group = -(-len(values) // COLUMNS)
    borders = edges(values)
    x = np.append(borders[:-1:group], borders[-1])
    low, high = ax.get_ylim()
    return x, np.linspace(low, high, ROWS + 1), group
