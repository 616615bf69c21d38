"""Several attractors at one value of the parameter: which there are, and how many starts reach each."""

import itertools
from typing import NamedTuple

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from vibro_sweep.oscillator.catalogue import BY_NAME
from vibro_sweep.plotting.drawn_sweep import DrawnSweep, Point
from vibro_sweep.plotting.families import KINDS, MARKERS, colours, kind, named
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.labels import arrange, legend_below, overlap
from vibro_sweep.plotting.style import at_section, edges, marked, type_size
from vibro_sweep.plotting.sweeps import mark_grazing

NARROW = 0.012  # of the axis; the period of a window is written over it where it is wider


class Share(NamedTuple):
    """An attractor at one value of the parameter, and the part of the starts that reach it."""

    place: int  # of the value, along the axis
    point: tuple[int, int]  # of the first start that reaches it, in the file
    kind: str
    period: int
    share: float
    mean: float  # of x1 over the section points
    number: float  # in the file, by which it has its colour; 0 where the file does not number attractors


def shows(result: DrawnSweep) -> bool:
    """A sweep over one key with several starts; attractors."""
    return len(result.sweep) == 1 and len(result.starts) > 1 and "attractor" in result


@picture(shows)
def coexistence(result: DrawnSweep) -> Panels:
    """Over the parameter: section points of each attractor, or their mean; below, the starts' shares, stacked."""
    ((key, values),) = result.sweep.items()
    order = np.argsort(values)  # a sweep may run downwards; an axis does not
    values, attractors = values[order], _shares(result, order)

    def draw(axes):
        above, below = axes[:, 0]
        _points(above, result, values, attractors)
        _stacks(below, values, attractors)
        if key == "b":
            mark_grazing((above, below), result, values[0], values[-1])
        below.set(xlim=edges(values)[[0, -1]], ylim=(0, 1), xlabel=result.axis(key), ylabel=BY_NAME["share"].label)
        kinds = {attractor.kind for attractor in attractors}
        shown = [(which, colour) for which, (_, colour) in KINDS.items() if which in kinds]
        marks = {named(which, result.meeting): marked(colour, MARKERS.get(which, "")) for which, colour in shown}
        marks |= {line.get_label(): line for line in above.lines if line.get_gid() == "grazing"}
        legend_below(axes, list(marks.values()), 3, labels=list(marks))
        above.figure.align_ylabels(axes[:, 0])
        _name_windows(below, values, attractors)

    title = result.title(f"Coexisting attractors; {len(result.starts)} starts at each value")
    return Panels(title, 5.8, draw, 2, grid={"sharex": True, "height_ratios": (1.6, 1)})


def _shares(result, order) -> list[Share]:
    """Every attractor at every value, in the order in which they are stacked."""
    label, share, period = (result.array(name)[order] for name in ("attractor", "share", "period"))
    # where the file does not number the attractors (it is not complete), by period and share
    number = result.array("attractor_id")[order] if "attractor_id" in result else np.full(label.shape, np.nan)
    average = result.array("average")[order]
    rank = list(KINDS)
    attractors = []
    for place in range(len(label)):
        here = []
        for rank_here in np.unique(label[place][label[place] >= 0]):
            members = np.flatnonzero(label[place] == rank_here)
            first, least = members[0], int(period[place, members].min())
            which, mean = str(kind(least, average[place, first])), average[place, members, 0].mean()
            known = np.nan_to_num(number[place, first])
            here.append((known, Share(place, (order[place], first), which, least, share[place, first], mean, known)))
        here.sort(key=lambda pair: (rank.index(pair[1].kind), pair[0], pair[1].period, -pair[1].share))
        attractors += [share for _, share in here]
    return attractors


def _points(ax, result, values, attractors):
    """x1 at the section, of one orbit on each attractor; its mean where the points are not stored."""
    stored = "x1" in result and "phase" not in result
    ax.set_ylabel(("" if stored else "mean of ") + at_section("x1") + result.unit("x1"))
    size = np.clip(60 / np.sqrt(len(values)), 1.5, 6) * (0.5 if stored else 1)
    colour_of = _colours(attractors)
    for which, number in dict.fromkeys((a.kind, a.number) for a in attractors if a.kind != "unsettled"):
        chosen = [attractor for attractor in attractors if (attractor.kind, attractor.number) == (which, number)]
        y = [result.at_point("x1", Point(a.point, a.point[:1], "")) if stored else [a.mean] for a in chosen]
        x = [np.full(len(points), values[attractor.place]) for attractor, points in zip(chosen, y, strict=True)]
        scale = 1.0 if MARKERS[which] == "." else 0.7  # that one is drawn at half its size
        dots = {"markersize": scale * size, "markeredgewidth": 0, "rasterized": True}
        ax.plot(np.concatenate(x), np.concatenate(y), MARKERS[which], color=colour_of[chosen[0]], **dots)


def _colours(attractors) -> dict[Share, tuple | str]:
    """The colour of each: that of its number in the file, else that of its kind."""
    by_number = colours({attractor.number: attractor.kind for attractor in attractors if attractor.number > 0})
    return {attractor: by_number.get(attractor.number, KINDS[attractor.kind][1]) for attractor in attractors}


def _stacks(ax, values, attractors):
    """A column for each value, of one part for each attractor; a line between parts of one colour."""
    borders, top = edges(values), np.zeros(len(values))
    parts, facecolours, seams, colour_of = [], [], [], _colours(attractors)
    for before, attractor in itertools.pairwise([None, *attractors]):
        left, right, low = borders[attractor.place], borders[attractor.place + 1], top[attractor.place]
        top[attractor.place] = high = low + attractor.share
        parts.append([(left, low), (right, low), (right, high), (left, high)])
        facecolours.append(colour_of[attractor])
        if before and (before.place, before.kind) == (attractor.place, attractor.kind):
            seams.append([(left, low), (right, low)])
    ax.add_collection(PolyCollection(parts, facecolors=facecolours, linewidth=0))
    ax.add_collection(LineCollection(seams, colors="white", linewidth=0.6))


def _name_windows(ax, values, attractors):
    """Over each window the period of the motion that most starts reach."""
    widest = {}  # place -> the attractor
    for attractor in attractors:
        if attractor.place not in widest or attractor.share > widest[attractor.place].share:
            widest[attractor.place] = attractor
    arrange(ax.figure)
    borders, boxes = edges(values), []
    for period, window in itertools.groupby(widest.values(), key=lambda attractor: attractor.period):
        places = [attractor.place for attractor in window]
        left, right = borders[places[0]], borders[places[-1] + 1]
        if period > 0 and right - left > NARROW * (borders[-1] - borders[0]):
            above = {"xy": ((left + right) / 2, 1.0), "xycoords": ax.get_xaxis_transform(), "xytext": (0, 2)}
            text = ax.annotate(f"{period}", **above, textcoords="offset points", ha="center", fontsize=type_size(7))
            box = text.get_window_extent().get_points()
            if any(overlap(box, box_before) for box_before in boxes):
                text.remove()
            else:
                boxes.append(box)
    ax.annotate(
        "period", (1.012, 1.0), (0, 2), xycoords="axes fraction", textcoords="offset points", fontsize=type_size(7)
    )
