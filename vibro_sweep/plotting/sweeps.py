"""Pictures over one swept parameter: bifurcation diagram, Lyapunov spectrum, impacts."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from vibro_sweep.plotting import density, sticking_marks, window_strip
from vibro_sweep.plotting.drawn_sweep import DrawnSweep, PlotError
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.impact_panel import NONE, impact_counts, there_are
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.labels import ABOVE, legend_below
from vibro_sweep.plotting.scales import in_proportion
from vibro_sweep.plotting.spectrum_panel import branches, curve, spectrum
from vibro_sweep.plotting.style import (
    ARROWS,
    BRANCHES,
    CHAOS,
    DASHES,
    FAINT,
    GRAZING,
    INK,
    at_section,
    before_impact,
    edges,
    exponent,
    limits,
    stop_name,
    symbol,
)
from vibro_sweep.tables.coordinates import MOST_MASSES, state

MANY = 100_000  # from here on single points make a blot, and are counted instead,
COLUMN = 400  # points (1/72 inch): the width of a diagram, which its values share
WIDE = 360  # in a picture of so many values; of fewer, each has as much room, and dots lie above each other
OF_CONTACTS = {"penetration_max": "largest penetration", "contact_force_max": "largest force"}
GRAZES = {  # the stop, and how it is drawn
    "b_right": (1, (0, (4, 2))),
    "b_left": (-1, (0, (1, 1))),
}


def shows_bifurcation(result: DrawnSweep) -> bool:
    """A sweep over one key; section."""
    return len(result.sweep) == 1 and ("x1" in result or "v1" in result)


def shows_lyapunov(result: DrawnSweep) -> bool:
    """A sweep over one key; lyapunov."""
    return len(result.sweep) == 1 and "lyapunov" in result


def shows_contacts(result: DrawnSweep) -> bool:
    """A sweep over one key; contacts."""
    return len(result.sweep) == 1 and all(name in result for name in OF_CONTACTS)


def force_panel(ax, result, values, order):
    """The largest force of compliant stops."""
    force = result.array("contact_force_max")[order]
    ax.set_ylabel(f"largest\nforce{result.unit('contact_force_max')}")
    if result.follow:
        branches(ax, values, force)
    else:
        curve(ax, values, force, color=INK)
    ax.set_ylim(bottom=0)
    result.measured_in(ax, next(iter(result.sweep)), "contact_force_max")


def shows_impacts(result: DrawnSweep) -> bool:
    """A sweep over one key; impacts."""
    return len(result.sweep) == 1 and "impacts_right" in result and "impacts_left" in result


def section_variables(result: DrawnSweep) -> tuple[str, ...]:
    """Coordinates of the section points in the file, the one that is drawn by default first."""
    names = state(MOST_MASSES)
    if "phase" in result:
        names = ("v1", "x1", "phase", *names[2:])
    elif "gap" in result:
        names = ("gap", *names)
    return tuple(name for name in names if name in result)


@picture(shows_bifurcation, section_variables)
def bifurcation(result: DrawnSweep) -> Panels:
    """Section points over the parameter; below, on the same axis, windows, spectrum and impacts where there are any."""
    panels = [(3.6, section)]
    if result.options.windows:
        panels.append((window_strip.HEIGHT, window_strip.windows))
    if shows_lyapunov(result):
        panels.append((1.7, spectrum))
    note = ""
    if shows_impacts(result):
        if there_are(result, in_range(result)):
            panels.append((0.9, impact_counts))
        elif not result.failed and result.rigid:
            note = f"; {NONE}"
    if shows_contacts(result):
        panels.append((0.9, force_panel))
    return _stack(result, panels, f"Bifurcation diagram{note}")


@picture(shows_lyapunov)
def lyapunov(result: DrawnSweep) -> Panels:
    """The Lyapunov spectrum over the parameter."""
    return _stack(result, [(3.6, spectrum)], "Lyapunov exponents")


@picture(shows_impacts)
def impacts(result: DrawnSweep) -> Panels:
    """Impacts at each stop over the parameter."""
    return _stack(result, [(2.8, impact_counts)], "Impacts")


def _stack(result, panels, subject) -> Panels:
    """Panels over the swept number, each of a height and what draws it: draw(ax, result, values, order)."""
    heights = [height for height, _ in panels]
    starts = len(result.starts)
    note = f"; {starts} starts at each value" if starts > 1 and not result.follow else ""
    ((key, values),) = result.sweep.items()
    order = in_range(result)
    values = values[order]

    def draw_all(axes):
        axes = axes[:, 0]
        for ax, (_, draw) in zip(axes, panels, strict=False):
            draw(ax, result, values, order)
        if key == "b":
            mark_grazing(axes, result, *(result.options.xlim or values[[0, -1]]))
        set_reach(axes[-1], values)
        axes[-1].set_xlabel(result.axis(key))
        _key(axes[0], result)
        _explanations(axes, result)

    grid = {"sharex": True, "height_ratios": heights}
    return Panels(result.title(subject + note), sum(heights) + 1.2, draw_all, len(panels), grid=grid, alone=True)


def set_reach(ax, values) -> None:
    """The x axis over rising values; logarithmic where they are in proportion."""
    if in_proportion(values):
        beyond = (values[-1] / values[0]) ** 0.02
        ax.set_xscale("log")
        ax.set_xlim(values[0] / beyond, beyond * values[-1])
    else:
        ax.set_xlim(_reach(values))


def _reach(values) -> tuple[float, float]:
    """The limits of an axis over rising values: half a step beyond them, but not far."""
    borders = edges(values)
    most = 0.02 * (values[-1] - values[0]) or np.inf
    return max(borders[0], values[0] - most), min(borders[-1], values[-1] + most)


def in_range(result) -> np.ndarray:
    """The order in which the values rise, of those that the picture shows. Raises PlotError where there are none."""
    ((key, values),) = result.sweep.items()
    order = np.argsort(values)  # a sweep may run downwards; an axis does not
    if result.options.xlim:
        low, high = result.options.xlim
        order = order[(low <= values[order]) & (values[order] <= high)]
        if not len(order):
            raise PlotError(f"xlim: the file has no {key} from {low:g} to {high:g}; {result.extent(key)}")
    return order


def mark_grazing(axes, result, low, high):
    """Mark in each panel over b from low to high where the free motion touches the stops, and where else the map was
    expanded."""
    marks = [("b_star", f"grazing, {symbol('b_star')}", (0, (4, 2)))]
    marks += [
        (name, f"grazing, {symbol(name)}", style) for name, (side, style) in GRAZES.items() if side in result.sides
    ]
    marks.append(("expand_at", "expansion of the mapping", ":"))
    for name, label, style in marks:
        b = result.number(name)
        if b is not None and low <= b <= high:
            for ax in axes:
                ax.axvline(b, color=GRAZING, lw=0.8, ls=style, zorder=3, gid="grazing", label=label)


def _key(ax, result):
    """Draw the key of the colours above the panel, where it hides no point."""
    handles = [line for line in ax.lines if line.get_gid() == "stop"]
    handles += [line for line in ax.lines if line.get_gid() in ("grazing", "measured")]
    if result.follow:
        dots = {"ls": "none", "marker": "o", "markersize": 4}
        both = [Line2D([], [], color=INK, label="both", **dots)] if ax.images else []
        handles += [*(Line2D([], [], color=BRANCHES[n], label=ARROWS[n], **dots) for n in BRANCHES), *both]
    if handles:
        ax.legend(handles=handles, ncols=len(handles), handletextpad=0.3, columnspacing=1.2, borderpad=0.1, **ABOVE)


def _explanations(axes, result):
    """Draw the key of tints, bands and lines below the panels."""
    group_ids = {artist.get_gid() for ax in axes for artist in (*ax.collections, *ax.lines)}
    errors = f"{result.significant:.2g} standard errors"
    certain = f" by more than {errors}" if "lyapunov_error" in result else ""
    handles = {
        "chaos": Patch(color=CHAOS, label=f"{exponent(1)} > 0{certain}: chaos"),
        "error": Patch(color=FAINT, alpha=0.4, label=f"exponent ± {errors}"),
        "lost": Patch(color=FAINT, label=rf"strips: $\lambda_i = -\infty$, lost at {sticking_marks.NOUN}"),
        "rest": sticking_marks.handle(),
        "periodic": Line2D([], [], color=INK, lw=0.8, label="line: periodic orbit"),
    }
    shown = [handle for name, handle in handles.items() if name in group_ids]
    if shown:
        legend_below(axes, shown, len(shown))


def section(ax, result, values, order):
    """Section points over the parameter, on axes of the caller's."""
    name = result.options.variable or section_variables(result)[0]
    at_impact = "phase" in result
    points = result.array(name)[order]  # (values, starts, samples)
    if at_impact:
        ax.set_ylabel(f"{before_impact(name)}, {result.settings.get('section_stop', 'right')} stop{result.unit(name)}")
    else:
        ax.set_ylabel(at_section(name) + result.unit(name))
    if result.failed:
        return
    inside = np.isfinite(points)
    low, high = limits(points) if inside.any() else (0, 1)
    bottom, top = result.options.ylim or (low, high)
    ax.set_ylim(bottom, top)
    inside &= (bottom <= points) & (points <= top)
    if not inside.any():
        ax.text(0.5, 0.5, "no section points", transform=ax.transAxes, ha="center", color=FAINT)
        return
    repeats = result.repeats(points, order)
    count = _distinct(points, inside, repeats)
    most = MANY * min(1, len(values) / WIDE) / (4 if result.follow else 1)  # of wide dots fewer
    if inside.sum() >= most and not in_proportion(values):  # the columns of a grid are even
        cloud = density.Cloud(values, points, repeats, high - low)
        if result.follow:
            density.two(ax, cloud, list(BRANCHES.values()))
        else:
            density.of_all(ax, cloud)
    elif result.follow:
        # Where the branches agree the wide dot shows as a rim around the narrow one.
        for i, (start, scale) in enumerate({"up": 2.0, "down": 0.9}.items()):
            _dots(ax, values, points[:, i], count, scale, color=BRANCHES[start])
    else:
        _dots(ax, values, points, count, color=INK)
    if name == ("x1" if result.contact_normal is None else "gap") and not at_impact:
        _stop_lines(ax, result, values, order)
    result.measured_in(ax, next(iter(result.sweep)), name)


def _distinct(points, inside, repeats) -> float:
    """The number of points that one can distinguish of those that are there, bool (values, starts, samples): of a
    periodic orbit those of one period."""
    known = np.maximum(np.isfinite(points).sum(axis=-1), 1)
    return float((inside.sum(axis=-1) * np.where(repeats > 0, repeats / known, 1)).sum())


def _dots(ax, values, points, count, scale=1.0, **style):
    inside = np.isfinite(points)
    x = np.broadcast_to(np.expand_dims(values, tuple(range(1, points.ndim))), points.shape)
    widest = np.clip(COLUMN / len(values), 1.5, 4)
    size = scale * np.clip(3.5 * (count / 1000) ** -0.25, 1.2, widest)
    ax.plot(x[inside], points[inside], ".", markersize=size, markeredgewidth=0, rasterized=True, **style)


def _stop_lines(ax, result, values, order):
    """The stops, where they pass through the picture: a section point on this line is about to touch."""
    low, high = ax.get_ylim()
    places = [result.stops((place,)) for place in order]
    for side in result.sides if places[0] else ():
        gap = np.array([stops[side] for stops in places])
        if ((low < gap) & (gap < high)).any():
            style = DASHES if side > 0 else ":"
            label = stop_name(result, side)
            ax.plot(values, gap, color=FAINT, lw=0.9, ls=style, zorder=1, gid="stop", label=label)
