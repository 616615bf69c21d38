"""Orbits that rest after impacts with R = 0, from the times of their impacts alone.

Where the acceleration just after such an impact points into the stop, the mass rests. How long it does so is not known:
some shares of the time to the next impact are tried.
"""

import numpy as np

from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.flow import flow

SHARES = (0.3, 0.6, 0.1, 0.9)  # of the time to the next impact
PHASES = 8  # of the first impact, where nothing is known


def with_rests(solution: Solution) -> Solution | None:
    """The first real orbit that is found with rests near the times of `solution`, which passes a stop."""
    t, P = solution.times, solution.P
    flights = np.diff(np.append(t, t[0] + P))
    for rests in _patterns(solution):
        for share in SHARES:
            ends = (t + share * flights)[list(rests)]
            u = np.concatenate([t, solution.jumps, ends])
            guess = Solution(solution.family, solution.sigma, solution.half_periods, solution.sides, u, 0.0, rests)
            found = guess.corrected()
            if found is not None and found.real:
                return found
    return None


def evenly(start: Solution):
    """Guesses with impacts at equal distances, for an orbit of this kind without times."""
    K, P, q = len(start.sides), start.P, start.family.linear
    for first in np.arange(PHASES) / PHASES:
        times = (first + np.arange(K) / K) * P
        jumps = -np.array(start.sides) * q.omega * np.abs(q.contact.stop(start.sides))
        u = np.concatenate([times, jumps])
        yield Solution(start.family, start.sigma, start.half_periods, start.sides, u)


def _patterns(solution: Solution) -> list[tuple[int, ...]]:
    """The impacts after which it may rest: those that would press into the stop, all with R = 0, the last ones in a
    row."""
    q, sides = solution.family.linear, np.array(solution.sides, float)
    dead = q.contact.restitution(sides) == 0
    N = q.masses
    after = solution.motion[:, 1] + solution.jumps * flow(q).B[N, N]
    last = np.append(sides[1:], solution.sigma * sides[0]) != sides
    chosen = dead & (sides * after > 0), dead, dead & last
    patterns = [tuple(map(int, np.flatnonzero(which))) for which in chosen]
    return [p for k, p in enumerate(patterns) if p and p not in patterns[:k]]
