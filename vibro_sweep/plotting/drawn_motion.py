"""What is drawn of a motion into axes, wherever the orbit comes from: portrait, history, force of the stops."""

from collections.abc import Collection

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from vibro_sweep.plotting import sticking_marks
from vibro_sweep.plotting.labels import legend_below
from vibro_sweep.plotting.style import DASHES, FAINT, IMPACT, INK, LEFT, RIGHT
from vibro_sweep.results.motion import Motion

ARROWS_AT = (0.06, 0.36, 0.66, 0.91)  # of the first forcing period, or of the whole way
CONTACT = {"color": IMPACT, "lw": 1.6, "zorder": 2.2, "label": "contact"}


def portrait(ax: Axes, motion: Motion, x: str, y: str, arrows_at=ARROWS_AT) -> None:
    """The way in the plane of two of its numbers, with arrows of time, rests and contacts; impacts in that of the gap
    and its velocity."""
    ax.plot(motion[x], motion[y], color=INK, lw=0.7)
    arrows(ax, motion.t, motion[x], motion[y], arrows_at)
    sticking_marks.along(ax, motion, x, y)
    contacts(ax, motion, x, y)
    if (x, y) == motion.names:
        for _, side, before, after in motion.impacts:
            stop = motion.stops.get(side, np.nan)
            ax.plot([stop, stop], [before, after], color=IMPACT, lw=1.2, ls=(0, (1, 1)), label="impact")


def contacts(ax: Axes, motion: Motion, x: str, y: str) -> None:
    """Mark contacts with compliant stops in the plane of two numbers of a motion, or over its time "t"."""
    for side in motion.stops:
        pressed = motion.force(side)[0] != 0
        if pressed.any():
            ax.plot(*(np.where(pressed, motion[name], np.nan) for name in (x, y)), **CONTACT)


def walls(ax: Axes, stops: dict[int, float], soft: Collection[int], names: dict[int, str]) -> None:
    """The stops in a plane whose abscissa is the gap: a line, and of a rigid one hatching where the mass cannot be.

    soft : the sides of compliant ones; names : of each side, for the legend
    """
    low, high = ax.get_xlim()
    depth = 0.04 * (high - low)
    for side, stop in stops.items():
        if low < stop < high:  # an orbit that stays far away is not squeezed to show them
            style = "-" if side > 0 else DASHES
            ax.axvline(stop, color=FAINT, lw=0.8, ls=style, zorder=1, label=names[side])
            if side in soft:
                continue
            end = stop + side * depth
            ax.axvspan(stop, end, facecolor="none", edgecolor=FAINT, hatch="//////", linewidth=0)
            ax.set_xlim(**{"right" if side > 0 else "left": end})


def levels(ax: Axes, motion: Motion, names: dict[int, str]) -> None:
    """The stops over time, as lines."""
    for side, stop in motion.stops.items():
        ax.axhline(stop, color=FAINT, lw=0.9, ls=DASHES if side > 0 else ":", label=names[side])


def force(over_time: Axes, loop: Axes, motion: Motion, names: dict[int, str]) -> None:
    """The force of the compliant stops over time, and against the gap."""
    for side in motion.laws:
        values = motion.force(side)[0]
        style = {"color": RIGHT if side > 0 else LEFT, "lw": 1.0, "label": names[side]}
        over_time.plot(motion.t, values, **style)
        loop.plot(motion[motion.names[0]], np.where(values != 0, values, np.nan), **style)
        loop.axvline(motion.stops[side], color=FAINT, lw=0.8, ls=DASHES)


def arrows(ax: Axes, t, x, y, times) -> None:
    """Arrows of time on the way (x, y) with NaN in its gaps, at these times or the nearest that do."""
    known = np.flatnonzero(np.isfinite(x[:-1]) & np.isfinite(x[1:]) & (np.hypot(np.diff(x), np.diff(y)) > 0))
    if not len(known):
        return
    for at in known[np.searchsorted(t[known], times).clip(max=len(known) - 1)]:
        ends = {"xy": (x[at + 1], y[at + 1]), "xytext": (x[at], y[at])}
        arrow = {"arrowstyle": "-|>", "color": INK, "lw": 0.7, "mutation_scale": 11, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", **ends, arrowprops=arrow, zorder=2.5, gid="time")


def legend(axes) -> None:
    """All that is labelled in these axes, each once, and what the arrows mean."""
    named, axes = {}, np.ravel(axes)
    for ax in axes:
        handles, labels = ax.get_legend_handles_labels()
        named = dict(zip(labels, handles, strict=True)) | named
    if any(text.get_gid() == "time" for ax in axes for text in ax.texts):
        named["direction of time"] = Line2D([], [], color=INK, lw=0, marker=">", markersize=5)
    if named:
        legend_below(axes, list(named.values()), len(named), labels=list(named))
