"""The state of an oscillator, (x1, v1, ..., xN, vN), and its names in scenes, files and pictures."""

import functools
from typing import NamedTuple

from vibro_sweep.model.parameters import NUMBER, Parameter

MOST_MASSES = 16


class Coordinate(NamedTuple):
    name: str
    symbol: str  # TeX
    label: str
    text: str
    units: str


@functools.cache
def coordinates(masses: int) -> tuple[Coordinate, ...]:
    """The coordinates of so many masses, in order."""
    return tuple(
        Coordinate(
            f"{letter}{mass}",
            f"{letter}_{mass}" if mass < 10 else f"{letter}_{{{mass}}}",
            f"{word} {letter}{mass}",
            f"{word} of mass {mass}",
            units,
        )
        for mass in range(1, masses + 1)
        for letter, word, units in (("x", "displacement", "m"), ("v", "velocity", "m s-1"))
    )


@functools.cache
def state(masses: int) -> tuple[str, ...]:
    """Names of the coordinates."""
    return tuple(one.name for one in coordinates(masses))


@functools.cache
def start(masses: int) -> tuple[str, ...]:
    """Names of the state at t = 0."""
    return tuple(START[name] for name in state(masses))


# A sweep over x1 has the dimension start_x1, since x1 are section points.
START = {one.name: f"start_{one.name}" for one in coordinates(MOST_MASSES)}
INITIAL = tuple(
    Parameter(START[name], f"{symbol}(0)", units, NUMBER, f"initial {text.split()[0]}", f"{text} at t = 0")
    for name, symbol, _, text, units in coordinates(MOST_MASSES)
)
