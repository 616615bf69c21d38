"""What is declared of a quantity: its name, texts, symbol and unit, and what checks, files and pictures need of it."""

import operator
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, NamedTuple

import numpy as np


@dataclass(frozen=True)
class Quantity:
    """A number, or an array of numbers, with a name: a parameter, a variable of a file, a dimension, a coordinate."""

    name: str  # of the argument, the scene's key and the variable of the file
    label: str  # short: of an axis
    text: str  # `description` in files
    symbol: str = ""  # TeX, as in the paper
    units: str = "1"  # where the system is given in SI (tables/units.py)
    _: KW_ONLY
    dimensions: tuple[str, ...] = ()  # of its array; of a sweep, behind those of the sweep
    dtype: str = "f8"
    missing: float | None = None  # where nothing is computed; None: NaN, or -1 of integers
    flags: tuple[str, ...] = ()  # words of its codes, which count from `least`
    index_in: str = ""  # of an index: the dimension along which it counts
    least: int = 0  # the least code or index; an index of -1: there is none
    extent: int | None = None  # of a dimension: how long it is; None: the scene decides

    @property
    def long_name(self) -> str:
        """`long_name` in files."""
        return self.label

    @property
    def fill(self) -> float:
        """The value where nothing is computed."""
        if self.missing is not None:
            return self.missing
        return np.nan if np.dtype(self.dtype).kind == "f" else -1

    @property
    def codes(self) -> range:
        """The codes that its flags stand for."""
        return range(self.least, self.least + len(self.flags))

    def limits(self, lengths: Mapping[str, int]) -> tuple[int, int] | None:
        """The least and the largest index or code; None for other numbers. lengths : of dimensions"""
        if self.index_in:
            return self.least, lengths.get(self.index_in, 0) - 1
        return (self.codes[0], self.codes[-1]) if self.flags else None

    def holds(self, values: np.ndarray, lengths: Mapping[str, int]) -> bool:
        """Whether all are indices or codes that there are."""
        least, most = self.limits(lengths) or (-np.inf, np.inf)
        return not np.any((values < least) | (values > most))


@dataclass(frozen=True)
class Observable(Quantity):
    """A variable of a file of orbits."""

    _: KW_ONLY
    asked_by: tuple[str, ...] = ()  # words of `observe`, TRAJECTORY or SETTLE; of none: it is always there
    in_kernel: bool = True  # a field of the record that kernels fill for each orbit
    at_impacts: bool = False  # only of sections at impacts
    attributes: Mapping[str, float] = field(default_factory=dict)  # more attributes in the file


_HOLDS = {
    "exclusiveMinimum": operator.gt,
    "minimum": operator.ge,
    "maximum": operator.le,
}


class Range(NamedTuple):
    """The range of a number, in words and as JSON Schema says it."""

    text: str
    bounds: dict[str, float]

    def holds(self, numbers: np.ndarray) -> np.ndarray:
        """Whether finite numbers are in the range; of the shape of `numbers`."""
        good = np.isfinite(numbers)
        for bound, value in self.bounds.items():
            good = good & _HOLDS[bound](numbers, value)
        return good


POSITIVE = Range("a number > 0", {"exclusiveMinimum": 0})
NOT_NEGATIVE = Range("a number >= 0", {"minimum": 0})
FRACTION = Range("a number from 0 to 1", {"minimum": 0, "maximum": 1})
NUMBER = Range("a number", {})

LENGTHS = {  # of lists, for N masses
    "mass": lambda masses: masses,
    "mode": lambda masses: masses,
    "spring": lambda masses: masses + 1,  # those to both walls too
    "coefficient": lambda masses: 2,
}


@dataclass(frozen=True)
class Parameter(Quantity):
    """A number of an oscillator, or of its start."""

    range: Range = NUMBER
    equation: str = ""  # in which it first appears
    default: Any = None  # None: it must be given, unless it is optional
    _: KW_ONLY
    words: Mapping[str, str] = field(default_factory=dict)  # in place of a number, and what they mean
    free_motion: bool = False  # whether the non-impacting motion depends on it (tau only shifts that in time)
    optional: bool = False  # whether it may be left out although it has no default
    follows: str = ""  # the number whose value it has where it is left out
    each: str = ""  # of a list: what it has one number for, a key of `LENGTHS`
    instead: str = ""  # how a machine with a number below the range is written

    @property
    def described(self) -> str:
        """Text and words."""
        return ", or ".join([self.text, *(f"`{word}`: {meaning}" for word, meaning in self.words.items())])

    @property
    def long_name(self) -> str:
        """Label and name, as plain text."""
        name = self.name.removeprefix("start_")
        return self.label if self.label.endswith(name) else f"{self.label} {name}"
