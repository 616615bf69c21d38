"""Pictures of single orbits: phase portrait, time history, section points one after another."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from vibro_sweep.model.state import MOST_MASSES, state
from vibro_sweep.plotting.paths import path
from vibro_sweep.plotting.result import Result
from vibro_sweep.plotting.style import (
    DASHES,
    EXPONENTS,
    FAINT,
    IMPACT,
    INK,
    PER_TIME,
    RIGHT,
    SECTION,
    at_section,
    before_impact,
    exponent,
    limits,
    symbol,
)
from vibro_sweep.plotting.sweeps import section_variables

ARROWS_AT = (0.06, 0.36, 0.66, 0.91)  # of the first forcing period, or of the whole way


def shows_trajectory(result: Result) -> bool:
    """A trajectory."""
    return all(name in result for name in ("trajectory_x1", "trajectory_v1", "time"))


def shows_both_masses(result: Result) -> bool:
    """A trajectory with the second mass."""
    return shows_trajectory(result) and "trajectory_x2" in result


def shows_section(result: Result) -> bool:
    """Section points."""
    return "x1" in result or "v1" in result


def _portraits(result, what):
    """A page with a panel for each orbit: (figure, [(axes, point)])."""
    points = result.points()
    columns = min(len(points), 2)
    rows = -(-len(points) // columns)
    fig = result.page(3.0 * rows + 0.7 if columns > 1 else 5.0, result.title(what))
    grid = fig.subplots(rows, columns, squeeze=False)
    for ax in grid.flat[len(points) :]:
        ax.set_axis_off()
    return fig, list(zip(grid.flat, points, strict=False))


def masses(result: Result) -> tuple[str, ...]:
    """The displacements that a trajectory of the file has."""
    return ("x1", "x2") if "trajectory_x2" in result and "trajectory_v2" in result else ("x1",)


def phase_portrait(result: Result):
    """x1 and v1 between the stops, or x2 and v2, one panel an orbit; impacts, and the state at each forcing period."""
    fig, panels = _portraits(result, "Phase portrait")
    x_name = result.look.variable or "x1"
    v_name = f"v{x_name[1]}"
    for ax, point in panels:
        way = path(result, point)
        first = x_name == "x1"
        way = way if first else way.joined()
        _line(ax, getattr(way, x_name), getattr(way, v_name), way)
        if first:
            for stop, before, after in way.jumps:
                ax.plot([stop, stop], [before, after], color=IMPACT, lw=1.2, ls=(0, (1, 1)), label="impact")
            _walls(ax, result.stops(point.place))
        _mark_sections(ax, result, point, x_name, v_name)
        ax.set(title=point.label, xlabel=symbol(x_name), ylabel=symbol(v_name))
    legend(fig)
    return fig


def configuration(result: Result):
    """Both masses' displacements against each other (the paper's figure 4), one panel an orbit."""
    fig, panels = _portraits(result, "Configuration plane")
    for ax, point in panels:
        way = path(result, point).joined()
        _line(ax, way.x1, way.x2, way)
        _walls(ax, result.stops(point.place))
        _mark_sections(ax, result, point, "x1", "x2")
        ax.set(title=point.label, xlabel=symbol("x1"), ylabel=symbol("x2"))
    legend(fig)
    return fig


def shows_poincare(result: Result) -> bool:
    """Section points with a displacement and its velocity; of impacts the phase and the velocity."""
    return bool(abscissae(result))


def abscissae(result: Result) -> tuple[str, ...]:
    """What stands along the axis of a Poincare plot, the default first; its velocity stands upwards."""
    if "phase" in result:
        return ("phase",) if "v1" in result and not result.model() else ()  # the map has one phase
    return tuple(f"x{n}" for n in (1, 2) if f"x{n}" in result and f"v{n}" in result)


def poincare(result: Result):
    """Section points in the plane of x1 and v1, or of x2 and v2; of impacts of phase and v1. One panel an orbit."""
    fig, panels = _portraits(result, "Poincaré section")
    x_name = result.look.variable or abscissae(result)[0]
    v_name = "v1" if x_name == "phase" else f"v{x_name[1]}"
    for ax, point in panels:
        x, v = (result.one(name, point) for name in (x_name, v_name))
        size = np.clip(60 / np.sqrt(_different(x)), 2, 8)
        ax.plot(x, v, ".", color=SECTION, markersize=size, markeredgewidth=0, rasterized=True)
        if np.isfinite(x).any():
            least = 0.01 * (result.number("b", point.place) or 0.0)
            ax.set(xlim=limits(x, least), ylim=limits(v, least))
        if x_name == "x1":
            _walls(ax, result.stops(point.place))
        name = before_impact if "phase" in result else at_section
        ax.set(title=point.label, xlabel=r"$\omega t$ mod $2\pi$" if x_name == "phase" else name(x_name))
        ax.set_ylabel(name(v_name))
    legend(fig)
    return fig


def _different(values) -> int:
    """How many points one can tell apart, at least 1."""
    known = values[np.isfinite(values)]
    return len(np.unique(np.round(known / (np.ptp(known) or 1.0), 3))) if len(known) else 1


def _line(ax, x, y, way):
    """The way as a line with arrows of time; as points where the file does not hold its impacts."""
    if not way.complete:
        label = "samples; this file does not hold the impacts between them"
        ax.plot(x, y, ".", color=INK, markersize=2, markeredgewidth=0, label=label)
        return
    ax.plot(x, y, color=INK, lw=0.7)
    arrows(ax, way.t, x, y, ARROWS_AT)


def arrows(ax, t, x, y, times):
    """Arrows of time on the way (x, y) with NaN in its gaps, at these times or the nearest that do."""
    known = np.flatnonzero(np.isfinite(x[:-1]) & np.isfinite(x[1:]) & (np.hypot(np.diff(x), np.diff(y)) > 0))
    if not len(known):
        return
    for at in known[np.searchsorted(t[known], times).clip(max=len(known) - 1)]:
        ends = {"xy": (x[at + 1], y[at + 1]), "xytext": (x[at], y[at])}
        arrow = {"arrowstyle": "-|>", "color": INK, "lw": 0.7, "mutation_scale": 11, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", **ends, arrowprops=arrow, zorder=2.5, gid="time")


def _mark_sections(ax, result, point, x_name, y_name):
    if "trajectory_section_x1" in result:
        x, y = (result.one(f"trajectory_section_{one}", point) for one in (x_name, y_name))
        ax.plot(x, y, "o", color=SECTION, markersize=3.5, label=r"$t = 0$ mod $T$", zorder=3)


def coordinates(result: Result) -> tuple[str, ...]:
    """What a trajectory of the file has."""
    return tuple(name for name in state(MOST_MASSES) if f"trajectory_{name}" in result)


def history(result: Result):
    """x1 and x2 over time, or one coordinate, one panel an orbit, the stops as lines."""
    points = result.points()
    fig = result.page(1.5 * len(points) + 0.9 if len(points) > 1 else 3.2, result.title("Time history"))
    grid = fig.subplots(len(points), squeeze=False, sharex=True)[:, 0]
    chosen = result.look.variable
    names = [chosen] if chosen else [name for name in ("x1", "x2") if name in coordinates(result)]
    styles = {"1": {"color": INK}, "2": {"color": RIGHT, "ls": (0, (4, 1))}}
    for ax, point in zip(grid, points, strict=True):
        way, stops = path(result, point), result.stops(point.place)
        for name in names:
            shown = way if name == "v1" else way.joined()
            ax.plot(shown.t, getattr(shown, name), label=symbol(name), **styles[name[1]])
        for side, stop in stops.items() if "x1" in names else ():
            label, style = ("right stop, $b$", DASHES) if side > 0 else ("left stop, $-b$", ":")
            ax.axhline(stop, color=FAINT, lw=0.9, ls=style, label=label)
        ax.margins(x=0)
        ax.set(title=point.label, ylabel=symbol(chosen) if chosen else "displacement")
    grid[-1].set_xlabel("$t / T$ (forcing periods)")
    legend(fig)
    return fig


def iteration(result: Result):
    """The section's coordinate over the iterations (the paper's figures 7 and 8), one panel an orbit."""
    at_impact = "phase" in result
    name = result.look.variable or section_variables(result)[0]
    points = result.points()
    fig = result.page(1.5 * len(points) + 0.9 if len(points) > 1 else 3.2, result.title("Iteration of the section"))
    grid = fig.subplots(len(points), squeeze=False, sharex=True)[:, 0]
    most = 1
    for ax, point in zip(grid, points, strict=True):
        values = result.one(name, point)
        ax.plot(values, "-", color=FAINT, lw=0.3)
        ax.plot(values, ".", color=INK, markersize=np.clip(60 / np.sqrt(len(values)), 3, 8), markeredgewidth=0)
        ax.set(title=point.label, ylabel=before_impact(name) if at_impact else symbol(name))
        ax.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1, steps=[1, 2, 2.5, 5, 10]))
        if np.isfinite(values).any():
            ax.set_ylim(limits(values))
            most = max(most, np.flatnonzero(np.isfinite(values))[-1] + 1)
    margin = max(0.5, 0.01 * most)
    grid[0].set_xlim(-margin, most - 1 + margin)
    transient = result.number("transient")
    after = "" if transient is None else f" after {transient:.0f} periods of transient"
    grid[-1].set_xlabel(("impact" if at_impact else "iteration") + " $n$" + after)
    return fig


def shows_convergence(result: Result) -> bool:
    """Exponents as they converge."""
    return "lyapunov_running" in result


def convergence(result: Result):
    """The spectrum as it was computed, period by period: lambda_1 beside zero, and below all four. Up to two orbits.

    Where the file has them: a dashed line at each final value, around it a band in which zero would not differ from it.
    """
    points = result.points(2)
    fig = result.page(5.2, result.title("Convergence of the Lyapunov exponents"))
    grid = fig.subplots(2, len(points), sharex=True, sharey="row", squeeze=False, height_ratios=(1.2, 1))
    periods = result.coordinate("elapsed")
    settled = slice(len(periods) // 10, None)
    for (largest, spectrum), point in zip(grid.T, points, strict=True):
        running = np.where(np.isfinite(values := result.one("lyapunov_running", point)), values, np.nan)
        for i in range(4):
            spectrum.plot(periods, running[:, i], color=EXPONENTS[i], label=exponent(i + 1), zorder=3 - i / 9)
        order = np.argsort(-np.nan_to_num(running[-1], nan=-np.inf))
        largest.plot(periods, running[:, order[0]], color=EXPONENTS[order[0]])
        text = point.label
        if "lyapunov" in result:
            text = ", ".join(filter(None, [text, _final_values((largest, spectrum), result, point)]))
        largest.axhline(0, color=INK, lw=0.6)
        largest.set_title(text)
        spectrum.set_xlabel("forcing periods recorded")
        spectrum.set_xlim(0, periods[-1])
    for row, shown in zip(grid, (slice(0, 1), slice(None)), strict=True):
        values = [
            np.sort(result.one("lyapunov_running", point)[settled], axis=1)[:, ::-1][:, shown] for point in points
        ]
        finite = np.concatenate([v[np.isfinite(v)] for v in values] + [[0.0]])
        row[0].set_ylim(limits(finite))
    grid[0, 0].set_ylabel(f"{exponent(1)} {PER_TIME}")
    grid[1, 0].set_ylabel(f"{exponent('i')} {PER_TIME}")
    legend(fig)
    fig.align_ylabels(grid[:, 0])
    return fig


def _final_values(panels, result, point) -> str:
    """Draw the exponents of the file, and how far their errors reach; the first of them as text."""
    final = result.one("lyapunov", point)
    known = "lyapunov_error" in result
    reach = result.interval(result.one("lyapunov_error", point)) if known else np.full(4, np.nan)
    errors = f"± {result.significant:.2g} standard errors"
    for ax, count in zip(panels, (1, 4), strict=True):
        for i, (value, spread, colour) in enumerate(list(zip(final, reach, EXPONENTS, strict=True))[:count]):
            if np.isfinite(value):
                ax.axhline(value, color=colour, lw=0.7, ls=DASHES, label="_" if i else "final value")
            if np.isfinite(value) and np.isfinite(spread):
                label = "_" if i else errors
                ax.axhspan(value - spread, value + spread, color=colour, alpha=0.15, lw=0, label=label)
    value = rf"{_scientific(final[0], 2)} \pm {_scientific(reach[0], 0)}" if known else _scientific(final[0], 2)
    return exponent(1, f" = {value}") + (f" ({errors})" if known else "")


def _scientific(value, digits) -> str:
    """A number for mathtext."""
    if not np.isfinite(value) or value == 0:
        return f"{value:.{digits}f}".replace("inf", r"\infty").replace("nan", "?")
    mantissa, exponent = f"{value:.{digits}e}".split("e")
    return rf"{mantissa} \times 10^{{{int(exponent)}}}"


def _walls(ax, stops):
    """The stops as walls: a line, and hatching where the mass cannot be."""
    low, high = ax.get_xlim()
    depth = 0.04 * (high - low)
    for side, stop in stops.items():
        if low < stop < high:  # an orbit that stays far away is not squeezed to show them
            label = "right stop, $x_1 = b$" if side > 0 else "left stop, $x_1 = -b$"
            ax.axvline(stop, color=FAINT, lw=0.8, ls="-" if side > 0 else DASHES, zorder=1, label=label)
            end = stop + side * depth
            ax.axvspan(stop, end, facecolor="none", edgecolor=FAINT, hatch="//////", linewidth=0)
            ax.set_xlim(**{"right" if side > 0 else "left": end})


def legend(fig):
    """All that is labelled in its panels, each once, and what the arrows mean."""
    named = {}
    for ax in fig.axes:
        handles, labels = ax.get_legend_handles_labels()
        named = dict(zip(labels, handles, strict=True)) | named
    if any(text.get_gid() == "time" for ax in fig.axes for text in ax.texts):
        named["direction of time"] = Line2D([], [], color=INK, lw=0, marker=">", markersize=5)
    if named:
        fig.legend(
            named.values(),
            named.keys(),
            loc="outside lower center",
            ncols=len(named) if len(named) < 7 else -(-len(named) // 2),
        )
