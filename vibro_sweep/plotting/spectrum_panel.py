"""Lyapunov exponents over a parameter, and what curves over one share."""

import numpy as np
from matplotlib.collections import PolyCollection

from vibro_sweep.plotting.style import ARROWS, BRANCHES, CHAOS, INK, edges, exponent, exponent_colour, exponents_name

STRIP = 0.05  # of the panel's height: what stands for an exponent of -infinity
MOST_NAMED = 8  # exponents beside their curves
_BRANCH_LINES = {
    "up": {"lw": 1.6, "alpha": 0.5},
    "down": {"lw": 0.8},
}  # the wide one shows beside the narrow one


def spectrum(ax, result, values, order):
    exponents = result.array("lyapunov")[order]  # (values, starts, 2 N)
    lost = np.isneginf(exponents).any(axis=1)
    exponents[~np.isfinite(exponents)] = np.nan  # directions lost by sticking leave a gap
    error = result.array("lyapunov_error")[order] if "lyapunov_error" in result else np.zeros(exponents.shape)
    spans(ax, values, result.is_chaotic()[order].any(axis=1), color=CHAOS, gid="chaos")
    ax.axhline(0, color=INK, lw=0.6, zorder=1)
    ax.set_ylabel(exponents_name(1 if result.follow else "i", result.unit("lyapunov")))
    if result.follow:
        branches(ax, values, exponents[:, :, 0])
        _strips(ax, values, lost[:, :1], [INK])
        for i, name in enumerate(BRANCHES):
            _error_band(ax, values, exponents[:, i, 0], result.interval(error[:, i, 0]), BRANCHES[name])
        return
    for i in reversed(range(exponents.shape[-1])):  # lambda_1 on top
        curve(ax, values, exponents[:, :, i], color=exponent_colour(i), label=exponent(i + 1))
        if len(result.starts) == 1:
            _error_band(ax, values, exponents[:, 0, i], result.interval(error[:, 0, i]), exponent_colour(i))
    _keep_the_leading_ones_legible(ax, exponents)
    _strips(ax, values, lost, [exponent_colour(i) for i in range(lost.shape[1])])
    if not result.failed:
        _name_curves(ax, exponents)


def _keep_the_leading_ones_legible(ax, exponents):
    """What lies many times further down than the first three exponents do is cut off: an exponent (strong damping,
    little restitution), or a dip of one in a hundred values."""
    known = exponents[..., :3][np.isfinite(exponents[..., :3])]
    if known.size:
        bottom = np.quantile(known, 0.01)
        span = max(known.max(), 0.0) - bottom
        low, high = ax.get_ylim()
        ax.set_ylim(bottom=max(low, bottom - 1.5 * span) if span > 0 else low, top=high)


def _strips(ax, values, lost, colours):
    """Draw at the bottom which exponents are -infinity: their directions are lost. lost : (values, exponents)"""
    rows = np.flatnonzero(lost.any(axis=0))
    if not len(rows):
        return
    low, high = ax.get_ylim()
    ax.set_ylim(low - 1.2 * STRIP * len(rows) * (high - low), high)
    for place, i in enumerate(reversed(rows)):  # the last one lowest
        bottom = STRIP * (place + 0.2)
        spans(ax, values, lost[:, i], (bottom, bottom + 0.8 * STRIP), color=colours[i], gid="lost", zorder=2)


def _error_band(ax, values, ordinates, reach, colour):
    """Draw the errors to each side, where that is wider than the line."""
    low, high = ax.get_ylim()
    if np.nanmax(reach, initial=0) > 2e-3 * (high - low):
        style = {"color": colour, "alpha": 0.3, "lw": 0, "zorder": 1.5, "rasterized": True, "gid": "error"}
        ax.fill_between(values, ordinates - reach, ordinates + reach, **style)


def branches(ax, values, ordinates):
    for i, name in enumerate(BRANCHES):
        curve(ax, values, ordinates[:, i], color=BRANCHES[name], label=ARROWS[name], **_BRANCH_LINES[name])


def spans(ax, values, chosen, between=(0, 1), **style):
    """Colour the cells of the chosen values, bool (n,), between two heights of the axes; neighbours are one area."""
    borders = edges(values)
    first, last = np.diff(np.concatenate([[False], chosen, [False]]).astype(int)).nonzero()[0].reshape(-1, 2).T
    if len(first):
        low, high = between
        cells = [
            [(left, low), (right, low), (right, high), (left, high)]
            for left, right in zip(borders[first], borders[last], strict=True)
        ]
        transform = ax.get_xaxis_transform()
        style = {"linewidth": 0, "zorder": 0} | style
        ax.add_collection(PolyCollection(cells, transform=transform, **style), autolim=False)


def curve(ax, values, ordinates, **style):
    """A line; dots where several attractors would make it jump to and fro, or where it has few points."""
    if ordinates.ndim == 2 and ordinates.shape[1] > 1:
        style |= {"ls": "none", "marker": ".", "markersize": 2.2, "markeredgewidth": 0, "rasterized": True}
    elif len(values) < 60:
        style |= {"marker": ".", "markersize": 4}
    ax.plot(values, ordinates, **style)


def _name_curves(ax, exponents):
    """Each exponent's symbol at its right end, pushed apart where they are the same."""
    low, high = ax.get_ylim()
    known = [curve[np.isfinite(curve)] for curve in np.moveaxis(exponents, -1, 0)]
    ends = [(curve[-1] - low) / (high - low) if curve.size else 0.0 for curve in known]
    inches = ax.get_position().height * ax.figure.get_figheight()
    apart = 0.16 / inches  # of which a line of text needs so many
    for _ in range(50):
        for i in range(len(ends) - 1):
            push = max(0.0, apart - (ends[i] - ends[i + 1])) / 2
            ends[i] += push
            ends[i + 1] -= push
    for i, end in enumerate(ends[:MOST_NAMED]):
        beyond = "" if known[i].size and known[i][-1] >= low else r"\,\downarrow" if known[i].size else r" = -\infty"
        margin_note(ax, max(end, 0.03), exponent(i + 1, beyond), exponent_colour(i))


def margin_note(ax, height, text, colour, **style):
    ax.annotate(text, (1.012, height), xycoords="axes fraction", va="center", color=colour, **style)
