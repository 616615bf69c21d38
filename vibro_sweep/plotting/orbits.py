"""Pictures of single orbits: phase portrait, time history, section points one after another."""

import numpy as np

from vibro_sweep.plotting.paths import path
from vibro_sweep.plotting.result import Result
from vibro_sweep.plotting.style import (
    DASHES,
    EXPONENTS,
    FAINT,
    INK,
    RIGHT,
    before_impact,
    exponent,
    limits,
    symbol,
)


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


def phase_portrait(result: Result):
    """x1 and v1 between the stops, one panel an orbit; its impacts, and the state at each forcing period, marked."""
    fig, panels = _portraits(result, "Phase portrait")
    for ax, point in panels:
        way = path(result, point)
        _line(ax, way.x1, way.v1, way)
        for stop, before, after in way.jumps:
            ax.plot([stop, stop], [before, after], color=EXPONENTS[1], lw=1.2, ls=(0, (1, 1)), label="impact")
        _walls(ax, result.stops(point.place))
        _mark_sections(ax, result, point, "v1")
        ax.set(title=point.label, xlabel=symbol("x1"), ylabel=symbol("v1"))
    _legend(fig)
    return fig


def configuration(result: Result):
    """Both masses' displacements against each other (the paper's figure 4), one panel an orbit."""
    fig, panels = _portraits(result, "Configuration plane")
    for ax, point in panels:
        way = path(result, point).joined()
        _line(ax, way.x1, way.x2, way)
        _walls(ax, result.stops(point.place))
        _mark_sections(ax, result, point, "x2")
        ax.set(title=point.label, xlabel=symbol("x1"), ylabel=symbol("x2"))
    _legend(fig)
    return fig


def _line(ax, x, y, way):
    """The way as a line; as points where the file does not hold its impacts."""
    if way.complete:
        ax.plot(x, y, color=INK, lw=0.7)
    else:
        label = "samples; this file does not hold the impacts between them"
        ax.plot(x, y, ".", color=INK, markersize=2, markeredgewidth=0, label=label)


def _mark_sections(ax, result, point, name):
    if "trajectory_section_x1" in result:
        x, y = (result.one(f"trajectory_section_{one}", point) for one in ("x1", name))
        ax.plot(x, y, "o", color=EXPONENTS[0], markersize=3.5, label=r"$t = 0$ mod $T$", zorder=3)


def history(result: Result):
    """x1 (and x2) over time, one panel an orbit, the stops as lines."""
    points = result.points()
    fig = result.page(1.5 * len(points) + 0.9 if len(points) > 1 else 3.2, result.title("Time history"))
    grid = fig.subplots(len(points), squeeze=False, sharex=True)[:, 0]
    for ax, point in zip(grid, points, strict=True):
        way, stops = path(result, point).joined(), result.stops(point.place)
        ax.plot(way.t, way.x1, color=INK, label=symbol("x1"))
        if "trajectory_x2" in result:
            ax.plot(way.t, way.x2, color=RIGHT, label=symbol("x2"))
        for stop in stops.values():
            ax.axhline(stop, color=FAINT, lw=0.7, ls=DASHES, label="stops" if len(stops) > 1 else "stop")
        ax.margins(x=0)
        ax.set(title=point.label, ylabel="displacement")
    grid[-1].set_xlabel("$t / T$ (forcing periods)")
    _legend(fig)
    return fig


def iteration(result: Result):
    """The section's coordinate over the iterations (the paper's figures 7 and 8), one panel an orbit."""
    at_impact = "phase" in result
    name = "v1" if at_impact else "x1"
    points = result.points()
    fig = result.page(1.5 * len(points) + 0.9 if len(points) > 1 else 3.2, result.title("Iteration of the section"))
    grid = fig.subplots(len(points), squeeze=False, sharex=True)[:, 0]
    for ax, point in zip(grid, points, strict=True):
        values = result.one(name, point)
        ax.plot(values, "-", color=FAINT, lw=0.3)
        ax.plot(values, ".", color=INK, markersize=3, markeredgewidth=0)
        ax.set(title=point.label, ylabel=before_impact("v1") if at_impact else symbol("x1"))
        ax.margins(x=0.01)
        if np.isfinite(values).any():
            ax.set_ylim(limits(values))
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
    fig = result.page(5.0, result.title("Convergence of the Lyapunov exponents"))
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
        spectrum.set_xlabel("forcing periods")
        spectrum.set_xlim(0, periods[-1])
    for row, shown in zip(grid, (slice(0, 1), slice(None)), strict=True):
        values = [
            np.sort(result.one("lyapunov_running", point)[settled], axis=1)[:, ::-1][:, shown] for point in points
        ]
        finite = np.concatenate([v[np.isfinite(v)] for v in values] + [[0.0]])
        row[0].set_ylim(limits(finite))
    grid[0, 0].set_ylabel(exponent(1))
    grid[1, 0].set_ylabel(exponent("i"))
    _legend(fig)
    fig.align_ylabels(grid[:, 0])
    return fig


def _final_values(panels, result, point) -> str:
    """Draw the exponents of the file, and how far their errors reach; the first of them as text."""
    final = result.one("lyapunov", point)
    error = result.one("lyapunov_error", point) if "lyapunov_error" in result else np.full(4, np.nan)
    for ax, count in zip(panels, (1, 4), strict=True):
        for value, spread, colour in list(zip(final, error, EXPONENTS, strict=True))[:count]:
            if np.isfinite(value):
                ax.axhline(value, color=colour, lw=0.7, ls=DASHES)
            if np.isfinite(value) and np.isfinite(spread):
                reach = result.interval(spread)
                ax.axhspan(value - reach, value + reach, color=colour, alpha=0.15, lw=0)
    return exponent(1, rf" = {_scientific(final[0], 2)} \pm {_scientific(error[0], 0)}")


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
            ax.axvline(stop, color=FAINT, lw=0.8, zorder=1)
            end = stop + side * depth
            ax.axvspan(stop, end, facecolor="none", edgecolor=FAINT, hatch="//////", linewidth=0)
            ax.set_xlim(**{"right" if side > 0 else "left": end})


def _legend(fig):
    named = {}
    for ax in fig.axes:
        handles, labels = ax.get_legend_handles_labels()
        named |= dict(zip(labels, handles, strict=True))
    if named:
        fig.legend(named.values(), named.keys(), loc="outside lower center", ncols=len(named))
