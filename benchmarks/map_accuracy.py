"""How good is the discontinuity mapping? One period of it, and its attractors, against the oscillator.

    python benchmarks/map_accuracy.py [--output FIGURE.png] [--workers N]

The first part is computed in 45 digits (tests/reference/naive_map.py): in doubles the error of order 2 drowns in
rounding at about psi = 1e-9. Prints both tables in Markdown.
"""

import argparse
import itertools
from pathlib import Path

import matplotlib
import numpy as np
import shared  # noqa: F401
from mpmath import mp, mpf
from reference import naive
from reference.naive_map import NaiveMap, linear_family, root_family
from support import paper

import vibro_sweep as vs
from vibro_sweep.plotting.page import page
from vibro_sweep.plotting.style import DASHES, EXPONENTS, FAINT, GRAZING, INK, LEFT, RIGHT, STYLE

CASES = {
    (False, False): "neither stop",
    (True, False): "right stop",
    (False, True): "left stop",
    (True, True): "both stops",
}
FAMILIES = {"X - X* ~ psi": linear_family, "X - X* ~ sqrt(psi)": root_family}
TITLES = dict(zip(FAMILIES, (r"$X - X^* \sim \psi$", r"$X - X^* \sim \sqrt{\psi}$"), strict=True))
DECADES = np.arange(-1, -14.1, -0.5)  # of psi
FITTED = -4  # orders are fitted below this decade
DIRECTION = (1, 0.7, -0.6, 0.5)
ORDERS = (1, 2)


def errors(family, case) -> np.ndarray:
    """|P_map(X) - P_exact(X)| for each psi and order, (n, 2); NaN where the oscillator does not hit these stops."""
    params = {**naive.PAPER, "b": 1}
    result = np.full((len(DECADES), 2), np.nan)
    with mp.workdps(45):
        maps = [NaiveMap(params, order, shift=0) for order in ORDERS]
        for n, decade in enumerate(DECADES):
            X = family(maps[0], case, mpf(10) ** decade, DIRECTION)
            exact, hit = maps[0].exact(X)
            if hit == case:
                result[n] = [mp.norm(P(X) - exact) for P in maps]
    return result


def fit(psi, error) -> tuple[float, float]:
    """Exponent of psi in the error, and its standard error."""
    x, y = np.log(psi), np.log(error)
    chosen = (psi < 10.0**FITTED) & np.isfinite(y)
    x, y = x[chosen] - x[chosen].mean(), y[chosen]
    slope = x @ y / (x @ x)
    rest = y - y.mean() - slope * x
    return slope, np.sqrt(rest @ rest / (len(x) - 2) / (x @ x))


def one_period():
    """(family, case) -> errors, for all that exist."""
    found = {}
    for name, family in FAMILIES.items():
        for case in CASES:
            if case != (True, True) or family is root_family:
                found[name, case] = errors(family, case)
    return found


# --- attractors

CLEARANCES = np.round(np.arange(5.6, 6.9, 0.002), 6)
WINDOWS = (5.6, 6.0, 6.3, 6.5, "b*", "end", 6.9)  # of b; "end": of the flow's impacting attractors
MODELS = {"map, order 1": "dynamics: map", "map, order 2": "dynamics: map\norder: 2", "flow": "dynamics: flow"}
STARTS, RECORD = 8, 1000
ORBIT = f"{{transient: 3000, record: {RECORD}}}"
WITHIN = {"impacts per period, to 2 %": 0.02, "lambda_1, to 0.001": 1e-3, "section points, K-S < 0.1": 0.1}


def quarter_back(data) -> np.ndarray:
    """x1 a quarter of a period before the section of the map's points, where the free motion is the oscillator's."""
    system = vs.System(**naive.PAPER, b=1)
    mu_m, mu_k, damping = system.mu_m, system.mu_k, 2 * system.zeta
    M2 = np.array([1, damping, -(1 + mu_k), -damping * (1 + mu_k)]) / mu_m
    rates, vectors = np.linalg.eig(np.array([[0, 1, 0, 0], [-1, -damping, 1, damping], [0, 0, 0, 1], M2]))
    back = (vectors * np.exp(-rates * system.period / 4)) @ np.linalg.inv(vectors)
    graze = np.array(vs.grazing(system).state)
    D = np.stack([data[name].values for name in ("x1", "v1", "x2", "v2")], -1) - graze
    return D @ back[0].real + 0.0  # the steady motion passes through x1 = 0 there


def attractors(run):
    """name -> (impacts per period (b,), lambda_1 (b,), x1 (b, starts, samples) at the phase between the stops)."""
    found, tau = {}, vs.grazing(vs.System(**naive.PAPER, b=1)).tau
    for name, model in MODELS.items():
        start = f"{{random: {STARTS}, seed: 1}}"
        data = run(model, ORBIT, start, CLEARANCES, tau=None if "map" in model else tau - np.pi / 2)
        x1 = data.x1.values if model == "dynamics: flow" else quarter_back(data)
        x1[~paper.bounded(data).values] = np.nan
        impacts = (data.impacts_right + data.impacts_left).mean("start").values / RECORD
        found[name] = impacts, data.lyapunov.values[..., 0].mean(axis=1), x1
    return found


def distance(a, b) -> float:
    """How far the attractors a are from the nearest of b, on average: Kolmogorov-Smirnov; (starts, samples) each."""
    rows = []
    for x in np.sort(a, axis=1):
        scale = 1e-6 * np.ptp(x) + 1e-9  # points of a periodic orbit are equal only to rounding
        nearest = 1.0
        for y in np.sort(b, axis=1):
            at = np.concatenate([x, y]) + scale
            below = [np.searchsorted(z, at) / len(z) for z in (x, y)]
            nearest = min(nearest, abs(below[0] - below[1]).max())
        rows.append(nearest)
    return float(np.mean(rows))


def differences(found, name) -> dict[str, np.ndarray]:
    """How far this map's attractors are from the flow's, (b,) for each measure of `WITHIN`; NaN where they run away."""
    (impacts, exponent, x1), flow = found[name], found["flow"]
    with np.errstate(invalid="ignore", divide="ignore"):
        relative = np.where(flow[0] > 0, abs(impacts / flow[0] - 1), np.where(impacts > 0, np.inf, 0.0))
    apart = np.array([distance(a, b) for a, b in zip(flow[2], x1, strict=True)])
    values = dict(zip(WITHIN, (relative, abs(exponent - flow[1]), apart), strict=True))
    away = np.isnan(x1).any(axis=(1, 2))
    return {what: np.where(away, np.nan, value) for what, value in values.items()}


# --- what is shown


def table_of_orders(found) -> str:
    lines = ["| displacement | impact on | order 1 | order 2 |", "| --- | --- | --- | --- |"]
    psi = 10.0**DECADES
    for (name, case), error in found.items():
        text = ["exact" if np.nanmax(e) < 1e-30 else "psi^({:.4f} +- {:.0e})".format(*fit(psi, e)) for e in error.T]
        lines.append(f"| {name} | {CASES[case]} | {text[0]} | {text[1]} |")
    return "\n".join(lines)


def table_of_agreement(found, end) -> str:
    named = {"b*": vs.grazing(vs.System(**naive.PAPER, b=1)).b, "end": end}
    borders = [named.get(border, border) for border in WINDOWS]
    windows = list(itertools.pairwise(borders))
    head = [f"{low:.4g} .. {high:.4g}" for low, high in windows]
    lines = ["| agreement with the flow, % of the clearances in | | " + " | ".join(head) + " |"]
    lines.append("|" + " --- |" * (len(windows) + 2))
    apart = {name: differences(found, name) for name in found if name != "flow"}
    for what, limit in WITHIN.items():
        for name, values in apart.items():
            inside = [(CLEARANCES >= low) & (CLEARANCES < high) for low, high in windows]
            share = [100 * np.mean(values[what][chosen] < limit) for chosen in inside]
            lines.append(f"| {what} | {name} | " + " | ".join(f"{value:.0f}" for value in share) + " |")
    return "\n".join(lines)


def figure(periods, found):
    fig = page(8.2, "The discontinuity mapping: its error over one period, and its attractors beside the flow's")
    top, rest = fig.subfigures(2, 1, height_ratios=(1, 1.35))
    psi = 10.0**DECADES
    colours = {(True, False): RIGHT, (False, True): LEFT, (True, True): EXPONENTS[0]}
    for ax, name in zip(top.subplots(1, 2, sharey=True), FAMILIES, strict=True):
        for case, colour in colours.items():
            if (name, case) in periods:
                for order, style in zip(ORDERS, ("o", "s"), strict=True):
                    error = periods[name, case][:, order - 1]
                    slope = fit(psi, error)[0]
                    label = rf"{CASES[case]}, order {order}: $\psi^{{{slope:.2f}}}$"
                    ax.loglog(psi, error, style, ms=3, color=colour, mfc="none" if order == 1 else colour, label=label)
                    low = psi < 10.0**FITTED
                    ax.loglog(psi[low], error[low][0] * (psi[low] / psi[low][0]) ** slope, color=colour, lw=0.6)
        ax.axhline(2**-52, color=FAINT, lw=0.8, ls=DASHES)
        ax.text(psi[-1], 2**-52 * 1.5, "rounding of doubles", color=FAINT, fontsize=7)
        ax.set(xlabel=r"penetration $\psi$", title=TITLES[name])
        ax.legend(fontsize=7)
    top.axes[0].set_ylabel("$|P_{map}(X) - P_{exact}(X)|$")
    panels = rest.subplots(3, 3, sharex=True, sharey="row", height_ratios=(2, 1, 1))
    for (section, exponent, impacts), name in zip(panels.T, found, strict=True):
        n, largest, x1 = found[name]
        b = np.broadcast_to(CLEARANCES[:, None, None], x1[:, :, ::10].shape)
        section.plot(b.ravel(), x1[:, :, ::10].ravel(), ",", color=INK, alpha=0.5, rasterized=True)
        exponent.plot(CLEARANCES, largest, color=EXPONENTS[0], lw=0.5)
        exponent.axhline(0, color=INK, lw=0.5)
        impacts.plot(CLEARANCES, n, color=INK, lw=0.7)
        for ax in (section, exponent, impacts):
            ax.axvline(vs.grazing(vs.System(**naive.PAPER, b=1)).b, color=GRAZING, lw=0.7, ls=DASHES)
        section.set_title(name)
        impacts.set_xlabel("clearance $b$")
    for ax, what in zip(panels[:, 0], (r"$x_1$ at $t = -T/4$", r"$\lambda_1$", "impacts / $T$"), strict=True):
        ax.set_ylabel(what)
    low, high = np.nanquantile(found["flow"][2], [0, 1])
    panels[0, 0].set_ylim(low - 0.1 * (high - low), high + 0.1 * (high - low))
    panels[0, 0].set_xlim(CLEARANCES[0], CLEARANCES[-1])
    return fig


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("map_accuracy.png"), help="the figure")
    parser.add_argument("--workers", type=int, default=None, help="threads; by default one for each core")
    options = parser.parse_args()
    periods = one_period()
    print(f"Error of one period, b = b*, fitted below psi = 1e{FITTED}\n\n{table_of_orders(periods)}\n")
    run = paper.Runner(options.workers)
    found = attractors(run)
    print(table_of_agreement(found, paper.end_from_elsewhere(run, "dynamics: flow").last))
    with matplotlib.rc_context(STYLE):
        figure(periods, found).savefig(options.output)


if __name__ == "__main__":
    main()
