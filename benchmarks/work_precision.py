"""Work and precision: the time of a forcing period against the error of early impact times, a point per setting.

This package has no tolerance: its point is its own choice of cells, and its curve other numbers of cells. Fewer than
that choice are outside what it certifies, and are drawn as they come out.
"""

import numpy as np
import problem
from book import Goal, digits, main, styled, table
from matplotlib.lines import Line2D
from peers import ENGINE, METHODS, available
from timing import interleaved

from vibro_sweep.plotting.page import page
from vibro_sweep.plotting.style import DASHES, FAINT, INK

TITLE = "Work and precision"
COMMAND = "python benchmarks/work_precision.py"
LOOKS = {
    ENGINE: ("#b2182b", "o"),
    "heyoka, batch of 8": ("#2166ac", "s"),
    "heyoka, one orbit": ("#67a9cf", "D"),
    "closed form, scan": ("#4d9221", "^"),
    "RK4, bisection": ("#e08214", "v"),
    "RK4, linear": ("#fdb863", "<"),
    "CVODE Adams": ("#542788", "P"),
    "CVODE BDF": ("#998ec3", "X"),
    "SciPy DOP853": ("#6e6e78", "p"),
}
LEAST, MOST = 6e-15, 2e-2  # of the axis of errors; what misses impacts stands beyond


def family(name: str) -> str:
    """A method and its variant share a curve's colour."""
    return name.removesuffix(", short steps")


def measure(quick: bool) -> list[dict]:
    """One row for each clearance, method and value of its knob (None: as it is)."""
    methods = [m for m in available(METHODS) if m.values]
    if quick:
        methods = [m for m in methods if not m.name.startswith(("CVODE BDF", "SciPy")) and "short" not in m.name]
    rows = []
    for b in problem.CLEARANCES:
        params, states = problem.on_attractor(b)
        solvers = {}
        for m in methods:
            values = m.values[::3] if quick else m.values
            for value in (None, *values) if m.name == ENGINE else values:
                setting = {} if value is None else {m.knob: value}
                solvers[m.name, value] = m.solver(params, states, **setting)
                found = problem.error(b, lambda p, s, n, m=m, k=setting: m.solver(p, s, **k).impacts(n))
                rows.append({"b": b, "method": m.name, "knob": m.knob, "value": value, **found._asdict()})
        costs = interleaved(solvers, problem.CYCLE[b], 0.01 if quick else 0.1, 1 if quick else 5)
        for row in rows:
            if row["b"] == b:
                row["seconds"] = costs[row["method"], row["value"]].median
    return rows


@styled
def figure(rows: list[dict]):
    """A panel for each clearance; hollow points at the right miss or invent impacts."""
    fig = page(4.4, None)
    axes = fig.subplots(1, len(problem.CLEARANCES), sharey=True)
    for ax, b in zip(axes, problem.CLEARANCES, strict=True):
        ax.axvspan(MOST, 30 * MOST, color="#f2f2f4", lw=0)
        small = {"transform": ax.get_xaxis_transform(), "fontsize": 7.5, "color": FAINT, "rotation": 90, "ha": "center"}
        ax.text(5.5 * MOST, 0.02, "missed", va="bottom", **small)
        ax.axvline(problem.rounding(b), color=FAINT, lw=0.7, ls=DASHES, zorder=0)
        if ax is axes[0]:
            ax.text(0.3 * problem.rounding(b), 0.63, "rounding of the inputs", va="center", **small)
        for name in dict.fromkeys(row["method"] for row in rows):
            draw(ax, name, [row for row in rows if row["b"] == b and row["method"] == name])
        ax.set(xscale="log", yscale="log", xlim=(LEAST, 30 * MOST), title=f"$b={b:g}$")
        ax.set_xticks(10.0 ** np.arange(-14, -1, 4))
        ax.minorticks_off()
        ax.grid(color="#e6e6ea", lw=0.4)
        ax.set_axisbelow(True)
    axes[0].set_ylabel(r"time of a forcing period ($\mu$s)")
    fig.supxlabel(f"largest error of the first {problem.COUNT} impact times, three orbits", fontsize=10)
    shown = [name for name in LOOKS if any(row["method"] == name for row in rows)]
    handles = [
        Line2D([], [], color=LOOKS[name][0], marker=LOOKS[name][1], ms=4.5, lw=1.1, label=name) for name in shown
    ]
    fig.legend(handles=handles, loc="outside upper center", ncols=5)
    return fig


def draw(ax, name: str, rows: list[dict]) -> None:
    colour, marker = LOOKS[family(name)]
    ours = name == ENGINE
    good = [row for row in rows if row["matched"] == problem.COUNT]
    curve = [row for row in good if not (ours and row["value"] is None)]
    style = {"color": colour, "marker": marker, "zorder": 4 if ours else 2}
    x = [max(row["largest"], LEAST) for row in curve]
    ax.plot(x, [1e6 * row["seconds"] for row in curve], ms=3.2, lw=1.4 if ours else 0.9, ls="-", **style)
    bad = [row for row in rows if row["matched"] < problem.COUNT]
    ax.plot([5.5 * MOST] * len(bad), [1e6 * row["seconds"] for row in bad], ls="", ms=3.6, mfc="none", mew=0.8, **style)
    chosen = [row for row in good if ours and row["value"] is None]
    x = [row["largest"] for row in chosen]
    ax.plot(
        x, [1e6 * row["seconds"] for row in chosen], ls="", ms=9, **(style | {"marker": "*", "mec": INK, "mew": 0.5})
    )


def text(rows: list[dict]) -> str:
    """All points."""
    lines = []
    keys = dict.fromkeys((row["method"], row["knob"], row["value"]) for row in rows)
    for name, knob, value in keys:
        line = [name, "as it is" if value is None else f"{knob} {value:.4g}"]
        for b in problem.CLEARANCES:
            (row,) = [r for r in rows if (r["b"], r["method"], r["value"]) == (b, name, value)]
            missed = row["matched"] < problem.COUNT
            line += [digits(1e6 * row["seconds"]), f"{row['matched']} of 40" if missed else f"{row['largest']:.0e}"]
        lines.append(line)
    header = ["method", "setting"]
    for b in problem.CLEARANCES:
        header += [f"b = {b:g}, us", "error"]
    return (
        "The star is this package as it is; its curve has other numbers of cells. Hollow points: not all of the first "
        f"{problem.COUNT} impacts are found, on the right sides.\n\n<details><summary>All points</summary>\n\n"
        + table(header, lines)
        + "\n</details>\n"
    )


def goals(_: list[dict]) -> list[Goal]:
    """Speed at equal error is counted in speed.py."""
    return []


if __name__ == "__main__":
    main(__name__)
