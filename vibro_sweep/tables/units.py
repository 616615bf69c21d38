"""Units: each number declares the one that it has where a system is given in SI; a system says what its own are in SI.

A unit is a text as CF has it, "m s-1". Without a system's `units` its numbers are nondimensional.
"""

import functools
import math
import re
from collections import Counter
from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

NONE = "1"
_OF = {"N": {"kg": 1, "m": 1, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}, "Hz": {"s": -1}}
_BASE = ("kg", "m", "s")
_PLAIN = re.compile(r"[\w.+ -]{1,60}")  # of what others write, what can stand in a picture
_POWERS = {"G": 9, "M": 6, "k": 3, "": 0, "c": -2, "m": -3, "\N{MICRO SIGN}": -6, "n": -9, "p": -12}  # by prefix
_ATOMS = {  # of units: the word that is declared of such numbers, and the size in that
    "kg": ("kg", Fraction(1)), "g": ("kg", Fraction(1, 1000)), "t": ("kg", Fraction(1000)), "m": ("m", Fraction(1)),
    "in": ("m", Fraction("0.0254")), "s": ("s", Fraction(1)), "N": ("N", Fraction(1)), "W": ("W", Fraction(1)),
    "Hz": ("Hz", Fraction(1)), "rpm": ("Hz", Fraction(1, 60)), "rad": ("rad", Fraction(1)),
}  # fmt: skip
_WITH_PREFIX = ("g", "m", "s", "N", "W", "Hz")
_LONG = {  # as other programs write them
    "gram": "g", "meter": "m", "metre": "m", "second": "s", "newton": "N", "watt": "W", "hertz": "Hz", "radian": "rad",
    "kilo": "k", "centi": "c", "milli": "m", "micro": "\N{MICRO SIGN}", "nano": "n", "mega": "M",
}  # fmt: skip
LONGEST = 60  # characters of a name in a message
NAMES = "kg, g, t, m, mm, in, s, ms, N, kN, Hz, rpm"  # some of them, for messages


class Named(NamedTuple):
    """A unit with a name: the name, the word that is declared of such numbers, and the size in that."""

    name: str
    word: str
    size: Fraction


@functools.lru_cache(1024)
def named_unit(text: str) -> Named | None:
    """The unit of a name, as mm, kN or Hz, also micrometer; None where there is no such."""
    for long, short in _LONG.items():
        text = text.replace(long, short)
    text = re.sub("^[u\N{GREEK SMALL LETTER MU}](?=.)", "\N{MICRO SIGN}", text)
    if text in _ATOMS:
        return Named(text, *_ATOMS[text])
    for atom in _WITH_PREFIX:
        prefix = text.removesuffix(atom)
        if prefix != text and prefix in _POWERS:
            word, size = _ATOMS[atom]
            return Named(text, word, size * Fraction(10) ** _POWERS[prefix])
    return None


class Units(NamedTuple):
    """The units of mass, length and time: what 1 is in kg, m and s.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> mass = vs.Oscillator([[1]], [[1]], contact_normal=[1], omega=1, R=0.7, b=1, units=[2e-3, 1e-6, 1e-3])
    >>> mass.units.m, mass.replace(units={"mass": "kg", "length": "mm", "time": "s"}).units
    (1e-06, (1.0, 0.001, 1.0))
    """

    kg: float
    m: float
    s: float

    @property
    def names(self) -> str:
        """As people write them, "kg, mm, s"."""
        return "SI" if self == SI else ", ".join(unit_text(unit_in(base, self)) for base in _BASE)

    def __repr__(self) -> str:
        return repr("SI" if self == SI else tuple(self))

    def __str__(self) -> str:
        return "SI" if self == SI else str([*self])


SI = Units(1.0, 1.0, 1.0)
_SIZES = {"mass": "kg", "length": "m", "time": "s", "force": "N"}


def units_of_names(names: Mapping[object, object]) -> Units | None:
    """The units of {mass: kg, length: mm, time: s}, or with a force in place of one of these; None for others."""
    known = {key: named_unit(name) for key, name in names.items() if isinstance(name, str)}
    if (
        len(known) != 3
        or len(names) != 3
        or any(unit is None or unit.word != _SIZES.get(str(key)) for key, unit in known.items())
    ):
        return None
    mass, length, time, force = (unit.size if (unit := known.get(key)) else None for key in _SIZES)
    if mass is None:
        mass = force * time**2 / length
    elif length is None:
        length = force * time**2 / mass
    elif time is None:
        time = math.sqrt(mass * length / force)
    return Units(float(mass), float(length), float(time))


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


class Written(NamedTuple):
    """A unit as a text has it: a factor, and units with names and their powers."""

    factor: float
    named: tuple[tuple[Named, int], ...]

    @property
    def size(self) -> float:
        """What it is in kg, m and s."""
        return self.factor * float(math.prod(unit.size**power for unit, power in self.named))

    @property
    def powers(self) -> Counter:
        """The powers of kg, m and s."""
        powers: Counter = Counter()
        for unit, power in self.named:
            for base, times in _OF.get(unit.word, {unit.word: 1}).items():
                powers[base] += times * power
        return Counter({base: powers[base] for base in _BASE if powers[base]})

    def count(self, word: str) -> int:
        """The power of a word that is declared."""
        return sum(power for unit, power in self.named if unit.word == word)


@functools.lru_cache(1024)
def written_unit(text: str) -> Written | None:
    """What a unit of a file, or of another program, means, as "0.001 m s-1" or "mm/s"; None where it is unknown."""
    factor, named, sign = 1.0, [], 1
    for token in re.findall(r"/|[^\s/*\N{MIDDLE DOT}]+", text.replace("**", "^")):
        number = _number(token)
        match = re.fullmatch(r"([^\d^-]+?)\^?(-?\d+)?", token)
        unit = named_unit(match[1]) if match else None
        if token == "/":
            sign = -1
            continue
        if number is not None:
            factor *= number**sign
        elif token != "dimensionless":
            if unit is None:
                return None
            named.append((unit, sign * int(match[2] or 1)))
        sign = 1
    return Written(factor, tuple(named)) if text.strip() else None


def ratio(text: str, other: str) -> float | None:
    """What numbers of one unit are multiplied by for the other; None where there is no such number."""
    if text == other:
        return 1.0
    one, another = written_unit(text), written_unit(other)
    if one is None or another is None or one.powers != another.powers:
        return None
    angles, cycles = (one.count(word) - another.count(word) for word in ("rad", "Hz"))
    turns = (2 * math.pi) ** cycles if cycles and angles else 1.0
    return one.size / another.size * turns


class Display(NamedTuple):
    """The units that numbers are shown in, whatever their file has: of each word that is declared, the unit."""

    units: Mapping[str, Named]

    @property
    def angular(self) -> "Display":
        """The same but for frequencies, which stay angular."""
        return Display({word: unit for word, unit in self.units.items() if word != "Hz"})

    @property
    def in_cycles(self) -> bool:
        """Whether the frequency of the force is shown in place of omega."""
        return "Hz" in self.units

    def of(self, text: str) -> tuple[float, str]:
        """What numbers of a unit are multiplied by to be shown, and the unit that they then have."""
        written = written_unit(text)
        if written is None or not self.units or not written.named:
            return 1.0, text
        if self.in_cycles and written.count("rad") == 1 and written.powers == {"s": -1}:
            return written.size / float(self.units["Hz"].size) / (2 * math.pi), self.units["Hz"].name
        factor, words = written.factor, []
        for unit, power in written.named:
            new = self.units.get(unit.word, unit)
            factor *= float((unit.size / new.size) ** power)
            words.append(f"{new.name}{power if power != 1 else ''}")
        return factor, " ".join(words)


AS_STORED = Display({})


def display_of(value: object) -> Display | None:
    """The display in units of these names, a list of them or a text with commas; None where one is unknown, or two are
    of one kind."""
    names = value.split(",") if isinstance(value, str) else value
    if not isinstance(names, (list, tuple)) or not all(isinstance(name, str) for name in names):
        return None
    known = [named_unit(name.strip()) for name in names if name.strip()]
    words = [unit.word for unit in known if unit is not None]
    if None in known or "rad" in words or len({*words}) < len(known):
        return None
    return Display({unit.word: unit for unit in known if unit is not None})


def why_no_display(value: object) -> str:
    """What is wrong with names of units that `display_of` refuses, and what to write."""
    names = value.split(",") if isinstance(value, str) else value
    known: dict[str, str] = {}
    for name in names if isinstance(names, (list, tuple)) else ():
        unit = named_unit(name.strip()) if isinstance(name, str) else None
        if isinstance(name, str) and "rad" in name:
            return (
                f"{name.strip()[:LONGEST]}: angles have none to name; an axis over omega has rad where no Hz is named"
            )
        if unit is None:
            return f"{str(name)[:LONGEST]} is no unit here; known are {NAMES}"
        if unit.word in known:
            return f"{known[unit.word]} and {name.strip()} are units of one kind; write one of each kind"
        known[unit.word] = name.strip()
    return f"write names of units, one of a kind, such as {NAMES}"


def names_of(display: Display) -> str:
    """The names of its units, as they are written."""
    return ", ".join(unit.name for unit in display.units.values())


def shown_unit(unit: str | None) -> str:
    """The unit after the name of an axis: " [m/s]"; nothing where numbers have no unit, or angles."""
    text = unit_text(unit)
    return f" [{text}]" if text else ""


def unit_text(unit: str | None) -> str:
    """A unit as people write it, "mm/s"; nothing where numbers have no unit, or angles."""
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
    if factor is None:
        return _quotient(above, below)
    factor = float(f"{factor:.4g}")  # as it is shown: 9.9999999e-4 m is 1 mm
    if above:
        factor, above[0] = _with_prefix(factor, above[0])
    times = f"{factor:.4g}"
    text = _quotient(above, below)
    if not above:
        return times + text[1:]
    return text if times == "1" else f"{times} {text}"


def without_factor(size: float, unit: str) -> tuple[float, str]:
    """What numbers of a unit with a factor, as "0.005 m", are multiplied by for one without, and that: of those with a
    prefix the one in which `size` is read best."""
    written = written_unit(unit)
    if written is None or not written.named or written.named[0][1] != 1:
        return 1.0, unit
    (first, _), *others = written.named
    whole = written.factor * abs(size)
    times, name = _with_prefix(whole, first.name)
    words = [name, *(f"{other.name}{power if power != 1 else ''}" for other, power in others)]
    return written.factor * (times / whole if whole else 1.0), " ".join(words)


def range_text(low: float, high: float, unit: str, display: Display = AS_STORED) -> str:
    """Numbers from `low` to `high` with their unit, as "0.3 to 140 mm"; of equal ones one of them."""
    factor, shown = display.of(unit)
    if shown == unit:
        factor, shown = without_factor(max(abs(low), abs(high)), unit)
    ends = [f"{factor * end:.4g}" for end in (low, high)]
    text = ends[0] if ends[0] == ends[1] else " to ".join(ends)
    return f"{text} {unit_text(shown)}".strip()


def _quotient(above: list[str], below: list[str]) -> str:
    return "".join([" ".join(above) or "1", *(["/", " ".join(below)] if below else [])])


def _with_prefix(factor: float, name: str) -> tuple[float, str]:
    """The factor and the unit, with a prefix that takes a part of the factor."""
    known = _ATOMS.get(name)
    for other in _PREFERRED.get(name, ()):
        unit = named_unit(other)
        times = factor * float(known[1] / unit.size)
        if 1 <= float(f"{times:.4g}") < 1000:
            return times, other
    return factor, name


_SMALL = ("", "m", "\N{MICRO SIGN}", "n")
_PREFERRED = {"kg": ("t", "kg", "g", "mg")} | {  # units that stand in place of others with a factor
    name: tuple(prefix + name for prefix in prefixes)
    for names, prefixes in ((("m", "s"), _SMALL), (("N", "W", "Hz"), ("G", "M", "k", *_SMALL)))
    for name in names
}


def _number(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None
