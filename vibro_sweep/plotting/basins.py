"""Basins of attraction: where the motion ends, over a plane of initial states."""

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch

from vibro_sweep.attractors import NOT_SETTLED, group
from vibro_sweep.plotting.families import KINDS, describe, kind
from vibro_sweep.plotting.result import Result
from vibro_sweep.plotting.style import NOT_COMPUTED, SYMBOLS, axis_name, edges, page

NAMED = 11  # attractors that the legend has room for
_SHADES = (0.0, 0.45, -0.35, 0.7)  # of attractors of one kind, towards white or black


def shows(result: Result) -> bool:
    return len(result.sweep) == 2 and all(key.startswith("start_") for key in result.sweep) and "average" in result


def basins(result: Result):
    """The plane of initial states, each in the colour of the attractor that its orbit reaches."""
    (x_key, x), (y_key, y) = result.sweep.items()
    columns, rows = np.argsort(x), np.argsort(y)  # a sweep may run downwards; an axis does not
    label, named = _attractors(result)
    fig = page(5.6, result.title("Basins of attraction" + _rest(result)))
    ax = fig.subplots()
    picture = np.full((*label.shape, 3), to_rgb(NOT_COMPUTED))
    for number, (colour, _) in named.items():
        picture[label == number] = colour
    image = picture[np.ix_(columns, rows)].transpose(1, 0, 2)
    ax.pcolorfast(edges(x[columns]), edges(y[rows]), image)
    ax.set(xlabel=axis_name(x_key), ylabel=axis_name(y_key))
    handles = [Patch(color=colour, label=text) for colour, text in named.values()]
    fig.legend(handles=handles, loc="outside lower center", ncols=2)
    return fig


def _attractors(result):
    """The number of each state's attractor, of the sweep's shape; and for each number its colour and its name.

    Those beyond `NAMED` share a number. 0: not settled; -1: not computed, or failed.
    """
    period, average, error = (result.array(name)[:, :, 0] for name in ("period", "average", "average_error"))
    at_point = result.array("attractor")[:, :, 0]
    average[~(at_point > NOT_SETTLED)] = np.nan
    whole = np.nan_to_num(period).astype(int).ravel()
    label = group(whole, average.reshape(-1, 7), error.reshape(-1, 7)).reshape(at_point.shape)
    label[np.isnan(at_point)] = -1
    label = np.minimum(label, NAMED + 1)
    named, seen = {}, {}
    for number in np.unique(label[label >= 0]):
        members = label == number
        least, of_it = int(period[members].min()), average[members].mean(axis=0)
        which, text = kind(least, of_it), describe(least, of_it)
        if number > NAMED:
            which, text = "unsettled", "others"
        seen[which] = seen.get(which, -1) + 1
        named[number] = (_shade(KINDS[which][1], seen[which]), f"{text} ({100 * members.mean():.3g} %)")
    return label, named


def _shade(colour, n):
    towards = _SHADES[n % len(_SHADES)]
    end = 1.0 if towards > 0 else 0.0
    return tuple((1 - abs(towards)) * part + abs(towards) * end for part in to_rgb(colour))


def _rest(result) -> str:
    """The part of the initial state that is the same everywhere."""
    same = [key for key in SYMBOLS if key.startswith("start_") and key not in result.sweep]
    given = {key: float(result.setting("start", key.removeprefix("start_")) or 0) for key in same}
    return "; " + ", ".join(f"${SYMBOLS[key]} = {value:.6g}$" for key, value in given.items())
