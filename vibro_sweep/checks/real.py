"""Real numbers in what a caller gives: of Python, of NumPy, and of what has `__array__` (xarray, pandas)."""

import math
from collections.abc import Sequence

import numpy as np

MOST = 10**8  # numbers of a `range` and the like, which takes no memory itself
NO_NUMBERS = (str, bytes, bytearray, memoryview)  # sequences, but not of numbers
# What NumPy, and `__array__` of an object of the caller's, raise where it cannot become an array.
CONVERSION = (ArithmeticError, AttributeError, BufferError, LookupError, RuntimeError, TypeError, ValueError)


def number_of(value: object) -> float | None:
    """One real number as a float, infinite beyond the range of the floats; None for anything else, masked and bool."""
    if type(value) is float:
        return value
    if isinstance(value, (bool, np.bool_, np.timedelta64)):
        return None
    if isinstance(value, (int, float, np.integer, np.floating)):
        try:
            return float(value)
        except OverflowError:
            return math.inf
    array = as_array(value)
    return None if array is None or array.ndim or array.dtype.kind not in "fiu" else number_of(array[()])


def array_of(value: object, dimensions: int) -> np.ndarray | None:
    """Real numbers as an array of floats with so many dimensions, a copy; None where it is not one.

    So for rows of different lengths, truth values, complex numbers, words, bytes, masked entries.
    """
    if dimensions == 0:
        number = number_of(value)
        return None if number is None else np.array(number)
    if isinstance(value, Sequence) and not isinstance(value, NO_NUMBERS):
        if isinstance(value, range) and not -MOST < value.stop - value.start < MOST:
            return None
        rows = [array_of(entry, dimensions - 1) if dimensions > 1 else number_of(entry) for entry in value]
        if any(row is None for row in rows) or (dimensions > 1 and len({row.shape for row in rows}) > 1):
            return None
        return np.array(rows, float).reshape((0,) * dimensions if not rows else (len(rows), *np.shape(rows[0])))
    array = as_array(value)
    if array is None or array.ndim != dimensions or array.dtype.kind not in "fiu":
        return None
    with np.errstate(over="ignore"):  # of a long double
        return np.array(array, float)


def as_array(value: object) -> np.ndarray | None:
    """An object that has `__array__` as an array; None for others, and where entries are masked."""
    if not hasattr(type(value), "__array__"):
        return None
    try:
        array = np.asanyarray(value)
    except CONVERSION:
        return None
    return None if np.ma.is_masked(array) else np.asarray(array)
