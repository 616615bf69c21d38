"""From special point to special point: what is found beyond each is followed, unless it is known.

The tasks of a generation can be done by any worker: the result is the same, in the same order, however many there are.
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, Protocol

from vibro_sweep.analysis.branches.flat import Flat

Evaluate = Callable[[list[str], list[Any]], list[Flat]]  # the arrays of tasks by their names; none: nothing was found


class Node(NamedTuple):
    """A branch or a curve that is known: the name of its task, its arrays, its seed, and how many special points lie
    between it and the first ones."""

    name: str
    flat: Flat
    seed: Any
    generation: int


class Searched(Protocol):
    """What is searched for: branches (`Branches`) or curves (`Curves`)."""

    def task(self, seed, look: bool) -> Any:
        """The task that follows a seed. look: whether it looks beyond the special points as well."""

    def lies_on(self, known: list[Node], seed) -> bool:
        """Whether a seed lies on one of these."""

    def is_known(self, known: list[Node], flat: Flat, seed) -> bool:
        """Whether what was found from a seed is one of these."""

    def beyond(self, node: Node, index: int) -> list:
        """The seeds beyond the special points of what was found as number `index`."""


def search(
    of: Searched, seeds: list, depth: int, evaluate: Evaluate, at_once: int | None = None, known: tuple | list = ()
) -> list[Node]:
    """All that is found, generation by generation, behind those that are `known`.

    depth : generations behind the first
    at_once : tasks that are evaluated before it is asked again which seeds lie on what is known; None: all of a
        generation
    """
    found = list(known)
    for generation in range(depth + 1):
        first = len(found)
        seeds = [seed for seed in seeds if not of.lies_on(found, seed)]
        for begin, batch in _batches(seeds, at_once):
            todo = {f"{generation}:{begin + i}": seed for i, seed in enumerate(batch)}
            todo = {name: seed for name, seed in todo.items() if not of.lies_on(found[first:], seed)}
            flats = evaluate(list(todo), [of.task(seed, generation < depth) for seed in todo.values()])
            before = len(found)
            for (name, seed), flat in zip(todo.items(), flats, strict=True):
                if flat and not of.lies_on(found[before:], seed) and not of.is_known(found, flat, seed):
                    found.append(Node(name, flat, seed, generation))
        seeds = [seed for i in range(first, len(found)) for seed in of.beyond(found[i], i)]
    return found


def _batches(items: list, size: int | None) -> Iterator[tuple[int, list]]:
    size = size or max(len(items), 1)
    for begin in range(0, len(items), size):
        yield begin, items[begin : begin + size]
