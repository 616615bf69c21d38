"""Numbers and units that a caller gives, checked by what is declared of them."""

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.tables.parameters import CLEARANCE
from vibro_sweep.tables.quantity import NUMBER, POSITIVE, Parameter, Range
from vibro_sweep.tables.units import SI, Units, units_of_names

SMALLEST = 1e-100  # of n of the gap n.x, and one over its largest
UNITS_ALLOWED = (
    "SI, or names as {mass: kg, length: mm, time: s}, also with a force in place of one of these, or three positive "
    "numbers: what a mass, a length and a time of 1 are in kg, m and s"
)


def units_from(value: Any) -> Units | None:
    """None for values that are not units: neither the word SI nor three names or positive numbers."""
    if isinstance(value, Mapping):
        return units_of_names(value)
    if isinstance(value, str):
        return SI if value == "SI" else None
    sizes = array_of(value, 1)
    if sizes is None or sizes.shape != (3,) or not all(0 < size < math.inf for size in sizes.tolist()):
        return None
    return Units(*sizes.tolist())


OF_PI = r"([-+]?)(\d+\.?\d*|\.\d+)?\s*\*?\s*pi\s*(?:/\s*(\d+\.?\d*))?"


def phase_in_words(text: str) -> str | float:
    """A phase that is given as "cos", or in parts of pi, as "pi/2" and "0.3 pi"; any other text as it is."""
    if text == "cos":  # of omega t, in place of a sine
        return math.pi / 2
    parts = re.fullmatch(OF_PI, text.strip())
    if parts is None or (parts[3] is not None and float(parts[3]) == 0):
        return text
    return float(f"{parts[1]}1") * float(parts[2] or 1) * math.pi / float(parts[3] or 1)


def range_of(parameter: Parameter, stops: str) -> Range:
    """The range of a number where there are these stops: one alone may stand anywhere."""
    if parameter.name not in (CLEARANCE.name, "B"):
        return parameter.range
    return POSITIVE if stops == "both" else NUMBER


def check_value(parameter: Parameter, value: object, stops: str = "both", key: str | None = None) -> None:
    """Raise `ParameterError` unless `value` (a number or an array of numbers) is allowed for the parameter.

    key : what the error names, by default the parameter
    """
    allowed, key = range_of(parameter, stops), key or parameter.name
    numbers = np.asarray(value)
    if numbers.dtype.kind not in "fiu":
        raise ParameterError(key, value, allowed.text)
    good = allowed.holds(numbers)
    if not np.all(good):
        wanted, bad = allowed.text.replace("a number", "a finite number", 1), numbers[~good].flat[0].item()
        beyond = bad == 0 or (-np.inf < bad < 0 and allowed.holds(np.zeros(())))
        raise ParameterError(key, bad, f"{wanted}; {parameter.instead}" if parameter.instead and beyond else wanted)


def checked_number(parameter: Parameter, value: object, stops: str = "both", key: str | None = None) -> float:
    """A number as a float. Raises `ParameterError`, with the value as it was given, unless it is allowed."""
    number, key = number_of(value), key or parameter.name
    if number is None:
        raise ParameterError(key, value, range_of(parameter, stops).text)
    try:
        check_value(parameter, number, stops, key)
    except ParameterError as error:
        raise ParameterError(key, value, error.allowed) from None
    return number


def checked_normal(value: Any) -> tuple[float, ...]:
    """n of a gap, which may have any scale."""
    normal = array_of(value, 1)
    if normal is None or normal.size == 0 or not np.isfinite(normal).all():
        raise ParameterError("contact_normal", value, "a list of finite numbers")
    if not normal.any():
        raise ParameterError("contact_normal", normal.tolist(), "other than zero: it is n of the gap n . x")
    if not SMALLEST < np.abs(normal).max() < 1 / SMALLEST:  # its square counts
        raise ParameterError("contact_normal", normal.tolist(), f"of a size from {SMALLEST:g} to {1 / SMALLEST:g}")
    return tuple(normal.tolist())
