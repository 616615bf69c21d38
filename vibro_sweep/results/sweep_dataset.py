"""What is asked of the results of a sweep: its axes, which points are done, numbers and attributes by name."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray

from vibro_sweep.results.declared_units import Shown, by_cycles, display_in
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.units import AS_STORED, NONE, Display


class Sweep:
    """A Dataset of a sweep: of a file, whose numbers are read when they are asked for, or in memory, or a part that
    `sel` and the like have cut out.

    name : in messages
    attrs : attributes, `sweep_dimensions` those that are left
    in_memory : whether it is a Dataset of the user's, and no file
    keys : names of the sweep's dimensions, in order
    held : swept numbers of which one value is left
    display : the units in which numbers are given, by default those of the file; None: those of its picture

    In a Dataset of the user's other units of variables, by their attribute, are understood. Raises ArgumentError for
    one that is none of such a number.
    """

    def __init__(
        self,
        data: xarray.Dataset,
        name: str,
        verify: Callable[[str], None] | None = None,
        display: Display | None = AS_STORED,
    ):
        display = display_in(data) if display is None else display
        data = by_cycles(data, display)
        self.data, self.name, self._verify = data, name, verify
        self.in_memory, self.display = verify is None, display
        self._shown = Shown(data, display, self.in_memory)
        swept = [str(key) for key in np.atleast_1d(data.attrs["sweep_dimensions"])]
        self.keys = [key for key in swept if key in data.dims]
        held = [key for key in swept if key not in data.dims and key in data.coords]
        self.held = {key: float(self._shown.value(key, data[key].values)) for key in held}
        numbers = {str(name): self._shown.value(str(name), value) for name, value in data.attrs.items()}
        if display.in_cycles and FREQUENCY.name in data.attrs:
            factor, _ = display.of(self._shown.of(FREQUENCY.name)[1] or NONE)
            numbers[CYCLES.name] = numbers[FREQUENCY.name] * factor
        self.attrs: dict[str, Any] = {**numbers, "sweep_dimensions": self.keys}
        self._known = {"status": data["status"].values} if "status" in data else {}  # before any other number
        if verify is not None and self._known:
            verify("status")

    @property
    def names(self) -> list[str]:
        """The names of what is computed."""
        return [str(name) for name in self.data.data_vars]

    @property
    def numbers(self) -> dict[str, float]:
        """The coordinates that have one value, but for swept ones."""
        scalars = {str(name): x for name, x in self.data.coords.items() if x.ndim == 0 and x.dtype.kind in "if"}
        return {name: self._shown.value(name, x.item()) for name, x in scalars.items() if name not in self.held}

    @property
    def sizes(self) -> dict[str, int]:
        """The sizes of all dimensions."""
        return {str(name): size for name, size in self.data.sizes.items()}

    def __contains__(self, name: str) -> bool:
        return name in self.data.variables and not (name in self.data.coords and self.data[name].ndim == 0)

    def dims(self, name: str) -> tuple[str, ...]:
        """Names of the dimensions of a variable, those of the sweep first and in their order."""
        dimensions = [str(dimension) for dimension in self.data[name].dims]
        lead = [dimension for dimension in (*self.keys, "start") if dimension in dimensions]
        return (*lead, *(dimension for dimension in dimensions if dimension not in lead))

    def values(self, name: str, first: Sequence[str] = (), index: Any = ()) -> np.ndarray:
        """The values of a variable, at an index, with these dimensions first, in their order. Raises StoreError."""
        if name in self._known:
            variable = xarray.Variable(
                self.data[name].dims, self._known[name], fastpath=True
            )  # without looking for dask
        else:
            variable = self.data[name].variable
            if self._verify is not None and name in self.data.data_vars:
                self._verify(name)
        values = np.asarray(variable.transpose(*(first or self.dims(name)), ...)[index].values)
        return np.asarray(self._shown.value(name, values))

    def unit(self, name: str) -> str | None:
        """The unit in which a variable, or a number of the system, is given; None where none is known."""
        return self._shown.of(name)[1]

    def attribute(self, name: str, key: str) -> Any:
        """An attribute of a variable; None where it has no such."""
        return self.data[name].attrs.get(key)
