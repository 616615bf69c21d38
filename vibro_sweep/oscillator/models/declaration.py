"""What a model declares of itself: numbers, options, and how its matrices follow from them."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.oscillator.contact_laws import LAWS, STOP_NUMBERS
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.tables.parameters import CLEARANCE, FREQUENCY, OFFSET, PHASE
from vibro_sweep.tables.quantity import LENGTHS, Parameter

STOPS = ("both", "right", "left")


class Option(NamedTuple):
    """What is not a number that could be swept. `kind`: "word" | "flag" | "whole" | "matrix" | "vector" | "units"."""

    name: str
    kind: str
    text: str
    default: Any = None
    words: tuple[str, ...] = ()  # of a word
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
    check: Callable[[Mapping[str, Any]], None] = lambda given: None  # raises ParameterError: how they must fit
    depending: Callable[[Mapping[str, Any]], dict[str, str]] = lambda given: {}  # units of numbers that others decide

    def flat(self, masses: int) -> dict[str, Parameter]:
        """The numbers that can be swept; of a list m these are m1, m2, ..."""
        result = {}
        for one in self.numbers:
            result |= {each.name: each for each in entries(one, masses)} if one.each else {one.name: one}
        return result


def names_of(one: Parameter, masses: int) -> list[str]:
    """Names of the numbers of a list, counted from 1."""
    return [f"{one.name}{i}" for i in range(1, LENGTHS[one.each](masses) + 1)]


def entries(one: Parameter, masses: int) -> list[Parameter]:
    """The numbers of a list."""
    return [
        replace(
            one,
            name=name,
            symbol=f"{one.symbol}_{{{i}}}" if "_" not in one.symbol else f"{one.symbol}{{}}_{{{i}}}",
            text=f"{one.text}, {one.each} {i}",
        )
        for i, name in enumerate(names_of(one, masses), start=1)
    ]


def linear_of(model: Model, given: Mapping[str, Any]) -> Linear:
    """The oscillator with these numbers and options; those of lists may be given one by one, as m1, m2, ..."""
    masses, whole = model.masses(given), {name: value for name, value in given.items() if name != UNITS.name}
    for one in model.numbers:
        if one.each and whole.get(one.name) is not None:
            names = names_of(one, masses)
            whole[one.name] = [whole.pop(name, value) for name, value in zip(names, whole[one.name], strict=True)]
    with np.errstate(all="ignore"):  # matrices beyond the range of the floats: such an oscillator is too stiff
        return model.build(**whole)


UNITS = Option(
    "units", "units", "what a mass, a length and a time of 1 are in kg, m and s, for labels; left out: nondimensional",
    optional=True,
)  # fmt: skip
WHICH_STOPS = Option("stops", "word", "which stops there are", "both", STOPS)
OF_STOPS = tuple(
    Option(one.name, "word", one.text, one.words[0], one.words) for law in LAWS.values() for one in law.options
)
CONTACT = (FREQUENCY, *STOP_NUMBERS, CLEARANCE, OFFSET, PHASE)  # numbers that every model has
