"""What is declared of a number: its name, symbol, unit, range and texts."""

import operator
from typing import Any, NamedTuple

import numpy as np

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


class Parameter(NamedTuple):
    name: str  # of the Python argument, the scene key and the variable of the file
    symbol: str  # TeX, as in the paper
    units: str  # where the system is given in SI (model/units.py)
    range: Range
    label: str  # short: of an axis
    text: str
    equation: str = ""  # in which it first appears
    default: Any = None  # None: it must be given
    words: dict[str, str] = {}  # noqa: RUF012  # what may stand in place of a number, and what it means; read only
    free_motion: bool = False  # whether the non-impacting motion depends on it (tau only shifts that in time)
    follows: str = ""  # the number whose value it has where it is left out
    each: str = ""  # of a list: what it has one number for, a key of `LENGTHS`
    optional: bool = False  # whether it may be left out although nothing is known of it then
    instead: str = ""  # how a machine with a number below the range is written

    @property
    def described(self) -> str:
        """Text and words."""
        return ", or ".join([self.text, *(f"`{word}`: {meaning}" for word, meaning in self.words.items())])

    @property
    def long_name(self) -> str:
        """Label and name, as plain text."""
        return f"{self.label} {self.name.removeprefix('start_')}"
