"""The state of the oscillator, (x1, v1, ..., xN, vN), and its names in scenes, files and pictures."""

from typing import NamedTuple

from vibro_sweep.model.parameters import NUMBER, Parameter

MASSES = 2


class Coordinate(NamedTuple):
    name: str
    symbol: str  # TeX
    label: str
    text: str


COORDINATES = tuple(
    Coordinate(f"{letter}{mass}", f"{letter}_{mass}", f"{word} {letter}{mass}", f"{word} of mass {mass}")
    for mass in range(1, MASSES + 1)
    for letter, word in (("x", "displacement"), ("v", "velocity"))
)
STATE = tuple(coordinate.name for coordinate in COORDINATES)

# The state at t = 0: a sweep over x1 has the dimension start_x1, since x1 are section points.
START = {name: f"start_{name}" for name in STATE}
INITIAL = tuple(
    Parameter(START[name], f"{symbol}(0)", "1", NUMBER, f"initial {text.split()[0]}", f"{text} at t = 0")
    for name, symbol, _, text in COORDINATES
)
