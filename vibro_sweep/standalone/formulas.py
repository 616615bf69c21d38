"""The numbers of an oscillator as formulas of JavaScript: its model's `build` is called with symbols.

So what a page computes with is what the model says, of any model whose numbers are sums, products, quotients and powers
of its parameters.
"""

from operator import attrgetter
from typing import Any

import numpy as np

from vibro_sweep.oscillator.linear import MOTION
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.own_time import BY_RATE

STOPS = tuple(f"contact.{name}" for name in ("low", "high", "R_low", "R_high"))
LAWS = tuple(f"contact.{name}" for name in ("k_low", "c_low", "p_low", "k_high", "c_high", "p_high"))


class Symbol:
    """A formula of JavaScript. It cannot be asked anything: a `build` that branches on a number has no one formula."""

    def __init__(self, text: str):
        self.text = text

    def __add__(self, other):
        return Symbol(f"({self.text} + {_text(other)})")

    def __radd__(self, other):
        return Symbol(f"({_text(other)} + {self.text})")

    def __sub__(self, other):
        return Symbol(f"({self.text} - {_text(other)})")

    def __rsub__(self, other):
        return Symbol(f"({_text(other)} - {self.text})")

    def __mul__(self, other):
        return Symbol(f"({self.text} * {_text(other)})")

    def __rmul__(self, other):
        return Symbol(f"({_text(other)} * {self.text})")

    def __truediv__(self, other):
        return Symbol(f"({self.text} / {_text(other)})")

    def __rtruediv__(self, other):
        return Symbol(f"({_text(other)} / {self.text})")

    def __pow__(self, other):
        return Symbol(f"({self.text} ** {_text(other)})")

    def __rpow__(self, other):
        return Symbol(f"({_text(other)} ** {self.text})")

    def __neg__(self):
        return Symbol(f"(-{self.text})")

    def __eq__(self, other):
        raise TypeError("a formula is equal to nothing")

    __hash__ = None  # so that no result of other numbers is taken for this one's

    def __bool__(self):
        raise TypeError("a formula is neither true nor false")


def _text(value: Any) -> str:
    if isinstance(value, Symbol):
        return value.text
    number = float(value)
    return {"inf": "Infinity", "-inf": "-Infinity", "nan": "NaN"}.get(
        repr(number), f"({number!r})" if number < 0 else repr(number)
    )


def is_variable(system: Oscillator, name: str) -> bool:
    """Whether a number is one that a page may change: it has a value, or follows another one that has."""
    value, quantity = system.family.numbers[name], system.described.get(name)
    if value is None and quantity is not None and quantity.follows:
        value = system.family.numbers.get(quantity.follows)
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def formulas_of(system: Oscillator) -> list[tuple[str, int]] | None:
    """Each number of the record `machine_of`, then `STOPS` and `LAWS`, as a formula of `v.name`, and the power of the
    rate by which it is divided in the machine's own time. None where its model computes with more than formulas."""
    family = system.family
    symbols = {
        name: Symbol(f"v.{name}") if is_variable(system, name) else family.numbers[name] for name in family.numbers
    }
    try:
        linear = family.build(**symbols)
        result = []
        for name in (*MOTION, *STOPS, *LAWS):
            value = attrgetter(name)(linear)
            entries = np.ravel(np.array(0.0 if value is None else value))
            result += [(_text(entry), BY_RATE.get(name, 0)) for entry in entries.tolist()]
        return result
    except (TypeError, AttributeError, ValueError):
        return None
