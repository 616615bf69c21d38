"""From special point to special point: what is found beyond each is followed, unless it is known.

The tasks of a generation can be done by any worker: the result is the same, in the same order, however many there are.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from vibro_sweep.analysis.branches.branch_arrays import Arrays
from vibro_sweep.analysis.branches.seeds import Seed, unpacked

Evaluate = Callable[[list[str], list[Any]], list[Arrays]]  # the arrays of tasks by their names; none: nothing was found
Bounds = tuple[tuple[float, float], ...]


class Node(NamedTuple):
    """A branch or a curve that is known: the name of its task, its arrays, its seed, and how many special points lie
    between it and the first ones."""

    name: str
    arrays: Arrays
    seed: Seed
    generation: int


class Task(NamedTuple):
    """A seed to be followed along `names` within `bounds`, the types for which to look at the special points, and what
    is observed."""

    seed: Seed
    names: tuple[str, ...]
    bounds: Bounds
    of: tuple[str, ...]
    observe: tuple[str, ...] = ()


@dataclass(frozen=True)
class Search:
    """A search for branches (`Branches`) or curves (`Curves`).

    names, bounds : the numbers along which they lead, and their limits
    of : of branches the types of special points beyond which others are looked for, of curves the types that are
    at_once : tasks that are evaluated before it is asked again which seeds lie on what is known; None: all of a
        generation
    observe : what else is computed of each orbit of branches
    """

    names: tuple[str, ...]
    bounds: Bounds
    of: tuple[str, ...]
    at_once: int | None = None
    observe: tuple[str, ...] = ()

    def passes(self, arrays: Arrays, seed: Seed) -> bool:
        """Whether a seed lies on the branch or curve with these arrays, also as a rotation or a mirror image."""
        raise NotImplementedError

    def is_known(self, known: list[Node], arrays: Arrays, seed: Seed) -> bool:
        """Whether what was found from a seed that lies on none of these is one of them all the same."""
        return False

    def lies_on(self, known: list[Node], seed: Seed) -> bool:
        """Whether a seed lies on one of these."""
        return any(self.passes(node.arrays, seed) for node in known)

    def run(self, seeds: list[Seed], depth: int, evaluate: Evaluate, known: list[Node] | tuple = ()) -> list[Node]:
        """All that is found, generation by generation, up to `depth` behind the first, behind those that are known."""
        found = list(known)
        for generation in range(depth + 1):
            first, of = len(found), self.of if generation < depth else ()
            seeds = [seed for seed in seeds if not self.lies_on(found, seed)]
            size = self.at_once or max(len(seeds), 1)
            for begin in range(0, len(seeds), size):
                batch = enumerate(seeds[begin : begin + size], begin)
                todo = {f"{generation}:{i}": seed for i, seed in batch if not self.lies_on(found[first:], seed)}
                tasks = [Task(seed, self.names, self.bounds, of, self.observe) for seed in todo.values()]
                before = len(found)
                for (name, seed), arrays in zip(todo.items(), evaluate(list(todo), tasks), strict=True):
                    if arrays and not self.lies_on(found[before:], seed) and not self.is_known(found, arrays, seed):
                        found.append(Node(name, arrays, seed, generation))
            seeds = [
                seed
                for i, node in enumerate(found[first:], first)
                for seed in unpacked(node.arrays, self.names, node.seed.system, i)
            ]
        return found
