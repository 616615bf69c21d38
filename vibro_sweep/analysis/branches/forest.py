"""Branches from branches, as tasks that any worker can do: the same branches in the same order however many there are.

A task follows one branch and switches at its special points. Of the orbits that it finds beyond these, those that lie
on a branch that is known are left out; so is a branch of the same generation that an earlier one has passed.
"""

import json
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.continuation import Branch, continue_orbit, not_followed
from vibro_sweep.analysis.branches.flat import Flat, flatten, orbit_at, section_states
from vibro_sweep.analysis.branches.recognising import clearest, passes, point_of
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.branches.switching import switch
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.linear import family_of

LEAST = 1e-4  # distance of a graze from the onset of sticking, as a part of the range, to which branches are followed


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

    Towards an onset of sticking branches without end follow each other, with one impact more on each: beyond grazes
    that are nearer to it than a small part of the range nothing is looked for.
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
    """A branch that is known: the name of its task, its arrays, its seed, and how many special points lie between it
    and the first branches."""

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
    at_once : tasks that it is given together; None: all of a generation. The branches do not depend on it; if it is 1,
        those that an earlier one of their generation has passed are not followed
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
                if not _lies_on(known[first:], parameter, task.seed) and not _is_known(known, flat, task):
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


def _lies_on(trees: list[Tree], parameter: str, seed: Seed) -> bool:
    s = seed.solution
    return any(passes(tree.flat, parameter, seed.system, s) for tree in trees)


def _is_known(trees: list[Tree], flat: Flat, task: Task) -> bool:
    """Whether a branch is one of these, also where that could not be told from its seed, which lies next to a birth or
    a fold."""
    i = clearest(flat)
    system = task.seed.system.replace(**{task.parameter: float(flat["value"][i])})
    s = point_of(flat, i, system)
    return any(passes(tree.flat, task.parameter, system, s) for tree in trees)
