"""What Python gives for a scene as the data that its YAML would hold."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from vibro_sweep.checks.real import MOST, NO_NUMBERS, as_array, number_of
from vibro_sweep.checks.refusals import hint_for, shown

DEEPEST = 8  # lists and mappings within each other; a scene has four


class InvalidValue:
    """Stands for a value that no YAML holds, until the form of the scene refuses it."""

    def __init__(self, value: object):
        self._shown, self.hint = shown(value), hint_for(value)

    def __repr__(self) -> str:
        return self._shown


def data_from(value: object, levels: int = DEEPEST) -> object:
    """Numbers, words, lists and mappings of Python, in place of those of NumPy and xarray and of other sequences."""
    if value is None or isinstance(value, (bool, np.bool_)):
        return None if value is None else bool(value)
    if isinstance(value, str):
        return str.__str__(value)
    if (number := number_of(value)) is not None and not isinstance(value, int):
        return int(value) if isinstance(value, np.integer) else number
    if isinstance(value, int) and abs(number) < math.inf:
        return int(value)
    if isinstance(value, Mapping) and levels:
        return {_key(key): data_from(item, levels - 1) for key, item in value.items()}
    array = as_array(value)
    if array is not None and array.dtype.kind in "fiubUO" and levels:
        if array.dtype.kind == "O" or array.ndim == 0:
            return data_from(array.tolist(), levels - 1)
        with np.errstate(over="ignore"):  # of a long double
            return (array.astype(float) if array.dtype.kind == "f" else array).tolist()
    sequence = isinstance(value, Sequence) and not isinstance(value, NO_NUMBERS) and levels
    if sequence and not (isinstance(value, range) and not -MOST < value.stop - value.start < MOST):
        return [data_from(item, levels - 1) for item in value]
    return InvalidValue(value)


def _key(key: object) -> str:
    return str.__str__(key) if isinstance(key, str) else shown(key)
