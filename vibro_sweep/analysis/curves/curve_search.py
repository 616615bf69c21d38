"""Curves from curves: a task follows one, and at its points of codimension two looks for others.

What lies on a curve that is known is not followed again: the same bifurcation of the same orbit, up to rotation and
mirror image.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches import seeds as orbits
from vibro_sweep.analysis.branches.flat import Flat
from vibro_sweep.analysis.branches.search import Evaluate, Node, search
from vibro_sweep.analysis.branches.seeds import Seed, packed, seed_of, unpacked
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.first_point import first_place
from vibro_sweep.analysis.continuation.start import KINDS, Start, keeps_symmetry
from vibro_sweep.analysis.continuation.tracer import Tracer
from vibro_sweep.analysis.curves.continuation import bifurcation_curve
from vibro_sweep.analysis.curves.flat import flatten, solution_at, start_from
from vibro_sweep.analysis.curves.start import as_special, start_at
from vibro_sweep.analysis.curves.switching import ENDS, switch
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit import orbit_of
from vibro_sweep.analysis.periodic.solution import Solution

AT_ONCE = 8  # curves that are followed before it is asked again which starts lie on known ones
NEAR = 0.003  # of the box: farther than that from the chord of two neighbouring points their curve does not lead
TYPES = tuple(KINDS)
SHAPES = orbits.SHAPES | {  # of `packed_curves`
    "q": f"{orbits.SHAPES['q']} beyond_type beyond_index beyond_theta",
    "q 2": "beyond_parameters",  # whether each of the names is one of a seed's `parameters`
}
SAME = 1e-8  # of the box; of impulses a hundred times as much

Box = tuple[tuple[float, float], tuple[float, float]]


class CurveSeed(NamedTuple):
    """A bifurcation of an orbit as plain numbers; orbit.parent, orbit.special: of codimension two, where it was met."""

    type: str
    index: int  # of the impact that grazes
    theta: float
    parameters: tuple[str, ...]  # those of its special point: one of a branch's, two of a curve's
    orbit: Seed
    word: tuple  # equal for bifurcations that may be those of one orbit, rotated or mirrored

    @property
    def start(self) -> Start:
        return Start(self.type, self.orbit.solution, self.index, self.theta)


def seed_at(special: SpecialPoint, names: tuple[str, str], index: int = -1) -> CurveSeed | None:
    """None where no curve starts: of a type that has none, or where the mass rests. index : of the special point"""
    try:
        start = start_at(special, names)
    except ValueError:
        return None
    orbit = seed_of(orbit_of(special.orbit.system, start.solution))._replace(special=index)
    return _seed(start.type, start.index, start.theta, tuple(special.parameters), orbit, names)


def _seed(kind: str, index: int, theta: float, parameters: tuple[str, ...], orbit: Seed, names) -> CurveSeed:
    return CurveSeed(kind, index, theta, parameters, orbit, _word(kind, index, orbit.solution, names))


def packed_curves(seeds: list[CurveSeed], names: tuple[str, str]) -> Flat:
    """Arrays `SHAPES` of q seeds that differ from one oscillator in the two parameters `names` alone."""
    return packed([seed.orbit for seed in seeds], names) | {
        "beyond_type": np.array([TYPES.index(seed.type) for seed in seeds], int),
        "beyond_index": np.array([seed.index for seed in seeds], int),
        "beyond_theta": np.array([seed.theta for seed in seeds], float),
        "beyond_parameters": np.array([[n in seed.parameters for n in names] for seed in seeds], bool).reshape(-1, 2),
    }


def fit_together(flat: Flat) -> bool:
    """Whether arrays of these shapes are of seeds."""
    types = flat["beyond_type"]
    return orbits.fit_together(flat) and bool(np.all((types >= 0) & (types < len(TYPES))))


def unpacked_curves(flat: Flat, names: tuple[str, str], system, parent: int = -1) -> list[CurveSeed]:
    """The seeds of `packed_curves`. system : one of their oscillators"""
    seeds = []
    for i, orbit in enumerate(unpacked(flat, names, system, parent)):
        own = tuple(name for name, there in zip(names, flat["beyond_parameters"][i], strict=True) if there)
        kind, index = TYPES[flat["beyond_type"][i]], int(flat["beyond_index"][i])
        seeds.append(_seed(kind, index, float(flat["beyond_theta"][i]), own, orbit, names))
    return seeds


class CurveTask(NamedTuple):
    """A curve to be followed, and the types of curves to look for at its points of codimension two."""

    seed: CurveSeed
    names: tuple[str, str]
    box: Box
    of: tuple[str, ...]


@one_thread()
def trace(task: CurveTask) -> Flat:
    """The curve of a task, with the seeds on it, as `packed_curves` has them; nothing where there is no curve."""
    seed, names = task.seed, task.names
    special = as_special(seed.start, seed.parameters, seed.orbit.system)
    try:
        curve = bifurcation_curve(special, names, task.box, virtual=False)
    except ValueError:  # it belongs to several curves at once, or there is no motion beside it
        return {}
    beyond = []
    for index, one in enumerate(curve.special):
        for other in switch(one) if task.of and one.type not in ENDS else ():
            found = seed_at(other, names, index) if other.type in task.of else None
            if found is not None:
                beyond.append(found)
    return flatten(curve) | packed_curves(beyond, names)


class Curves(NamedTuple):
    """What a search for curves is told (`Searched`): in the parameters `names` within `box`, of the types `of`."""

    names: tuple[str, str]
    box: Box
    of: tuple[str, ...]

    def task(self, seed: CurveSeed, look: bool) -> CurveTask:
        return CurveTask(seed, self.names, self.box, self.of if look else ())

    def lies_on(self, known: list[Node], seed: CurveSeed) -> bool:
        """A bifurcation, or its mirror image."""
        alike = (node.flat for node in known if node.seed.word == seed.word)
        return any(lies_on(flat, seed, self.names, self.box) for flat in alike)

    def is_known(self, known: list[Node], flat: Flat, seed: CurveSeed) -> bool:
        return False  # a seed lies on its curve

    def beyond(self, node: Node, index: int) -> list[CurveSeed]:
        return unpacked_curves(node.flat, self.names, node.seed.orbit.system, index)

    def search(self, seeds: list[CurveSeed], depth: int, evaluate: Evaluate, known: list[Node] | tuple = ()):
        """Curves, list of Node, generation by generation, behind those that are `known`; evaluate : gives `trace`"""
        return search(self, seeds, depth, evaluate, AT_ONCE, known)


def lies_on(flat: Flat, seed: CurveSeed, names, box: Box) -> bool:
    """Whether a bifurcation lies on a curve of orbits like its own: by Newton's method from the points beside it."""
    solution, place, size = seed.orbit.solution, seed.orbit.place(names), np.ptp(box, axis=1)
    speeds, scale = _speeds(solution), solution.family.linear.omega * solution.size_of_gap

    def alike(other: Solution) -> bool:
        return bool(np.abs(_speeds(other) - speeds).max(initial=0.0) <= 100 * SAME * scale)

    for s in np.flatnonzero(np.all(np.abs(flat["special_value"] - place) <= SAME * size, axis=1)):
        if alike(_solution(flat, int(flat["special_point"][s]), seed, names)):
            return True
    return any(alike(found) for found in _crossings(flat, seed, names, box, place, size))


def _crossings(flat: Flat, seed: CurveSeed, names, box: Box, place, size):
    """The orbits of a curve where it passes the place, if it does."""
    at = flat["value"] / size
    chord, away = np.diff(at, axis=0), place / size - at[:-1]
    share = np.clip((away * chord).sum(axis=1) / np.maximum((chord**2).sum(axis=1), 1e-300), 0, 1)
    for i in np.flatnonzero(np.hypot(*(away - share[:, None] * chord).T) < NEAR):
        row = int(i + (share[i] > 0.5))
        row = min(max(row, 1), len(at) - 2) if len(at) > 2 else row  # at its ends a curve may be singular
        system = seed.orbit.system.replace(**dict(zip(names, map(float, flat["value"][row]), strict=True)))
        tracer = Tracer(start_from(flat, row, system), names, box)
        first, axis = first_place(tracer), int(abs(chord[i, 1]) > abs(chord[i, 0]))
        found = None if first is None else tracer.level(first, axis, float(place[axis]))
        if found is not None and np.all(np.abs(found.p[:2] - place) <= SAME * size):
            yield tracer.solution(found)


def _solution(flat: Flat, point: int, seed: CurveSeed, names) -> Solution:
    values = dict(zip(names, map(float, flat["value"][point]), strict=True))
    return solution_at(flat, point, seed.orbit.system.replace(**values))


def _speeds(solution: Solution) -> np.ndarray:
    """Of a whole period, sorted."""
    return np.sort(np.abs(solution.whole().jumps))


def _word(kind: str, grazing: int, solution: Solution, names) -> tuple:
    """Type, period and impacts of a bifurcation, equal for all rotations and mirror images."""
    mirrors = solution.family.linear.symmetric and all(keeps_symmetry(solution.family, name) for name in names)
    sides, symmetric = list(map(int, solution.whole().sides)), solution.sigma == -1
    letters = _letters(sides, {grazing} if kind == "graze" else set(), symmetric)
    return kind, solution.halves * (2 if symmetric else 1), _least(letters, mirrors)


def _letters(sides: list[int], grazing: set[int], symmetric: bool) -> list[int]:
    """+1, -1 of impacts; +2, -2 of those that graze."""
    half = len(sides) // 2
    return [side * (1 + (i in grazing or (symmetric and i - half in grazing))) for i, side in enumerate(sides)]


def _least(letters: list[int], mirrors: bool) -> tuple[int, ...]:
    """Of all rotations, and those of the mirror image."""
    words = [letters, [-letter for letter in letters]] if mirrors else [letters]
    return min(tuple(word[k:] + word[:k]) for word in words for k in range(max(len(word), 1)))
