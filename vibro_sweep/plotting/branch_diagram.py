"""Branches of periodic orbits as the field draws them: stable solid, unstable dashed, special points labelled."""

from itertools import pairwise

import numpy as np
from matplotlib.lines import Line2D

from vibro_sweep.checks.refusals import shown
from vibro_sweep.plotting import multiplier_lines, sweeps
from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.labels import arrange, legend_below, name_beside
from vibro_sweep.plotting.measured import draw_measured
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.ragged import RaggedFile, in_units_of, sweep_below
from vibro_sweep.plotting.scales import scale_of
from vibro_sweep.plotting.style import (
    ARROWS,
    DASHES,
    FAINT,
    INK,
    LEFT,
    SPECIAL,
    axis_name,
    limits,
    special_mark,
    symbol,
)
from vibro_sweep.plotting.style import BRANCHES as BRANCH_COLOURS
from vibro_sweep.tables.bifurcations import ON_CIRCLE
from vibro_sweep.tables.coordinates import MOST_MASSES, state
from vibro_sweep.tables.file_columns import BRANCHES, OF_CONTACTS

LINES = (LEFT, "#c26a00", "#446644", "#7b3294", "#77541f", "#1a1a2e")  # of branches, in turn
COLUMN = {"impact_speed": "min_impact_speed"}  # of the file, where a variable has another name
MOST = 3.0  # modulus of a multiplier that is shown: at a graze it is infinite


def variables(file: RaggedFile) -> tuple[str, ...]:
    """The variables that may be drawn over the parameter."""
    return (*_sections(file), "impact_speed", "multiplier", "stop_distance", *_of_contacts(file))


def branches(path, options: PlotOptions) -> Panels:
    """The diagram of a file of branches; over a sweep where the options name one. Raises PlotError."""
    options = in_units_of(options, path)
    file = RaggedFile(path, BRANCHES, options.display)
    name = options.variable or "x1"
    if name not in variables(file):
        raise PlotError(f"variable {shown(name)} is not allowed; there are {', '.join(variables(file))}")
    if not len(file["branch_period"]):
        raise PlotError(f"{file.name}: nothing to show, it has no branches")
    if options.over is not None and "branch_sections" not in file.arrays:
        raise PlotError(f"{file.name}: a file of windows is not drawn over a sweep; draw the sweep, with these windows")
    title = f"Branches of periodic orbits: {file.title}"
    measurable = (file.parameters[0], name)
    return Panels(title, 5.0, lambda axes: _draw(axes[0, 0], file, name, options), measurable=measurable)


def _draw(ax, file: RaggedFile, name: str, options: PlotOptions) -> None:
    below = [] if options.over is None else _sweep(ax, options, file, name)
    values = values_of(file, name)
    together = (
        multiplier_lines.margins(file, _sections(file)) if name == "stop_distance" else np.ones(len(values), bool)
    )
    _lines(ax, file, _drawn(file, name, values, options.over is not None), together)
    marks = _marks(ax, file, values)
    if options.over is None:
        ax.set_xscale(scale_of(file.parameters[0], file[file.parameters[0]]))
    ax.set_xlabel(axis_name(file.parameters[0], file.unit(file.parameters[0])))
    if options.xlim:
        ax.set_xlim(options.xlim)
    if options.over is None:
        finite = values[_inside(file[file.parameters[0]], options.xlim)]
        finite = finite[np.isfinite(finite)]
        ax.set_ylim(options.ylim or (limits(finite) if finite.size else None))
        ax.set_ylabel(_label(name) + file.unit(COLUMN.get(name, name)))
    if name == "multiplier":
        ax.axhline(1, color=INK, lw=0.5)
        ax.set_ylim(0, min(1.05 * np.nanmax(values), MOST))
    visible = [(kind, place) for kind, place in marks if all(map(_inside, place, (ax.get_xlim(), ax.get_ylim())))]
    x = file.parameters[0]
    draw_measured(ax, options.points, (x, file.stored_unit(x)), (name, file.stored_unit(COLUMN.get(name, name))))
    _legend(ax, {kind for kind, _ in visible}, below)
    arrange(ax.figure)
    visible.sort(key=lambda mark: mark[0] != "sticking")  # where many accumulate, what they lead to is named
    y = np.reshape(values, (len(values), -1))
    lines = np.column_stack([np.repeat(file[file.parameters[0]], y.shape[1]), y.ravel()])
    name_beside(ax, [SPECIAL[kind][0] for kind, _ in visible], [place for _, place in visible], lines)


def _inside(values, limits):
    """Whether numbers lie between two limits; all do where there are none."""
    return (limits[0] <= values) & (values <= limits[1]) if limits else np.ones(np.shape(values), bool)


def values_of(file: RaggedFile, name: str) -> np.ndarray:
    """(points,) or (points, lines) what is drawn, of each point; NaN where it is not there."""
    if name == "multiplier":
        return multiplier_lines.multipliers(file)
    if name in ("impact_speed", "stop_distance"):
        found = file[COLUMN.get(name, name)].astype(float)
        return np.where(np.isfinite(found), found, np.nan)
    return file[name]


def _label(name: str) -> str:
    labels = {
        "impact_speed": "smallest impact speed",
        "multiplier": "modulus $|\\mu|$ of the multipliers",
        "stop_distance": "distance of the nearest turning point from its stop",
        **{column.name: column.label for column in OF_CONTACTS},
    }
    return labels.get(name) or f"{symbol(name)} at $t = 0$"


def _sections(file: RaggedFile) -> list[str]:
    return [name for name in state(MOST_MASSES) if name in file.arrays]


def _of_contacts(file: RaggedFile) -> list[str]:
    return [column.name for column in OF_CONTACTS if column.name in file.arrays]


def _lines(ax, file: RaggedFile, values: list[np.ndarray], together: np.ndarray) -> None:
    """Each branch between its special points, where alone its stability changes.

    together : (points,) whether a point is joined with the next one
    """
    p, special, begin = file[file.parameters[0]], file["special_point"], 0
    for number, size in enumerate(file["branch_row_size"].tolist()):
        inner = special[(special > begin) & (special < begin + size - 1)]
        for one, other in pairwise([begin, *np.unique(inner).tolist(), begin + size - 1]):
            line = slice(one, other + 1)
            stable = file["unstable"][(one + other) // 2] == 0
            style = {"ls": "-", "lw": 1.2} if stable else {"ls": DASHES, "lw": 0.7}
            style["color"], style["gid"] = LINES[number % len(LINES)], "stable" if stable else "unstable"
            gaps = np.flatnonzero(~together[one:other]) + 1
            for y in values[number]:
                shown = y[one - begin : other + 1 - begin]
                ax.plot(*(np.insert(part, gaps, np.nan) for part in (p[line], shown)), **style)
        begin += size


def _drawn(file: RaggedFile, name: str, values: np.ndarray, all_sections: bool) -> list[np.ndarray]:
    """The lines that are drawn of each branch, (lines, its points): over a sweep all section states, mirror images
    among them."""
    ends = np.cumsum(file["branch_row_size"])[:-1]
    if not all_sections:
        return [part.reshape(len(part), -1).T for part in np.split(values, ends)]
    sizes, counts = file["branch_row_size"], file["branch_sections"]
    parts = np.split(file[f"section_{name}"], np.cumsum(sizes * counts)[:-1])
    return [part.reshape(-1, count).T for part, count in zip(parts, counts, strict=True)]


def _marks(ax, file: RaggedFile, values: np.ndarray) -> list[tuple[str, tuple[float, float]]]:
    """Special points: (type, place). A line at the onset of sticking, where points accumulate."""
    x, y = file["special_value"][:, 0], values[_places(file)]
    if y.ndim == 2:
        y = np.array(
            [multiplier_lines.at_circle(m, kind in ON_CIRCLE) for m, kind in zip(y, file.types(), strict=True)]
        )
    marked = []
    for kind, at_x, at_y in zip(file.types(), x, y, strict=True):
        if kind not in SPECIAL or not np.isfinite(at_y):
            continue
        if kind == "sticking":
            ax.axvline(at_x, color=SPECIAL[kind][3], lw=0.6, ls=":", zorder=1, gid="sticking")
        ax.plot(at_x, at_y, gid="special", **special_mark(kind, 4.0), zorder=4.5 if kind == "sticking" else 4)
        marked.append((kind, (at_x, at_y)))
    return marked


def _places(file: RaggedFile) -> np.ndarray:
    """Points of the special points; of a sticking onset, which is not a point of a branch, the end of the branch before
    it."""
    point, branch = file["special_point"].copy(), file["special_branch"]
    for at in np.flatnonzero(point < 0):
        begins, ends = (int(file[name][branch[at]]) for name in ("branch_begins", "branch_ends"))
        point[at] = point[begins if at < begins else ends]
    return point


def _legend(ax, kinds: set[str], below: list[Line2D]) -> None:
    """What is drawn. below : handles of what lies below the branches"""
    handles = [Line2D([], [], color=INK, lw=1.2, label="stable")]
    handles.append(Line2D([], [], color=INK, lw=0.7, ls=DASHES, label="unstable"))
    handles += [
        Line2D([], [], label=f"{SPECIAL[k][0]} {SPECIAL[k][1]}", **special_mark(k)) for k in SPECIAL if k in kinds
    ]
    handles += below + [line for line in ax.lines if line.get_gid() in ("stop", "measured")]
    legend_below(ax, handles, 5)


def _sweep(ax, options: PlotOptions, file: RaggedFile, name: str) -> list[Line2D]:
    """The section points of a sweep, below everything; the handles of a legend for them."""
    with DrawnSweep(
        sweep_below(options.over), PlotOptions(variable=name, xlim=options.xlim, ylim=options.ylim, units=options.units)
    ) as result:
        if list(result.sweep) != file.parameters or name not in sweeps.section_variables(result):
            raise PlotError(f"over: {result.path} is not a sweep over {file.parameters[0]} with section points {name}")
        ((_, values),) = result.sweep.items()
        order = sweeps.in_range(result)
        sweeps.section(ax, result, values[order], order)
        for dots in (line for line in ax.lines if line.get_ls() == "None" and not result.follow):
            dots.set_color(FAINT)  # the branches over them are dark
        ax.set_xlim(values[order[0]], values[order[-1]])
        dots = {"ls": "none", "marker": "o", "markersize": 3}
        if result.follow:
            return [
                Line2D([], [], color=colour, label=f"sweep {ARROWS[way]}", **dots)
                for way, colour in BRANCH_COLOURS.items()
            ]
        return [Line2D([], [], color=FAINT, label="sweep", **dots)]
