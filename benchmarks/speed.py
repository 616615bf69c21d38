"""Time per forcing period of every method in its best mode, side by side, and what the exponents cost."""

from typing import NamedTuple

import problem
from book import Goal, digits, main, table
from peers import BARE, BATCH, ENGINE, EXPONENTS, METHODS, SCALAR, TANGENT, TANGENT_BATCH, available
from timing import Cost, interleaved

TITLE = "Speed: microseconds per forcing period"
COMMAND = "python benchmarks/speed.py"
ASKED_ORBIT, ASKED_EXPONENTS = 30, 150
LOOSER = {"tol": 1e-14}  # heyoka may take any tolerance that is as good as ours


class Result(NamedTuple):
    costs: dict[float, dict[str, Cost]]
    errors: dict[float, dict[str, problem.Error]]


def settings(quick: bool, b: float):
    """(label, method, setting), the fast ones first; of a chaotic orbit only these."""
    slow = ("CVODE", "SciPy") if quick else ()
    fast = ("vibro_sweep", "heyoka") if b in problem.CHAOTIC else ""
    chosen = [m for m in available(METHODS) if m.name.startswith(fast) and not m.name.startswith(slow)]
    rows = [(m.name, m, m.fine) for m in chosen]
    return rows + [(f"{m.name}, tol 1e-14", m, LOOSER) for m in chosen if m.name in (BATCH, SCALAR)]


def measure(quick: bool) -> Result:
    costs, errors = {}, {}
    for b in (*problem.CLEARANCES, *problem.CHAOTIC):
        params, states = problem.on_attractor(b)
        rows = settings(quick, b)
        solvers = {label: m.solver(params, states, **setting) for label, m, setting in rows}
        costs[b] = interleaved(solvers, problem.CYCLE[b], 0.03 if quick else 0.2, 3 if quick else 15)
        errors[b] = {
            label: problem.error(b, lambda p, s, n, m=m, setting=setting: m.solver(p, s, **setting).impacts(n))
            for label, m, setting in rows
            if label != BARE
        }
    return Result(costs, errors)


def best(result: Result, b: float) -> str:
    """heyoka's fastest mode whose error is no larger than ours, or than what the rounding of the inputs does."""
    errors, enough = result.errors[b], max(result.errors[b][ENGINE].largest, problem.rounding(b))
    modes = [label for label in errors if label.startswith((BATCH, SCALAR)) and "exponents" not in label]
    good = [label for label in modes if errors[label].matched == problem.COUNT and errors[label].largest <= enough]
    return min(good, key=lambda label: result.costs[b][label].median)


def ratio(result: Result, b: float, peer: str, ours: str = ENGINE) -> float:
    return result.costs[b][peer].median / result.costs[b][ours].median


def times(result: Result, clearances: tuple[float, ...]) -> str:
    """Table of times with the ratio to ours, and errors."""
    header, rows = ["method"], []
    for b in clearances:
        header += [f"b = {b:g}", "ratio", "error"]
    for label in result.costs[clearances[0]]:
        row = [label]
        for b in clearances:
            found = result.errors[b].get(label)
            ours = EXPONENTS if "exponents" in label else ENGINE
            row += [digits(result.costs[b][label].microseconds()), f"{ratio(result, b, label, ours):.3g}"]
            if found is None or found.matched == problem.COUNT:
                row.append(f"{found.largest:.0e}" if found else "-")
            else:
                row.append(f"{found.matched} of {problem.COUNT} impacts")
        rows.append(row)
    return table(header, rows)


def text(result: Result) -> str:
    """Tables of the periodic and of the chaotic orbits, and what the methods are."""
    impacts = ", ".join(f"{cost[ENGINE].impacts:.2f} (b = {b:g})" for b, cost in result.costs.items())
    rounding = ", ".join(f"{problem.rounding(b):.0e} (b = {b:g})" for b in result.costs)
    spread = max(max(c.rounds) / min(c.rounds) for costs in result.costs.values() for c in costs.values())
    notes = [f"- {m.name}: {m.note}" for m in METHODS if m.note and m.name in result.costs[problem.CLEARANCES[0]]]
    return (
        f"Paper parameters, on the attractor; one core, CPU time, medians of interleaved rounds (slowest round over "
        f"fastest: at most {spread:.2f}). Impacts per period: {impacts}. The error is the largest of the first "
        f"{problem.COUNT} impact times of three orbits, in units of time; the rounding of the inputs alone makes "
        f"{rounding}. Ratios are to this package, with the exponents where the peer has them.\n\n"
        + times(result, problem.CLEARANCES)
        + "\nChaotic motions, of eight orbits that have parted:\n\n"
        + times(result, problem.CHAOTIC)
        + "\n"
        + "\n".join(notes)
        + "\n"
    )


def goals(result: Result) -> list[Goal]:
    rows = []
    with_heyoka = [b for b, costs in result.costs.items() if BATCH in costs]
    for b in with_heyoka:
        peer = best(result, b)
        times, ours, theirs = ratio(result, b, peer), result.errors[b][ENGINE].largest, result.errors[b][peer].largest
        reached = (
            f"{times:.1f} times ({peer}; without events {ratio(result, b, BARE):.1f} times); errors {ours:.0e} and "
            f"{theirs:.0e}, rounding of the inputs {problem.rounding(b):.0e}"
        )
        rows.append(
            Goal(
                f"b = {b:g}: {ASKED_ORBIT} times heyoka's best mode of that error",
                reached,
                times / ASKED_ORBIT,
                COMMAND,
            )
        )
    for b in with_heyoka:
        peer = min((TANGENT, TANGENT_BATCH), key=lambda name: result.costs[b][name].median)
        times, scalar = ratio(result, b, peer, EXPONENTS), ratio(result, b, TANGENT, EXPONENTS)
        reached = f"{times:.1f} times ({peer}); {scalar:.1f} times one orbit"
        asked = f"b = {b:g}: {ASKED_EXPONENTS} times heyoka's variational run"
        rows.append(Goal(asked, reached, times / ASKED_EXPONENTS, COMMAND))
    for b in result.costs:
        share = ratio(result, b, EXPONENTS, ENGINE) - 1
        asked = f"b = {b:g}: exponents cost less than the orbit"
        rows.append(Goal(asked, f"{share:.2f} of the orbit", 1 / max(share, 1e-3), COMMAND))
    return rows


def figure(_: Result) -> None:
    """The figure of the speeds is that of work_precision.py."""


if __name__ == "__main__":
    main(__name__)
