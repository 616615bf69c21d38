"""Curves from curves: a task follows one, and at its points of codimension two looks for others.

What lies on a curve that is known is not followed again: the same bifurcation of the same orbit, up to rotation and
mirror image.
"""

from dataclasses import dataclass

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import Arrays
from vibro_sweep.analysis.branches.recognising import apart, rotates
from vibro_sweep.analysis.branches.search import Bounds, Search, Task
from vibro_sweep.analysis.branches.seeds import Seed, packed, seed_of
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.first_point import first_place
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import keeps_symmetry
from vibro_sweep.analysis.curves.bifurcation_curve import bifurcation_curve
from vibro_sweep.analysis.curves.curve_arrays import arrays_of, solution_at, start_from, type_of
from vibro_sweep.analysis.curves.curve_start import as_special, start_at
from vibro_sweep.analysis.curves.curve_switching import ENDS, switch
from vibro_sweep.analysis.periodic.itinerary import word
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.solution import Solution

NEAR = 0.003  # of the bounds: farther than that from the chord of two neighbouring points their curve does not lead
MOST = 8  # times that a curve comes so near, of thousands that rounding makes where points lie close together
SAME = 1e-8  # of the bounds; of impulses a hundred times as much


def seed_at(special: SpecialPoint, names: tuple[str, str], index: int = -1) -> Seed | None:
    """None where no curve starts: of a type that has none, or where the mass rests. index : of the special point"""
    try:
        return seed_of(special.orbit.system, start_at(special, names), special.parameters, index)
    except ValueError:
        return None


@one_thread()
def compute_curve(task: Task) -> Arrays:
    """The curve of a task, with the seeds on it, as `packed` has them; nothing where there is no curve."""
    seed, names = task.seed, task.names
    special = as_special(seed.start, seed.parameters, seed.system)
    try:
        curve = bifurcation_curve(special, names, task.bounds, virtual=False)
    except ValueError:  # it belongs to several curves at once, or there is no motion beside it
        return {}
    beyond = []
    for index, one in enumerate(curve.special):
        for other in switch(one) if task.of and one.type not in ENDS else ():
            found = seed_at(other, names, index) if other.type in task.of else None
            if found is not None:
                beyond.append(found)
    return arrays_of(curve) | packed(beyond, names)


@dataclass(frozen=True)
class Curves(Search):
    """A search for curves of bifurcations in two parameters."""

    at_once: int | None = 8

    def passes(self, arrays: Arrays, seed: Seed) -> bool:
        """Whether a seed lies on the curve, by Newton's method from the points of the curve beside it."""
        if seed.type != type_of(arrays) or not _may_pass(arrays, seed, self.names):
            return False
        solution, place, size = seed.solution, seed.place(self.names), np.ptp(self.bounds, axis=1)
        least = 100 * SAME * solution.family.linear.omega * solution.size_of_gap
        for s in np.flatnonzero(np.all(np.abs(arrays["special_value"] - place) <= SAME * size, axis=1)):
            if apart(_solution(arrays, int(arrays["special_point"][s]), seed, self.names), solution) <= least:
                return True
        crossings = _crossings(arrays, seed, self.names, self.bounds, place, size)
        return any(apart(found, solution) <= least for found in crossings)


def _crossings(arrays: Arrays, seed: Seed, names, bounds: Bounds, place, size):
    """The orbits of a curve where it passes the place, if it does."""
    at = arrays["value"] / size
    chord, away = np.diff(at, axis=0), place / size - at[:-1]
    share = np.clip((away * chord).sum(axis=1) / np.maximum((chord**2).sum(axis=1), 1e-300), 0, 1)
    distance = np.hypot(*(away - share[:, None] * chord).T)
    beside = np.pad(distance, 1, constant_values=np.inf)
    nearest = (distance <= beside[:-2]) & (distance <= beside[2:])  # of each time that the curve comes near
    near = np.flatnonzero(nearest & (distance < NEAR))
    for i in near[np.argsort(distance[near], kind="stable")][:MOST]:
        row = int(i + (share[i] > 0.5))
        row = min(max(row, 1), len(at) - 2) if len(at) > 2 else row  # at its ends a curve may be singular
        system = seed.system.replace(**dict(zip(names, map(float, arrays["value"][row]), strict=True)))
        curve = SolutionCurve(start_from(arrays, row, system), names, bounds)
        first, axis = first_place(curve), int(abs(chord[i, 1]) > abs(chord[i, 0]))
        found = None if first is None else curve.level(first, axis, float(place[axis]))
        if found is not None and np.all(np.abs(found.p[:2] - place) <= SAME * size):
            yield curve.solution(found)


def _solution(arrays: Arrays, point: int, seed: Seed, names) -> Solution:
    values = dict(zip(names, map(float, arrays["value"][point]), strict=True))
    return solution_at(arrays, point, seed.system.replace(**values))


def _may_pass(arrays: Arrays, seed: Seed, names) -> bool:
    """Whether the orbit may be a rotation, or a mirror image, of those of a curve: by its period and its impacts."""
    s, whole = seed.solution, seed.solution.whole()
    if whole.half_periods != 2 * arrays["branch_period"]:
        return False
    own = _word(whole.sides, seed.index if seed.type == "graze" else -1, s.sigma == -1)
    known = _word(arrays["impact_side"], int(arrays["branch_grazing"]), bool(arrays["branch_symmetric"]))
    mirrors = s.family.linear.symmetric and all(keeps_symmetry(s.family, name) for name in names)
    return rotates(known, own, mirrors)


def _word(sides, grazing: int, symmetric: bool) -> str:
    """R and L of impacts, r and l of those that graze."""
    graze = {grazing, grazing + len(sides) // 2} if symmetric and grazing >= 0 else {grazing}
    return "".join(letter.lower() if i in graze else letter for i, letter in enumerate(word(sides)))
