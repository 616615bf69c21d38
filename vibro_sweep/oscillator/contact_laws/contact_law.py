"""What a law of contact declares of itself; keys of scenes and sweeps, messages, files and pictures follow from it."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from vibro_sweep.tables.quantity import Parameter


class Choice(NamedTuple):
    """A word that says how all stops of this law behave; the first of its `words` is the default."""

    name: str
    text: str
    words: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class ContactLaw:
    """What a stop does to the mass that meets it."""

    name: str
    title: str  # one line
    equations: str
    source: str
    numbers: tuple[Parameter, ...]  # of the right stop; a stop that has the first of them has this law
    left: tuple[Parameter, ...]  # of the left stop, one for each; left out, they follow the right one's
    options: tuple[Choice, ...] = ()

    @property
    def numbers_of_both(self) -> tuple[Parameter, ...]:
        return (*self.numbers, *self.left)

    @cached_property
    def names(self) -> dict[str, tuple[str, ...]]:
        """The names of the numbers of the stop on each side, right and left."""
        sides = (("right", self.numbers), ("left", self.left))
        return {side: tuple(number.name for number in numbers) for side, numbers in sides}
