"""Pictures of single orbits: phase portrait, time history, section points one after another."""

import math

import numpy as np

from vibro_sweep.plotting.breaks import break_at_impacts
from vibro_sweep.plotting.result import Result
from vibro_sweep.plotting.style import DASHES, EXPONENTS, FAINT, INK, RIGHT, limits, page


def shows_trajectory(result: Result) -> bool:
    return all(name in result for name in ("trajectory_x1", "trajectory_v1", "time"))


def shows_section(result: Result) -> bool:
    return "x1" in result or "v1" in result


def phase_portrait(result: Result):
    """x1 and v1 between the stops, one panel an orbit; the state at each forcing period marked."""
    points = result.points()
    columns = min(len(points), 2)
    rows = -(-len(points) // columns)
    fig = page(3.0 * rows + 0.7 if columns > 1 else 5.0, result.title("Phase portrait"))
    grid = fig.subplots(rows, columns, squeeze=False)
    for ax in grid.flat[len(points) :]:
        ax.set_axis_off()
    for ax, point in zip(grid.flat, points, strict=False):
        t, x, v = _trajectory(result, point)
        stops = result.stops(point.place)
        path = break_at_impacts(t, x, v, stops)
        ax.plot(path.x, path.v, color=INK, lw=0.7)
        for stop, v_in, v_out in path.jumps:
            ax.plot([stop, stop], [v_in, v_out], color=EXPONENTS[1], lw=1.2, ls=(0, (1, 1)), label="impact")
        _walls(ax, stops)
        period = _forcing_period(result, point)
        if period:
            whole = np.arange(0, t[-1] + period / 2, period)
            at = np.rint(np.interp(whole, t, np.arange(len(t)))).astype(int)
            ax.plot(x[at], v[at], "o", color=EXPONENTS[0], markersize=3.5, label=r"$t = 0$ mod $T$", zorder=3)
        ax.set(title=point.label, xlabel="$x_1$", ylabel="$v_1$")
    _legend(fig)
    return fig


def history(result: Result):
    """x1 (and x2) over time, one panel an orbit, the stops as lines."""
    points = result.points()
    fig = page(1.5 * len(points) + 0.9 if len(points) > 1 else 3.2, result.title("Time history"))
    grid = fig.subplots(len(points), squeeze=False, sharex=True)[:, 0]
    for ax, point in zip(grid, points, strict=True):
        t, x, v = _trajectory(result, point)
        stops = result.stops(point.place)
        period = _forcing_period(result, point)
        unit = period or 1.0
        path = break_at_impacts(t, x, v, stops)
        met = np.isfinite(path.x)  # the displacement does not jump: the line goes on through the impact
        ax.plot(path.t[met] / unit, path.x[met], color=INK, label="$x_1$")
        if "trajectory_x2" in result:
            ax.plot(t / unit, result.one("trajectory_x2", point), color=RIGHT, label="$x_2$")
        for stop in stops.values():
            ax.axhline(stop, color=FAINT, lw=0.7, ls=DASHES, label="stops" if len(stops) > 1 else "stop")
        ax.margins(x=0)
        ax.set(title=point.label, ylabel="displacement")
    grid[-1].set_xlabel("$t / T$ (forcing periods)" if period else "nondimensional time $t$")
    _legend(fig)
    return fig


def iteration(result: Result):
    """The section's coordinate over the iterations (the paper's figures 7 and 8), one panel an orbit."""
    at_impact = "phase" in result
    name = "v1" if at_impact else "x1"
    points = result.points()
    fig = page(1.5 * len(points) + 0.9 if len(points) > 1 else 3.2, result.title("Iteration of the section"))
    grid = fig.subplots(len(points), squeeze=False, sharex=True)[:, 0]
    for ax, point in zip(grid, points, strict=True):
        values = result.one(name, point)
        ax.plot(values, "-", color=FAINT, lw=0.3)
        ax.plot(values, ".", color=INK, markersize=3, markeredgewidth=0)
        ax.set(title=point.label, ylabel="$v_1$ before impact" if at_impact else "$x_1$")
        ax.margins(x=0.01)
        if np.isfinite(values).any():
            ax.set_ylim(limits(values))
    transient = result.setting("orbit", "transient")
    after = f" after {transient} periods of transient" if isinstance(transient, int) else ""
    grid[-1].set_xlabel(("impact" if at_impact else "iteration") + " $n$" + after)
    return fig


def _trajectory(result, point):
    return result.coordinate("time"), *(result.one(f"trajectory_{name}", point) for name in ("x1", "v1"))


def _forcing_period(result, point):
    omega = result.number("omega", point.place)
    return 2 * math.pi / omega if omega else None


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
