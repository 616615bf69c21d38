"""What is given of a model's numbers and options, checked and complete."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from vibro_sweep.checks.meant import did_you_mean
from vibro_sweep.checks.not_computed import why_not_computed
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator import wording
from vibro_sweep.oscillator.checked_numbers import UNITS_ALLOWED, checked_number, phase_in_words, units_from
from vibro_sweep.oscillator.models.declaration import Model, Option
from vibro_sweep.oscillator.stops import check_stops
from vibro_sweep.tables.coordinates import MOST_MASSES
from vibro_sweep.tables.parameters import PHASE
from vibro_sweep.tables.quantity import LENGTHS, Parameter


def checked(model: Model, arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Everything the model needs, in its order: floats, tuples of floats, words. Raises ParameterError."""
    known = {quantity.name: quantity for quantity in (*model.options, *model.numbers)}
    for name, value in arguments.items():
        if name not in known:
            why = why_not_computed(name) or f"{did_you_mean(name, known)}{model.name} has {', '.join(known)}"
            raise ParameterError(name, value, f"left out; {why}")
    result = {}
    for quantity in model.options:
        result[quantity.name] = checked_option(quantity, arguments.get(quantity.name, quantity.default))
    stops = result.get("stops", "both")
    lists = [quantity for quantity in model.numbers if quantity.each]
    for quantity in sorted(lists, key=lambda x: x.default is not None or x.optional):  # those that must be given first
        value = arguments.get(quantity.name, quantity.default)
        if value is None and quantity.optional:
            result[quantity.name] = None
            continue
        if value is None:
            raise ParameterError(quantity.name, None, f"given: a list of numbers, one for each {quantity.each}")
        first = quantity.name not in result and not result.get("M") and quantity is lists[0]
        length = len(_entries(quantity, value)) if first else LENGTHS[quantity.each](model.masses(result))
        result[quantity.name] = _checked_list(quantity, value, length)
    masses = model.masses(result)
    if not 1 <= masses <= MOST_MASSES:
        name = "M" if "M" in result else lists[0].name
        raise ParameterError(name, wording.plain(result[name]), f"of 1 to {MOST_MASSES} masses")
    model.check(result)
    for quantity in model.numbers:
        if not quantity.each:
            value = arguments.get(quantity.name, quantity.default)
            if quantity.name == PHASE.name and isinstance(value, str):
                value = phase_in_words(value)
            words = isinstance(value, str) and value in quantity.words
            left_out = value is None and quantity.optional
            result[quantity.name] = value if words or left_out else checked_number(quantity, value, stops)
    check_stops(result)
    return {name: result[name] for name in known}


def _checked_list(quantity: Parameter, value: Any, length: int) -> tuple[float, ...]:
    if quantity.default is not None and number_of(value) == quantity.default:
        value = [value] * length  # nothing anywhere
    values = _entries(quantity, value)
    if len(values) != length:
        walls = ", to both walls too, where 0 is none" if quantity.each == "spring" else ""
        raise ParameterError(quantity.name, value, f"a list of {length} numbers, one for each {quantity.each}{walls}")
    return tuple(checked_number(quantity, entry, key=f"{quantity.name}[{i}]") for i, entry in enumerate(values))


def _entries(quantity: Parameter, value: Any) -> list:
    if number_of(value) is not None:
        return [value]  # of one mass
    numbers = array_of(value, 1)
    if numbers is None and not isinstance(value, (list, tuple)):  # of which the entry is named that is not a number
        raise ParameterError(quantity.name, value, f"a list of numbers, one for each {quantity.each}")
    return list(value) if numbers is None else numbers.tolist()


def checked_option(quantity: Option, value: Any) -> Any:
    if quantity.optional and (
        value is None or (quantity.kind == "matrix" and number_of(value) == 0)
    ):  # a matrix of zeros: nothing
        return None
    if quantity.kind == "word":
        if not (isinstance(value, str) and value in quantity.words):
            raise ParameterError(quantity.name, value, f"{', '.join(quantity.words[:-1])} or {quantity.words[-1]}")
    elif quantity.kind == "choice":
        value = bool(value) if isinstance(value, np.bool_) else value
        if not (isinstance(value, (bool, str)) and value in quantity.words):
            words = [str(word).lower() for word in quantity.words]
            raise ParameterError(quantity.name, value, f"{', '.join(words[:-1])} or {words[-1]}")
    elif quantity.kind == "pair":
        numbers = array_of(value, 1)
        if numbers is None or numbers.shape != (2,) or np.any(numbers % 1) or numbers[0] == numbers[1]:
            raise ParameterError(quantity.name, value, "two different whole numbers")
        return tuple(int(number) for number in numbers)
    elif quantity.kind == "units":
        if (units := units_from(value)) is None:
            raise ParameterError(quantity.name, value, UNITS_ALLOWED)
        return units
    elif quantity.kind == "whole":
        if not isinstance(value, (int, np.integer)) or number_of(value) is None:
            raise ParameterError(quantity.name, value, "a whole number")
        return int(value)
    else:
        return _array(quantity, value)
    return value


def _array(quantity: Option, value: Any) -> tuple:
    """A matrix or a vector as nested tuples of floats."""
    allowed = "a square matrix of finite numbers" if quantity.kind == "matrix" else "a list of finite numbers"
    dimensions, one_mass = 2 if quantity.kind == "matrix" else 1, number_of(value)
    array = array_of(value, dimensions) if one_mass is None else np.full((1,) * dimensions, one_mass)
    if array is None or len({*array.shape}) != 1 or array.size == 0 or not np.isfinite(array).all():
        raise ParameterError(quantity.name, value, allowed)
    numbers = array.tolist()
    return tuple(tuple(row) for row in numbers) if quantity.kind == "matrix" else tuple(numbers)
