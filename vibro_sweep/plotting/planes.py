"""Pictures over two swept parameters: where the motion is periodic, with which period, and where chaotic."""

import numpy as np
from matplotlib import colormaps, patheffects
from matplotlib.colors import BoundaryNorm, CenteredNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from vibro_sweep.model.observables import VARIABLES
from vibro_sweep.plotting import strip
from vibro_sweep.plotting.relative import axis_label, check_relative
from vibro_sweep.plotting.result import PlotError, Result
from vibro_sweep.plotting.style import (
    DASHES,
    DIVERGING,
    FAINT,
    INK,
    LONGER,
    LONGEST,
    NEUTRAL,
    NO_PERIOD,
    NOT_COMPUTED,
    PER_TIME,
    PERIODS,
    edges,
    exponent,
    grazing_of,
)

_OF_A_POINT = {one.name: one.label for one in VARIABLES if not one.dimensions}

CURVES = {"b_star": DASHES, "b_right": DASHES, "b_left": ":"}
ROOM = 4.5  # points (1/72 inch) around a period that is written into the plane
LETTERS = 140  # in a line of the legend
COARSE = 400  # cells a side among which places for the periods are sought


def shows(result: Result) -> bool:
    """A sweep over two keys; lyapunov, section or impacts."""
    return len(result.sweep) == 2 and any(name in result for name in ("lyapunov", "period", "impacts_right"))


def variables(result: Result) -> tuple[str, ...]:
    """Variables of the file that are one number a point."""
    return tuple(name for name in ("lyapunov", *_OF_A_POINT) if name in result)


def plane(result: Result, overlay=None, more=()):
    """lambda_1 and the period over the two parameters, side by side; the impacts where neither is stored.

    Of several starts the one with the largest lambda_1 is shown, point by point; beside it how many attractors they
    reach, where that is stored. A variable that is chosen is shown alone. Raises PlotError where the look wants b in
    parts of b*, and b* is not known.

    overlay(ax) draws on each panel, `more` are its handles for the legend.
    """
    maps, note = _maps(result)
    maps = maps if result.ax is None else maps[:1]
    of_states = all(key.startswith("start_") for key in result.sweep)
    what = "Plane of initial states" if of_states else "Parameter plane"
    fig = result.page(4.4 if len(maps) > 1 else 5.4, result.title(what + note))
    grid = fig.subplots(1, len(maps), sharex=True, sharey=True, squeeze=False)[0]
    (x_key, x), (y_key, y) = result.sweep.items()
    columns, rows = np.argsort(x), np.argsort(y)  # a sweep may run downwards; an axis does not
    relative = result.look.relative
    corners = (edges(x[columns]), edges(y[rows])) if not relative else _relative_corners(result, columns, rows)
    for ax, (draw, values) in zip(grid, maps, strict=True):
        draw(ax, *corners, np.ma.masked_invalid(values[np.ix_(columns, rows)].T))
        ax.set_xlabel(axis_label(x_key, relative))
        ax.patch.set(facecolor=NOT_COMPUTED, edgecolor=FAINT, hatch="///")
        _grazing_curve(ax, result)
        if result.look.windows is not None:
            strip.ends_over(ax, result)
        if overlay is not None:
            overlay(ax)
    grid[0].set_ylabel(axis_label(y_key, relative))
    shown = [line for line in grid[0].lines if line.get_gid() == "window end"]
    if "lyapunov_error" in result and any(draw is _exponent and (values == 0).any() for draw, values in maps):
        errors = f"{result.significant:.2g} standard errors"
        shown.append(Patch(facecolor=NEUTRAL, edgecolor=FAINT, label=f"{exponent(1)} within {errors} of 0"))
    _legend(fig, grid, any(np.isnan(values).any() for _, values in maps), [*shown, *more])
    return fig


def _relative_corners(result, columns, rows) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the cells, each (rows + 1, columns + 1), with b in parts of b*. Raises PlotError."""
    (x_key, x), (y_key, y) = result.sweep.items()
    other, order = (x_key, columns) if y_key == "b" else (y_key, rows)
    b_star = result.grazing(other).get("b_star")
    check_relative(str(result.path), result.sweep, b_star)
    if result.look.windows is not None:
        raise PlotError("relative: ends of windows have b itself as their axis; leave out `relative` or `windows`")
    X, Y = np.meshgrid(edges(x[columns]), edges(y[rows]))
    star = edges(b_star[order])
    return (X, Y / star) if y_key == "b" else (X / star[:, None], Y)


def _grazing_curve(ax, result):
    """b* of Theorem 1 where b is one of the axes, or that of each stop: above it the mass can swing freely."""
    keys = list(result.sweep)
    if "b" not in keys:
        return
    other = keys[1 - keys.index("b")]
    order = np.argsort(result.sweep[other])
    frame = ax.get_xlim(), ax.get_ylim()
    for name, curve in result.grazing(other).items():
        line = result.sweep[other][order], np.ones(len(order)) if result.look.relative else curve[order]
        for style in ({"color": "white", "lw": 2.2}, {"color": INK, "lw": 1.0, "ls": CURVES[name], "gid": "grazing"}):
            ax.plot(*(line if keys[1] == "b" else line[::-1]), label=grazing_of(name), **style)
    ax.set(xlim=frame[0], ylim=frame[1])


def _legend(fig, grid, gaps, more):
    handles = list(more)
    curves = {line.get_label(): line.get_linestyle() for line in grid[0].lines if line.get_gid() == "grazing"}
    handles += [Line2D([], [], color=INK, lw=1.0, ls=style, label=label) for label, style in curves.items()]
    if gaps:
        handles.append(Patch(facecolor=NOT_COMPUTED, edgecolor=FAINT, hatch="////", label="no number"))
    if handles:
        columns = min(4 if more else 3, len(handles))
        while columns > 1 and sum(sorted(len(handle.get_label()) for handle in handles)[-columns:]) > LETTERS:
            columns -= 1
        fig.legend(handles=handles, loc="outside lower center", ncols=columns)


def _maps(result):
    """The maps to draw, each with its values, shape (first key, second key); and which start they show."""
    starts = len(result.starts)
    chosen = np.zeros((*result.done.shape[:-1], 1), int)
    note = f"; first of {starts} starts" if starts > 1 else ""
    largest = result.largest_exponent() if "lyapunov" in result else None
    if largest is not None and starts > 1:
        chosen = np.argmax(np.where(np.isnan(largest), -np.inf, largest), axis=-1)[..., None]
        note = f"; of {starts} starts the one with the largest {exponent(1)}"

    def shown(values):
        return np.take_along_axis(values, chosen, -1)[..., 0] if starts > 1 else values[..., 0]

    if variable := result.look.variable:
        if variable == "lyapunov":
            return [(_exponent, shown(largest))], note
        draw = {"period": _period, "attractor": _number}.get(variable, _amount(_OF_A_POINT[variable]))
        return [(draw, shown(result.array(variable)))], note
    maps = [] if largest is None else [(_exponent, shown(largest))]
    if "attractor" in result and starts > 1:
        maps.append((_number, np.fmax.reduce(result.array("attractor"), axis=-1)))
    elif "period" in result:
        maps.append((_period, shown(result.array("period"))))
    if not maps:
        impacts = result.array("impacts_right") + result.array("impacts_left")
        maps.append((_amount("impacts in the recorded periods"), impacts[..., 0]))
    return maps, note


def _exponent(ax, x, y, values):
    """One unit on both sides of zero; 0 has the neutral colour, and no other value has."""
    finite = np.abs(values[values != 0].compressed())
    norm = CenteredNorm(0, max(np.quantile(finite, 0.995), 1e-300) if finite.size else 1.0)
    least = 1.01 * norm.halfrange / DIVERGING.N
    tinted = np.ma.where(values == 0, 0.0, np.copysign(np.maximum(np.abs(values), least), values))
    image = _image(ax, x, y, tinted, cmap=DIVERGING, norm=norm)
    _bar(ax, image, f"{exponent(1)} {PER_TIME}; > 0: chaos", extend="both")


def _period(ax, x, y, values):
    colours = ListedColormap([NO_PERIOD, *PERIODS, LONGER])
    norm = BoundaryNorm(np.arange(-0.5, LONGEST + 2), colours.N)
    image = _image(ax, x, y, np.ma.minimum(values, LONGEST + 1), cmap=colours, norm=norm)
    bar = _bar(ax, image, "period in $T$; 0: none found", ticks=range(LONGEST + 2))
    bar.ax.set_xticklabels([*range(LONGEST + 1), f">{LONGEST}"])
    bar.ax.tick_params(length=0)
    _name_regions(ax, x, y, values)


def _name_regions(ax, x, y, values):
    """The period, written where there is room for it: into the widest place of its regions."""
    from scipy import ndimage  # slow to import

    steps = [max(1, length // COARSE) for length in values.shape]
    part = values.filled(-1)[:: steps[0], :: steps[1]].astype(int)
    width, height = 72 * ax.get_window_extent().size / ax.figure.dpi  # in points, before the layout
    inside = np.zeros(part.shape, bool)  # not beside another period, nor at the frame
    inner = part[1:-1, 1:-1]
    inside[1:-1, 1:-1] = np.logical_and.reduce(
        [inner == side for side in (part[2:, 1:-1], part[:-2, 1:-1], part[1:-1, 2:], part[1:-1, :-2])]
    )
    sampling = height / part.shape[0], width / part.shape[1]
    room = ndimage.distance_transform_edt(inside, sampling=sampling)
    periods = np.unique(part[part > 0])
    X, Y = np.meshgrid(x, y) if x.ndim == 1 else (x, y)
    for period, (row, column) in zip(periods, ndimage.maximum_position(room, part, periods), strict=True):
        if room[row, column] > ROOM:
            cell = slice(row * steps[0], row * steps[0] + 2), slice(column * steps[1], column * steps[1] + 2)
            at = X[cell].mean(), Y[cell].mean()
            halo = [patheffects.withStroke(linewidth=2, foreground="white")]
            style = {"fontsize": 7, "ha": "center", "va": "center", "path_effects": halo, "color": INK}
            ax.text(*at, f"{period}", **style, clip_on=True, gid="period")


def _number(ax, x, y, values):
    most = int(values.max()) if values.count() else 1
    colours = ListedColormap(colormaps["viridis"](np.linspace(0, 1, most + 1)))
    image = _image(ax, x, y, values, cmap=colours, norm=BoundaryNorm(np.arange(-0.5, most + 1), most + 1))
    _bar(ax, image, "attractors", ticks=MaxNLocator(12, integer=True))


def _amount(label):
    """Draws values on an even scale."""

    def draw(ax, x, y, values):
        _bar(ax, _image(ax, x, y, values, cmap="viridis"), label)

    return draw


def _image(ax, x, y, values, **style):
    """The cells between these corners, as pixels also in a file of lines."""
    image = ax.pcolorfast(x, y, values, **style)
    image.set_rasterized(True)
    return image


def _bar(ax, image, label, **options):
    return ax.figure.colorbar(image, ax=ax, location="bottom", aspect=30, label=label, **options)
