"""Which recorded orbits of a sweep lie on the orbit of a window, or on its mirror image."""

import math

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import section_states
from vibro_sweep.analysis.branches.branch_orbits import Arrays, solution_of
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import ALIKE, Solution, corrected
from vibro_sweep.analysis.windows.job import are_near
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.tables.bifurcations import BIRTHS, BY_NAME, TYPES


def members(arrays: Arrays, system, parameter: str, values: np.ndarray, states: np.ndarray) -> np.ndarray:
    """(m, starts) whether section states (m, starts, 2N) at m values within a window lie on its orbit."""
    family, result = family_of(system), np.zeros(states.shape[:2], bool)
    guesses = [solution_of(arrays, family.replace(**{parameter: p}), *guess_at(arrays, p)) for p in values.tolist()]
    for i, found in enumerate(corrected(guesses)):
        if found is not None:
            sections = section_states(PeriodicOrbit(found.family, "ok", found, (0, 0)))
            result[i] = are_near(sections, states[i], found.family.linear.omega)
    return result


def solution_in(arrays: Arrays, value: float, system) -> Solution | None:
    """The orbit of a window at a value within it, where it is known to be real; None where Newton's method fails."""
    return solution_of(arrays, system, *guess_at(arrays, value)).corrected()


def guess_at(arrays: Arrays, value: float) -> list[np.ndarray]:
    """Times and speeds of impacts, and ends of rests, (K,) each, from the neighbouring points of the branch.

    Beside a fold, or where the orbit is born, they move like the square root of the distance from there: on a straight
    line Newton's method would find the parent.
    """
    p = arrays["value"]
    i = int(np.clip(np.searchsorted(p, value) - 1, 0, len(p) - 2))
    share = (value - p[i]) / (p[i + 1] - p[i]) if p[i + 1] > p[i] else 0.0
    if i == 0 and _turns(arrays, 0):
        share = math.sqrt(max(share, 0.0))
    if i == len(p) - 2 and _turns(arrays, -1):
        share = 1 - math.sqrt(max(1 - share, 0.0))
    return [
        (1 - share) * arrays[name][i] + share * arrays[name][i + 1] for name in ("impact_t", "impact_v", "impact_t_off")
    ]


def _turns(arrays: Arrays, end: int) -> bool:
    """Whether the branch turns back at an end (0 or -1) of a window: at a fold, and where a doubled or asymmetric orbit
    is born, whose halves are alike there."""
    kind = TYPES[int(arrays["special_type"][end])].name
    if kind == "fold":
        return True
    K, t, v = len(arrays["impact_side"]), arrays["impact_t"][end], arrays["impact_v"][end]
    if kind not in BIRTHS or arrays["branch_symmetric"] or K % 2:
        return False
    sign = BY_NAME[kind].sigma
    lengths, speeds = np.diff(t), v[K // 2 :] - sign * v[: K // 2]
    apart = np.abs(lengths[K // 2 :] - lengths[: K // 2 - 1]).max(initial=0.0)
    return bool(np.abs(speeds).max() < ALIKE * np.abs(v).max() and apart < ALIKE * lengths.max())
