"""The values of a swept parameter, checked before any memory is taken."""

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np

from .form import CountAxis, ListAxis, StepAxis
from .problems import problem

MAX_VALUES = 10**7
MAX_SPAN = 1e300  # between the ends of an axis: no difference of its values leaves the range of the floats


def axis_values(path: str, axis: StepAxis | CountAxis | ListAxis) -> tuple[np.ndarray | None, list[str]]:
    """The values of one axis, (n,), strictly monotonic and read-only; or None and what is wrong."""
    if isinstance(axis, ListAxis):
        count, key, value = len(axis.values), f"{path}.values", axis.values
        if count == 0:
            return None, [problem(key, value, "is empty; there must be at least one value")]
    elif isinstance(axis, CountAxis):
        count, key, value = axis.num, f"{path}.num", axis.num
        if count < 2:
            return None, [problem(key, value, "must be a whole number >= 2")]
        if axis.start == axis.stop:
            return None, [problem(f"{path}.stop", axis.stop, "must differ from start")]
    else:
        key, value = f"{path}.step", axis.step
        if axis.step == 0:
            return None, [problem(key, value, "must not be 0")]
        if axis.stop != axis.start and (axis.stop > axis.start) != (axis.step > 0):
            direction = "> 0" if axis.stop > axis.start else "< 0"
            text = f"has the wrong sign: from {axis.start:g} to {axis.stop:g} it must be {direction}"
            return None, [problem(key, value, text)]
        count = math.floor((_exact(axis.stop) - _exact(axis.start)) / _exact(axis.step)) + 1
    if count > MAX_VALUES:
        return None, [problem(key, value, f"makes {Decimal(count):.3g} values; at most {MAX_VALUES:.0e} are allowed")]

    if isinstance(axis, ListAxis):
        values = np.array(axis.values)
    elif count == 1:
        values = np.array([axis.start])
    else:
        wide = isinstance(axis, CountAxis)
        step = (_exact(axis.stop) - _exact(axis.start)) / (count - 1) if wide else _exact(axis.step)
        if abs(step) * (count - 1) > MAX_SPAN:
            return None, [problem(f"{path}.stop", axis.stop, f"is farther than {MAX_SPAN:.0e} from start")]
        values = _progression(axis.start, step, count)
    with np.errstate(over="ignore"):
        steps = np.diff(values)
    if not (np.all(steps > 0) or np.all(steps < 0)):
        text = "must rise or fall from value to value, none of them twice"
        if not isinstance(axis, ListAxis):
            text = "makes steps below the resolution of double precision"
        return None, [problem(key, value, text)]
    values.flags.writeable = False
    return values, []


def _exact(number: float) -> Fraction:
    return Fraction(repr(number))  # the decimal number that was written, not the double next to it


def _progression(start: float, step: Fraction, count: int) -> np.ndarray:
    """start + i step, each the double nearest to the exact value: 6.6 in a sweep is the 6.6 of a prompt."""
    first = _exact(start)
    denominator = math.lcm(first.denominator, step.denominator)
    numerators = [int((first + i * step) * denominator) for i in (0, count - 1)]
    if max(denominator, *map(abs, numerators)) > 2**53:
        return start + float(step) * np.arange(count)
    # below 2^53 integers are exact doubles, and a division rounds once
    return (numerators[0] + int(step * denominator) * np.arange(count)) / denominator
