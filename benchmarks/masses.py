"""What a forcing period and an impact take for chains of any number of masses, with and without exponents.

Chains of equal masses and springs, damped, the first mass driven and between two stops; eight orbits side by side. One
mass is also computed as the first of two that do not know of each other: the same motion, with twice the numbers.
Beside it heyoka (peer_heyoka_masses.py), if it is installed, and the first run of a chain of three with an empty cache.
"""

import tempfile
from importlib.util import find_spec

import compile_time
import numpy as np
from book import HERE, Goal, digits, main, table
from peers import Solver
from timing import interleaved

import vibro_sweep as vs
from vibro_sweep.engine import points
from vibro_sweep.engine.any_points import any_points, kind_of
from vibro_sweep.engine.one_system import plan_of
from vibro_sweep.engine.records import new_results, starts_at
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.model import status
from vibro_sweep.model.linear import amplitudes, stacked

TITLE = "Any number of masses"
COMMAND = "python benchmarks/masses.py"
MASSES = (1, 2, 3, 4, 8)
EMBEDDED = "1 beside another"
PARTS = (0.7, 0.2)  # of the free swing of the gap, that the clearance is
ASKED = 0.85  # of the time of two masses, for one
TIMES = {1: 30, 2: 30, 3: 30, 8: 15}  # heyoka's time
TOLERANCE = 1e-14  # of heyoka: as good as the engine
ASKED_COMPILE = 12  # seconds
TRANSIENT = 300  # periods, from rest to the attractor
COUNT = 20  # impacts by which both are compared
ENGINE, HEYOKA = "vibro_sweep", "heyoka, batch of 8"


def chain(masses: int) -> vs.Oscillator:
    """The last mass is joined to the ground."""
    K = 2 * np.eye(masses) - np.eye(masses, k=1) - np.eye(masses, k=-1)
    K[0, 0] = 1
    return _driven(K)


def embedded() -> vs.Oscillator:
    """One mass beside another that it does not know of."""
    return _driven(np.eye(2))


def _driven(K: np.ndarray) -> vs.Oscillator:
    first = np.eye(len(K))[0]
    return vs.Oscillator(
        np.eye(len(K)), K, 0.1 * K, contact_normal=first, force=first, omega=0.63, tau=0.0, b=1.0, R=0.8
    )


def swing(system: vs.Oscillator) -> float:
    """Amplitude of the gap in the steady motion."""
    return abs(system.linear.normal @ amplitudes(system.linear))


def starts_of(system: vs.Oscillator) -> np.ndarray:
    """States of eight orbits (8, 2 N) on the attractors."""
    states = np.zeros((LANES, 2 * system.masses))
    states[:, 0] = system.b * np.linspace(-0.7, 0.6, LANES)
    return np.array([vs.simulate(system, state, TRANSIENT).section[-1] for state in states])


def solver(system: vs.Oscillator, states: np.ndarray, exponents: bool) -> Solver:
    one = stacked([system.linear])
    kind = kind_of(one)
    table = np.repeat(any_points(one, kind)[None], LANES, axis=1)
    starts = starts_at(np.stack([states, states]))

    def job(periods):
        plan = plan_of(0, periods, exponents)
        workspace = points.new_workspace(plan, int(table["cells"].max()), 0, kind=kind)
        results = new_results((1, LANES), kind.masses)
        nothing = np.empty((1, LANES, 0))

        def run():
            points.run_points(
                table, starts, results, nothing[..., None], nothing, nothing[..., None], workspace, plan, None
            )
            if not status.is_valid(results["status"]).all():
                raise ArithmeticError(f"status {results['status']}")
            return int(results["impacts_right"].sum() + results["impacts_left"].sum())

        return run

    def impacts(count):
        found = vs.simulate(system, states[0], 10 * count).impacts[:count]
        return found["t"], found["v1"]

    return Solver(impacts, job, LANES)


def measure(quick: bool) -> dict:
    rounds, found, apart = 3 if quick else 15, {}, {}
    systems = {n: chain(n) for n in (MASSES[:2] if quick else MASSES)} | {EMBEDDED: embedded()}
    solvers = {}
    for n, one in systems.items():
        for part in PARTS:
            system = one.replace(b=part * swing(one))
            states = starts_of(system)
            for exponents in (False, True):
                key = (n, part, exponents)
                solvers[ENGINE, *key] = solver(system, states, exponents)
                if find_spec("heyoka") and n != EMBEDDED:
                    import peer_heyoka_masses

                    solvers[HEYOKA, *key] = peer_heyoka_masses.solver(system.linear, states, exponents, TOLERANCE)
                    theirs, ours = (solvers[name, *key].impacts(COUNT) for name in (HEYOKA, ENGINE))
                    apart[key] = float(np.abs(theirs - ours).max())
    together = [(1, EMBEDDED), *((n,) for n in systems if n not in (1, EMBEDDED))]
    for those in together:  # in turn with each other
        mine = {name: one for name, one in solvers.items() if name[1] in those}
        found |= interleaved(mine, seconds=0.02 if quick else 0.1, rounds=rounds)
    with tempfile.TemporaryDirectory() as cache:
        first = compile_time.start(cache, HERE.parent / "configs" / "models" / "chain.yaml")
    return {"costs": found, "apart": apart, "first": first}


def text(data: dict) -> str:
    costs, rows = data["costs"], []
    for n in dict.fromkeys(key[1] for key in costs):
        for part in PARTS:
            row = [n, part, digits(costs[ENGINE, n, part, False].impacts)]
            for exponents in (False, True):
                ours, theirs = (costs.get((name, n, part, exponents)) for name in (ENGINE, HEYOKA))
                row += [digits(ours.microseconds()), digits(ours.microseconds() / ours.impacts)]
                row.append(digits(theirs.microseconds()) if theirs else "-")
                row.append(digits(theirs.median / ours.median) if theirs else "-")
            rows.append(row)
    header = ["masses", "b, of the free swing", "impacts a period"]
    for what in ("", "exponents: "):
        header += [f"{what}period", "for each impact", "heyoka's period", "ratio"]
    first, apart = data["first"], max(data["apart"].values(), default=None)
    beside = f" The first {COUNT} impacts of both differ by at most {apart:.0e} in time and speed." if apart else ""
    return (
        f"CPU time of one orbit in microseconds, of eight computed together, on the attractor; heyoka in batches of "
        f"eight at tol {TOLERANCE:g}.{beside} With an empty cache the first point of a chain of three is there "
        f"{first['done']:.1f} s after Python starts, with {first['compile']:.1f} s (CPU) of compiling.\n\n"
        + table(header, rows)
    )


def goals(data: dict) -> list[Goal]:
    costs, compiled = data["costs"], data["first"]["compile"]
    one, two = (costs[ENGINE, n, PARTS[0], False].median for n in (1, EMBEDDED))
    rows = [
        Goal(f"one mass takes at most {ASKED} of what two take", digits(one / two), ASKED * two / one, COMMAND),
        Goal(
            f"compile time for a first number of masses below {ASKED_COMPILE} s",
            f"{compiled:.1f} s", ASKED_COMPILE / compiled, COMMAND,
        ),
    ]  # fmt: skip
    for n, asked in TIMES.items():
        for exponents in (False, True):
            ratios = [
                costs[HEYOKA, n, part, exponents].median / costs[ENGINE, n, part, exponents].median
                for part in PARTS
                if (HEYOKA, n, part, exponents) in costs
            ]
            if ratios:
                what = f"{n} mass{'es' * (n > 1)}{', exponents' * exponents}: {asked} times heyoka"
                rows.append(Goal(what, f"{min(ratios):.1f} times", min(ratios) / asked, COMMAND))
    return rows


def figure(_data: dict) -> None:
    """The table says all."""


if __name__ == "__main__":
    main(__name__)
