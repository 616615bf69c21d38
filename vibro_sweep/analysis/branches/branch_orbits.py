"""The orbits at the points of a branch, from the arrays that recognise them."""

import numpy as np

from vibro_sweep.analysis.branches.branch_points import impacts
from vibro_sweep.analysis.continuation.recorded import Rows
from vibro_sweep.analysis.periodic.contact_numbers import one_plus_R
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.free_modes import checked_cells
from vibro_sweep.oscillator.family import family_of

Arrays = dict[str, np.ndarray]


def outline(start: Solution, parameter: str, frame: tuple[int, int], rows: Rows) -> Arrays:
    """The arrays of a branch by which orbits on it are recognised; frame: the first impact, and the forcing periods
    before it."""
    t, sides, v = impacts(start, parameter, frame, rows)
    return {
        "branch_period": np.int32(start.whole().half_periods // 2),
        "branch_symmetric": np.int8(start.sigma == -1),
        "value": rows.p,
        "impact_t": t,
        "impact_v": v,
        "impact_t_off": _rest_ends(start, frame, rows, t),
        "impact_side": sides.astype(np.int8),
    }


def _rest_ends(start: Solution, frame: tuple[int, int], rows: Rows, t: np.ndarray) -> np.ndarray:
    """(n, K) ends of rests beside the impacts `t` in their canonical order, from those of the branch's own frame."""
    ends = np.full(t.shape, np.nan)
    K, (first, _) = start.K, frame
    for j, k in enumerate(start.rests):
        lengths = rows.ends[:, j] - rows.t[:, k]
        for place in range(k, t.shape[1], K):
            at = (place - first) % t.shape[1]
            ends[:, at] = t[:, at] + lengths
    return ends


def solution_of(arrays: Arrays, system, t, v, t_off) -> Solution:
    """The solution with these impacts (K,) of a branch, for the oscillator `system`; not corrected. TooStiffError."""
    family, symmetric = family_of(system), bool(arrays["branch_symmetric"])
    period, sides = int(arrays["branch_period"]), arrays["impact_side"]
    K = len(sides) // 2 if symmetric else len(sides)
    sides = tuple(map(int, sides[:K]))
    rests = tuple(np.flatnonzero(np.isfinite(t_off[:K])).tolist())
    D = -one_plus_R(family.linear, sides) * v[:K]
    u = np.concatenate([t[:K], D, t_off[list(rests)]])
    sigma, half_periods = (-1, period) if symmetric else (1, 2 * period)
    checked_cells(family.linear, half_periods)
    return Solution(family, sigma, half_periods, sides, u, 0.0, rests)


def orbit_at(arrays: Arrays, point: int, system) -> PeriodicOrbit:
    """The orbit at a point of a branch; `system` has the parameter's value there."""
    solution = solution_of(arrays, system, *(arrays[name][point] for name in ("impact_t", "impact_v", "impact_t_off")))
    return orbit_of(system, solution)
