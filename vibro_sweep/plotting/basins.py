"""Basins of attraction: where the motion ends, over a plane of initial states."""

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch

from vibro_sweep.plotting.drawn_sweep import DrawnSweep, Point
from vibro_sweep.plotting.families import KINDS, colours, describe, kind, named
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.labels import legend_below
from vibro_sweep.plotting.style import INK, NOT_COMPUTED, edges, equation, marked
from vibro_sweep.tables.coordinates import MOST_MASSES, START, state

NAMED = 11  # attractors that the legend has room for
NEAR = 0.52  # of the plane's width or height, from its middle
OTHERS = np.inf  # number of all beyond these
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*", "<", ">", "h")  # of the attractors, the largest basin first


def shows(result: DrawnSweep) -> bool:
    """A sweep over two numbers of the start; attractors."""
    return len(result.sweep) == 2 and all(key.startswith("start_") for key in result.sweep) and "average" in result


@picture(shows)
def basins(result: DrawnSweep) -> Panels:
    """The plane of initial states, each in the colour of the attractor that its orbit reaches, as the file numbers it.

    A file without these numbers (not complete) shows of which kind the attractors are.
    """
    (x_key, x), (y_key, y) = result.sweep.items()
    columns, rows = np.argsort(x), np.argsort(y)  # a sweep may run downwards; an axis does not
    numbered = "attractor_id" in result and result.done.all()
    label, named = (_attractors if numbered else _kinds)(result)
    note = "" if numbered else "\nkinds of motion; this file does not number its attractors"
    stored = "x1" in result and "phase" not in result
    marks = "section points" if stored else "mean of the section points"
    note += f"\nmarks: {marks} of each attractor, projected onto this plane" if numbered else ""
    picture = np.full((*label.shape, 3), to_rgb(NOT_COMPUTED))
    for number, (colour, _) in named.items():
        picture[label == number] = colour

    def draw(axes):
        ax = axes[0, 0]
        image = picture[np.ix_(columns, rows)].transpose(1, 0, 2)
        ax.pcolorfast(edges(x[columns]), edges(y[rows]), image)
        ax.set(xlabel=result.axis(x_key), ylabel=result.axis(y_key))
        handles = [Patch(color=colour) for colour, _ in named.values()]
        if numbered:
            frame = ax.get_xlim(), ax.get_ylim()
            for i, (number, (colour, _)) in enumerate(named.items()):
                if number not in (0, OTHERS):
                    _mark(ax, result, label == number, MARKERS[i], stored)
                    handles[i] = marked(colour, MARKERS[i])
            ax.set(xlim=frame[0], ylim=frame[1])
        legend_below(ax, handles, 2, labels=[text for _, text in named.values()])

    return Panels(result.title("Basins of attraction" + _rest(result)) + note, 5.8, draw)


def _mark(ax, result, members, marker, stored):
    """Mark an attractor in the plane: section points of one orbit on it, or their mean."""
    place = tuple(map(int, np.argwhere(members)[0]))
    names = [key.removeprefix("start_") for key in result.sweep]
    if stored:
        x, y = (result.at_point(name, Point((*place, 0), place, "")) for name in names)
    else:
        average = result.at_point("average", Point((*place, 0), place, ""))
        x, y = ([average[state(MOST_MASSES).index(name)]] for name in names)
    # an attractor at the frame is marked as a whole
    frame = zip((x, y), (ax.get_xlim(), ax.get_ylim()), strict=True)
    near = all(abs(v - (low + high) / 2) < NEAR * (high - low) for values, (low, high) in frame for v in values)
    style = {"color": "white", "markeredgecolor": INK, "markeredgewidth": 0.8, "markersize": 4 if stored else 7}
    ax.plot(x, y, marker, **style, ls="none", clip_on=not near, gid="attractor")


def _attractors(result):
    """The number of each state's attractor, of the sweep's shape; and for each number its colour and its name.

    Those beyond the `NAMED` largest share a number. NaN: not computed, or failed.
    """
    label, period = (result.array(name)[:, :, 0] for name in ("attractor_id", "period"))
    average = result.array("average")[:, :, 0]
    numbers, counts = np.unique(label[label > 0], return_counts=True)
    others = numbers[np.argsort(-counts, kind="stable")][NAMED:]
    label[np.isin(label, others)] = OTHERS
    numbers, counts = np.unique(label[label >= 0], return_counts=True)
    kinds, texts = {}, {}
    for number in sorted(numbers, key=lambda n: (n == 0, n == OTHERS, -counts[numbers == n])):
        members = label == number
        least, of_it = period[members].min(), average[members].mean(axis=0)
        kinds[number], text = str(kind(least, of_it)), describe(least, of_it, result.meeting)
        if number in (0, OTHERS):
            kinds[number], text = "unsettled", "others" if number else KINDS["unsettled"][0]
        texts[number] = f"{text} ({100 * members.mean():.3g} %)"
    colour_of = colours(kinds)
    return label, {number: (colour_of[number], text) for number, text in texts.items()}


def _kinds(result):
    """The same as `_attractors`, for kinds of attractors."""
    names = list(KINDS)
    which = kind(result.array("period")[:, :, 0], result.array("average")[:, :, 0])
    label = np.select([which == name for name in names], range(len(names)), np.nan)
    rank = result.array("attractor")[:, :, 0]
    label[rank == 0] = names.index("unsettled")
    label[np.isnan(rank)] = np.nan
    shares = {number: np.mean(label == number) for number in np.unique(label[label >= 0])}
    return label, {
        number: (
            to_rgb(KINDS[names[int(number)]][1]),
            f"{named(names[int(number)], result.meeting)} ({100 * share:.3g} %)",
        )
        for number, share in shares.items()
    }


def _rest(result) -> str:
    """The part of the initial state that is the same everywhere."""
    rest_of_start = {key: result.number(key) for key in START.values() if key not in result.sweep}
    known = [equation(key, value) for key, value in rest_of_start.items() if value is not None]
    return "; " + ", ".join(known) if known else ""
