"""Arguments of the Python functions, checked: what is wrong is named before anything is computed."""

import os
from pathlib import Path

import numpy as np

from vibro_sweep.model.state import state as names

_COUNTS = {2: "two", 4: "four", 6: "six"}
MAX_COUNT = 10**12  # periods
LATEST = 10**9  # forcing periods from t = 0; a time then resolves a millionth of one


def checked_state(state, masses: int = 2, name: str = "state") -> np.ndarray:
    """A state (x1, v1, x2, v2, ...) as an array (2 N,). Raises ValueError unless it is so many finite numbers."""
    try:
        values = np.asarray(state)
    except ValueError:  # rows of different lengths
        values = np.asarray(None)
    good = values.shape == (2 * masses,) and values.dtype.kind in "fiu"
    if not (good and np.isfinite(values.astype(float)).all()):
        count = _COUNTS.get(2 * masses, str(2 * masses))
        raise ValueError(
            f"{name}: {state!r} is not allowed; it must be {count} finite numbers ({', '.join(names(masses))})"
        )
    return values.astype(float)


def is_number(value) -> bool:
    """Whether this is one real number, of Python's or NumPy's."""
    return np.ndim(value) == 0 and np.asarray(value).dtype.kind in "fiu"


def checked_times(times, first: float, last: float, allowed: str) -> np.ndarray:
    """Times (m,) from first to last, of one number or of a sequence of them. ValueError; `allowed` says so in words."""
    try:
        values = np.atleast_1d(np.asarray(times))
    except ValueError:  # rows of different lengths
        values = np.asarray(None)
    if values.ndim != 1 or not (values.dtype.kind in "fiu" or values.size == 0):
        raise ValueError(f"times: {times!r} is not allowed; it must be a number or a sequence of numbers")
    values = values.astype(float)
    outside = ~((values >= first) & (values <= last))
    if outside.any():
        raise ValueError(f"times: {float(values[outside][0])!r} is not allowed; it must be {allowed}")
    return values


def checked_count(name: str, value, least: int, most: int = MAX_COUNT) -> int:
    """A whole number of at least and at most so many. Raises ValueError."""
    if not (is_number(value) and least <= value <= most and value == int(value)):
        raise ValueError(f"{name}: {value!r} is not allowed; it must be a whole number >= {least} and <= {most}")
    return int(value)


def file_to_write(name: str, value: str | Path) -> Path:
    """The path of a file. Raises TypeError for what is no path, ValueError for the name of a folder."""
    check_type(name, value, (str, Path), "the path of a file")
    if str(value).endswith(("/", os.sep)):
        raise ValueError(f"{name}: {str(value)!r} is not allowed; it names a folder, and must name a file")
    return Path(value)


def check_type(name: str, value: object, kinds: type | tuple[type, ...], allowed: str) -> None:
    """Raise TypeError unless `value` is one of these kinds; `allowed` says so in words."""
    if not isinstance(value, kinds):
        raise TypeError(f"{name}: {value!r} is not allowed; it must be {allowed}")
