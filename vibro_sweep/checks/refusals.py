"""What is said of a value that is not allowed: its name, the value, shortened, and what is allowed."""

import re
import reprlib

import numpy as np

from vibro_sweep.checks.errors import VibroSweepError

LONGEST = 60  # letters of a value in a message
MOST_DIGITS = 4000  # of an integer, which Python does not print where it has more
UNMASK = "; of masked data the entries must be filled (`filled`) or left out (`compressed`)"


class _Short(reprlib.Repr):
    """A short repr: of containers the beginning, of an object that cannot be shown its type."""

    known = (list, tuple, dict, set, frozenset, str, int)

    def __init__(self):
        super().__init__()
        self.maxlevel = 4
        self.maxlist = self.maxtuple = self.maxdict = self.maxset = self.maxfrozenset = 20
        self.maxstring = self.maxother = self.maxlong = 2 * LONGEST

    def repr1(self, x, level):
        return super().repr1(x, level) if type(x) in self.known else self.repr_instance(x, level)

    def repr_int(self, x, level):
        return super().repr_int(x, level) if x.bit_length() < 3 * MOST_DIGITS else f"an int of {x.bit_length()} bits"


_SHORT = _Short()


def shown(value: object) -> str:
    """A value as Python writes it, in one line of at most `LONGEST` letters."""
    return cut(re.sub(r"\s*\n\s*", " ", _SHORT.repr(value)))


def cut(text: str, most: int = LONGEST) -> str:
    """The beginning of a text."""
    return text if len(text) <= most else text[: most - 3] + "..."


def not_allowed(name: str, value: object, allowed: str) -> str:
    """The message of the package for an argument, a key or an option."""
    return f"{cut(name)}: {shown(value)} is not allowed; it must be {allowed}{hint_for(value)}"


def hint_for(value: object) -> str:
    """The hint for masked data."""
    return UNMASK if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value) else ""


class ParameterError(VibroSweepError, ValueError):
    """A parameter outside its range; carries `key`, `value` and `allowed`.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> try:
    ...     system.replace(R=1.2)
    ... except vs.ParameterError as error:
    ...     print(error)
    ...     print(error.key, error.value)
    R: 1.2 is not allowed; it must be a finite number from 0 to 1
    R 1.2
    """

    def __init__(self, key: str, value: object, allowed: str):
        super().__init__(key, value, allowed)
        self.key, self.value, self.allowed = key, value, allowed

    def __str__(self):
        return not_allowed(self.key, self.value, self.allowed)
