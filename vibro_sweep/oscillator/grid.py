"""The numbers of an oscillator over a grid of values for some of them: what a sweep computes, point by point."""

import hashlib
import math

import numpy as np

from vibro_sweep.oscillator.family import stack_of
from vibro_sweep.oscillator.function_model import FunctionModel, sizes_of, stored_of
from vibro_sweep.oscillator.linear import Linear, mapped, stacked
from vibro_sweep.oscillator.oscillator import Oscillator, following, in_closed_form
from vibro_sweep.oscillator.other_words import with_omega
from vibro_sweep.oscillator.paper_motion import resolved

MOST_COMPARED = 4096


def grid(system: Oscillator, axes: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Every number by name, `tau` resolved, and the axes, at each point of a grid of values for some.

    Read-only arrays with one dimension for each of `axes`, in their order.
    """
    numbers = system.numbers
    swept = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij", sparse=True), strict=True))
    numbers |= swept | with_omega(swept, numbers)
    shape = tuple(len(values) for values in axes.values())
    if in_closed_form(system, axes):
        numbers = resolved(numbers)
    else:
        if isinstance(system, FunctionModel):
            numbers |= sizes_of(linears(system, axes))
        numbers |= following(system.model, numbers)
        numbers = {name: value for name, value in numbers.items() if value is not None}
        if isinstance(numbers.get("tau"), str):
            numbers["tau"] = linears(system, axes).tau
    return {name: _everywhere(value, shape) for name, value in numbers.items()}


def _everywhere(value, shape: tuple[int, ...]) -> np.ndarray:
    """The same as np.broadcast_to, which takes six times as long for a number: each block has a dozen of them."""
    if isinstance(value, np.ndarray):
        return np.broadcast_to(value, shape)
    number = np.array(value)
    number.flags.writeable = False
    return np.ndarray(shape, number.dtype, number, 0, (0,) * len(shape))


def linears(system: Oscillator, axes: dict[str, np.ndarray]) -> Linear:
    """The oscillators at the points of such a grid, phases resolved: a stack of its shape."""
    shape = tuple(len(values) for values in axes.values())
    dense = isinstance(system, FunctionModel)
    meshes = zip(axes, np.meshgrid(*axes.values(), indexing="ij", sparse=not dense), strict=True)
    changes = {key: values for key, values in meshes if key in system.described}
    if not dense:
        return stack_of(system.family, shape, changes)
    rows = zip(*(values.ravel().tolist() for values in changes.values()), strict=True) if changes else [()]
    each = stacked([_one(system.family, dict(zip(changes, row, strict=True))) for row in rows])
    count = math.prod(shape)
    return mapped(lambda name, x: np.broadcast_to(x, (count, *x.shape[1:])).reshape(*shape, *x.shape[1:]), each)


def digest(system: FunctionModel, axes: dict[str, np.ndarray]) -> str:
    """A digest of what the function makes at the points of such a grid: at no more than `MOST_COMPARED`, spread evenly.

    Two functions of one name are distinguished by it, and a file of one is not continued by the other.
    """
    axes = {key: values for key, values in axes.items() if key in system.described}
    shape = tuple(len(values) for values in axes.values())
    count, state_of_hash = math.prod(shape), hashlib.sha256()
    for i in range(min(count, MOST_COMPARED)):
        place = np.unravel_index(i * count // min(count, MOST_COMPARED), shape) if shape else ()
        changes = {key: float(values[k]) for (key, values), k in zip(axes.items(), place, strict=True)}
        state_of_hash.update(np.array([*stored_of(_one(system.family, changes)).values()]).tobytes())
    return state_of_hash.hexdigest()[:16]


def _one(family, changes) -> Linear:
    return family.replace(**changes).linear
