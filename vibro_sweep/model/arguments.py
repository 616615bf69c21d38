"""Arguments of the Python functions, checked: what is wrong is named before anything is computed."""

import numpy as np

MAX_COUNT = 10**12  # periods


def checked_state(state) -> np.ndarray:
    """A state (x1, v1, x2, v2) as an array (4,). Raises ValueError unless it is four finite numbers."""
    try:
        values = np.asarray(state)
    except ValueError:  # rows of different lengths
        values = np.asarray(None)
    if values.shape != (4,) or values.dtype.kind not in "fiu" or not np.isfinite(values.astype(float)).all():
        raise ValueError(f"state: {state!r} is not allowed; it must be four finite numbers (x1, v1, x2, v2)")
    return values.astype(float)


def is_number(value) -> bool:
    """Whether this is one real number, of Python's or NumPy's."""
    return np.ndim(value) == 0 and np.asarray(value).dtype.kind in "fiu"


def checked_count(name: str, value, least: int, most: int = MAX_COUNT) -> int:
    """A whole number of at least and at most so many. Raises ValueError."""
    if not (is_number(value) and least <= value <= most and value == int(value)):
        raise ValueError(f"{name}: {value!r} is not allowed; it must be a whole number >= {least} and <= {most}")
    return int(value)


def check_type(name: str, value: object, kinds: type | tuple[type, ...], allowed: str) -> None:
    """Raise TypeError unless `value` is one of these kinds; `allowed` says so in words."""
    if not isinstance(value, kinds):
        raise TypeError(f"{name}: {value!r} is not allowed; it must be {allowed}")
