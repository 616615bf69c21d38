"""Branches from branches, as tasks that any worker can do: the same branches in the same order however many there are.

A task follows one branch and switches at its special points. Of the orbits that it finds beyond these, those that lie on
a branch that is known are left out; so is a branch of the same generation that an earlier one has passed.
"""

import json
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.continuation import Branch, continue_orbit, not_followed
from vibro_sweep.analysis.branches.flat import Flat, flatten, orbit_at, section_states, solution_of
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.branches.switching import switch
from vibro_sweep.analysis.periodic.itinerary import word
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.linear import family_of

LEAST = 1e-4  # distance of a graze from the onset of sticking, as a part of the range, to which branches are followed
SAME = 1e-7  # relative difference of the impact speeds of one orbit, found twice


class Seed(NamedTuple):
    """An orbit as plain numbers, and where it was found: in the branch `parent`, at its special point `special`."""

    system: Any
    sigma: int
    halves: int
    sides: tuple[int, ...]
    u: tuple[float, ...]
    rests: tuple[int, ...]
    parent: int = -1
    special: int = -1

    @property
    def solution(self) -> Solution:
        return Solution(family_of(self.system), self.sigma, self.halves, self.sides, np.array(self.u), 0.0, self.rests)

    def orbit(self) -> PeriodicOrbit:
        return orbit_of(self.system, self.solution)


def seed_of(orbit: PeriodicOrbit) -> Seed:
    s = orbit._solution
    return Seed(
        orbit.system, s.sigma, s.halves, tuple(map(int, s.sides)), tuple(s.u.tolist()), tuple(map(int, s.rests))
    )


class Task(NamedTuple):
    """A branch to be followed, and the types of special points at which to look for others."""

    seed: Seed
    parameter: str
    bounds: tuple[float, float]
    follow: tuple[str, ...]


@one_thread()
def grow(task: Task) -> Flat:
    """The branch of a task, with `section`, and with `beyond`, as `written` has it."""
    branch = followed(task)
    flat = flatten(branch, task.seed.solution.family.numbers[task.parameter])
    flat["section"] = _sections(flat, task)
    return flat | written(beyond(branch, task), task.parameter)


def followed(task: Task, progress=None) -> Branch:
    """The branch of a task; with the status failed where it cannot be followed, so that the others are not lost."""
    orbit = task.seed.orbit()
    try:
        return continue_orbit(orbit, task.parameter, task.bounds, progress)
    except ValueError:  # no orbit beside a special point is within the bounds
        return not_followed(orbit, task.parameter)


def beyond(branch: Branch, task: Task) -> list[Seed]:
    """The orbits within the bounds beyond the special points of a branch at which others are looked for.

    Towards an onset of sticking branches without end follow each other, with one impact more on each: beyond grazes that
    are nearer to it than a small part of the range nothing is looked for.
    """
    lo, hi = task.bounds
    found = []
    for index, special in enumerate(branch.special):
        if special.type in task.follow and not accumulates(branch, special, LEAST * (hi - lo)):
            orbits = [orbit for orbit in switch(special) if lo <= orbit._solution.family.numbers[task.parameter] <= hi]
            found += [seed_of(orbit)._replace(special=index) for orbit in orbits]
    return found


def written(seeds: list[Seed], parameter: str) -> Flat:
    """`beyond`: seeds as JSON, with their numbers to the last bit."""
    text = json.dumps([[seed.solution.family.numbers[parameter], *seed[1:6], seed.special] for seed in seeds])
    return {"beyond": np.frombuffer(text.encode(), np.uint8)}


def accumulates(branch: Branch, end: SpecialPoint, reach: float) -> bool:
    """Whether `end` is a graze of this branch within `reach` of the onset of sticking beyond it."""
    for outermost, last in ((branch.special[0], branch.begins), (branch.special[-1], branch.ends)):
        if end is last and outermost is not last:
            return abs(outermost.parameters[branch.parameter] - end.parameters[branch.parameter]) < reach
    return False


def _sections(flat: Flat, task: Task) -> np.ndarray:
    """(n, m, 2N) all section states of each point: those at t = 0 mod T of the orbit and of its mirror image."""
    systems = [task.seed.system.replace(**{task.parameter: value}) for value in flat["value"].tolist()]
    return np.array([section_states(orbit_at(flat, i, system)) for i, system in enumerate(systems)])


class Tree(NamedTuple):
    """A branch that is known: the name of its task, its arrays, its seed, and how many special points away from the first
    branches it is."""

    name: str
    flat: Flat
    seed: Seed
    generation: int


Evaluate = Callable[[list[str], list[Task]], list[Flat]]


def forest(
    seeds: list[Seed],
    parameter: str,
    bounds: tuple[float, float],
    follow: tuple[str, ...],
    depth: int,
    evaluate: Evaluate,
    at_once: int | None = None,
) -> list[Tree]:
    """All branches, generation by generation.

    evaluate : gives the arrays of branches, `outline` (flat.py) and `beyond` at least, of tasks by their names
    at_once : tasks that it is given together; None: all of a generation. The branches do not depend on it, but those that
        an earlier one of their generation has passed need not be followed if it is 1
    """
    known: list[Tree] = []
    for generation in range(depth + 1):
        looked, first = follow if generation < depth else (), len(known)
        seeds = [seed for seed in seeds if not _lies_on(known, parameter, seed)]
        named = [(f"{generation}:{i}", Task(seed, parameter, bounds, looked)) for i, seed in enumerate(seeds)]
        for batch in _batches(named, at_once):
            todo = [(name, task) for name, task in batch if not _lies_on(known[first:], parameter, task.seed)]
            flats = evaluate([name for name, _ in todo], [task for _, task in todo])
            for (name, task), flat in zip(todo, flats, strict=True):
                if not _lies_on(known[first:], parameter, task.seed) and not _lies_on(known, *_middle(flat, task)):
                    known.append(Tree(name, flat, task.seed, generation))
        seeds = [seed for i in range(first, len(known)) for seed in _beyond(known[i], i, parameter)]
    return known


def _batches(items: list, size: int | None) -> Iterator[list]:
    size = size or max(len(items), 1)
    for begin in range(0, len(items), size):
        yield items[begin : begin + size]


def _beyond(tree: Tree, parent: int, parameter: str) -> list[Seed]:
    result = []
    for value, sigma, halves, sides, u, rests, special in json.loads(tree.flat["beyond"].tobytes().decode()):
        system = tree.seed.system.replace(**{parameter: value})
        result.append(Seed(system, sigma, halves, tuple(sides), tuple(u), tuple(rests), parent, special))
    return result


def _middle(flat: Flat, task: Task) -> tuple[str, Seed]:
    """An orbit of a branch where it is farthest from a fold: next to one Newton's method tells orbits badly apart."""
    p, names = flat["value"], ("impact_t", "impact_v", "impact_t_off")
    i = int(np.argmax(np.abs(p[2:] - p[:-2]))) + 1 if len(p) > 2 else 0
    system = task.seed.system.replace(**{task.parameter: float(p[i])})
    s = solution_of(flat, system, *(flat[name][i] for name in names))
    return task.parameter, Seed(system, s.sigma, s.halves, s.sides, tuple(s.u.tolist()), s.rests)


def _lies_on(trees: list[Tree], parameter: str, seed: Seed) -> bool:
    return any(passes(tree.flat, parameter, seed) for tree in trees)


def passes(flat: Flat, parameter: str, seed: Seed) -> bool:
    """Whether an orbit, or its mirror image, lies on a branch: by Newton's method from its points on both sides."""
    s = seed.solution
    if _kind_on(flat, s.family.linear.symmetric) != _kind_of(s):
        return False
    offset = flat["value"] - s.family.numbers[parameter]
    names = ("impact_t", "impact_v", "impact_t_off")
    if len(offset) == 1:  # a branch that could not be followed
        return not offset[0] and alike(solution_of(flat, seed.system, *(flat[name][0] for name in names)), s)
    for i in np.flatnonzero(offset[:-1] * offset[1:] <= 0):
        share = offset[i] / (offset[i] - offset[i + 1]) if offset[i] != offset[i + 1] else 0.0
        parts = [(1 - share) * flat[name][i] + share * flat[name][i + 1] for name in names]
        found = solution_of(flat, seed.system, *parts).corrected()
        if found is not None and alike(found, s):
            return True
    return False


def _kind_of(s: Solution) -> tuple:
    """Equal for orbits that may be rotations or mirror images of each other."""
    sides, period = (s.sides, s.halves // 2) if s.sigma == 1 else ((*s.sides, *(-side for side in s.sides)), s.halves)
    rests = len(s.rests) * (1 if s.sigma == 1 else 2)
    return _least_word(sides, s.family.linear.symmetric), period, s.sigma == -1, rests


def _kind_on(flat: Flat, mirrors: bool) -> tuple:
    """`_kind_of` the orbits of a branch."""
    rests = int(np.isfinite(flat["impact_t_off"][0]).sum())
    return _least_word(flat["impact_side"], mirrors), int(flat["branch_period"]), bool(flat["branch_symmetric"]), rests


def _least_word(sides, mirrors: bool) -> str:
    """Of all rotations and, if orbits have mirror images, of those of the other sides."""
    words = [word(sides)] + ([word(-np.asarray(sides))] if mirrors else [])
    return min(one[k:] + one[:k] for one in words for k in range(max(len(one), 1)))


def alike(a: Solution, b: Solution) -> bool:
    speeds = [np.sort(np.abs(s.jumps)) for s in (a, b)]
    return bool(np.abs(speeds[0] - speeds[1]).max(initial=0.0) <= SAME * max(speeds[0].max(initial=0.0), 1e-300))
