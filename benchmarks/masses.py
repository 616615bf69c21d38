"""What a forcing period and an impact take for chains of any number of masses, with and without exponents.

Chains of equal masses and springs, damped, the first mass driven and between two stops; eight orbits side by side. One
mass is also computed as the first of two that do not know of each other: the same motion, with twice the numbers.
"""

import numpy as np
from book import Goal, digits, main, table
from peers import Solver
from timing import interleaved

import vibro_sweep as vs
from vibro_sweep.engine import points
from vibro_sweep.engine.any_points import any_points, kind_of
from vibro_sweep.engine.one_system import plan_of
from vibro_sweep.engine.records import new_results
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.model import status
from vibro_sweep.model.linear import amplitudes

TITLE = "Any number of masses"
COMMAND = "python benchmarks/masses.py"
MASSES = (1, 2, 3, 4, 8)
EMBEDDED = "1 beside another"
PARTS = (0.7, 0.2)  # of the free swing of the gap, that the clearance is
ASKED = 0.85  # of the time of two masses, for one


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
    return vs.Oscillator(np.eye(len(K)), K, 0.1 * K, along=first, force=first, omega=0.63, tau=0.0, b=1.0, R=0.8)


def swing(system: vs.Oscillator) -> float:
    """Amplitude of the gap in the steady motion."""
    return abs(system.linear.along @ amplitudes(system.linear))


def solver(system: vs.Oscillator, exponents: bool) -> Solver:
    one = np.empty(1, object)
    one[0] = system.linear
    kind = kind_of(one)
    table = np.repeat(any_points(one, kind)[None], LANES, axis=1)
    starts = np.zeros((2, LANES, 2 * kind.masses))
    starts[:, :, 0] = system.b * np.linspace(-0.7, 0.6, LANES)

    def job(periods):
        plan = plan_of(0, periods, exponents)
        workspace = points.new_workspace(plan, int(table["cells"].max()), 0, kind=kind)
        results = new_results((1, LANES), kind.masses)
        nothing = np.empty((1, LANES, 0))

        def run():
            points.run_points(
                table, starts, results, nothing[..., None], nothing, nothing[..., None], workspace, plan, None
            )
            if not status.stands(results["status"]).all():
                raise ArithmeticError(f"status {results['status']}")
            return int(results["impacts_right"].sum() + results["impacts_left"].sum())

        return run

    return Solver(None, job, LANES)


def measure(quick: bool) -> dict:
    rounds = 3 if quick else 15
    found = {}
    for exponents in (False, True):
        systems = {n: chain(n) for n in (MASSES[:2] if quick else MASSES)} | {EMBEDDED: embedded()}
        solvers = {
            (n, part): solver(one.replace(b=part * swing(one)), exponents)
            for n, one in systems.items()
            for part in PARTS
        }
        costs = interleaved(solvers, seconds=0.02 if quick else 0.1, rounds=rounds)
        for key, cost in costs.items():
            found[(*key, exponents)] = (1e3 * cost.microseconds(), cost.impacts)
    return found


def text(data: dict) -> str:
    rows = []
    for n, part in dict.fromkeys(key[:2] for key in data):
        (plain, impacts), (with_exponents, _) = data[n, part, False], data[n, part, True]
        numbers = (part, impacts, plain, plain / impacts, with_exponents, with_exponents / impacts)
        rows.append((n, *map(digits, numbers)))
    header = ("masses", "b, of the free swing", "impacts a period", "period, ns", "for each impact, ns")
    more = ("with exponents: period, ns", "for each impact, ns")
    return "CPU time of one orbit, of eight computed together.\n\n" + table((*header, *more), rows)


def goals(data: dict) -> list[Goal]:
    ratio = data[1, PARTS[0], False][0] / data[EMBEDDED, PARTS[0], False][0]
    return [Goal(f"one mass takes at most {ASKED} of what two take", digits(ratio), ASKED / ratio, COMMAND)]


def figure(_data: dict) -> None:
    """The table says all."""


if __name__ == "__main__":
    main(__name__)
