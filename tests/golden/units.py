"""How far a number may lie from its record: by what rounding of the inputs does to it.

A rebuilt engine may round otherwise, so numbers are not compared bit for bit. The unit of a number is the most that it
moves when one number of the oscillator moves by one unit in its last place.
"""

import copy
import math

import numpy as np

SAFETY = 10.0  # units that a number may differ by
LEAST = 1e-13  # of the largest number of its kind: rounding within the calculation


def moved_inputs(numbers: dict):
    """The oscillators beside one: each of its numbers that is not zero or an integer, the next float up in turn."""
    for key, value in numbers.items():
        for place in _places(value):
            changed = copy.deepcopy(numbers)
            _move(changed, (key, *place))
            yield changed


def _places(value):
    if isinstance(value, list):
        for i, inner in enumerate(value):
            for place in _places(inner):
                yield (i, *place)
    elif isinstance(value, float) and value != 0.0 and math.isfinite(value):
        yield ()


def _move(numbers, place) -> None:
    *path, last = place
    for step in path:
        numbers = numbers[step]
    numbers[last] = math.nextafter(numbers[last], math.inf)


def allowances(values, beside, scale=None) -> np.ndarray:
    """How far each of `values` may move, given what it is for the oscillators beside (an array of the same shape for
    each). `scale`, a number or an array: the size of its kind; without it the largest of `values`."""
    values = np.asarray(values, float)
    size = np.abs(values).max(initial=0.0) if scale is None else np.asarray(scale, float)
    moved = [np.abs(np.asarray(other, float) - values) for other in beside]
    return np.maximum(SAFETY * np.max([np.zeros(values.shape), *moved], axis=0), LEAST * size)


def apart(stored, now, allowed) -> np.ndarray:
    """Indices (flat) of numbers that differ by more than is allowed; NaN and infinities have to be the same."""
    stored, now = np.asarray(stored, float).ravel(), np.asarray(now, float).ravel()
    with np.errstate(invalid="ignore"):
        near = np.abs(stored - now) <= np.asarray(allowed, float).ravel()
    same = (stored == now) | (np.isnan(stored) & np.isnan(now))
    return np.flatnonzero(~(near | same))
