"""Pictures over two swept parameters: where the motion is periodic, with which period, and where chaotic."""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import BoundaryNorm, ListedColormap, TwoSlopeNorm

from vibro_sweep.plotting.result import Result
from vibro_sweep.plotting.style import DASHES, INK, NOT_COMPUTED, axis_name, edges, exponent

LONGEST = 12  # periods with a colour of their own
# Paired light and dark, so that a period and its double, 1 and 2 or 3 and 6, are told apart at a glance.
_PERIODS = (
    *("#a6cee3", "#1f78b4", "#b2df8a", "#33a02c", "#fb9a99", "#e31a1c"),
    *("#fdbf6f", "#ff7f00", "#cab2d6", "#6a3d9a", "#ffff99", "#b15928"),
)
_NONE, _LONGER = "#26262e", "#8c8c94"


def shows(result: Result) -> bool:
    """A sweep over two keys; lyapunov, section or impacts."""
    return len(result.sweep) == 2 and any(name in result for name in ("lyapunov", "period", "impacts_right"))


def plane(result: Result):
    """lambda_1 and the period over the two parameters, side by side; the impacts where neither is stored.

    Of several starts the one with the largest lambda_1 is shown, point by point; beside it how many attractors they
    reach, where that is stored.
    """
    maps, note = _maps(result)
    maps = maps if result.ax is None else maps[:1]
    fig = result.page(4.2 if len(maps) > 1 else 5.2, result.title("Parameter plane" + note))
    grid = fig.subplots(1, len(maps), sharex=True, sharey=True, squeeze=False)[0]
    (x_key, x), (y_key, y) = result.sweep.items()
    columns, rows = np.argsort(x), np.argsort(y)  # a sweep may run downwards; an axis does not
    for ax, (draw, values) in zip(grid, maps, strict=True):
        draw(ax, edges(x[columns]), edges(y[rows]), np.ma.masked_invalid(values[np.ix_(columns, rows)].T))
        ax.set_xlabel(axis_name(x_key))
        ax.set_facecolor(NOT_COMPUTED)
        _grazing_curve(ax, result)
    grid[0].set_ylabel(axis_name(y_key))
    return fig


def _grazing_curve(ax, result):
    """b* of Theorem 1 where b is one of the axes: above it the mass can swing freely."""
    keys = list(result.sweep)
    if "b" not in keys:
        return
    other = keys[1 - keys.index("b")]
    curve = result.grazing(other)
    if curve is None:
        return
    order = np.argsort(result.sweep[other])
    line = result.sweep[other][order], curve[order]
    frame = ax.get_xlim(), ax.get_ylim()
    for style in ({"color": "white", "lw": 2.2}, {"color": INK, "lw": 1.0, "ls": DASHES, "label": "grazing, $b^*$"}):
        ax.plot(*(line if keys[1] == "b" else line[::-1]), **style)
    ax.set(xlim=frame[0], ylim=frame[1])
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1, borderpad=0.1)


def _maps(result):
    """The maps to draw, each with its values, shape (first key, second key); and which start they show."""
    starts = len(result.starts)
    chosen = np.zeros((*result.done.shape[:-1], 1), int)
    note = f"; first of {starts} starts" if starts > 1 else ""
    maps = []
    if "lyapunov" in result:
        largest = result.array("lyapunov")[..., 0]
        if starts > 1:
            chosen = np.argmax(np.where(np.isnan(largest), -np.inf, largest), axis=-1)[..., None]
            note = f"; of {starts} starts the one with the largest {exponent(1)}"
        maps.append((_exponent, np.take_along_axis(largest, chosen, -1)[..., 0]))
    if "period" in result:
        maps.append((_period, np.take_along_axis(result.array("period"), chosen, -1)[..., 0]))
    if "attractor" in result and starts > 1:
        maps[1:] = [(_number, np.fmax.reduce(result.array("attractor"), axis=-1))]
    if not maps:
        impacts = result.array("impacts_right") + result.array("impacts_left")
        maps.append((_impacts, impacts[..., 0]))
    return maps, note


def _exponent(ax, x, y, values):
    finite = values.compressed()
    low, high = np.quantile(finite, [0.005, 0.995]) if finite.size else (-1.0, 1.0)
    # Each side of zero has a scale of its own: chaos is weak beside the damping of a periodic orbit.
    tiny = 1e-6 * max(abs(low), abs(high), 1e-300)
    norm = TwoSlopeNorm(0, min(low, -tiny), max(high, tiny))
    image = ax.pcolorfast(x, y, values, cmap="RdBu_r", norm=norm)
    bar = _bar(ax, image, exponent(1), extend="both")
    if -low > 1e-3 * high and high > -1e-3 * low:
        bar.set_ticks([*np.linspace(norm.vmin, 0, 3)[:-1], 0, *np.linspace(0, norm.vmax, 3)[1:]])
        bar.ax.xaxis.set_major_formatter(lambda value, _: f"${value:.2g}$")


def _period(ax, x, y, values):
    colours = ListedColormap([_NONE, *_PERIODS, _LONGER])
    norm = BoundaryNorm(np.arange(-0.5, LONGEST + 2), colours.N)
    image = ax.pcolorfast(x, y, np.ma.minimum(values, LONGEST + 1), cmap=colours, norm=norm)
    bar = _bar(ax, image, r"period$\,/\,T$ (0: none found)", ticks=range(LONGEST + 2))
    bar.ax.set_xticklabels([*range(LONGEST + 1), f">{LONGEST}"])
    bar.ax.tick_params(length=0)


def _number(ax, x, y, values):
    most = int(values.max()) if values.count() else 1
    colours = ListedColormap(colormaps["viridis"](np.linspace(0, 1, most + 1)))
    image = ax.pcolorfast(x, y, values, cmap=colours, norm=BoundaryNorm(np.arange(-0.5, most + 1), most + 1))
    _bar(ax, image, "attractors", ticks=range(most + 1))


def _impacts(ax, x, y, values):
    _bar(ax, ax.pcolorfast(x, y, values, cmap="viridis"), "impacts in the recorded periods")


def _bar(ax, image, label, **options):
    return ax.figure.colorbar(image, ax=ax, location="bottom", aspect=30, label=label, **options)
