"""The windows of a sweep as a strip below its diagram: a bar for each, with what ends it, and reasons in between."""

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.plotting.ragged import RaggedFile
from vibro_sweep.plotting.scales import along_axis
from vibro_sweep.plotting.style import FAINT, SPECIAL, edges, special_mark, type_size
from vibro_sweep.tables.file_columns import WINDOWS
from vibro_sweep.tables.outcomes import REASONS, names

HEIGHT = 1.5  # inches
LANES = 6  # bars of windows that overlap lie above each other
MANY = 30  # windows in a picture, of more the marks are smaller
APART = 0.012  # of the axis: bars in one lane are so far apart at least
HATCH, HATCHES = "/////", "#33475b"
BAR, SYMMETRIC = "#9fd0ea", "#dcc9a0"
REASON_COLOURS = {
    "chaos": "#b2182b",
    "quasi_periodic": "#7b3294",
    "sticking": "#446644",
    "not_settled": "#8a8a96",
    "failed": "#000000",
    "not_computed": "#f2f2f5",
    "not_isolated": "#f0a030",
    "permanent_contact": "#7fae7f",
    "unrelaxed": "#c9a0dc",
    "turning": "#5b8fb9",
}


def windows(ax, result: DrawnSweep, values, order):
    """The strip of the windows file that the options name."""
    file = _windows_of(result)
    left, right = values[0], values[-1]
    lo, hi = np.maximum(file["window_lo"], left), np.minimum(file["window_hi"], right)
    shown = np.flatnonzero(hi >= lo)
    to, back = along_axis(values)
    begin, end, length = to(lo[shown]), to(hi[shown]), to(right) - to(left)
    lanes = lanes_of(begin, end, APART * length)
    for chosen, colour, name in ((0, BAR, "not symmetric"), (1, SYMMETRIC, "symmetric")):
        bars = [
            [(lo[w], lane - 0.32), (hi[w], lane - 0.32), (hi[w], lane + 0.32), (lo[w], lane + 0.32)]
            for w, lane in zip(shown, lanes, strict=True)
            if file["window_symmetric"][w] == chosen
        ]
        ax.add_collection(PolyCollection(bars, facecolor=colour, edgecolor=FAINT, linewidth=0.4, label=name))
    unvisited = _unvisited(ax, file, shown, lanes, (left, right))
    _ends(ax, file, shown, lanes, (left, right))
    wide = end - begin >= (0.08 if getattr(ax.figure, "narrow", False) else 0.03) * length
    _periods(ax, file, shown[wide], np.array(lanes)[wide], back((begin + end) / 2)[wide])
    reasons = _reasons(ax, result, file, values, order)
    ax.set_ylim(max(lanes, default=0) + 0.7, -1.6)
    ax.set_yticks([])
    ax.set_ylabel("windows")
    _legend(ax, file, shown, unvisited, (left, right), reasons)


def _windows_of(result: DrawnSweep) -> RaggedFile:
    file = RaggedFile(result.options.windows, WINDOWS, result.display)
    if file.sweep != str(result.settings.get("identity", "")) or sorted(file.parameters) != sorted(result.sweep):
        raise PlotError(f"windows: {file.name} has the windows of another sweep than {result.path}")
    return file


def ends_over(ax, result: DrawnSweep) -> None:
    """Draw what ends the windows of a plane, row by row, on the picture of the plane."""
    file = _windows_of(result)
    types, frame = np.array(file.types()), (ax.get_xlim(), ax.get_ylim())
    ends = np.append(file["window_lower"], file["window_upper"])
    order = [file.parameters.index(name) for name in result.sweep]
    rows = max(int(file["window_row"].max(initial=0)) + 1, 1)
    for kind, (short, name, *_) in SPECIAL.items():
        places = file["special_value"][ends[types[ends] == kind]][:, order]
        if len(places):
            style = special_mark(kind, min(2.4, 60 / rows)) | {"markeredgewidth": 0.3}
            ax.plot(*places.T, label=f"{short} {name}", gid="window end", **style)
    ax.set(xlim=frame[0], ylim=frame[1])


def lanes_of(lo: np.ndarray, hi: np.ndarray, apart: float) -> list[int]:
    """The lane of each interval: the first in which the interval before it has ended; the last lane takes what is
    left."""
    ends, result = [-np.inf] * LANES, [0] * len(lo)
    for i in np.argsort(lo, kind="stable"):
        lane = next((n for n, end in enumerate(ends) if end + apart <= lo[i]), LANES - 1)
        ends[lane] = max(ends[lane], hi[i])
        result[i] = lane
    return result


def _unvisited(ax, file, shown, lanes, limits) -> bool:
    """Hatch the bars where the sweep shows other attractors only. Whether there are such stretches."""
    lane_of, hatched = dict(zip(shown.tolist(), lanes, strict=True)), []
    lows, highs = np.maximum(file["unvisited_lo"], limits[0]), np.minimum(file["unvisited_hi"], limits[1])
    for w, lo, hi in zip(file["unvisited_window"].tolist(), lows, highs, strict=True):
        if w in lane_of and lo <= hi:
            hatched.append([(x, lane_of[w] + y) for x, y in ((lo, -0.32), (hi, -0.32), (hi, 0.32), (lo, 0.32))])
    style = {"facecolor": "none", "edgecolor": HATCHES, "linewidth": 0, "hatch": HATCH, "gid": "unvisited"}
    ax.add_collection(PolyCollection(hatched, **style))
    return bool(hatched)


def _ends(ax, file, shown, lanes, limits):
    types, places_of = file.types(), {}
    size = 2.6 * min(1.0, (MANY / max(len(shown), 1)) ** 0.5)
    for w, lane in zip(shown, lanes, strict=True):
        for end, at in (("window_lower", "window_lo"), ("window_upper", "window_hi")):
            kind, value = types[file[end][w]], file[at][w]
            if kind in SPECIAL and limits[0] <= value <= limits[1]:
                places_of.setdefault(kind, []).append((value, lane))
    for kind, places in places_of.items():
        x, y = np.transpose(places)
        ax.plot(x, y, **special_mark(kind, size))


def _periods(ax, file, shown, lanes, middles):
    for w, lane, middle in zip(shown, lanes, middles, strict=True):
        text = str(file["window_period"][w])
        ax.text(middle, lane, text, ha="center", va="center", fontsize=type_size(6), clip_on=True)


def _reasons(ax, result, file, values, order) -> list[str]:
    """A band of the orbits that lie in no window; which reasons there are."""
    (swept,) = result.sweep.values()  # of which the picture may show a part
    reasons = file["orbit_reason"].reshape(len(swept), -1)[order]
    to, back = along_axis(values)
    borders, named = back(edges(to(values))), []
    for code, name in enumerate(names(REASONS)):
        chosen = np.flatnonzero((reasons == code).any(axis=1))
        if code and len(chosen):
            named.append(name)
            spans = [(borders[i], borders[i + 1] - borders[i]) for i in chosen]
            ax.broken_barh(spans, (-1.4, 0.6), facecolor=REASON_COLOURS[name], linewidth=0)
    return named


def _legend(ax, file, shown, unvisited, limits, reasons):
    types = file.types()
    chosen = {
        types[file[f"window_{end}"][w]]
        for w in shown
        for end, at in (("lower", "window_lo"), ("upper", "window_hi"))
        if limits[0] <= file[at][w] <= limits[1]
    }
    handles = [
        Line2D([], [], label=f"{SPECIAL[k][0]} {SPECIAL[k][1]}", **special_mark(k)) for k in SPECIAL if k in chosen
    ]
    symmetric = file["window_symmetric"][shown].astype(bool)
    colours = {"window, with its period": (BAR, ~symmetric), "symmetric orbit": (SYMMETRIC, symmetric)}
    handles += [Patch(facecolor=colour, label=name) for name, (colour, of_colour) in colours.items() if of_colour.any()]
    if unvisited:
        handles.append(Patch(facecolor=BAR, edgecolor=HATCHES, linewidth=0, hatch=HATCH, label="missed by all starts"))
    names = {name: name.replace("quasi_", "quasi-").replace("_", " ") for name in reasons}
    handles += [Patch(facecolor=REASON_COLOURS[name], label=label) for name, label in names.items()]
    where = {"loc": "upper left", "bbox_to_anchor": (1.005, 1.05)}
    page = ax.figure
    narrow = getattr(page, "narrow", False)
    if narrow:  # beside it there is no room
        where = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.1), "ncols": 2, "columnspacing": 0.8}
    legend = ax.legend(handles=handles, fontsize=type_size(6), handlelength=1.2, labelspacing=0.25, **where)
    if narrow and page.grows:
        page.set_figheight(page.get_figheight() + legend.get_window_extent().height / page.dpi)
