"""Which recorded orbits of a sweep lie on the orbit of a window, or on its mirror image."""

import numpy as np

from vibro_sweep.analysis.branches.flat import Flat, section_states, solution_of
from vibro_sweep.analysis.periodic.event_equations import EventEquations, contact_of
from vibro_sweep.analysis.periodic.motion_between import moves_stops_only, sections_of
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import ALIKE, Solution
from vibro_sweep.analysis.windows.job import is_near
from vibro_sweep.engine.impulses.flow import contact_coordinates
from vibro_sweep.model.bifurcations import BIRTHS, BY_NAME, TYPES
from vibro_sweep.model.linear import Linear, family_of


def members(flat: Flat, system, parameter: str, values: np.ndarray, states: np.ndarray) -> np.ndarray:
    """(m, starts) whether section states (m, starts, 2N) at m values within a window lie on its orbit."""
    result = np.zeros(states.shape[:2], bool)
    for i, sections in enumerate(_sections(flat, system, parameter, values)):
        result[i] = [is_near(sections, state) for state in states[i]]
    return result


def solution_in(flat: Flat, value: float, system) -> Solution | None:
    """The orbit of a window at a value within it, where it is known to be real; None where Newton's method fails."""
    parts = _between(flat, np.array([value]))
    return solution_of(flat, system, *(part[0] for part in parts)).corrected()


def _between(flat: Flat, values: np.ndarray) -> list[np.ndarray]:
    """Times and speeds of impacts, and ends of rests, (m, K) each, from the neighbouring points of the branch.

    Beside a fold, or where the orbit is born, they move like the square root of the distance from there: on a straight
    line Newton's method would find the parent.
    """
    p = flat["value"]
    i = np.clip(np.searchsorted(p, values) - 1, 0, len(p) - 2)
    length = p[i + 1] - p[i]
    share = np.where(length > 0, (values - p[i]) / np.where(length > 0, length, 1.0), 0.0)
    if _turns(flat, 0):
        share = np.where(i == 0, np.sqrt(np.maximum(share, 0.0)), share)
    if _turns(flat, -1):
        share = np.where(i == len(p) - 2, 1 - np.sqrt(np.maximum(1 - share, 0.0)), share)
    share = share[:, None]
    return [
        (1 - share) * flat[name][i] + share * flat[name][i + 1] for name in ("impact_t", "impact_v", "impact_t_off")
    ]


def _turns(flat: Flat, end: int) -> bool:
    """Whether the branch turns back at an end (0 or -1) of a window: at a fold, and where a doubled or asymmetric orbit
    is born, whose halves are alike there."""
    kind = TYPES[int(flat["special_type"][end])].name
    if kind == "fold":
        return True
    K, t, v = len(flat["impact_side"]), flat["impact_t"][end], flat["impact_v"][end]
    if kind not in BIRTHS or flat["branch_symmetric"] or K % 2:
        return False
    sign = BY_NAME[kind].sigma
    lengths, speeds = np.diff(t), v[K // 2 :] - sign * v[: K // 2]
    apart = np.abs(lengths[K // 2 :] - lengths[: K // 2 - 1]).max(initial=0.0)
    return bool(np.abs(speeds).max() < ALIKE * np.abs(v).max() and apart < ALIKE * lengths.max())


def _sections(flat: Flat, system, parameter: str, values: np.ndarray) -> list[np.ndarray]:
    """(s, 2N) for each value: all section states of the orbit and its mirror image; none where it is not found.

    All at once where the parameter moves the stops and the restitution only, and nothing else speaks against it.
    """
    if not len(values):
        return []
    parts, family = _between(flat, values), family_of(system)
    there = [family.replace(**{parameter: float(value)}) for value in values]
    first = solution_of(flat, there[0], *(part[0] for part in parts))
    q = first.family.linear
    if not moves_stops_only(family.derivative(parameter)) or first.rests:
        return [_section_states(solution_of(flat, one, *impacts)) for one, *impacts in zip(there, *parts, strict=True)]
    oscillators, sides = [one.stops(parameter, q)[0] for one in there], np.array(first.sides)
    gains = np.array([1 + one.restitution(sides) for one in oscillators]).reshape(len(values), first.K)
    guesses = np.hstack([parts[0][:, : first.K], -gains * parts[1][:, : first.K]])
    unknowns, change = EventEquations.of(first).newton(guesses, np.array([contact_of(one) for one in oscillators]))
    gaps = np.array([one.stop(sides[0]) if first.K else 0.0 for one in oscillators])
    found = _masses(q, sections_of(q, first.sigma, first.halves, unknowns, gaps))
    found = [_own(q, first, states) for q, states in zip(oscillators, found, strict=True)]
    return [states if ok else states[:0] for states, ok in zip(found, np.isfinite(change), strict=True)]


def _section_states(solution: Solution) -> np.ndarray:
    found = solution.corrected()
    if found is None:
        return np.empty((0, 2 * len(solution.family.linear.along)))
    return section_states(PeriodicOrbit(found.family, "ok", found))


def _own(q: Linear, solution: Solution, states: np.ndarray) -> np.ndarray:
    """Those at t = 0 mod T of states at the multiples of T/2; and of the mirror image, where that is another orbit."""
    if q.symmetric and solution.sigma == 1:  # x(t) -> -x(t + T/2)
        return np.concatenate([states[::2], -states[1::2]])
    return states[::2]


def _masses(q: Linear, states: np.ndarray) -> np.ndarray:
    """States (.., 2N) as x1 v1 .. xN vN from contact coordinates."""
    return contact_coordinates(q).to_masses(states)
