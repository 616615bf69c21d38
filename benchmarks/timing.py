"""How times are taken.

One-core jobs are measured in CPU time of the process, so that a busy machine disturbs them least, and in turn (A B A
B): what changes with time changes all of them alike. A figure is the median over the rounds.
"""

import statistics
import time
from collections.abc import Callable
from typing import NamedTuple


class Cost(NamedTuple):
    """Seconds per forcing period and orbit: median over the rounds, and the least."""

    median: float
    least: float
    rounds: tuple[float, ...]
    impacts: float  # per forcing period

    def microseconds(self) -> float:
        return 1e6 * self.median


def spent(job: Callable[[], object]) -> tuple[float, object]:
    """CPU seconds of a call, and what it returns."""
    began = time.process_time()
    result = job()
    return time.process_time() - began, result


def interleaved(solvers: dict, cycle: int = 1, seconds: float = 0.1, rounds: int = 7) -> dict[str, Cost]:
    """Costs of solvers (`peers.Solver`) by name, each given jobs of about so many seconds, in turn.

    Jobs are whole multiples of `cycle` periods, after which the orbit repeats itself and with it the impacts.
    """
    jobs, units, impacts = {}, {}, {}
    for name, solver in solvers.items():
        solver.job(cycle)()  # compiles
        count = 1
        while True:
            elapsed, _ = spent(solver.job(count * cycle))
            if elapsed > 0.2 * seconds:
                break
            count *= 4
        count = max(1, round(count * seconds / elapsed))
        jobs[name], units[name] = solver.job(count * cycle), count * cycle * solver.orbits
        impacts[name] = jobs[name]() / units[name]
    taken = {name: [] for name in solvers}
    for _ in range(rounds):
        for name, job in jobs.items():
            taken[name].append(spent(job)[0] / units[name])
    return {
        name: Cost(statistics.median(times), min(times), tuple(times), impacts[name]) for name, times in taken.items()
    }
