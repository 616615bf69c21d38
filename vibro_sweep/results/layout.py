"""From a scene to the Dataset of its file, with nothing computed: variables, coordinates, attributes, fill values."""

import math
from collections.abc import Sequence

import numpy as np
import xarray

from vibro_sweep.oscillator.catalogue import AXES
from vibro_sweep.oscillator.function_model import stored_names
from vibro_sweep.results.described import described
from vibro_sweep.scene import Scene, resolved_numbers
from vibro_sweep.tables.exponents import RUNNING, periods_read
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.observables import DIMENSIONS, SETTLE, TRAJECTORY, asked_for, averaged
from vibro_sweep.tables.observables import dimensions as dimensions_of
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.quantity import Observable, Quantity
from vibro_sweep.tables.units import Units, unit_in

MATRIX = ("row", "column")  # the dimensions of a matrix


def quantities(scene: Scene) -> dict[str, Observable]:
    """The variables that a scene asks for, `status` first; what it does not observe is not there."""
    keys_asked = scene.observe | ({TRAJECTORY} if scene.trajectory else set()) | ({SETTLE} if scene.settle else set())
    system = scene.system
    wanted_quantities = asked_for(keys_asked, scene.section.kind == "impact", system.masses, not system.gap_is_x1)
    return {"status": wanted_quantities.pop("status"), **wanted_quantities}


def coordinates(scene: Scene) -> dict[str, np.ndarray]:
    """Every dimension of the scene's file, in order, with its coordinate."""
    result = dict(scene.sweep)
    if scene.n_starts > 1:
        both = scene.start.direction == "both"
        result["start"] = np.array(["up", "down"]) if both else np.arange(scene.n_starts)
    used = {dimension for quantity in quantities(scene).values() for dimension in quantity.dimensions}
    return result | {name: _own_axis(scene, name) for name in DIMENSIONS if name in used}


def _own_axis(scene: Scene, name: str) -> np.ndarray:
    """The coordinate of a dimension that is not a key of the sweep."""
    trajectory, extent = scene.trajectory, dimensions_of(scene.system.masses)[name].extent
    if name == "sample":
        return np.arange(scene.record)
    if name == "averaged":
        return np.array(averaged(scene.system.masses))
    if name == "elapsed":
        parts = min(RUNNING, scene.record)
        return np.array([periods_read(m, parts, scene.record) for m in range(parts)])
    if name == "t_over_T":
        return np.linspace(0.0, trajectory.periods, trajectory.samples)
    if name == "trajectory_section":
        return np.arange(trajectory.periods + 1)
    if name == "trajectory_impact":
        return np.arange(trajectory.samples)
    return np.arange(1, extent + 1)


def shape_of(scene: Scene, quantity: Observable, axes: dict[str, np.ndarray]) -> tuple[int, ...]:
    """The shape of a variable: that of the sweep, then its own."""
    return (*scene.shape, *(len(axes[name]) for name in quantity.dimensions))


def size(scene: Scene) -> int:
    """Bytes of the scene's file, but for its structure: some kilobytes."""
    axes = coordinates(scene)
    lead = math.prod(scene.shape)
    numbers = [
        math.prod(shape_of(scene, quantity, axes)) * np.dtype(quantity.dtype).itemsize + 4 * lead  # and its checksums
        for quantity in quantities(scene).values()
    ]
    over = [math.prod(len(scene.sweep[key]) for key in keys) for keys in resolved_numbers.dimensions(scene).values()]
    return sum(numbers) + 8 * (sum(over) + sum(len(values) for values in axes.values()))


def dataset(scene: Scene) -> xarray.Dataset:
    """The whole Dataset of a scene, with nothing computed: arrays of fill values take no memory, and are not to be
    written to."""
    axes, units = coordinates(scene), scene.system.units
    coords = {}
    for name, values in axes.items():
        of = scene.system.described.get(name, AXES.get(name))
        coords[name] = variable((name,), values, of, units)
    for name, values in resolved_numbers.angular(scene).items():
        coords[name] = variable((CYCLES.name,), values, FREQUENCY, units)
    for name, values in _following(scene).items():
        of = AXES.get(name) or stored_names(scene.system.masses)[name]
        keys = resolved_numbers.dimensions(scene)[name]
        coords[name] = variable(keys, values, of, units)
    for name, values in resolved_numbers.matrices(scene).items():
        option = next(option for option in scene.system.model.options if option.name == name)
        of = Quantity(name, f"matrix {name}", option.text, units=option.units)
        coords[name] = variable(MATRIX, values, of, units)
    lead = (*scene.sweep, *(["start"] if scene.n_starts > 1 else []))
    variables = {}
    for name, quantity in quantities(scene).items():
        empty = np.broadcast_to(np.array(quantity.fill, quantity.dtype), shape_of(scene, quantity, axes))
        variables[name] = variable((*lead, *quantity.dimensions), empty, quantity, units)
    attributes = {"kind": SWEEP, "title": f"vibro_sweep: {scene.name}", "scene": scene.text}
    attributes |= {"sweep_dimensions": list(scene.sweep)}
    return xarray.Dataset(variables, coords, attributes | resolved_numbers.attributes(scene))


def variable(dimensions: Sequence[str], values, of: Quantity, units: Units | None) -> xarray.Variable:
    """A variable of a file; made without xarray's look for arrays of dask, which would be imported."""
    return xarray.Variable(dimensions, np.asarray(values), described(of, unit_in(of.units, units)), fastpath=True)


def _following(scene: Scene) -> dict[str, np.ndarray]:
    """The numbers that follow from swept ones, over the keys that they depend on."""
    keys = resolved_numbers.dimensions(scene)
    shape = tuple(len(scene.sweep[key]) for key in resolved_numbers.depends_on(scene))
    values_of = {name: np.empty(shape) for name in keys}
    for box in resolved_numbers.slabs(scene) if values_of else ():
        for name, values in resolved_numbers.following(scene, box).items():
            if name in values_of:
                values_of[name][box] = values
    return values_of
