"""A scene as the data that its YAML holds, and as YAML: the way back from a `Scene`, and from arguments in Python."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.model.oscillator import System
from vibro_sweep.model.parameters import NAMES
from vibro_sweep.model.state import START, STATE

from .axes import axis_values
from .form import CountAxis
from .starts import Start

if TYPE_CHECKING:
    from .scene import Scene

_KEYS = {dimension: key for key, dimension in START.items()}  # start_x1 -> x1
_ORBIT = ("transient", "record")
SHORTEST_PROGRESSION = 3


def data_of(scene: "Scene") -> dict[str, Any]:
    """What the YAML text of a scene holds; numbers that are the default are left out."""
    data = {
        "system": _system(scene.system, scene.sweep),
        "sweep": {_KEYS.get(key, key): _axis(values) for key, values in scene.sweep.items()},
        "start": _start(scene.start, scene.sweep),
        "orbit": {"transient": scene.transient, "record": scene.record},
        "section": {"kind": scene.section.kind},
        "observe": sorted(scene.observe),
    }
    if scene.model == "map":
        data |= {"model": "map", "order": scene.order}
        data |= {} if scene.expand_at is None else {"expand_at": scene.expand_at}
    if scene.section.kind == "impact":
        data["section"]["stop"] = scene.section.stop
    if scene.trajectory:
        data["trajectory"] = {"periods": scene.trajectory.periods, "samples": scene.trajectory.samples}
    if scene.picture:
        data["picture"] = scene.picture
    return {key: value for key, value in data.items() if value or key == "observe"}


def changed(data: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a scene with other values, given as a `Scene` has them or as its YAML has them; None: left out."""
    result = dict(data)
    for key, value in changes.items():
        if key in _ORBIT:
            result["orbit"] = result.get("orbit", {}) | {key: _plain(value)}
        elif value is None:
            result.pop(key, None)
        else:
            result[key] = _as_data(key, value)
    return result


def yaml_of(data: Mapping[str, Any]) -> str:
    """The data of a scene as YAML, one key a line."""
    return "".join(f"{key}: {_flow(value)}\n" for key, value in data.items())


def _as_data(key: str, value):
    if isinstance(value, System):
        return _system(value, ())
    if isinstance(value, Start):
        return _start(value, ())
    if key == "sweep" and isinstance(value, Mapping):
        return {_KEYS.get(name, name): _axis_data(axis) for name, axis in value.items()}
    if key == "start" and not isinstance(value, (str, Mapping)):
        state = _plain(value)
        return dict(zip(STATE, state, strict=True)) if isinstance(state, list) and len(state) == len(STATE) else state
    if key in ("section", "trajectory") and not isinstance(value, (str, Mapping)):
        value = {name: getattr(value, name) for name in getattr(value, "__dataclass_fields__", {})} or value
    return _plain(value)


def _axis_data(axis):
    if isinstance(axis, Mapping):
        return _plain(axis)
    values = _plain(axis)
    return {"values": values} if isinstance(values, list) else values


def _plain(value):
    """Numbers and lists of Python in place of those of NumPy and of other sequences."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, Iterable) and not isinstance(value, (str, bytes)):
        return [_plain(item) for item in value]
    return value


def _system(system: System, swept) -> dict[str, Any]:
    numbers = {name: getattr(system, name) for name in NAMES if name not in swept}
    return numbers | {"stops": system.stops}


def _axis(values: np.ndarray) -> dict[str, Any]:
    """By its ends where these give the same values, bit for bit."""
    if len(values) >= SHORTEST_PROGRESSION:
        ends = {"start": float(values[0]), "stop": float(values[-1]), "num": len(values)}
        found, _ = axis_values("", CountAxis(**ends))
        if found is not None and np.array_equal(found, values):
            return ends
    return {"values": values.tolist()}


def _start(start: Start, swept) -> dict[str, Any]:
    if start.kind == "random":
        return {"random": start.count, "seed": start.seed}
    given = {name: value for name, value in zip(STATE, start.state, strict=True) if value and START[name] not in swept}
    return ({"follow": start.direction} if start.kind == "follow" else {}) | given


def _flow(value) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if not isinstance(value, float):
        return str(value)
    if value.is_integer() and abs(value) < 1e16:
        return str(int(value))
    mantissa, e, exponent = repr(value).partition("e")
    return mantissa + (".0" if e and "." not in mantissa else "") + e + exponent  # 1e-9 is a text in YAML 1.1
