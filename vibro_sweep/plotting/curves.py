"""Charts: bifurcation curves in the plane of two parameters, with their points of codimension two."""

from typing import NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib import patheffects
from matplotlib.lines import Line2D

from vibro_sweep.model.bifurcations import CODIMENSION_TWO
from vibro_sweep.plotting.style import FAINT, INK, STYLE, axis_name, page

COLOURS = {
    "fold": "#2f8fd8",
    "flip": "#e0a030",
    "pitchfork": "#b2182b",
    "neimark_sacker": "#1a1a5e",
    "graze": FAINT,
    "sticking": "#9600fa",
}
LABELS = {"neimark_sacker": "Neimark-Sacker"}
LETTER, LINE, GAP = 4.8, 7.5, 2.5  # points: width of a letter of a name, its height, its distance from what is beside
CORNERS = ((1, 1), (-1, 1), (1, -1), (-1, -1))  # of a mark, where its name may stand
VIRTUAL = (0, (1, 1.5))  # dots of what is no motion
MANY = 100  # curves
SHORT = {one.name: one.label for one in CODIMENSION_TWO if one.label}


class Drawn(NamedTuple):
    """A curve: its type, both parameters and `virtual` (points,), points of codimension two as (type, p, q); whether it
    bounds attractors (points,), or None where that is not shown."""

    type: str
    p: np.ndarray
    q: np.ndarray
    virtual: np.ndarray
    special: list[tuple[str, float, float]]
    bounds: np.ndarray | None = None


def plot_curves(curves: list[Drawn], names: tuple[str, str]):
    """All curves in one panel. Returns a matplotlib Figure."""
    with mpl.rc_context(STYLE):
        fig = page(4.2, "bifurcation curves")
        ax = fig.subplots()
        draw(ax, curves)
        ax.set(xlabel=axis_name(names[0]), ylabel=axis_name(names[1]))
        fig.legend(handles=handles(curves), loc="outside lower center", ncols=6)
        name_points(ax, curves)
        return fig


def draw(ax, curves: list[Drawn], halo: bool = False) -> None:
    """The lines: virtual parts dotted, parts that bound no attractor thin. halo: with a white rim, over a picture.

    Many curves have thin lines and no rims.
    """
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
                ax.plot(p, q, color=COLOURS[curve.type], **style)


def _joined(shown: np.ndarray) -> np.ndarray:
    """With the points beside, so that parts of a line touch."""
    result = shown.copy()
    result[1:] |= shown[:-1]
    return result


def name_points(ax, curves: list[Drawn], most: int | None = None) -> None:
    """Points of codimension two, and names of those that stand alone. most : over a picture, where few have room."""
    places = {(kind, f"{p:.9g}", f"{q:.9g}"): (p, q) for curve in curves for kind, p, q in curve.special}
    points = [(SHORT[kind], place) for (kind, _, _), place in places.items() if kind in SHORT]
    many = len(curves) > MANY
    size = {"ms": 0.7, "mew": 0} if many else {"ms": 3.5 if most is None else 2.2, "mew": 0.6, "mfc": "white"}
    for _, place in points:
        ax.plot(*place, "o", color=INK, zorder=4, gid="special", **size)
    if many:  # no room for names
        return
    ax.autoscale_view()  # else transforms know neither the limits yet,
    if (layout := ax.figure.get_layout_engine()) is not None:
        layout.execute(ax.figure)  # nor where the axes will be
    to_points, scale = ax.transData.transform, 72 / ax.figure.dpi
    marks = scale * to_points([place for _, place in points]).reshape(-1, 2)
    lines = scale * np.concatenate([to_points(_filled(curve)) for curve in curves])
    frame = scale * ax.transAxes.transform([(0, 0), (1, 1)])
    taken: list[np.ndarray] = []  # boxes (2, 2) of names, from the lower left to the upper right
    for (name, place), mark in zip(points, marks, strict=True):
        found = _free_corner(name, mark, marks, lines, frame, taken)
        if found is None or len(taken) >= (most or len(points)):
            continue
        (right, up), box = found
        halo = [patheffects.withStroke(linewidth=1.8, foreground="white")] if most is not None else None
        ax.annotate(
            name, place, (right * GAP, up * GAP), textcoords="offset points", size=6, path_effects=halo, zorder=5,
            ha="left" if right > 0 else "right", va="bottom" if up > 0 else "top", clip_on=True, annotation_clip=True,
        )  # fmt: skip
        taken.append(box)


def _free_corner(name: str, mark, marks, lines, frame, taken):
    """((+-1, +-1), box) of the corner of a mark where its name covers no mark and no other name, and the fewest points
    of lines; None where there is no such corner within the frame. All in points of the page."""
    size, best = np.array([LETTER * len(name) + GAP, LINE]), None
    for corner in CORNERS:
        ends = mark + GAP * np.array(corner), mark + (GAP + size) * corner
        box = np.array([np.minimum(*ends), np.maximum(*ends)])
        inside = np.all((frame[0] <= box) & (box <= frame[1]))
        apart = all(np.any((box[1] < other[0]) | (other[1] < box[0])) for other in taken)
        if not inside or not apart or _within(marks, box):
            continue
        covered = _within(lines, box)
        if best is None or covered < best[0]:
            best = covered, corner, box
    return best and best[1:]


def _filled(curve: Drawn, pieces: int = 8) -> np.ndarray:
    """(points, 2) of a curve, with more on its chords."""
    at, share = np.column_stack([curve.p, curve.q]), np.arange(pieces)[:, None, None] / pieces
    return np.concatenate([((1 - share) * at[:-1] + share * at[1:]).reshape(-1, 2), at[-1:]])


def _within(points: np.ndarray, box: np.ndarray) -> int:
    return int(np.count_nonzero(np.all((box[0] <= points) & (points <= box[1]), axis=1)))


def handles(curves: list[Drawn]) -> list[Line2D]:
    """Of a legend: the types, and what thin and dotted lines mean where there are any."""
    there = [kind for kind in COLOURS if any(curve.type == kind for curve in curves)]
    found = [Line2D([], [], color=COLOURS[kind], lw=1.2, label=LABELS.get(kind, kind)) for kind in there]
    if any(curve.bounds is not None and not curve.bounds.all() for curve in curves):
        found.append(Line2D([], [], color=INK, lw=0.5, label="of unstable orbits"))
    if any(curve.virtual.any() for curve in curves):
        found.append(Line2D([], [], color=INK, ls=VIRTUAL, lw=0.8, label="virtual"))
    return found
