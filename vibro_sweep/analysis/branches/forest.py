"""Branches from branches, as jobs that any worker can do: the same branches in the same order however many there are.

A job follows one branch and switches at its special points. Of the orbits that it finds beyond these, those that lie on
a branch that is known are left out; so is a branch of the same generation that an earlier one has passed.
"""

import json
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.continuation import continue_orbit
from vibro_sweep.analysis.branches.flat import Flat, flatten, orbit_at, section_states, solution_of
from vibro_sweep.analysis.branches.generations import alike, kind_of
from vibro_sweep.analysis.branches.switching import switch
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.linear import family_of


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
    """The branch of a task, with `beyond`: the orbits found at its special points, as JSON; empty without a branch."""
    try:
        branch = continue_orbit(task.seed.orbit(), task.parameter, task.bounds)
    except ValueError:  # an orbit that cannot be corrected
        return {"beyond": np.zeros(0, np.uint8)}
    beyond = []
    for index, special in enumerate(branch.special):
        if special.type not in task.follow:
            continue
        for orbit in switch(special):
            value = orbit._solution.family.numbers[task.parameter]
            if task.bounds[0] <= value <= task.bounds[1]:
                beyond.append([index, value, *seed_of(orbit)[1:6]])
    origin = task.seed.orbit()._solution.family.numbers[task.parameter]
    flat = flatten(branch, origin)
    flat["section"] = _sections(flat, task)
    return flat | {"beyond": np.frombuffer(json.dumps(beyond).encode(), np.uint8)}


def _sections(flat: Flat, task: Task) -> np.ndarray:
    """(n, m, 2N) all section states of each point: those at t = 0 mod T of the orbit and of its mirror image."""
    systems = [task.seed.system.replace(**{task.parameter: value}) for value in flat["value"].tolist()]
    return np.array([section_states(orbit_at(flat, i, system)) for i, system in enumerate(systems)])


class Tree(NamedTuple):
    """A branch that is known: its arrays, its seed, and how many special points away from the first it is."""

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
) -> list[Tree]:
    """All branches, generation by generation. evaluate : gives `grow` of tasks, which it may know by their names."""
    known: list[Tree] = []
    for generation in range(depth + 1):
        seeds = [seed for seed in seeds if not any(passes(tree.flat, parameter, seed) for tree in known)]
        looked = follow if generation < depth else ()
        tasks = [Task(seed, parameter, bounds, looked) for seed in seeds]
        names = [f"{generation}:{i}" for i in range(len(tasks))]
        new = []
        for seed, flat in zip(seeds, evaluate(names, tasks), strict=True):
            if "value" in flat and not any(passes(tree.flat, parameter, seed) for tree in new):
                new.append(Tree(flat, seed, generation))
        seeds = [seed for i, tree in enumerate(new) for seed in _beyond(tree, len(known) + i, parameter)]
        known += new
    return known


def _beyond(tree: Tree, parent: int, parameter: str) -> list[Seed]:
    result = []
    text = tree.flat["beyond"].tobytes().decode()
    for index, value, sigma, halves, sides, u, rests in json.loads(text) if text else ():
        system = tree.seed.system.replace(**{parameter: value})
        result.append(Seed(system, sigma, halves, tuple(sides), tuple(u), tuple(rests), parent, index))
    return result


def passes(flat: Flat, parameter: str, seed: Seed) -> bool:
    """Whether an orbit, or its mirror image, lies on a branch: by Newton's method from its points on both sides."""
    s = seed.orbit()._solution
    value = s.family.numbers[parameter]
    offset = flat["value"] - value
    names = ("impact_t", "impact_v", "impact_t_off")
    if not len(offset) or kind_of(solution_of(flat, seed.system, *(flat[name][0] for name in names))) != kind_of(s):
        return False
    for i in np.flatnonzero(offset[:-1] * offset[1:] <= 0):
        share = offset[i] / (offset[i] - offset[i + 1]) if offset[i] != offset[i + 1] else 0.0
        parts = [(1 - share) * flat[name][i] + share * flat[name][i + 1] for name in names]
        found = solution_of(flat, seed.system, *parts).corrected()
        if found is not None and alike(found, s):
            return True
    return False
