"""Curves from curves, as jobs that any worker can do: the same curves in the same order however many there are.

A job follows one curve, and at its points of codimension two looks for others. What lies on a curve that is known is
not followed again: the same bifurcation of the same orbit, up to rotation and mirror image.
"""

import json
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.beginning import keeps_symmetry
from vibro_sweep.analysis.branches.flat import Flat
from vibro_sweep.analysis.branches.forest import Seed, seed_of
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.curves.continuation import bifurcation_curve
from vibro_sweep.analysis.curves.flat import as_special, flatten, solution_at, start_from
from vibro_sweep.analysis.curves.start import Start, start_at
from vibro_sweep.analysis.curves.switching import ENDS, switch
from vibro_sweep.analysis.curves.tracer import Tracer
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit import orbit_of
from vibro_sweep.analysis.periodic.solution import Solution

AT_ONCE = 8  # curves that are followed before it is asked again which starts lie on known ones
NEAR = 0.003  # of the box: farther than that from the chord of two neighbouring points their curve does not lead
SAME = 1e-8  # of the box; of impulses a hundred times as much

Box = tuple[tuple[float, float], tuple[float, float]]


class CurveSeed(NamedTuple):
    """A bifurcation of an orbit as plain numbers; orbit.parent, orbit.special: of codimension two, where it was met."""

    type: str
    index: int  # of the impact that grazes
    theta: float
    parameters: tuple[str, ...]  # those of its special point: one of a branch's, two of a curve's
    orbit: Seed

    @property
    def start(self) -> Start:
        return Start(self.type, self.orbit.solution, self.index, self.theta)

    def place(self, names: tuple[str, str]) -> np.ndarray:
        numbers = self.orbit.system.family.numbers
        return np.array([numbers[name] for name in names], float)


def seed_at(special: SpecialPoint, names: tuple[str, str], parent: int = -1, index: int = -1) -> CurveSeed | None:
    """None where no curve starts: of a type that has none, or where the mass rests."""
    try:
        start = start_at(special, names)
    except ValueError:
        return None
    orbit = seed_of(orbit_of(special.orbit.system, start.solution))._replace(parent=parent, special=index)
    return CurveSeed(start.type, start.index, start.theta, tuple(special.parameters), orbit)


class CurveTask(NamedTuple):
    """A curve to be followed, and the types of curves to look for at its points of codimension two."""

    seed: CurveSeed
    names: tuple[str, str]
    box: Box
    of: tuple[str, ...]


@one_thread()
def trace(task: CurveTask) -> Flat:
    """The curve of a task, with `beyond`: the starts found on it, as JSON; nothing else where there is no curve."""
    seed, names = task.seed, task.names
    values = dict(zip(names, seed.place(names).tolist(), strict=True))
    special = as_special(seed.start, {name: values[name] for name in seed.parameters}, seed.orbit.system)
    try:
        curve = bifurcation_curve(special, names, task.box, virtual=False)
    except ValueError:  # it belongs to several curves at once, or there is no motion beside it
        return {"beyond": np.zeros(0, np.uint8)}
    beyond = []
    for index, one in enumerate(curve.special):
        for other in switch(one) if task.of and one.type not in ENDS else ():
            found = seed_at(other, names) if other.type in task.of else None
            if found is not None:
                place = found.place(names).tolist()
                beyond.append([index, place, *found[:4], *found.orbit[1:6]])
    return flatten(curve) | {"beyond": np.frombuffer(json.dumps(beyond).encode(), np.uint8)}


class Traced(NamedTuple):
    """A curve that is known, and how many points of codimension two away from the first ones it is.

    word : equal for bifurcations that may be those of one orbit, rotated or mirrored
    """

    flat: Flat
    seed: CurveSeed
    generation: int
    word: tuple


Evaluate = Callable[[list[str], list[CurveTask]], list[Flat]]


def network(seeds: list[CurveSeed], names, box: Box, of: tuple[str, ...], depth: int, evaluate: Evaluate, known=()):
    """All curves, list of Traced, generation by generation, behind those that are `known`.

    evaluate : gives `trace` of tasks by their names
    """
    known = list(known)
    for generation in range(depth + 1):
        looked = of if generation < depth else ()
        first = len(known)
        for at in range(0, len(seeds), AT_ONCE):
            jobs = {}
            for i, seed in enumerate(seeds[at : at + AT_ONCE]):
                if not is_known(known, seed, names, box):
                    jobs[f"{generation}:{at + i}"] = CurveTask(seed, names, box, looked)
            for task, flat in zip(jobs.values(), evaluate(list(jobs), list(jobs.values())), strict=True):
                if "value" in flat and not is_known(known, task.seed, names, box):
                    known.append(Traced(flat, task.seed, generation, _word(task.seed, names)))
        seeds = [seed for i in range(first, len(known)) for seed in _beyond(known[i], i, names)]
    return known


def _beyond(one: Traced, parent: int, names) -> list[CurveSeed]:
    text, result = one.flat["beyond"].tobytes().decode(), []
    for special, place, kind, index, theta, parameters, sigma, halves, sides, u, rests in (
        json.loads(text) if text else ()
    ):
        system = one.seed.orbit.system.replace(**dict(zip(names, place, strict=True)))
        orbit = Seed(system, sigma, halves, tuple(sides), tuple(u), tuple(rests), parent, special)
        result.append(CurveSeed(kind, index, theta, tuple(parameters), orbit))
    return result


def is_known(known: list[Traced], seed: CurveSeed, names, box: Box) -> bool:
    """Whether a bifurcation, or its mirror image, lies on one of these curves."""
    word = _word(seed, names)
    return any(one.word == word and lies_on(one.flat, seed, names, box) for one in known)


def lies_on(flat: Flat, seed: CurveSeed, names, box: Box) -> bool:
    """Whether a bifurcation lies on a curve of orbits like its own: by Newton's method from the points beside it."""
    solution, place, size = seed.orbit.solution, seed.place(names), np.ptp(box, axis=1)
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
        first, axis = tracer.first(), int(abs(chord[i, 1]) > abs(chord[i, 0]))
        found = None if first is None else tracer.level(first, axis, float(place[axis]))
        if found is not None and np.all(np.abs(found.p[:2] - place) <= SAME * size):
            yield tracer.solution(found)


def _solution(flat: Flat, point: int, seed: CurveSeed, names) -> Solution:
    values = dict(zip(names, map(float, flat["value"][point]), strict=True))
    return solution_at(flat, point, seed.orbit.system.replace(**values))


def _speeds(solution: Solution) -> np.ndarray:
    """Of a whole period, sorted."""
    return np.sort(np.abs(solution.whole().jumps))


def _word(seed: CurveSeed, names) -> tuple:
    """Type, period and impacts of a bifurcation, equal for all rotations and mirror images."""
    solution = seed.orbit.solution
    mirrors = solution.family.linear.symmetric and all(keeps_symmetry(solution.family, name) for name in names)
    sides, symmetric = list(map(int, solution.whole().sides)), solution.sigma == -1
    letters = _letters(sides, {seed.index} if seed.type == "graze" else set(), symmetric)
    return seed.type, solution.halves * (2 if symmetric else 1), _least(letters, mirrors)


def _letters(sides: list[int], grazing: set[int], symmetric: bool) -> list[int]:
    """+1, -1 of impacts; +2, -2 of those that graze."""
    half = len(sides) // 2
    return [side * (1 + (i in grazing or (symmetric and i - half in grazing))) for i, side in enumerate(sides)]


def _least(letters: list[int], mirrors: bool) -> tuple[int, ...]:
    """Of all rotations, and those of the mirror image."""
    words = [letters, [-letter for letter in letters]] if mirrors else [letters]
    return min(tuple(word[k:] + word[:k]) for word in words for k in range(max(len(word), 1)))
