"""How the arguments of the page's kernel lie in the memory of a module.

Numba passes an array as five words and its shape and strides, and a tuple with names field by field: some three hundred
numbers. In a module all arrays lie one behind the other, from a cache line on. How long each is follows from a few
sizes, as the number of orbits, which a page chooses: so each shape is written as numbers a + b size.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import typeof
from numba.core import types

from vibro_sweep.engine.motion.orbits import orbit_of
from vibro_sweep.engine.orbit_block import WARM_UP, Plan, new_workspace
from vibro_sweep.engine.page_kernel import SET_UP
from vibro_sweep.engine.points.plain_points import machine_of, modes_of
from vibro_sweep.engine.records import Kind, new_results, point_of
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.trajectory import new_trajectories
from vibro_sweep.engine.variational.spectrum import BATCHES


class Sizes(NamedTuple):
    """How many of each there is room for."""

    orbits: int  # side by side; of a chain of orbits one after the other
    record: int  # forcing periods
    cells: int
    logged: int  # of impacts, for an impact section
    parts: int  # of the record
    hits: int  # impacts of a trajectory, its
    samples: int
    periods: int
    kept: int  # and impacts that it keeps


SMALL = Sizes(2, 3, 24, 5, 7, 9, 11, 13, 15)  # sizes with which shapes are compared


def arguments_of(kind: Kind, sizes: Sizes) -> dict[str, Any]:
    """The arguments of `run_page`, by name."""
    n, s, states = kind.masses, sizes, 2 * kind.masses
    plan = Plan(**dict.fromkeys(Plan._fields, 0))._replace(
        record=s.record, parts=s.parts, periods=s.periods, section_side=1.0,
        **dict.fromkeys(("states", "lyapunov", "impacts", "contacts", "energy", "attractors"), True),
    )  # fmt: skip
    workspace = new_workspace(plan._replace(record=s.logged), s.cells, s.samples, kind)
    return {
        "task": SET_UP,
        "machines": np.zeros(s.orbits, machine_of(n)),
        "stops": np.zeros((s.orbits, 4)),
        "laws": np.zeros((s.orbits, 2, 3)) if kind.compliant else None,
        "release": 0,
        "known": np.zeros(s.orbits, bool),
        "modes": np.zeros(1, modes_of(n)),
        "points": np.zeros((1, s.orbits), point_of(kind)),
        "starts": np.zeros((2, s.orbits, states + 3)),
        "results": new_results((1, s.orbits), n),
        "sections": np.zeros((1, s.orbits, s.record, states)),
        "phases": np.zeros((1, s.orbits, s.logged)),
        "running": np.zeros((1, s.orbits, 0, states)),
        "hits": np.zeros((1, s.hits, states + 3)),
        "kept": new_trajectories((1, 1), s.samples, s.periods, s.kept, n),
        "w": workspace._replace(section=np.zeros((LANES, s.record, states))),
        "plan": plan,
    }


class Array(NamedTuple):
    """An array among the arguments: its name, bytes of an entry, and its shape: of each axis a, and b for each size."""

    name: str
    itemsize: int
    shape: list[tuple[int, dict[str, int]]]


class Scalar(NamedTuple):
    """A number among them. kind: i, an integer of 64 bits; b, a truth value; f, a float; n, nothing"""

    name: str
    kind: str


def described(kind: Kind) -> list[Array | Scalar]:
    """What the kernel is passed, in its order."""
    shapes = {None: _flat(arguments_of(kind, SMALL))}
    for size in Sizes._fields:
        shapes[size] = _flat(arguments_of(kind, SMALL._replace(**{size: getattr(SMALL, size) + 1})))
    result = []
    for place, (name, value, its_type) in enumerate(shapes[None]):
        if isinstance(its_type, types.Array):
            assert value.flags.c_contiguous or not value.size, name
            more = {size: shapes[size][place][1].shape for size in Sizes._fields}
            shape = []
            for axis, length in enumerate(value.shape):
                slope = {size: grown[axis] - length for size, grown in more.items() if grown[axis] != length}
                shape.append((length - sum(slope[size] * getattr(SMALL, size) for size in slope), slope))
            result.append(Array(name, value.itemsize, shape))
        else:
            result.append(
                Scalar(name, {types.Boolean: "b", types.Float: "f", types.NoneType: "n"}.get(type(its_type), "i"))
            )
    return result


def _flat(arguments: dict[str, Any]) -> list[tuple[str, Any, types.Type]]:
    """Arrays and numbers with their names, as numba's data model has them."""
    result = []

    def add(name: str, value: Any, its_type: types.Type) -> None:
        if isinstance(its_type, types.BaseTuple):
            for field, part, part_type in zip(value._fields, value, its_type.types, strict=True):
                add(f"{name}.{field}", part, part_type)
        else:
            result.append((name, value, its_type))

    for name, value in arguments.items():
        add(name, value, typeof(value))
    return result


def fields_of(dtype: np.dtype, *names: str) -> dict[str, tuple[int, str]]:
    """The bytes at which fields begin, and the type of their numbers."""
    return {name: (dtype.fields[name][1], dtype.fields[name][0].base.str[1:]) for name in names}


def layout_of(kind: Kind) -> dict[str, Any]:
    """All that a page needs to call the kernel and to read its results; for JSON."""
    n = kind.masses
    orbit, results, point = orbit_of(n, kind.constant), new_results((1,), n), point_of(kind)
    return {
        "masses": n,
        "compliant": kind.compliant,
        "arguments": [
            [one.name, one.itemsize, one.shape] if isinstance(one, Array) else [one.name, one.kind]
            for one in described(kind)
        ],
        "lane": orbit.fields["lane"][1],  # of each of the orbits side by side: its number is to be written there
        "machine": machine_of(n).itemsize // 8,
        "point": {"size": point.itemsize} | fields_of(point, "tau", "cells", "P", "back"),
        "result": {"size": results.itemsize}
        | fields_of(results.dtype, "status", "period", "lyapunov", "lyapunov_error", "end", "resting"),
        "fill": results.tobytes().hex(),
        "batches": BATCHES,
        "warm_up": WARM_UP,
    }
