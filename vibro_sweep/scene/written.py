"""A scene as the data that its YAML holds, and as YAML: the way back from a `Scene`, and from arguments in Python."""

import json
from collections.abc import Iterator, Mapping, Set
from dataclasses import fields, is_dataclass
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.checks.refusals import shown
from vibro_sweep.model.built import Built
from vibro_sweep.model.models import DEFAULT
from vibro_sweep.model.oscillator import Oscillator, checked_system
from vibro_sweep.tables.coordinates import START, start, state
from vibro_sweep.tables.observables import WORDS

from .axes import axis_values
from .data import Foreign, data_from
from .form import CountAxis
from .starts import Start

if TYPE_CHECKING:
    from .continuation import Continuation
    from .scene import Scene

_KEYS = {dimension: key for key, dimension in START.items()}  # start_x1 -> x1
_ORBIT = ("transient", "settle", "record")
SHORTEST_PROGRESSION = 3
MANY = 10_000  # values, of which each wrong one is named
LONGEST = 100  # entries of what a scene of branches or curves holds


def data_of(scene: "Scene") -> dict[str, Any]:
    """The data of the YAML text of a scene; numbers that are the default are left out."""
    data = {
        "system": _system(scene.system, scene.sweep),
        "sweep": {_KEYS.get(key, key): _axis(values) for key, values in scene.sweep.items()},
        "start": _start(scene.start, scene.sweep, scene.system.masses),
        "orbit": {name: getattr(scene, name) for name in _ORBIT if getattr(scene, name) is not None},
        "section": {"kind": scene.section.kind},
        "observe": sorted(scene.observe),
    }
    if scene.dynamics == "map":
        data |= {"dynamics": "map", "order": scene.order}
        data |= {} if scene.expand_at is None else {"expand_at": scene.expand_at}
    if scene.section.kind == "impact":
        data["section"]["stop"] = scene.section.stop
    if scene.trajectory:
        data["trajectory"] = {"periods": scene.trajectory.periods, "samples": scene.trajectory.samples}
    if scene.picture:
        data["picture"] = scene.picture
    return {key: value for key, value in data.items() if value or key == "observe"}


def continuation_data(scene: "Continuation", changes: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The data of the YAML text of a scene of branches or curves, with other values as the scene has them."""
    has = {field.name: getattr(scene, field.name) for field in fields(scene)}
    for key, value in (changes or {}).items():
        data = _as_data(key, value)
        # nothing here is long: what is, is refused as a whole
        has[key] = Foreign(value) if isinstance(data, (list, dict)) and len(data) > LONGEST else data
    begin, origin, parameter = has["begin"], has["origin"], has["parameter"]
    if origin == "state" and isinstance(begin, (list, tuple)):
        begin = dict(zip(state(len(begin) // 2), begin, strict=False))
    more = {"periods": has["periods"]} if origin in ("state", "itinerary") else {}
    more |= {"special": has["special"]} if origin == "branches" else {}
    more |= {"largest": has["largest"]} if origin == "sweep" and has["largest"] is not None else {}
    if isinstance(parameter, dict):
        parameter = {key: _listed(bounds) for key, bounds in parameter.items()}
    body = {"from": "free" if origin == "free" else {origin: begin, **more}, "parameter": parameter}
    if isinstance(parameter, dict) and len(parameter) == 2:
        body["of"] = _listed(has["of"])
    system = _system(scene.system, ()) if has["system"] is scene.system else has["system"]
    return {"system": system, "continue": body | {"follow": _listed(has["follow"]), "depth": has["depth"]}}


def _listed(words: object) -> object:
    return list(words) if isinstance(words, tuple) else words


def changed(data: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a scene with other values, given as a `Scene` has them or as its YAML has them; None: left out."""
    result = dict(data)
    for key, value in changes.items():
        if key in _ORBIT:
            result["orbit"] = result.get("orbit", {}) | {key: data_from(value)}
        elif value is None:
            result.pop(key, None)
        else:
            result[key] = _as_data(key, value)
    return result


def yaml_of(data: Mapping[str, Any]) -> str:
    """The data of a scene as YAML, one key a line."""
    return "".join(f"{key}: {_flow(value)}\n" for key, value in data.items())


def _as_data(key: str, value):
    if isinstance(value, Oscillator):
        return _system(value, ())
    if isinstance(value, Start):
        return _start(value, (), len(value.state) // 2)
    if key == "sweep" and isinstance(value, Mapping):
        return {
            _KEYS.get(name, name) if isinstance(name, str) else shown(name): axis_data(axis)
            for name, axis in value.items()
        }
    if key == "observe":
        found = data_from(list(islice(value, len(WORDS) + 1)) if isinstance(value, (Iterator, Set)) else value)
        return found[: len(WORDS) + 1] if isinstance(found, list) else found  # of more some are there twice
    if key == "start" and not isinstance(value, (str, Mapping)):
        values = data_from(value)
        if not isinstance(values, list) or len(values) % 2 or len(values) > len(START):
            return values
        return dict(zip(state(len(values) // 2), values, strict=True))
    if is_dataclass(value) and not isinstance(value, type):  # a Section or a Trajectory
        value = {field.name: getattr(value, field.name) for field in fields(value)}
    return data_from(value)


def axis_data(axis: object) -> object:
    """An axis as YAML has it."""
    data = data_from(axis)
    data = {"values": data} if isinstance(data, list) else data
    values = data.get("values") if isinstance(data, dict) else None
    if isinstance(values, list) and len(values) > MANY and any(type(one) not in (int, float) for one in values):
        data["values"] = Foreign(values)  # it is refused as a whole
    return data


def _system(system: Oscillator, swept) -> dict[str, Any]:
    """Numbers and options that are not what they are if they are left out; those of lists that are swept stay."""
    if isinstance(system, Built):
        return dict(system.options)
    checked_system(system)
    kind = {} if system.model.name == DEFAULT else {"type": system.model.name}
    given = {one.name: getattr(system, one.name) for one in system.model.numbers if one.name not in swept}
    left_out = {one.name: one.default for one in system.model.numbers if one.default is not None}
    left_out["tau"] = None  # always written
    numbers = {
        name: data_from(value)
        for name, value in given.items()
        if value is not None and not np.array_equal(value, left_out.get(name)) and np.any(value != left_out.get(name))
    }
    return kind | numbers | {name: data_from(value) for name, value in system.options.items() if value is not None}


def _axis(values: np.ndarray) -> dict[str, Any]:
    """The axis as data, by its ends where these give the same values, bit for bit."""
    if len(values) >= SHORTEST_PROGRESSION:
        ends = {"start": float(values[0]), "stop": float(values[-1]), "num": len(values)}
        found, _ = axis_values("", CountAxis(**ends))
        if found is not None and np.array_equal(found, values):
            return ends
    return {"values": values.tolist()}


def _start(given: Start, swept, masses: int) -> dict[str, Any]:
    if given.kind == "random":
        return {"random": given.count, "seed": given.seed}
    named = zip(state(masses), start(masses), given.state, strict=True)
    values = {name: value for name, dimension, value in named if value and dimension not in swept}
    return ({"follow": given.direction} if given.kind == "follow" else {}) | values


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
