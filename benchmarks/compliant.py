"""What a forcing period of an orbit takes where stops are compliant, with and without exponents, beside heyoka.

Eight orbits side by side, on their attractor. heyoka (peer_heyoka_compliant.py) runs in the same turns, one orbit at a
time and eight in a batch; its tolerance is the largest with which its first touches are as near to those of a
calculation in forty digits as ours, or the finest. The faster of its modes counts. What it takes without events is
given, too: the difference are its events and their callbacks in Python. Rigid stops now and in an earlier version, and
the first run of both: versions.py.
"""

import compile_time
import engine
import numpy as np
import shared  # noqa: F401
from book import Goal, digits, main, table
from engine import compute
from peers import Solver
from reference.events import simulate
from reference.machine import machine_of
from timing import interleaved

import vibro_sweep as vs
from vibro_sweep.model import status

TITLE = "Compliant stops"
COMMAND = "python benchmarks/compliant.py"
ONE = dict(type="one_mass", k=1, zeta=0.05, F=0.5, omega=0.8, b=1, stops="right", tau=0.0)
PAPER = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, tau=0.0)
DAMPED = dict(k_stop=1e4, c_stop=14)  # the damping ratio of mass 1 on the stop is 0.07
CASES = {
    "one mass, k_stop = 29": ONE | dict(k_stop=29),
    "one mass, k_stop = 1e4": ONE | dict(k_stop=1e4),
    "the paper's, b = 5, k_stop = 1e4": PAPER | DAMPED | dict(b=5),
    "the paper's, b = 3, k_stop = 1e4": PAPER | DAMPED | dict(b=3),
    "one mass, release by force": ONE | dict(k_stop=1e4, c_stop=14, release="force"),
    "one mass, preload": ONE | dict(k_stop=1e4, c_stop=14, preload=0.1),
}
EXPONENTS = tuple(CASES)[:4]
TRANSIENT, LANES, COUNT = 1000, 8, 20
TOLERANCES = (1e-13, 1e-14, 1e-15, 1e-16)


def system_of(numbers):
    numbers = dict(numbers)
    kind = numbers.pop("type", None)
    return vs.Oscillator.named(kind, **numbers) if kind else vs.System(**numbers)


def ours(numbers, states, exponents: bool) -> Solver:
    system = ", ".join(f"{name}: {value}" for name, value in numbers.items())
    observe = "contacts, lyapunov" if exponents else "contacts"

    def impacts(count):
        return vs.simulate(system_of(numbers), states[0], 4 * count).contacts["t_touch"][:count], None

    def job(periods):
        text = f"system: {{{system}}}\norbit: {{transient: 0, record: {periods}}}\nobserve: [{observe}]\n"
        block = engine.block_of(text)._replace(starts=states)

        def run():
            arrays = compute.compute(block)[1]
            if not status.is_valid(arrays["status"]).all():
                raise ArithmeticError(f"status {arrays['status']}")
            return int(arrays["contacts_right"].sum() + arrays["contacts_left"].sum())

        return run

    return Solver(impacts, job, LANES)


def error_of(solver: Solver, exact) -> float:
    """Of the first touches."""
    found = solver.impacts(len(exact))[0]
    return float(np.abs(found - exact).max()) if len(found) == len(exact) else np.inf


def measure(quick: bool) -> dict:
    from peer_heyoka_compliant import solver as heyoka

    rows = []
    for name, numbers in CASES.items():
        system = system_of(numbers)
        section = vs.simulate(system, [0] * (2 * system.masses), TRANSIENT).section
        states = np.array(section[-LANES:])
        exact = simulate(machine_of(system.linear), states[0], contacts=COUNT).contacts
        exact = np.array([float(one.t_touch) for one in exact])
        for exponents in (False, True) if name in EXPONENTS else (False,):
            engine_solver = ours(numbers, states, exponents)
            solvers = {"ours": engine_solver}
            error, tolerances = error_of(engine_solver, exact), {}
            for mode, lanes in (("scalar", 1), ("batch", LANES)):
                for tol in TOLERANCES:
                    peer = heyoka(system.linear, states, tol, lanes, exponents=exponents)
                    tolerances[mode] = tol, error_of(peer, exact)
                    if tolerances[mode][1] <= max(error, 1e-14):
                        break
                solvers[mode] = peer
                solvers[f"{mode}, no events"] = heyoka(system.linear, states, tol, lanes, False, exponents)
            costs = interleaved(solvers, seconds=0.05 if quick else 0.2, rounds=3 if quick else 9)
            rows.append(
                {
                    "name": name + (", exponents" if exponents else ""),
                    "contacts": costs["ours"].impacts,
                    "error": error,
                    "errors": {mode: found for mode, (_, found) in tolerances.items()},
                    "times": {mode: cost.microseconds() for mode, cost in costs.items()},
                }
            )
    return {"rows": rows, "compile": compile_time.measure(quick)["fresh"]["compile"]}


def best(row: dict) -> float:
    return min(row["times"]["scalar"], row["times"]["batch"])


def text(data: dict) -> str:
    modes = ("ours", "scalar", "batch", "scalar, no events", "batch, no events")
    header = ("us a period and orbit", "contacts a period", *modes, "ratio", "error: ours", "scalar", "batch")
    lines = []
    for row in data["rows"]:
        times = [digits(row["times"][mode]) for mode in modes]
        errors = [f"{one:.0e}" for one in (row["error"], *row["errors"].values())]
        ratio = f"{best(row) / row['times']['ours']:.1f}"
        lines.append((row["name"], digits(row["contacts"]), *times, ratio, *errors))
    about = " ".join(__doc__.split("\n\n", 1)[1].split())
    return (
        f"{about}\n\n{table(header, lines)}\n\nCompiling a first run with rigid stops: {data['compile']:.1f} s (CPU)."
    )


def goal_of(name: str) -> int:
    """How many times as fast as heyoka it should be."""
    if name.endswith("exponents"):
        return 30
    return 20 if name.endswith(("force", "preload")) else 40


def goals(data: dict) -> list[Goal]:
    rows = [(row["name"], best(row) / row["times"]["ours"]) for row in data["rows"]]
    return [
        Goal(f"{name}: {goal} times heyoka's best mode", f"{ratio:.1f} times", ratio / goal, COMMAND)
        for name, ratio in rows
        for goal in (goal_of(name),)
    ]


def figure(_: dict) -> None:
    """A table says it all."""


if __name__ == "__main__":
    main(__name__)
