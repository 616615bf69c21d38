"""Texts that cover neither each other nor marks: names beside points, labels of ticks, legends as wide as the page."""

import numpy as np
from matplotlib import patheffects

from vibro_sweep.plotting.figure import Picture
from vibro_sweep.plotting.style import type_size

GAP = 2.5  # points (1/72 inch) between a name and what is beside it
MARK = 2.4  # points from the middle of a mark to its edge, with the white rim of a name
SAME = 4.0  # points between marks of one name, of which nearer ones have it once
CORNERS = ((1, 1), (-1, 1), (1, -1), (-1, -1))  # of a mark, where its name may stand
SIZES, HIGHEST = (8, 7, 6, 5), 0.35  # of the type of a legend, and the part of the page that it takes at most
ABOVE = {"loc": "lower right", "bbox_to_anchor": (1, 1), "borderaxespad": 0.1}  # a legend above its panel
APART = 1.5  # points between the labels of neighbouring ticks


def arrange(fig) -> None:
    """Let the figure give its axes their places, which depend on all titles, labels and legends."""
    if (layout := fig.get_layout_engine()) is not None:
        layout.execute(fig)


def name_beside(ax, names, places, lines=(), taken=(), most=None) -> list[np.ndarray]:
    """Write names beside marks, each where it covers no mark, no other name and the fewest points of lines.

    names, places : of the marks, places (n, 2) in the numbers of the axes; lines : (m, 2), points on curves
    taken : boxes (2, 2) in pixels that are to stay free, from the lower left to the upper right
    most : names that are written at most
    Returns the boxes that are taken afterwards. What has no room has no name. `arrange` comes before.
    """
    scale, to_pixels = ax.figure.dpi / 72, ax.transData.transform
    marks, lines = (to_pixels(np.reshape(points, (-1, 2))) for points in (places, lines))
    frame, boxes, written = ax.transAxes.transform([(0, 0), (1, 1)]), list(taken), []
    sizes = {name: _size(ax, name) for name in dict.fromkeys(names)}
    for name, place, mark in zip(names, places, marks, strict=True):
        if most is not None and len(written) >= most:
            break
        if any(name == name_before and np.hypot(*(mark - at)) < scale * SAME for name_before, at in written):
            continue
        free_corner = _free_corner(sizes[name], mark, scale, marks, lines, frame, boxes)
        if free_corner is None:
            continue
        (right, up), box = free_corner
        style = _NAME | {
            "size": type_size(6),
            "ha": "left" if right > 0 else "right",
            "va": "bottom" if up > 0 else "top",
        }
        ax.annotate(name, place, (right * GAP, up * GAP), textcoords="offset points", annotation_clip=True, **style)
        boxes.append(box)
        written.append((name, mark))
    return boxes


_NAME = {
    "zorder": 5, "gid": "name", "clip_on": True,
    "path_effects": [patheffects.withStroke(linewidth=1.8, foreground="white")],
}  # fmt: skip


def _size(ax, name: str) -> np.ndarray:
    """Width and height of a name in pixels."""
    text = ax.text(0, 0, name, size=type_size(6), **_NAME)
    size = text.get_window_extent().size
    text.remove()
    return size


def _free_corner(size, mark, scale, marks, lines, frame, taken):
    """((+-1, +-1), box) of the corner of a mark where a name of this size covers no mark and no taken box, and the
    fewest points of lines; None where there is no such corner within the frame."""
    best, gap, rim = None, scale * GAP, scale * MARK * np.array([[-1.0], [1.0]])
    for corner in CORNERS:
        ends = mark + gap * np.array(corner), mark + (gap + size) * corner
        box = np.array([np.minimum(*ends), np.maximum(*ends)])
        inside = np.all((frame[0] <= box) & (box <= frame[1]))
        if not inside or _within(marks, box + rim) or any(overlap(box, other) for other in taken):
            continue
        covered = _within(lines, box)
        if best is None or covered < best[0]:
            best = covered, corner, box
    return best and best[1:]


def overlap(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two boxes (2, 2) have a common point."""
    return bool(np.all((first[0] <= second[1]) & (second[0] <= first[1])))


def _within(points: np.ndarray, box: np.ndarray) -> int:
    return int(np.count_nonzero(np.all((box[0] <= points) & (points <= box[1]), axis=1)))


def thin_ticks(bar, first: float = 0.0) -> None:
    """Keep of the ticks of a horizontal colour bar those whose labels do not overlap: `first`, both ends, and what
    has room in between."""
    scale = APART * bar.ax.figure.dpi / 72
    if (locator := bar.ax.get_axes_locator()) is not None:  # the arrows at the ends take a part of its place
        bar.ax.apply_aspect(locator(bar.ax, None))
    low, high = bar.ax.get_xlim()
    labelled = [(place, text) for place, text in zip(bar.ax.get_xticks(), bar.ax.get_xticklabels(), strict=True)]
    labelled = [(place, text) for place, text in labelled if low <= place <= high]
    if not labelled:
        return
    places, texts = np.array([place for place, _ in labelled]), [text for _, text in labelled]
    spans = [(box.x0 - scale, box.x1) for box in (text.get_window_extent() for text in texts)]
    begin, kept = int(np.argmin(np.abs(places - first))), []
    order = [begin, len(places) - 1, 0, *range(begin + 1, len(places)), *range(begin - 1, 0, -1)]
    for i in dict.fromkeys(order):
        if all(spans[i][1] < spans[j][0] or spans[j][1] < spans[i][0] for j in kept):
            kept.append(i)
    if len(kept) < len(places):
        kept.sort()
        power = bar.ax.xaxis.get_major_formatter().get_offset()  # of ten, by which all labels are to be multiplied
        bar.set_ticks(places[kept], labels=[texts[i].get_text() for i in kept])
        bar.ax.xaxis.get_major_formatter().set_offset_string(power)


def legend_below(axes, handles, most: int, grow: bool = False, **style) -> None:
    """A legend below all axes, in so many columns, at most, as the page has room for; within those of the caller.

    style : options of matplotlib's legend

    grow : the page becomes higher by all but the first two of its rows; a narrow page does, unless its size is given
    """
    ax = np.ravel(axes)[0]
    fig = ax.figure
    if not handles:
        return
    if not (isinstance(fig, Picture) and fig.being_drawn):  # the figure is the caller's; a legend that is there stays
        if old := ax.get_legend():
            ax.add_artist(old)
        ax.legend(handles=handles, **style | {"loc": "best", "frameon": True})
        return
    narrow = fig.narrow
    grow = fig.grows if narrow else grow
    sizes = (None,) if grow or narrow else SIZES
    for size in sizes:
        for columns in range(min(most, len(handles)), 0, -1):
            where = {"loc": "outside lower center", "ncols": columns, "fontsize": size}
            legend = fig.legend(handles=handles, **where | style)
            extent = legend.get_window_extent()
            if columns == 1 or extent.width <= fig.bbox.width:
                break
            legend.remove()
        if extent.width > fig.bbox.width:
            for text in legend.get_texts():
                text.set_text(text.get_text().replace(", ", ",\n", 1))
        if extent.height <= HIGHEST * fig.bbox.height or size == sizes[-1]:
            break
        legend.remove()
    rows = -(-len(handles) // columns)
    if grow and rows > 2:
        fig.set_figheight(fig.get_figheight() + (1 - 2 / rows) * extent.height / fig.dpi)
