"""A scene as the data that its YAML holds, and as YAML: the way back from a `Scene`, and from arguments in Python."""

import json
from collections.abc import Iterator, Mapping, Set
from dataclasses import fields, is_dataclass
from itertools import islice
from typing import Any

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed, shown
from vibro_sweep.oscillator.function_model import FunctionModel
from vibro_sweep.oscillator.models import DEFAULT
from vibro_sweep.oscillator.oscillator import Oscillator, checked_system
from vibro_sweep.oscillator.other_words import own_name
from vibro_sweep.tables.coordinates import START, start, state
from vibro_sweep.tables.observables import WORDS

from .axes import axis_values
from .data import InvalidValue, data_from
from .form import CountAxis
from .slips import is_number_of_values
from .starts import Start

KEYS = {dimension: key for key, dimension in START.items()}  # start_x1 -> x1
ORBIT = ("transient", "settle", "record")
SHORTEST_PROGRESSION = 3
MANY = 10_000  # values, of which each wrong one is named


def changed(data: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a scene with other values, given as a `Scene` has them or as its YAML has them; None: left out."""
    result = dict(data)
    for key, value in changes.items():
        if key in ORBIT:
            result["orbit"] = result.get("orbit", {}) | {key: data_from(value)}
        elif value is None:
            result.pop(key, None)
        else:
            result[key] = as_data(key, value)
    return result


def yaml_of(data: Mapping[str, Any]) -> str:
    """The data of a scene as YAML, one key a line."""
    return "".join(f"{key}: {_flow(value)}\n" for key, value in data.items())


def as_data(key: str, value):
    if isinstance(value, Oscillator):
        return system_data(value, ())
    if isinstance(value, Start):
        return start_data(value, (), len(value.state) // 2)
    if key == "sweep" and isinstance(value, Mapping):
        return {
            KEYS.get(name, name) if isinstance(name, str) else shown(name): axis_data(axis)
            for name, axis in value.items()
        }
    if key == "observe":
        plain_data = data_from(list(islice(value, len(WORDS) + 1)) if isinstance(value, (Iterator, Set)) else value)
        return (
            plain_data[: len(WORDS) + 1] if isinstance(plain_data, list) else plain_data
        )  # of more some are there twice
    if key == "start" and not isinstance(value, (str, Mapping)):
        values = data_from(value)
        if not isinstance(values, list) or len(values) % 2 or len(values) > len(START):
            return values
        return dict(zip(state(len(values) // 2), values, strict=True))
    if is_dataclass(value) and not isinstance(value, type):  # a Section or a Trajectory
        names = {"begin": "from"}  # which is no name in Python
        value = {names.get(field.name, field.name): getattr(value, field.name) for field in fields(value)}
    return data_from(value)


def axis_data(axis: object) -> object:
    """An axis as YAML has it."""
    if isinstance(axis, tuple) and len(axis) == 3 and is_number_of_values(*axis):
        start, stop, num = axis
        ways = f"{{'start': {start!r}, 'stop': {stop!r}, 'num': {num!r}}} or np.linspace({start!r}, {stop!r}, {num!r})"
        raise ArgumentError(not_allowed("axes", axis, f"written as {ways}; three values are a list, {list(axis)!r}"))
    data = data_from(axis)
    data = {"values": data} if isinstance(data, list) else data
    values = data.get("values") if isinstance(data, dict) else None
    if (
        isinstance(values, list)
        and len(values) > MANY
        and any(type(quantity) not in (int, float) for quantity in values)
    ):
        data["values"] = InvalidValue(values)  # it is refused as a whole
    return data


def system_data(system: Oscillator, swept) -> dict[str, Any]:
    """Numbers and options that are not what they are if they are left out; those of lists that are swept stay."""
    if isinstance(system, FunctionModel):
        return dict(system.options)
    checked_system(system)
    kind, swept = {} if system.model.name == DEFAULT else {"type": system.model.name}, {own_name(key) for key in swept}
    entries = {
        quantity.name: getattr(system, quantity.name) for quantity in system.model.numbers if quantity.name not in swept
    }
    left_out = {quantity.name: quantity.default for quantity in system.model.numbers if quantity.default is not None}
    left_out["tau"] = None  # always written
    numbers = {
        name: data_from(value)
        for name, value in entries.items()
        if value is not None and not np.array_equal(value, left_out.get(name)) and np.any(value != left_out.get(name))
    }
    return kind | numbers | {name: data_from(value) for name, value in system.options.items() if value is not None}


def progression(values: np.ndarray) -> dict[str, Any]:
    """The axis as data, by its ends where these give the same values, bit for bit."""
    if len(values) >= SHORTEST_PROGRESSION:
        ends = {"start": float(values[0]), "stop": float(values[-1]), "num": len(values)}
        plain_data, _ = axis_values("", CountAxis(**ends))
        if plain_data is not None and np.array_equal(plain_data, values):
            return ends
    return {"values": values.tolist()}


def start_data(entries: Start, swept, masses: int) -> dict[str, Any]:
    if entries.kind == "random":
        box = {key: [low, high] for key, low, high in entries.box}
        return {"random": entries.count, "seed": entries.seed} | ({"box": box} if box else {})
    named = zip(state(masses), start(masses), entries.state, strict=True)
    values = {name: value for name, dimension, value in named if value and dimension not in swept}
    return ({"follow": entries.direction} if entries.kind == "follow" else {}) | values


def _flow(value) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, str) and not value.isidentifier():
        return json.dumps(value, ensure_ascii=False)  # a path, say, may hold what YAML reads otherwise
    if not isinstance(value, float):
        return str(value)
    if value.is_integer() and abs(value) < 1e16:
        return str(int(value))
    mantissa, e, exponent = repr(value).partition("e")
    return mantissa + (".0" if e and "." not in mantissa else "") + e + exponent  # 1e-9 is a text in YAML 1.1
