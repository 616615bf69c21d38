"""Pictures over two swept parameters: where the motion is periodic, with which period, and where chaotic."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import BoundaryNorm, CenteredNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from vibro_sweep.plotting import scales, sticking_marks, window_strip
from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.labels import arrange, legend_below, thin_ticks
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.plotting.regions import name_regions
from vibro_sweep.plotting.relative import axis_label, check_relative
from vibro_sweep.plotting.scales import along_axis, in_proportion
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
    PERIODS,
    edges,
    exponent,
    exponents_name,
    grazing_of,
)
from vibro_sweep.tables.observables import VARIABLES

_OF_A_POINT = {row.name: row.label for row in VARIABLES if not row.dimensions}

QUIET, UNSETTLED = "#ffffff", "#ffd166"
FEW = 40  # columns of a plane, at which curves have dots
CURVES = {"b_star": DASHES, "b_right": DASHES, "b_left": ":"}


class Overlay(NamedTuple):
    """An overlay of a plane: `draw(ax)`; `handles(ax)` for the legend; and `name(ax)`, which writes its names when the
    axes have their places, and returns the boxes (2, 2), in pixels, in which they stand."""

    draw: Callable
    handles: Callable
    name: Callable


def shows(result: DrawnSweep) -> bool:
    """A sweep over two keys; lyapunov, section, impacts or energy."""
    shown = ("lyapunov", "period", "impacts_right", "impact_power")
    return len(result.sweep) == 2 and any(name in result for name in shown)


def variables(result: DrawnSweep) -> tuple[str, ...]:
    """Variables of the file that are one number a point."""
    return tuple(name for name in ("lyapunov", *_OF_A_POINT) if name in result)


@picture(shows, variables, relative=True)
def plane(result: DrawnSweep, overlay: Overlay | None = None) -> Panels:
    """lambda_1 and the period over the two parameters, side by side; where neither is stored the impacts, or their
    power.

    Of several starts the one with the largest lambda_1 is shown, point by point; beside it how many attractors they
    reach, where that is stored. A variable that is chosen is shown alone. Raises PlotError where the options ask for b
    in parts of b*, and b* is not known.

    overlay : drawn on each panel
    """
    maps, note = _maps(result)
    of_states = all(key.startswith("start_") for key in result.sweep)
    subject = "Plane of initial states" if of_states else "Parameter plane"
    return Panels(
        result.title(subject + note), 4.4 if len(maps) > 1 else 5.4, lambda axes: _draw(axes[0], result, maps, overlay),
        columns=len(maps), grid={"sharex": True, "sharey": True}, alone=True,
    )  # fmt: skip


def _draw(grid, result, maps, overlay) -> None:
    """Draw the maps; into axes of the caller's the first of them."""
    maps = maps[: len(grid)]
    (x_key, x), (y_key, y) = result.sweep.items()
    relative = result.options.relative
    scales = ["log" if in_proportion(np.sort(values)) and not relative else "linear" for values in (x, y)]
    if relative:
        columns, rows = np.argsort(x), np.argsort(y)
        corners = _relative_corners(result, columns, rows)
    else:
        (columns, across), (rows, up) = _in_range(x, result.options.xlim), _in_range(y, result.options.ylim)
        corners = (across, up) if scales == ["linear", "linear"] else np.meshgrid(across, up)
    unit = result.unit(result.options.variable or "lyapunov")
    shown = [np.ma.masked_invalid(values[np.ix_(columns, rows)].T) for _, values in maps]
    others = [(text, colour, mask[np.ix_(columns, rows)].T) for text, colour, mask in _not_periodic(result)]
    for ax, (draw, _), values in zip(grid, maps, shown, strict=True):
        draw(ax, *corners, values, unit)
        for _, colour, mask in others:
            if draw is not _period or not mask.any():
                continue
            _image(ax, *corners, np.ma.masked_where(~mask, mask), cmap=ListedColormap([colour]))
        ax.set(xscale=scales[0], yscale=scales[1])
        if ax.get_subplotspec().is_last_row():
            ax.set_xlabel(axis_label(x_key, relative, result.unit(x_key)))
        if ax.get_subplotspec().is_first_col():
            ax.set_ylabel(axis_label(y_key, relative, result.unit(y_key)))
        ax.patch.set(facecolor=NOT_COMPUTED, edgecolor=FAINT, hatch="///")
        ax.set(xlim=result.options.xlim or ax.get_xlim(), ylim=result.options.ylim or ax.get_ylim())
        result.measured_in(ax, x_key, y_key)
        sticking_marks.cells(ax, result, columns, rows, corners)
        _grazing_curve(ax, result)
        if result.options.windows is not None:
            window_strip.ends_over(ax, result)
        if overlay is not None:
            overlay.draw(ax)
    zero = "lyapunov_error" in result and any(draw is _exponent and (values == 0).any() for draw, values in maps)
    more = [_within_errors(result)] if zero else []
    if any(draw is _period for draw, _ in maps):
        more += [Patch(facecolor=c, edgecolor=FAINT, label=text) for text, c, mask in others if mask.any()]
    more += [line for line in grid[0].lines if line.get_gid() == "measured"]
    _legend(grid, any(values.mask.any() for values in shown), result.options, overlay, more)
    arrange(grid[0].figure)
    for ax, (draw, _), values in zip(grid, maps, shown, strict=True):
        taken = [] if overlay is None else overlay.name(ax)
        if draw is _period:
            name_regions(ax, *corners, values, taken)
        for image in (*ax.images, *ax.collections):
            if image.colorbar is not None:
                thin_ticks(image.colorbar)


def _in_range(values, limits) -> tuple[np.ndarray, np.ndarray]:
    """The order (n,) in which values rise (a sweep may run downwards; an axis does not), and the borders (n + 1,) of
    their cells; of those between the limits of the picture, if there are any."""
    order = np.argsort(values)
    to, back = along_axis(values[order])
    borders = back(edges(to(values[order])))
    low, high = limits or (-np.inf, np.inf)
    inside = np.flatnonzero((borders[1:] > low) & (borders[:-1] < high))
    if not len(inside):
        return order, borders
    return order[inside], borders[inside[0] : inside[-1] + 2]


def _relative_corners(result, columns, rows) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the cells, each (rows + 1, columns + 1), with b in parts of b*. Raises PlotError."""
    (x_key, x), (y_key, y) = result.sweep.items()
    other_key, order = (x_key, columns) if y_key == "b" else (y_key, rows)
    b_star = result.grazing(other_key).get("b_star")
    check_relative(str(result.path), result.sweep, b_star)
    if result.options.windows is not None:
        raise PlotError("relative: ends of windows have b itself as their axis; leave out `relative` or `windows`")
    X, Y = np.meshgrid(edges(x[columns]), edges(y[rows]))
    star = edges(b_star[order])
    return (X, Y / star) if y_key == "b" else (X / star[:, None], Y)


def _grazing_curve(ax, result):
    """b* of Theorem 1 where b is one of the axes, or that of each stop: above it the mass can swing freely."""
    keys = list(result.sweep)
    if "b" not in keys:
        return
    other_key = keys[1 - keys.index("b")]
    order = np.argsort(result.sweep[other_key])
    frame = ax.get_xlim(), ax.get_ylim()
    for name, curve in result.grazing(other_key).items():
        dots = {"marker": ".", "ms": 4} if len(order) < FEW else {}  # between them the line is straight
        line = result.sweep[other_key][order], np.ones(len(order)) if result.options.relative else curve[order]
        dashes = {"color": INK, "lw": 1.0, "ls": CURVES[name], "gid": "grazing"} | dots
        for style in ({"color": "white", "lw": 2.2}, dashes):
            ax.plot(*(line if keys[1] == "b" else line[::-1]), label=grazing_of(name), **style)
    ax.set(xlim=frame[0], ylim=frame[1])


def _within_errors(result) -> Patch:
    """The patch of a legend for the neutral colour of exponents."""
    text = f"{exponent(1)} within {result.significant:.2g} standard errors of 0"
    return Patch(facecolor=NEUTRAL, edgecolor=FAINT, label=text)


def _legend(grid, gaps, options, overlay, more):
    handles = [line for line in grid[0].lines if line.get_gid() == "window end"]
    handles += more
    handles += [] if overlay is None else overlay.handles(grid[0])
    curves = {}
    for line in grid[0].lines:
        if line.get_gid() == "grazing" and _visible(grid[0], line):
            curves[line.get_label()] = line.get_linestyle()
    handles += [Line2D([], [], color=INK, lw=1.0, ls=style, label=label) for label, style in curves.items()]
    if any(collection.get_gid() == "rest" for collection in grid[0].collections):
        handles.append(sticking_marks.patch())
    hatched = [text for text, present in (("outside of the sweep", options.relative), ("no number", gaps)) if present]
    if hatched:
        handles.append(Patch(facecolor=NOT_COMPUTED, edgecolor=FAINT, hatch="////", label=" or ".join(hatched)))
    if handles:
        legend_below(grid, handles, 4, grow=options.size is None)


def _visible(ax, line) -> bool:
    """Whether a part of a line lies within the frame."""
    return line.get_path().intersects_bbox(ax.viewLim, filled=False)


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

    if variable := result.options.variable:
        if variable == "lyapunov":
            return [(_exponent, shown(largest))], note
        draw = {"period": _period, "attractor": _number}.get(variable, _amount(_OF_A_POINT[variable]))
        return [(draw, shown(result.array(variable)))], note
    maps = [] if largest is None else [(_exponent, shown(largest))]
    if "attractor" in result and starts > 1:
        maps.append((_number, np.fmax.reduce(result.array("attractor"), axis=-1)))
    elif "period" in result:
        maps.append((_period, shown(result.array("period"))))
    if not maps and "impacts_right" in result:
        impacts = result.array("impacts_right") + result.array("impacts_left")
        maps.append((_amount("impacts in the recorded periods"), impacts[..., 0]))
    if not maps:
        maps.append((_amount(_OF_A_POINT["impact_power"]), shown(result.array("impact_power"))))
    return [shown for shown in maps if np.isfinite(shown[1]).any()] or maps[:1], note


def _not_periodic(result) -> list[tuple[str, str, np.ndarray]]:
    """What cells of a map of periods show in place of one: text, colour, and where, (first key, second key). Of several
    starts all are so."""
    quiet = result.without_contact()
    found = [] if quiet is None else [("no contact", QUIET, quiet.all(axis=-1))]
    return [*found, ("not settled", UNSETTLED, result.unsettled.all(axis=-1))]


def _exponent(ax, x, y, values, unit):
    """One unit on both sides of zero; 0 has the neutral colour, and no other value has."""
    finite = np.abs(values[values != 0].compressed())
    norm = CenteredNorm(0, max(np.quantile(finite, 0.995), 1e-300) if finite.size else 1.0)
    least = 1.01 * norm.halfrange / DIVERGING.N
    tinted = np.ma.where(values == 0, 0.0, np.copysign(np.maximum(np.abs(values), least), values))
    image = _image(ax, x, y, tinted, cmap=DIVERGING, norm=norm)
    _bar(ax, image, f"{exponents_name(1, unit)}; > 0: chaos", extend="both")


def _period(ax, x, y, values, _):
    colours = ListedColormap([NO_PERIOD, *PERIODS, LONGER])
    norm = BoundaryNorm(np.arange(-0.5, LONGEST + 2), colours.N)
    image = _image(ax, x, y, np.ma.minimum(values, LONGEST + 1), cmap=colours, norm=norm)
    bar = _bar(ax, image, "period in $T$; 0: none found", ticks=range(LONGEST + 2))
    bar.ax.set_xticklabels([*range(LONGEST + 1), f">{LONGEST}"])
    bar.ax.tick_params(length=0)


def _number(ax, x, y, values, _):
    most = int(values.max()) if values.count() else 1
    colours = ListedColormap(colormaps["viridis"](np.linspace(0, 1, most + 1)))
    image = _image(ax, x, y, values, cmap=colours, norm=BoundaryNorm(np.arange(-0.5, most + 1), most + 1))
    _bar(ax, image, "attractors", ticks=MaxNLocator(12, integer=True))


def _amount(label):
    """Draws values on an even scale."""

    def draw(ax, x, y, values, unit):
        image = _image(ax, x, y, values, cmap="viridis", norm=scales.norm(values.filled(np.nan)))
        _bar(ax, image, label + unit)

    return draw


def _image(ax, x, y, values, **style):
    """The cells between these corners, as pixels also in a file of lines."""
    image = ax.pcolorfast(x, y, values, **style)
    image.set_rasterized(True)
    return image


def _bar(ax, image, label, **options):
    return ax.figure.colorbar(image, ax=ax, location="bottom", aspect=30, label=label, **options)
