"""Units: each number declares the one that it has where a system is given in SI; a system says what its own are in SI.

A unit is a text as CF has it, "m s-1". Without a system's `units` its numbers are nondimensional.
"""

import functools
import math
import re
from collections import Counter
from fractions import Fraction
from typing import NamedTuple

NONE = "1"
_OF = {"N": {"kg": 1, "m": 1, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}}
_PREFIXED = ("m", "s", "N", "W")
_PREFIXES = {"m": 1e-3, "\N{MICRO SIGN}": 1e-6, "n": 1e-9}  # for those below 1
_BASE = ("kg", "m", "s")
_PLAIN = re.compile(r"[\w.+ -]{1,60}")  # of what others write, what can stand in a picture


class Units(NamedTuple):
    """The units of mass, length and time: what 1 is in kg, m and s.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> mass = vs.Oscillator([[1]], [[1]], contact_normal=[1], omega=1, R=0.7, b=1, units=[2e-3, 1e-6, 1e-3])
    >>> mass.units.m, mass.replace(units="SI").units
    (1e-06, 'SI')
    """

    kg: float
    m: float
    s: float

    def __repr__(self) -> str:
        return repr("SI" if self == SI else tuple(self))

    def __str__(self) -> str:
        return "SI" if self == SI else str([*self])


SI = Units(1.0, 1.0, 1.0)


def unit_in(declared: str, units: Units | None) -> str:
    """The unit of a number of a system with these units, with its factor where that is not 1: "0.005 m".

    Where the factor is beyond the range of the floats there is none.
    """
    powers = _powers(declared)
    if not powers.keys() & {*_BASE}:  # of angles, counts and ratios there is one
        return declared
    if units is None:
        return NONE
    try:
        factor = float(math.prod(Fraction(getattr(units, base_unit)) ** powers[base_unit] for base_unit in _BASE))
    except OverflowError:
        return NONE
    if factor == 0:
        return NONE
    return declared if factor == 1 else f"{factor!r} {declared}"


@functools.cache
def power_of_seconds(unit: str) -> int:
    """The power of a time in a unit: -1 of "m s-1"."""
    return _powers(unit)["s"]


def _powers(unit: str) -> Counter:
    """The powers of kg, m and s; of rad, and of 1, which are zero."""
    powers_found: Counter = Counter()
    for word in unit.split():
        name, power = re.fullmatch(r"(\D+?|1)(-?\d*)", word).groups()
        for base, times in _OF.get(name, {name: 1}).items():
            powers_found[base] += times * int(power or 1)
    return powers_found


def shown_unit(unit: str | None) -> str:
    """The unit after the name of an axis: " [m/s]"; nothing where numbers have no unit, or angles."""
    if not unit or unit in (NONE, "rad", "nondimensional") or not _PLAIN.fullmatch(unit):
        return ""
    first, *others = unit.split()
    factor = _number(first)
    above, below = [], []
    for word in unit.split() if factor is None else others:
        name, _, power = word.partition("-")
        if power.isdecimal():
            below.append(name + (power if power != "1" else ""))
        else:
            above.append(word)
    text = "".join([" ".join(above) or "1", *(["/", " ".join(below)] if below else [])])
    if factor is None:
        return f" [{text}]"
    factor = float(f"{factor:.4g}")  # as it is shown: 9.9999999e-4 m is 1 mm
    if not above:
        return f" [{factor:.4g}{text[1:]}]"
    for prefix, least in _PREFIXES.items():
        if above[0] in _PREFIXED and least <= factor < 1:
            return f" [{_times(factor / least)}{prefix}{text}]"
    return f" [{_times(factor)}{text}]"


def _times(factor: float) -> str:
    return "" if f"{factor:.4g}" == "1" else f"{factor:.4g} "


def _number(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None
