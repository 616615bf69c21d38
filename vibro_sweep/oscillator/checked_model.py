"""What is given of a model's numbers and options, checked and complete."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from vibro_sweep.checks.meant import did_you_mean
from vibro_sweep.checks.not_computed import why_not_computed
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator import wording
from vibro_sweep.oscillator.checked_numbers import UNITS_ALLOWED, checked_number, units_from
from vibro_sweep.oscillator.models.declaration import Model, Option
from vibro_sweep.oscillator.stops import check_stops
from vibro_sweep.tables.coordinates import MOST_MASSES
from vibro_sweep.tables.quantity import LENGTHS, Parameter


def checked(model: Model, given: Mapping[str, Any]) -> dict[str, Any]:
    """Everything the model needs, in its order: floats, tuples of floats, words. Raises ParameterError."""
    known = {one.name: one for one in (*model.options, *model.numbers)}
    for name, value in given.items():
        if name not in known:
            why = why_not_computed(name) or f"{did_you_mean(name, known)}{model.name} has {', '.join(known)}"
            raise ParameterError(name, value, f"left out; {why}")
    result = {}
    for one in model.options:
        result[one.name] = checked_option(one, given.get(one.name, one.default))
    stops = result.get("stops", "both")
    lists = [one for one in model.numbers if one.each]
    for one in sorted(lists, key=lambda one: one.default is not None or one.optional):  # those that must be given first
        value = given.get(one.name, one.default)
        if value is None and one.optional:
            result[one.name] = None
            continue
        if value is None:
            raise ParameterError(one.name, None, f"given: a list of numbers, one for each {one.each}")
        first = one.name not in result and not result.get("M") and one is lists[0]
        length = len(_entries(one, value)) if first else LENGTHS[one.each](model.masses(result))
        result[one.name] = _checked_list(one, value, length)
    masses = model.masses(result)
    if not 1 <= masses <= MOST_MASSES:
        name = "M" if "M" in result else lists[0].name
        raise ParameterError(name, wording.plain(result[name]), f"of 1 to {MOST_MASSES} masses")
    model.check(result)
    for one in model.numbers:
        if not one.each:
            value = given.get(one.name, one.default)
            words = isinstance(value, str) and value in one.words
            left_out = value is None and one.optional
            result[one.name] = value if words or left_out else checked_number(one, value, stops)
    check_stops(result)
    return {name: result[name] for name in known}


def _checked_list(one: Parameter, value: Any, length: int) -> tuple[float, ...]:
    if one.default is not None and number_of(value) == one.default:
        value = [value] * length  # nothing anywhere
    values = _entries(one, value)
    if len(values) != length:
        walls = ", to both walls too, where 0 is none" if one.each == "spring" else ""
        raise ParameterError(one.name, value, f"a list of {length} numbers, one for each {one.each}{walls}")
    return tuple(checked_number(one, entry, key=f"{one.name}[{i}]") for i, entry in enumerate(values))


def _entries(one: Parameter, value: Any) -> list:
    if number_of(value) is not None:
        return [value]  # of one mass
    numbers = array_of(value, 1)
    if numbers is None and not isinstance(value, (list, tuple)):  # of which the entry is named that is not a number
        raise ParameterError(one.name, value, f"a list of numbers, one for each {one.each}")
    return list(value) if numbers is None else numbers.tolist()


def checked_option(one: Option, value: Any) -> Any:
    if one.optional and (
        value is None or (one.kind == "matrix" and number_of(value) == 0)
    ):  # a matrix of zeros: nothing
        return None
    if one.kind == "word":
        if not (isinstance(value, str) and value in one.words):
            raise ParameterError(one.name, value, f"{', '.join(one.words[:-1])} or {one.words[-1]}")
    elif one.kind == "flag":
        if not isinstance(value, (bool, np.bool_)):
            raise ParameterError(one.name, value, "true or false")
        return bool(value)
    elif one.kind == "units":
        if (units := units_from(value)) is None:
            raise ParameterError(one.name, value, UNITS_ALLOWED)
        return units
    elif one.kind == "whole":
        if not isinstance(value, (int, np.integer)) or number_of(value) is None:
            raise ParameterError(one.name, value, "a whole number")
        return int(value)
    else:
        return _array(one, value)
    return value


def _array(one: Option, value: Any) -> tuple:
    """A matrix or a vector as nested tuples of floats."""
    allowed = "a square matrix of finite numbers" if one.kind == "matrix" else "a list of finite numbers"
    dimensions, one_mass = 2 if one.kind == "matrix" else 1, number_of(value)
    array = array_of(value, dimensions) if one_mass is None else np.full((1,) * dimensions, one_mass)
    if array is None or len({*array.shape}) != 1 or array.size == 0 or not np.isfinite(array).all():
        raise ParameterError(one.name, value, allowed)
    numbers = array.tolist()
    return tuple(tuple(row) for row in numbers) if one.kind == "matrix" else tuple(numbers)
