"""The period written into the regions of a plane, where there is room for it."""

import numpy as np
from matplotlib import patheffects

from vibro_sweep.plotting.style import INK, type_size

STEP, MOST = 1.5, 400  # points (1/72 inch) between the places that are tried, at most so many along an axis
MARGIN = 1.0  # points around a text
DIGIT = 0.75  # the height of a digit over the size of its type


def name_regions(ax, x, y, values, boxes=()) -> None:
    """Write each period into the widest place of its regions, if the text has room there.

    x, y : corners of the cells, (columns + 1,) and (rows + 1,), or both (rows + 1, columns + 1)
    values : whole numbers (rows, columns), masked where there is none
    boxes : (2, 2) in pixels, in which other texts stand
    The axes have got their places and limits before (`labels.arrange`).
    """
    from scipy import ndimage  # slow to import

    low, high = ax.transAxes.transform([(0, 0), (1, 1)])
    step = max(STEP * ax.figure.dpi / 72, (high - low).max() / MOST)  # in pixels
    across, up = (np.arange(begin + step / 2, end, step) for begin, end in zip(low, high, strict=True))
    X, Y = (_numbers(ax, places, axis) for axis, places in enumerate((across, up)))
    shown = _at(X, Y, x, y, values.filled(-1).astype(int))
    for (left, bottom), (right, top) in boxes:
        shown[np.ix_((bottom <= up) & (up <= top), (left <= across) & (across <= right))] = -1
    for period in np.unique(shown[shown > 0]):
        text = ax.text(X[0], Y[0], f"{period}", fontsize=type_size(7), **_STYLE)
        size = text.get_window_extent().width * 72 / ax.figure.dpi, DIGIT * text.get_fontsize()
        # odd numbers of places: they reach as far to one side as to the other
        width, height = (int(np.ceil((length + 2 * MARGIN) * ax.figure.dpi / 72 / step)) | 1 for length in size)
        inside = np.pad(shown == period, 1)  # the frame is a border, too
        fits = ndimage.minimum_filter(inside, (height, width), mode="constant", cval=0)
        if not fits.any():
            text.remove()
            continue
        room = np.where(fits, ndimage.distance_transform_edt(inside), 0)
        row, column = np.unravel_index(np.argmax(room), room.shape)
        text.set_position((X[column - 1], Y[row - 1]))


_STYLE = {
    "ha": "center", "va": "center", "color": INK, "clip_on": True, "gid": "period",
    "path_effects": [patheffects.withStroke(linewidth=2, foreground="white")],
}  # fmt: skip


def _numbers(ax, pixels, axis) -> np.ndarray:
    """The values along an axis, 0 or 1, at pixels (n,)."""
    places = np.zeros((len(pixels), 2))
    places[:, axis] = pixels
    return ax.transData.inverted().transform(places)[:, axis]


def _at(X, Y, x, y, values) -> np.ndarray:
    """The values at all pairs of X (n,) and Y (m,): (m, n); -1 outside of the cells."""
    if x.ndim == 1:
        return _table(_cell(X, x), _cell(Y, y), values)
    if np.ptp(x, axis=0).max() > 0:  # the other way round
        return _at(Y, X, y.T, x.T, values.T).T
    columns = _cell(X, x[0])
    result = np.full((len(Y), len(X)), -1)
    for i in np.unique(columns[columns >= 0]):
        rows = _cell(Y, (y[:, i] + y[:, i + 1]) / 2)
        result[:, columns == i] = np.where(rows >= 0, values[rows, i], -1)[:, None]
    return result


def _cell(places, borders) -> np.ndarray:
    """The index of the cell between rising borders (k + 1,) in which each place lies; -1: in none."""
    index = np.searchsorted(borders, places, side="right") - 1
    return np.where((index >= 0) & (index < len(borders) - 1), index, -1)


def _table(columns, rows, values) -> np.ndarray:
    known = (rows >= 0)[:, None] & (columns >= 0)
    return np.where(known, values[np.ix_(rows, columns)], -1)
