"""Charts: bifurcation curves in the plane of two parameters, with their points of codimension two."""

from collections import Counter
from typing import NamedTuple

import numpy as np
from matplotlib import patheffects
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.labels import arrange, legend_below, name_beside
from vibro_sweep.plotting.measured import draw_measured
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.scales import scale_of
from vibro_sweep.plotting.style import INK, axis_name, with_unit
from vibro_sweep.tables.bifurcations import BY_NAME, CODIMENSION_TWO, TYPES

COLOURS = {row.name: row.curve_colour for row in TYPES if row.condition}
# of orbits of different periods, beside the colours of the types but for the graze's
ORBITS = ("#8a8a96", "#5ce4ff", "#521433", "#9aca91", "#425a8a", "#ff5c5c", "#8a425a", "#660099", "#ff00d5")
MOSTLY, DIFFERENT = 0.6, 3  # from this part of the curves on, and so many periods, one type is distinguished by periods
VIRTUAL = (0, (1, 1.5))  # dots of what is not a motion
MANY = 100  # curves
SHORT = {row.name: row.label for row in CODIMENSION_TWO if row.label}


class Drawn(NamedTuple):
    """A curve: its type, both parameters and `virtual` (points,), points of codimension two as (type, p, q); whether it
    bounds attractors (points,), or None where that is not shown; the period of its orbits."""

    type: str
    p: np.ndarray
    q: np.ndarray
    virtual: np.ndarray
    special: list[tuple[str, float, float]]
    bounds: np.ndarray | None = None
    period: int = 1


def plot_curves(curves: list[Drawn], names: tuple[str, str], system=None, width: float | None = None) -> Figure:
    """All curves of a system in one panel, so many mm wide."""
    known = getattr(system, "described", {})  # a Family has numbers without units
    labels = [with_unit(axis_name(name), known[name].units if name in known else "1", system) for name in names]
    options = PlotOptions(width=width)
    return options.draw(chart_of("bifurcation curves", 4.2, curves, names, labels, options))[0].figure


def chart_of(
    title: str, height: float, curves: list[Drawn], names, labels, options: PlotOptions, units=(None, None)
) -> Panels:
    """Curves in the plane of two numbers with these units, with their legend and the names of their points."""

    def draw_all(axes):
        ax = axes[0, 0]
        scale(ax, curves, names)
        draw(ax, curves)
        ax.set(xlim=options.xlim or ax.get_xlim(), ylim=options.ylim or ax.get_ylim())
        ax.set(xlabel=labels[0], ylabel=labels[1])
        draw_measured(ax, options.points, *zip(names, units, strict=True))
        measured = [line for line in ax.lines if line.get_gid() == "measured"]
        legend_below(ax, handles(curves, frame_of(ax)) + measured, 6, grow=options.size is None, columnspacing=1.2)
        arrange(ax.figure)
        name_points(ax, curves)

    return Panels(title, height, draw_all, measurable=tuple(names))


def frame_of(ax) -> tuple[tuple[float, float], tuple[float, float]]:
    """((left, right), (low, high)) of a picture."""
    return ax.get_xlim(), ax.get_ylim()


def scale(ax, curves: list[Drawn], names) -> None:
    """Set the scales of the axes, of these two numbers."""
    across, up = (np.concatenate(values) for values in zip(*((curve.p, curve.q) for curve in curves), strict=True))
    ax.set(xscale=scale_of(names[0], across), yscale=scale_of(names[1], up))


def draw(ax, curves: list[Drawn], halo: bool = False) -> None:
    """The lines: virtual parts dotted, parts that bound no attractor thin; points of codimension two.

    halo : with a white rim and small points, over a picture.
    Many curves have thin lines and no rims.
    """
    by_period = _by_period(curves)
    many = len(curves) > MANY
    rim = [patheffects.withStroke(linewidth=2.4, foreground="white")] if halo and not many else []
    for curve in curves:
        strong = np.ones(len(curve.p), bool) if curve.bounds is None else curve.bounds
        for shown, style in (
            (curve.virtual, {"ls": VIRTUAL, "lw": 0.8}),
            (~curve.virtual & ~strong, {"ls": "-", "lw": 0.2 if many else 0.5, "gid": "weak"}),
            (~curve.virtual & strong, {"ls": "-", "lw": 0.6 if many else 1.2, "path_effects": rim, "gid": "curve"}),
        ):
            p, q = (np.where(_joined(shown), values, np.nan) for values in (curve.p, curve.q))
            if shown.any():
                ax.plot(p, q, color=_style(curve, by_period)[0], **style)
    size = {"ms": 0.7, "mew": 0, "mfc": INK} if many else {"ms": 2.2 if halo else 3.5}
    for _, place in points_of(curves):
        ax.plot(*place, zorder=4, gid="special", **_dot(3.5) | size)


def _joined(shown: np.ndarray) -> np.ndarray:
    """The mask with the points beside, so that parts of a line touch."""
    result = shown.copy()
    result[1:] |= shown[:-1]
    return result


def name_points(ax, curves: list[Drawn], most: int | None = None) -> list[np.ndarray]:
    """Names of the points of codimension two that stand alone; the boxes in which they stand (`labels.name_beside`).

    most : over a picture, where few have room
    """
    if len(curves) > MANY:  # no room for names
        return []
    points = points_of(curves)
    lines = np.concatenate([_filled(curve) for curve in curves])
    return name_beside(ax, [SHORT[kind] for kind, _ in points], [place for _, place in points], lines, most=most)


def points_of(curves: list[Drawn]) -> list[tuple[str, tuple[float, float]]]:
    """Points of codimension two that have a label, each once: (type, place)."""
    places = {(kind, f"{p:.9g}", f"{q:.9g}"): (p, q) for curve in curves for kind, p, q in curve.special}
    return [(kind, place) for (kind, _, _), place in places.items() if kind in SHORT]


def _filled(curve: Drawn, pieces: int = 8) -> np.ndarray:
    """(points, 2) of a curve, with more on its chords."""
    at, share = np.column_stack([curve.p, curve.q]), np.arange(pieces)[:, None, None] / pieces
    return np.concatenate([((1 - share) * at[:-1] + share * at[1:]).reshape(-1, 2), at[-1:]])


def handles(curves: list[Drawn], frame=None) -> list[Line2D]:
    """The handles of a legend: the types, what thin and dotted lines mean where there are any, and the names of points.

    frame : ((left, right), (low, high)) of the picture, where that is not all
    """
    by_period = _by_period(curves)
    if frame is not None:
        curves = [_within(curve, *frame) for curve in curves]
        curves = [curve for curve in curves if len(curve.p)]
    result = {}
    for curve in sorted(curves, key=lambda curve: (list(COLOURS).index(curve.type), curve.period)):
        colour, label = _style(curve, by_period)
        result.setdefault(label, Line2D([], [], color=colour, lw=1.2, label=label))
    result = list(result.values())
    if any(curve.bounds is not None and not curve.bounds.all() for curve in curves):
        result.append(Line2D([], [], color=INK, lw=0.5, label="of unstable orbits"))
    if any(curve.virtual.any() for curve in curves):
        result.append(Line2D([], [], color=INK, ls=VIRTUAL, lw=0.8, label="virtual"))
    kinds = {kind for kind, _ in points_of(curves)}
    if kinds and len(curves) > MANY:
        result.append(Line2D([], [], **_dot(2.0) | {"mfc": INK}, label="points of codimension two"))
    else:
        named = [row for row in CODIMENSION_TWO if row.name in kinds]
        result += [Line2D([], [], **_dot(3.0), label=f"{row.label} {_words(row.name)}") for row in named]
    return result


def _words(name: str) -> str:
    """The name of a type of point, as texts have it."""
    text = name.replace("resonance_1_", "resonance 1:")
    for kind in COLOURS:
        text = text.replace(kind, BY_NAME[kind].words)
    words = text.split("_")
    return (" + " if words[0] in {BY_NAME[kind].words for kind in COLOURS} else " ").join(words)


def _dot(size: float) -> dict:
    return {"ls": "none", "marker": "o", "color": INK, "ms": size, "mew": 0.6, "mfc": "white"}


def _within(curve: Drawn, across, up) -> Drawn:
    """The part of a curve that lies in a frame."""
    inside = (across[0] <= curve.p) & (curve.p <= across[1]) & (up[0] <= curve.q) & (curve.q <= up[1])
    special = [point for point in curve.special if across[0] <= point[1] <= across[1] and up[0] <= point[2] <= up[1]]
    bounds = None if curve.bounds is None else curve.bounds[inside]
    return curve._replace(
        p=curve.p[inside], q=curve.q[inside], virtual=curve.virtual[inside], special=special, bounds=bounds
    )


def _by_period(curves: list[Drawn]) -> dict[int, str]:
    """period -> colour, where most curves have one type and a legend of types would distinguish nothing; else none.

    The shortest periods have a colour each, all others the one of their type.
    """
    if len(curves) > MANY:
        return {}
    types = Counter(curve.type for curve in curves)
    ((common, count),) = types.most_common(1) or [("", 0)]
    periods = sorted({curve.period for curve in curves if curve.type == common})
    if count <= MOSTLY * len(curves) or len(periods) < DIFFERENT:
        return {}
    return {common: dict(zip(periods, ORBITS, strict=False))}


def _style(curve: Drawn, by_period) -> tuple[str, str]:
    """Colour and label of a curve."""
    name = BY_NAME[curve.type].words
    if curve.type not in by_period:
        return COLOURS[curve.type], name
    colour = by_period[curve.type].get(curve.period)
    return (colour, f"{name}, period {curve.period}") if colour else (COLOURS[curve.type], f"{name}, longer periods")
