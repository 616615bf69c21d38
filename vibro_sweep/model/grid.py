"""The numbers of an oscillator over a grid of values for some of them: what a sweep computes, point by point."""

import hashlib
import itertools
import math

import numpy as np

from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.built import Built, sizes_of, stored_of
from vibro_sweep.model.grazing import resolved
from vibro_sweep.model.linear import Linear
from vibro_sweep.model.oscillator import System
from vibro_sweep.model.stops import followers

MOST_COMPARED = 4096


def grid(system: AnyOscillator, axes: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Every number by name, `tau` resolved, and the axes, at each point of a grid of values for some.

    Read-only arrays with one dimension for each of `axes`, in their order.
    """
    numbers = system.numbers
    numbers.update(zip(axes, np.meshgrid(*axes.values(), indexing="ij", sparse=True), strict=True))
    shape = tuple(len(values) for values in axes.values())
    if isinstance(system, System):
        numbers = resolved(numbers)
    else:
        if isinstance(system, Built):
            numbers |= _sizes(linears(system, axes))
        numbers |= followers(numbers)
        numbers = {name: value for name, value in numbers.items() if value is not None}
        if isinstance(numbers.get("tau"), str):
            numbers["tau"] = np.array([q.tau for q in linears(system, axes).flat]).reshape(shape)
    return {name: _everywhere(value, shape) for name, value in numbers.items()}


def _everywhere(value, shape: tuple[int, ...]) -> np.ndarray:
    """The same as np.broadcast_to, which takes six times as long for a number: each block has a dozen of them."""
    if isinstance(value, np.ndarray):
        return np.broadcast_to(value, shape)
    number = np.array(value)
    number.flags.writeable = False
    return np.ndarray(shape, number.dtype, number, 0, (0,) * len(shape))


def linears(system: AnyOscillator, axes: dict[str, np.ndarray]) -> np.ndarray:
    """The oscillators at the points of such a grid, phases resolved: an array of `Linear` with its shape."""
    keys = [key for key in axes if key in system.described]
    family = system.family
    result = np.empty(tuple(len(values) for values in axes.values()), object)
    flat = (values.tolist() if key in keys else [None] * len(values) for key, values in axes.items())
    for place, values in zip(np.ndindex(result.shape), itertools.product(*flat), strict=True):
        changes = {key: value for key, value in zip(axes, values, strict=True) if key in keys}
        result[place] = _one(family, changes)
    return result


def digest(system: Built, axes: dict[str, np.ndarray]) -> str:
    """A digest of what the function makes at the points of such a grid: at no more than `MOST_COMPARED`, spread evenly.

    Two functions of one name are distinguished by it, and a file of one is not continued by the other.
    """
    axes = {key: values for key, values in axes.items() if key in system.described}
    shape = tuple(len(values) for values in axes.values())
    count, found = math.prod(shape), hashlib.sha256()
    for i in range(min(count, MOST_COMPARED)):
        place = np.unravel_index(i * count // min(count, MOST_COMPARED), shape) if shape else ()
        changes = {key: float(values[k]) for (key, values), k in zip(axes.items(), place, strict=True)}
        found.update(np.array([*stored_of(_one(system.family, changes)).values()]).tobytes())
    return found.hexdigest()[:16]


def _sizes(each: np.ndarray) -> dict[str, np.ndarray]:
    found = [sizes_of(q) for q in each.flat]
    return {name: np.array([one[name] for one in found]).reshape(each.shape) for name in found[0]}


def _one(family, changes) -> Linear:
    return family.replace(**changes).linear
