"""A system in a unit of time of its own, so that nothing that is computed or concluded depends on its user's unit.

The unit is 1/rate, with the power of two nearest to omega for the rate: changing to it and back rounds no number, and
powers of a rate stay within the range of the floats. What is computed is scaled back by the unit that it declares.
"""

import functools
import math

import numpy as np

from vibro_sweep.oscillator.linear import Linear, mapped
from vibro_sweep.oscillator.stacks import unrepeated
from vibro_sweep.tables.observables import variables
from vibro_sweep.tables.units import power_of_seconds

BY_RATE = {"C": 1, "omega": 1, "contact.c_low": 1, "contact.c_high": 1} | dict.fromkeys(
    ("K", "constant", "sine", "cosine", *(f"contact.{name}" for name in ("k_low", "k_high", "p_low", "p_high"))), 2
)  # number: the power of a time in its unit is minus this

FARTHEST = 300  # power of two


def rate_of(omega: float) -> float:
    """The power of two that is nearest to a frequency, as far as its powers are floats."""
    return 2.0 ** min(max(round(math.log2(omega)), -FARTHEST), FARTHEST)


@np.errstate(over="ignore")  # numbers that leave the range of the floats are a status
def in_own_time(q: Linear, rate: float) -> Linear:
    """Oscillators with 1/rate as the unit of time."""
    return mapped(lambda name, x: _scaled(x, rate ** BY_RATE[name]) if name in BY_RATE else x, q)


def _scaled(x, factor: float):
    """x / factor; what np.broadcast_to repeats stays so."""
    if not np.ndim(x) or all(x.strides):
        return x / factor
    return np.broadcast_to(x[unrepeated([x], np.ndim(x))] / factor, x.shape)


def with_velocities(states: np.ndarray, masses: int, factor: float) -> np.ndarray:
    """States (..., 2 N or more), x1, v1, x2, v2, ..., whose velocities are multiplied by a factor."""
    states = np.array(states, float)
    states[..., 1 : 2 * masses : 2] *= factor
    return states


def as_lengths(states: np.ndarray, omega: float) -> np.ndarray:
    """States (..., 2 N) with velocities over omega: numbers of one unit, whose sizes can be compared."""
    return with_velocities(states, states.shape[-1] // 2, 1 / omega)


def in_users_time(named: dict[str, np.ndarray], masses: int, rate: float) -> dict[str, np.ndarray]:
    """Arrays of a file, by the names of its variables, in the user's unit of time again; in their place."""
    if rate == 1.0:
        return named
    for name, values in named.items():
        if power := _powers(masses).get(name):
            values *= rate**power
    if "end" in named:
        named["end"][..., 1 : 2 * masses : 2] *= rate
    factors = np.ones(2 * masses + 3)  # of averages: section points, counts, lambda_1
    factors[1 : 2 * masses : 2] = factors[-1] = rate
    for name in named.keys() & {"average", "average_error"}:
        named[name] *= factors
    return named


@functools.cache
def _powers(masses: int) -> dict[str, int]:
    """Of the variables that have a time in their unit: the power of the rate by which they are scaled."""
    known = (*variables(masses, True), *variables(masses, False))  # whether or not the gap is x1
    return {quantity.name: -power for quantity in known if (power := power_of_seconds(quantity.units))}
