"""Sweeps as records: the variables and attributes of their files, and what differs from a record.

Names, dimensions, types, texts and whole numbers have to be the same, real numbers within their allowance. Of a long
array some numbers are kept. What rounding decides is not kept: numbers that move by more than `LARGEST` of the size of
their variable, and, where section points or averages do so, the counts of that orbit too.
"""

import numpy as np

from golden import units
from golden.files import comparable
from golden.scenes import computed
from golden.special_points import changed

KEPT = 16  # real numbers of a variable
COUNTS = 48  # whole numbers of a variable
LARGEST = 1e-6
NOISE = 1e-9  # a variable whose largest number is smaller holds errors of rounding, which say nothing of its orbits
OF_ERRORS = 10.0  # the size of numbers whose rounding is the least that an error is told apart from
SETTLED_OR_NOT = ("status", "period")  # kept of all orbits
OF_THE_RUN = ("history", "provenance", "heap", "identity")  # attributes with the date, the version and the place


def result_of(data, beside, rng) -> dict:
    """What is kept of a Dataset, given those of the same scene with other rounding."""
    numbers, others = numbers_of(data), [numbers_of(other) for other in beside]
    allowed = {
        name: _allowances(name, values, [other[name] for other in others])
        for name, values in numbers.items()
        if _is_real(values)
    }
    unsettled = _unsettled(data, numbers, allowed)
    result = form_of(data)
    for name, values in numbers.items():
        flat = values.ravel()
        if name in allowed:
            chosen = np.flatnonzero(_certain(values, allowed[name]).ravel())
            chosen = np.sort(rng.permutation(chosen)[:KEPT])
            more = {"allowed": [float(f"{a:.1e}") for a in allowed[name].ravel()[chosen]]}
        else:
            same = np.all([values == other[name] for other in others], axis=0)
            if name in data.variables and name not in SETTLED_OR_NOT:
                same &= ~_spread(unsettled, data, name)
            chosen, more = np.sort(rng.permutation(np.flatnonzero(same))[:COUNTS]), {}
        result["numbers"][name] = {"at": chosen.tolist(), "values": flat[chosen].tolist()} | more
    return result


def form_of(data) -> dict:
    """Names, dimensions, types and texts."""
    variables = {
        name: {
            "dims": list(variable.dims), "shape": list(variable.shape), "dtype": str(variable.dtype),
            "attrs": {key: _plain(value) for key, value in variable.attrs.items()},
        }
        for name, variable in data.variables.items()
    }  # fmt: skip
    texts = {
        key: _plain(value)
        for key, value in data.attrs.items()
        if key not in OF_THE_RUN and not _is_real(np.asarray(value))
    }
    return {"variables": variables, "attrs": texts, "numbers": {}}


def numbers_of(data) -> dict[str, np.ndarray]:
    """All variables, and the attributes that are real numbers."""
    attributes = {name: np.asarray(value) for name, value in data.attrs.items() if name not in OF_THE_RUN}
    return {name: variable.values for name, variable in data.variables.items()} | {
        f"attribute {name}": value for name, value in attributes.items() if _is_real(value)
    }


def compared(result: dict, data) -> list[str]:
    """In words what differs between the `result` of a record and a Dataset."""
    now, numbers = form_of(data), numbers_of(data)
    lines = [f"{name}: {line}" for name in ("variables", "attrs") for line in _other(result[name], now[name])]
    lines += changed({"numbers": sorted(result["numbers"])}, {"numbers": sorted(numbers)}, ("numbers",))
    if lines:
        return lines
    for name, kept in result["numbers"].items():
        values = numbers[name].ravel()[kept["at"]]
        if "allowed" in kept:
            wrong = units.apart(kept["values"], values, kept["allowed"])
        else:
            wrong = np.flatnonzero(np.asarray(kept["values"], values.dtype) != values)
        lines += [f"{name}[{kept['at'][i]}]: {kept['values'][i]!r}, now {values[i]!r}" for i in wrong]
    return lines


def differences_from(record: dict) -> list[str]:
    """Between a record and the sweep that is computed now."""
    return compared(record["result"], computed(record["scene"]))


def _other(stored: dict, now: dict) -> list[str]:
    stored, now = comparable(stored), comparable(now)
    return changed(
        stored | {"names": sorted(stored)}, now | {"names": sorted(now)}, ("names", *(stored.keys() & now.keys()))
    )


def _is_real(values: np.ndarray) -> bool:
    return values.dtype.kind == "f"


def _allowances(name: str, values, others) -> np.ndarray:
    """How far numbers may move; of what is NaN or infinite 0, infinity where other rounding makes it a number."""
    scale = OF_ERRORS if name.endswith(("_error", "_residual")) else None
    finite = np.isfinite([values, *others])
    numbers = [np.where(is_number, number, 0.0) for is_number, number in zip(finite, (values, *others), strict=True)]
    allowed = units.allowances(numbers[0], numbers[1:], scale)
    return np.where(finite.all(axis=0), allowed, np.where(finite.any(axis=0), np.inf, 0.0))


def _certain(values, allowed) -> np.ndarray:
    """Which numbers rounding does not decide."""
    return allowed <= max(LARGEST * _size(values), units.LEAST * OF_ERRORS)


def _size(values) -> float:
    return np.abs(values[np.isfinite(values)]).max(initial=0.0)


def _unsettled(data, numbers, allowed) -> np.ndarray:
    """At which points of the sweep real numbers are decided by rounding."""
    orbits = data["status"]
    result = np.zeros(orbits.shape, bool)
    for name in allowed.keys() & {*data.data_vars}:
        if _size(numbers[name]) > NOISE and data[name].dims[: orbits.ndim] == orbits.dims:
            sure = _certain(numbers[name], allowed[name])
            result |= ~sure.reshape(*orbits.shape, -1).all(axis=-1)
    return result


def _spread(unsettled, data, name: str) -> np.ndarray:
    """The same for each number of a variable."""
    dims, shape = data["status"].dims, data[name].shape
    if data[name].dims[: len(dims)] != dims:
        return np.zeros(shape, bool)
    return np.broadcast_to(unsettled.reshape(unsettled.shape + (1,) * (len(shape) - len(dims))), shape)


def _plain(value):
    """As JSON has it."""
    return np.asarray(value).tolist() if isinstance(value, (np.ndarray, np.generic)) else value
