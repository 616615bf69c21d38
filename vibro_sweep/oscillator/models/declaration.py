"""What a model declares of itself: numbers, options, and how its matrices follow from them."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.oscillator.contact_laws import LAWS, STOP_NUMBERS
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.tables.parameters import CLEARANCE, CYCLES, FREQUENCY, OFFSET, PHASE
from vibro_sweep.tables.quantity import LENGTHS, Parameter

STOPS = ("both", "right", "left")


class Option(NamedTuple):
    """What is not a number that could be swept.

    kind : "word" | "choice" | "whole" | "pair" | "matrix" | "vector" | "units"
    """

    name: str
    kind: str
    text: str
    default: Any = None
    words: tuple[str | bool, ...] = ()  # of a word, or a choice
    optional: bool = False
    units: str = "1"  # of a matrix, where the system is given in SI


class Model(NamedTuple):
    """An oscillator with a name. Files, scenes, sweeps, messages, pictures and `vibro-sweep models` follow from it."""

    name: str
    title: str  # one line
    sketch: str  # in text
    equations: str
    source: str
    numbers: tuple[Parameter, ...]
    options: tuple[Option, ...]
    masses: Callable[[Mapping[str, Any]], int]  # N, from what is given
    build: Callable[..., Linear]  # from all numbers and options by name; analytic in the numbers, also complex ones
    check: Callable[[Mapping[str, Any]], None] = lambda arguments: None  # raises ParameterError: how they must fit
    depending: Callable[[Mapping[str, Any]], dict[str, str]] = lambda values: {}  # units of numbers that others decide

    def flat(self, masses: int) -> dict[str, Parameter]:
        """The numbers that can be swept; of a list m these are m1, m2, ..; and the frequency in place of omega."""
        result = {}
        for quantity in self.numbers:
            result |= {x.name: x for x in (entries(quantity, masses) if quantity.each else [quantity])}
            if quantity.name == FREQUENCY.name:
                result[CYCLES.name] = CYCLES
        return result


def names_of(quantity: Parameter, masses: int) -> list[str]:
    """Names of the numbers of a list, counted from 1."""
    return [f"{quantity.name}{i}" for i in range(1, LENGTHS[quantity.each](masses) + 1)]


def entries(quantity: Parameter, masses: int) -> list[Parameter]:
    """The numbers of a list."""
    return [
        replace(
            quantity,
            name=name,
            symbol=f"{quantity.symbol}_{{{i}}}" if "_" not in quantity.symbol else f"{quantity.symbol}{{}}_{{{i}}}",
            text=f"{quantity.text}, {quantity.each} {i}",
        )
        for i, name in enumerate(names_of(quantity, masses), start=1)
    ]


def linear_of(model: Model, arguments: Mapping[str, Any]) -> Linear:
    """The oscillator with these numbers and options; those of lists may be given one by one, as m1, m2, ..."""
    masses, whole = model.masses(arguments), {name: value for name, value in arguments.items() if name != UNITS.name}
    for quantity in model.numbers:
        if quantity.each and whole.get(quantity.name) is not None:
            names = names_of(quantity, masses)
            pairs = zip(names, whole[quantity.name], strict=True)
            whole[quantity.name] = [whole.pop(name, value) for name, value in pairs]
    with np.errstate(all="ignore"):  # matrices beyond the range of the floats: such an oscillator is too stiff
        return model.build(**whole)


UNITS = Option(
    "units", "units", "what a mass, a length and a time of 1 are in kg, m and s, for labels; left out: nondimensional",
    optional=True,
)  # fmt: skip
WHICH_STOPS = Option("stops", "word", "which stops there are", "both", STOPS)
OF_STOPS = tuple(
    Option(quantity.name, "word", quantity.text, quantity.words[0], quantity.words)
    for law in LAWS.values()
    for quantity in law.options
)
CONTACT = (FREQUENCY, *STOP_NUMBERS, CLEARANCE, OFFSET, PHASE)  # numbers that every model has
