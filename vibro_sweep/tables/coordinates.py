"""The state of an oscillator, (x1, v1, ..., xN, vN), and its names in scenes, files and pictures."""

import functools

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import array_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.tables.quantity import Parameter, Quantity

MOST_MASSES = 16
_COUNTS = {2: "two", 4: "four", 6: "six"}


@functools.cache
def coordinates(masses: int) -> tuple[Quantity, ...]:
    """The coordinates of so many masses, in order."""
    return tuple(
        Quantity(
            f"{letter}{mass}",
            f"{word} {letter}{mass}",
            f"{word} of mass {mass}",
            f"{letter}_{mass}" if mass < 10 else f"{letter}_{{{mass}}}",
            units,
        )
        for mass in range(1, masses + 1)
        for letter, word, units in (("x", "displacement", "m"), ("v", "velocity", "m s-1"))
    )


@functools.cache
def state(masses: int) -> tuple[str, ...]:
    """Names of the coordinates."""
    return tuple(coordinate.name for coordinate in coordinates(masses))


@functools.cache
def start(masses: int) -> tuple[str, ...]:
    """Names of the state at t = 0."""
    return tuple(START[name] for name in state(masses))


# A sweep over x1 has the dimension start_x1, since x1 are section points.
START = {name: f"start_{name}" for name in state(MOST_MASSES)}
INITIAL = tuple(
    Parameter(
        START[coordinate.name],
        f"initial {coordinate.label.split()[0]}",
        f"{coordinate.text} at t = 0",
        f"{coordinate.symbol}(0)",
        coordinate.units,
    )
    for coordinate in coordinates(MOST_MASSES)
)


def checked_state(value, masses: int = 2, name: str = "state") -> np.ndarray:
    """A state (x1, v1, x2, v2, ...) as an array (2 N,). Raises ValueError unless it is so many finite numbers."""
    values, names = array_of(value, 1), state(masses)
    if values is None or values.shape != (len(names),) or not np.isfinite(values).all():
        count = _COUNTS.get(len(names), str(len(names)))
        raise ArgumentError(not_allowed(name, value, f"{count} finite numbers ({', '.join(names)})"))
    return values
