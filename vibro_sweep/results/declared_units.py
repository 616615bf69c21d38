"""The units of what a file holds, by its scene; and the same numbers in the units that they are shown in."""

import functools
from typing import Any

import numpy as np
import xarray

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.catalogue import NUMBERS
from vibro_sweep.tables.file_columns import OF_FIRST, OF_PARAMETER, RAGGED_KINDS, UNVISITED, columns
from vibro_sweep.tables.observables import variables
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.units import AS_STORED, NONE, Display, Units, display_of, names_of, ratio, unit_in


@functools.lru_cache(16)
def declared_units(scene: str) -> tuple[dict[str, str], Units | None]:
    """The units of the numbers and variables of a scene's file, by name, and those of its system; of a sweep of a
    function's oscillators none are known."""
    from vibro_sweep.scene import SceneError, parse_continuation, parse_scene  # and pydantic, which few pictures need
    from vibro_sweep.scene.continuation import is_continuation
    from vibro_sweep.scene.yaml_text import YAMLTextError, read_yaml

    try:
        of = parse_continuation if is_continuation(read_yaml(scene)) else parse_scene
        system = of(scene).system
    except (SceneError, YAMLTextError):
        return {}, None
    known = {quantity.name: quantity for quantity in variables(system.masses, not system.gap_is_x1)}
    quantities = {**NUMBERS, **known, **system.described}
    return {name: unit_in(quantity.units, system.units) for name, quantity in quantities.items()}, system.units


def has_units(data: xarray.Dataset) -> bool:
    """Whether some of its numbers have a unit."""
    return any(variable.attrs.get("units") not in (None, NONE, "rad") for variable in data.variables.values())


def display_in(data: xarray.Dataset) -> Display:
    """The units in which the scene of a file says that its numbers are shown."""
    return display_of(str(data.attrs.get("picture_units", ""))) or AS_STORED


class Shown:
    """The factors and units of the numbers of a Dataset as they are shown.

    In a Dataset of the user's, variables may have another unit than their file, by the attribute `units`: such are
    understood. Raises ArgumentError for a unit that is none of such a number, and for a display of numbers without
    units.
    """

    def __init__(self, data: xarray.Dataset, display: Display, is_users: bool):
        self._has_units = has_units(data)
        if display.units and not self._has_units:
            raise ArgumentError(not_allowed("units", names_of(display), "left out: the system has no units"))
        self.needed = bool(display.units) or (is_users and self._has_units)
        self._data, self._display = data, display
        self._known: dict[str, tuple[float, str]] = {}

    @functools.cached_property
    def _declared(self) -> dict[str, str]:
        """The units of the file, by the names of its numbers and variables; nothing where there are none."""
        if not self._has_units:
            return {}
        declared, units = declared_units(str(self._data.attrs.get("scene", "")))
        if not declared or self._data.attrs.get("kind") not in RAGGED_KINDS:
            return declared
        names = [str(name) for name in np.atleast_1d(self._data.attrs["parameters"])]
        of_columns = columns(self._data.attrs["kind"], names, self._data.sizes["multiplier"] // 2)
        first = {OF_FIRST: declared[names[0]]}
        return {
            column.name: first.get(column.units) or unit_in(column.units, units)
            for column in of_columns
            if column.units != OF_PARAMETER
        } | {name: unit for name, unit in declared.items() if name in (*names, *NUMBERS)}

    def of(self, name: str) -> tuple[float, str | None]:
        """What the values of a variable, or of a number of the system, are multiplied by, and their unit then."""
        stored = self._data[name].attrs.get("units") if name in self._data.variables else self._declared.get(name)
        if not self.needed or stored is None:
            return 1.0, stored
        if name not in self._known:
            declared = self._declared.get(name, stored)
            to_declared = ratio(stored, declared)
            if to_declared is None:
                allowed = f"a unit such as {declared!r}" if declared != NONE else "left out: it has no unit"
                raise ArgumentError(not_allowed(f"{name}.attrs['units']", stored, allowed))
            display = self._display.angular if name == FREQUENCY.name else self._display
            factor, unit = display.of(declared)
            self._known[name] = to_declared * factor, unit
        return self._known[name]

    def value(self, name: str, value: Any) -> Any:
        """A number, or an array, as it is shown; words, flags and counts as they are."""
        if not self.needed or np.asarray(value).dtype.kind != "f":
            return value
        factor, _ = self.of(name)
        return value if factor == 1.0 else value * factor


def by_cycles(data: xarray.Dataset, display: Display) -> xarray.Dataset:
    """The Dataset with `frequency` in place of `omega` as an axis, or a parameter, where the display is in cycles. Its
    values keep their unit, by which `Shown` converts them."""
    if not display.in_cycles or FREQUENCY.name not in data.variables or CYCLES.name in data.variables:
        return data
    omega = data[FREQUENCY.name].variable
    if omega.dims not in ((FREQUENCY.name,), ("point",)):
        return data
    renamed = data.rename({FREQUENCY.name: CYCLES.name})
    attributes = {}
    for key in ("sweep_dimensions", "parameters"):
        names = [str(name) for name in np.atleast_1d(data.attrs.get(key, []))]
        attributes[key] = [CYCLES.name if name == FREQUENCY.name else name for name in names]
    renamed = renamed.assign_attrs({key: names for key, names in attributes.items() if key in data.attrs})
    if omega.dims == (FREQUENCY.name,):
        renamed = renamed.assign_coords({FREQUENCY.name: ((CYCLES.name,), omega.values, omega.attrs)})
    return renamed


def shown_dataset(data: xarray.Dataset, display: Display = AS_STORED, is_users: bool = False) -> xarray.Dataset:
    """Branches, curves or windows in the units that they are shown in."""
    shown = Shown(data, display, is_users)
    if not shown.needed:
        return data
    declared_scene = data.attrs.get("scene")
    data = by_cycles(data, display)
    shown = Shown(data, display, is_users)
    result = data.copy()
    result.attrs["scene"] = declared_scene
    factors = [shown.of(str(name))[0] for name in np.atleast_1d(data.attrs["parameters"])]
    for name, variable in data.variables.items():
        if str(name).startswith("unvisited_") and str(name).removeprefix("unvisited_") not in UNVISITED:
            continue  # a start, which is to be written into a scene
        factor, unit = shown.of(str(name))
        values = variable.values * factor if variable.dtype.kind == "f" and factor != 1.0 else variable.values
        if "parameter" in variable.dims:
            values = variable.values * np.array(factors)
        attributes = dict(variable.attrs) if unit is None else {**variable.attrs, "units": unit}
        result[name] = (variable.dims, values, attributes)
    return result
