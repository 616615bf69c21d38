"""Time of a forcing period with its error: this package beside heyoka, SciPy's DOP853, and Runge-Kutta of fixed steps.

Ours is a sweep over starts that records 2000 periods, less one that records 100, so that what each call takes
drops out; the others carry their orbits from states on the attractor. The error is that of the first impact times
(problem.py). A method that misses an impact, or invents one, gets the number of impacts up to there.
"""

from functools import partial
from importlib.util import find_spec

import numpy as np
import peers
import problem
from bench import digits, enough, figures, in_turns, main, measured, per_unit, spent, table

import vibro_sweep as vs

RECORD, FEW = 2000, 100
MOST = 2048  # orbits of a sweep at most
SECONDS = 0.2  # that a sample takes at least
COUNT = 20  # of contacts, and of impacts of chains, that are compared
OURS, EXPONENTS = "vibro_sweep", "vibro_sweep, exponents"
BATCH, SCALAR, BARE = "heyoka, batch of 8", "heyoka, one orbit", "heyoka, batch of 8, no events"
RK4, DOP853, SHORT = "RK4 of fixed steps, bisection", "SciPy DOP853", "SciPy DOP853, short steps"
METHODS = {  # name: (maker, package, knob, its values from coarse to fine)
    BATCH: (peers.heyoka, "heyoka", "tol", (1e-8, 1e-10, 1e-12, 1e-14, 1e-16)),
    SCALAR: (partial(peers.heyoka, lanes=1), "heyoka", "tol", (1e-8, 1e-12, 1e-14, 1e-16)),
    RK4: (peers.rk4, "numba", "steps", (100, 300, 1000, 3000, 10_000)),
    DOP853: (peers.dop853, "scipy", "tol", (1e-6, 1e-8, 1e-10, 1e-12)),
    SHORT: (peers.dop853, "scipy", "longest", (1 / 40, 1 / 100, 1 / 400)),
    BARE: (partial(peers.heyoka, events=False), "heyoka", "tol", (1e-16,)),
    "heyoka, batch of 8, exponents": (partial(peers.heyoka, exponents=True), "heyoka", "tol", (1e-16,)),
    "heyoka, one orbit, exponents": (partial(peers.heyoka, lanes=1, exponents=True), "heyoka", "tol", (1e-16,)),
}
COLOURS = {
    OURS: ("#b2182b", "*"), BATCH: ("#2166ac", "s"), SCALAR: ("#67a9cf", "D"), RK4: ("#e08214", "v"),
    DOP853: ("#6e6e78", "p"), SHORT: ("#6e6e78", "P"),
}  # fmt: skip


def sweep_row(system, observe):
    """A maker: nanoseconds that a forcing period of an orbit takes in a sweep over starts."""

    def make():
        width, orbits = problem.width(system), 512

        def job(periods):
            axes = {"x1": {"start": -width, "stop": width, "num": orbits}}
            return vs.sweep(system, axes, transient=1000, record=periods // orbits, observe=observe, workers=1)

        while (sample := per_unit(job, orbits * RECORD, orbits * FEW))() * 1e-9 * orbits * RECORD < SECONDS:
            orbits *= 2
            if orbits == MOST:
                return per_unit(job, orbits * RECORD, orbits * FEW)
        return sample

    return make


def simulate_row(b: float, periods: int):
    """A maker: one orbit at a prompt."""

    def make():
        system = problem.paper(b)
        state = problem.on_attractor(system)[0]
        vs.simulate(system, state, periods)
        return lambda: 1e3 * spent(lambda: vs.simulate(system, state, periods))

    return make


def grid_row(axes, record: int):
    """A maker: a point of a sweep whose points have tables of their own, or orbits of few periods."""

    def make():
        def job(count):
            keys, chosen = ("start", "stop", "num"), {name: [*ends] for name, *ends in axes}
            chosen[axes[0][0]][-1] = count
            chosen = {name: dict(zip(keys, ends, strict=True)) for name, ends in chosen.items()}
            return vs.sweep(
                problem.paper(6.6), chosen, transient=0, record=record, observe=["impacts"], workers=1, output=None
            )

        sample = per_unit(job, axes[0][-1], axes[0][-1] // 20, 1e6)
        return lambda: sample() / int(np.prod([most for *_, most in axes[1:]]))

    return make


def rows() -> dict:
    found = {}
    for b in (*problem.PERIODIC, *problem.CHAOTIC):
        found[f"sweep, b = {b:g}: ns a period"] = sweep_row(problem.paper(b), ["impacts"])
        found[f"sweep with exponents, b = {b:g}: ns a period"] = sweep_row(problem.paper(b), ["impacts", "lyapunov"])
    for case in problem.COMPLIANT:
        found[f"{case}: ns a period"] = sweep_row(problem.compliant(case), ["contacts"])
        found[f"{case}, exponents: ns a period"] = sweep_row(problem.compliant(case), ["contacts", "lyapunov"])
    for masses in problem.MASSES:
        found[f"chain of {masses}: ns a period"] = sweep_row(problem.chain(masses), ["impacts"])
        found[f"chain of {masses}, exponents: ns a period"] = sweep_row(problem.chain(masses), ["impacts", "lyapunov"])
    found["simulate, 100 periods, b = 3: ms"] = simulate_row(3.0, 100)
    found["simulate, 100 000 periods, b = 3: ms"] = simulate_row(3.0, 100_000)
    found["sweep in omega, a period each: us a point"] = grid_row([("omega", 0.6, 0.66, 20_000)], 1)
    found["plane of b and R, a period each: us a point"] = grid_row([("b", 5.0, 7.0, 4000), ("R", 0.5, 0.9, 50)], 1)
    found["plane of b and omega, ten periods each: us a point"] = grid_row(
        [("b", 5.0, 7.0, 2000), ("omega", 0.6, 0.66, 10)], 10
    )
    return found


ROWS = rows()


def flown(solver):
    return lambda state, count: solver.fly(state, count=count)[:2]


def ours(system):
    """fly of `problem.error`."""

    def fly(state, count):
        orbit, rigid = vs.simulate(system, state, 20 * count), "k_stop" not in repr(system)
        events = orbit.impacts if rigid else orbit.contacts
        return events["t" if rigid else "t_touch"], events["side"]

    return fly


def of_peer(solver, cycle: int, seconds: float):
    """A sample of microseconds a period and orbit."""
    periods = enough(solver.job, seconds, cycle)
    return lambda: 1e6 * spent(lambda: solver.job(periods)) / periods / solver.orbits


def micro(row: str):
    """A sample of one of our rows in microseconds."""
    sample = ROWS[row]()
    return lambda: sample() / 1e3


def beside(b: float, quick: bool) -> list[dict]:
    """Time and error of all methods at one clearance, each with the values of its knob: {method, value, us, error}."""
    system, samples, found = problem.paper(b), {}, []
    states, cycle = problem.on_attractor(system), problem.CYCLE.get(b, 1)
    samples[OURS, None] = micro(f"sweep, b = {b:g}: ns a period")
    samples[EXPONENTS, None] = micro(f"sweep with exponents, b = {b:g}: ns a period")
    errors = dict.fromkeys(samples, problem.error(system, problem.starts(b), problem.COUNT, ours(system)))
    for name, (make, package, knob, values) in METHODS.items():
        if find_spec(package) is None or (b in problem.CHAOTIC and package != "heyoka"):
            continue
        for value in values[-2:] if quick or b in problem.CHAOTIC else values:
            if quick and name == SHORT:
                continue
            solver = make(system, states, **{knob: value})
            if name != BARE:
                errors[name, value] = problem.error(system, problem.starts(b), problem.COUNT, flown(solver))
            samples[name, value] = of_peer(solver, cycle if package != "scipy" else 1, 0.02 if quick else 0.05)
    for (name, value), us in in_turns(samples, 1 if quick else 5).items():
        error = errors.get((name, value))
        found.append({"method": name, "value": value, "us": us, "error": error and list(error)})
    return found


def other(system, row: str, exponents: bool, quick: bool) -> dict:
    """A compliant machine or a chain, beside heyoka's faster mode, at an error like ours if it has one."""
    states = problem.on_attractor(system)
    error = problem.error(system, states[:1], COUNT, ours(system))
    samples, errors = {OURS: micro(row)}, {}
    if find_spec("heyoka"):
        for name, lanes in ((BATCH, 8), (SCALAR, 1)):
            if lanes == 1 and system.masses > 2:  # many times as slow
                continue
            for tol in (1e-14, 1e-16):
                solver = peers.heyoka(system, states, tol, lanes, exponents=exponents)
                errors[name] = problem.error(system, states[:1], COUNT, flown(solver))
                samples[name] = of_peer(solver, 1, 0.02 if quick else 0.05)
                if errors[name].matched == COUNT and errors[name].largest <= max(error.largest, 1e-14):
                    break
    costs = in_turns(samples, 1 if quick else 3)
    peer = min(errors, key=costs.get, default=None)
    found = {"what": row.partition(":")[0], "us": costs[OURS], "error": list(error)}
    return found | ({"peer": peer, "peer_us": costs[peer], "peer_error": list(errors[peer])} if peer else {})


def measure(quick: bool) -> dict:
    clearances = problem.PERIODIC[1:2] + problem.CHAOTIC[2:] if quick else problem.PERIODIC + problem.CHAOTIC
    others = []
    for case in list(problem.COMPLIANT)[: 1 if quick else None]:
        for what, exponents in ((case, False), (f"{case}, exponents", True)):
            if not (exponents and "force" in case):  # peers.py has no tangents of stops that relax
                others.append(other(problem.compliant(case), f"{what}: ns a period", exponents, quick))
    for masses in problem.MASSES[: 1 if quick else None]:
        for what, exponents in ((f"chain of {masses}", False), (f"chain of {masses}, exponents", True)):
            others.append(other(problem.chain(masses), f"{what}: ns a period", exponents, quick))
    return {
        "points": {f"{b:g}": beside(b, quick) for b in clearances},
        "rounding": {f"{b:g}": problem.rounding(b) for b in clearances},
        "others": others,
        "rows": measured({name: make for name, make in ROWS.items() if not name.endswith("a period")}, 3),
    }


def best(data: dict, b: str, exponents: bool = False) -> dict | None:
    """heyoka's fastest mode whose error is at most three times ours, or three times that of rounding the inputs."""
    mine = next(row for row in data["points"][b] if row["method"] == OURS)
    limit, good = 3 * max(mine["error"][1], data["rounding"][b]), []
    for row in data["points"][b]:
        if row["method"].startswith("heyoka") and row["error"] and exponents == ("exponents" in row["method"]):
            matched, largest, count = row["error"]
            good += [row] if exponents or (matched == count and largest <= limit) else []
    return min(good, key=lambda row: row["us"], default=None)


def ratios(data: dict, exponents: bool = False) -> dict[str, float]:
    """How many times as long as ours heyoka's best mode takes, by clearance."""
    found = {}
    for b, points in data["points"].items():
        mine = next(row for row in points if row["method"] == (EXPONENTS if exponents else OURS))
        if peer := best(data, b, exponents):
            found[b] = peer["us"] / mine["us"]
    return found


def said(error) -> str:
    return "-" if error is None else str(problem.Error(*error))


def head(data: dict) -> str:
    """Error against time as one table."""
    keys = dict.fromkeys((row["method"], row["value"]) for points in data["points"].values() for row in points)
    finest = {name: value for name, value in keys} | {BATCH: 1e-14, SCALAR: 1e-14}
    chosen = [key for key in keys if key[1] == finest[key[0]] or key == (RK4, 1000)]
    lines = []
    for name, value in chosen:
        setting = "" if value is None else f", {METHODS[name][2]} {value:g}" if value != 1 / 400 else ""
        line = [name + setting]
        for points in data["points"].values():
            row = next((row for row in points if (row["method"], row["value"]) == (name, value)), None)
            line.append(f"{digits(row['us'])}, {said(row['error'])}" if row else "")
        lines.append(line)
    for what, exponents in (("heyoka's best mode / vibro_sweep", False), ("the same with exponents", True)):
        times = ratios(data, exponents)
        lines.append([what, *(f"{times[b]:.1f}" if b in times else "" for b in data["points"])])
    lines.append(["error by rounding of the inputs", *(f"{value:.0e}" for value in data["rounding"].values())])
    return table(["microseconds a forcing period, error", *(f"b = {b}" for b in data["points"])], lines)


def rest(data: dict) -> str:
    """Compliant stops and chains, without and with exponents, and what else is measured."""
    header = (
        "microseconds a forcing period",
        "vibro_sweep",
        "error",
        "heyoka",
        "error",
        "times",
        "exponents",
        "heyoka",
        "times",
    )
    rows, lines = {row["what"]: row for row in data["others"]}, []
    for what, row in rows.items():
        if what.endswith(", exponents"):
            continue
        line, more = [what, digits(row["us"]), said(row["error"])], rows.get(f"{what}, exponents", {})
        peer = (
            (digits(row["peer_us"]), said(row["peer_error"]), f"{row['peer_us'] / row['us']:.1f}")
            if "peer" in row
            else ""
        )
        line += [*peer, *([""] * (3 - len(peer))), digits(more["us"]) if more else ""]
        line += [digits(more["peer_us"]), f"{more['peer_us'] / more['us']:.1f}"] if "peer" in more else ["", ""]
        lines.append(line)
    return table(header, lines) + "\n" + figures(data["rows"])


def figure(data: dict):
    """Time against error, a panel for each clearance with periodic orbits; at the right what misses impacts."""
    from matplotlib.figure import Figure

    shown = {b: data["points"][b] for b in data["points"] if float(b) in problem.PERIODIC}
    fig = Figure((7.2, 3.4), layout="constrained", dpi=150)
    axes = fig.subplots(1, len(shown), sharey=True, squeeze=False)[0]
    for ax, (b, points) in zip(axes, shown.items(), strict=True):
        for name, (colour, marker) in COLOURS.items():
            mine = [row for row in points if row["method"] == name]
            good = [row for row in mine if row["error"][0] == row["error"][2]]
            bad = [row["us"] for row in mine if row["error"][0] < row["error"][2]]
            style = {"color": colour, "marker": marker, "ms": 9 if name == OURS else 4, "lw": 1, "label": name}
            ax.loglog([max(row["error"][1], 6e-15) for row in good], [row["us"] for row in good], **style)
            ax.loglog([0.1] * len(bad), bad, ls="", mfc="none", **{k: style[k] for k in ("color", "marker", "ms")})
        ax.axvspan(0.02, 0.6, color="#f2f2f4", lw=0)
        ax.axvline(data["rounding"][b], color="#6e6e78", lw=0.7, ls="--", zorder=0)
        ax.set(xlim=(4e-15, 0.6), title=f"b = {b}", xticks=[1e-13, 1e-10, 1e-7, 1e-4])
        ax.minorticks_off()
        ax.grid(color="#e6e6ea", lw=0.4)
    axes[0].set_ylabel("time of a forcing period (us)")
    fig.supxlabel("largest error of the first 40 impact times of three orbits", fontsize=9)
    fig.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=8, frameon=False)
    return fig


def text(data: dict) -> str:
    return f"{head(data)}\n{rest(data)}"


if __name__ == "__main__":
    main(ROWS, measure, text)
