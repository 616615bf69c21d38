"""A simulated or a periodic orbit as an `xarray.Dataset`."""

from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.analysis.single.result import columns_of
from vibro_sweep.oscillator.models.declaration import UNITS
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.units import unit_in

if TYPE_CHECKING:
    import xarray

_UNITS = {"t": "s", "xdot": "m s-1", "x": "m", "v": "m s-1", "max_p": "m", "max_f": "N"}  # in SI, of fields


def dataset_of(orbit: Any, times: np.ndarray, section: np.ndarray, about: dict[str, Any]) -> "xarray.Dataset":
    """Of an Orbit or a PeriodicOrbit: states x1 .. vN over `section` at these times (m,), its coordinate t; impacts
    over `impact`, contacts over `contact`, rests over `rest`.

    These are named as the fields of `Orbit`: `impact_t`, .., `rest_t_on`, ..; where the oscillator is not a System also
    of all masses, `impact_x1`, `impact_xdot1`, .. Attributes: numbers and options of the oscillator, and `about`.
    """
    import xarray

    system = orbit.system
    variables = {name: ("section", section[:, i]) for i, name in enumerate(state(system.masses))}
    variables |= {f"impact_{key}": ("impact", one) for key, one in columns_of(orbit.impacts).items()}
    variables |= {f"contact_{key}": ("contact", one) for key, one in columns_of(orbit.contacts).items()}
    variables |= {f"rest_{key}": ("rest", one) for key, one in columns_of(orbit.sticking).items()}
    options = {name: value for name, value in system.options.items() if value is not None and name != UNITS.name}
    data = xarray.Dataset(variables, {"t": ("section", times)}, system.parameters() | options | about)
    for name, one in data.variables.items():
        one.attrs["units"] = unit_in(_unit(str(name)), system.units)
    return data


def _unit(name: str) -> str:
    """In SI, of what a field of `Orbit` holds."""
    field = name.removeprefix("impact_").removeprefix("contact_").removeprefix("rest_")
    return next((unit for beginning, unit in _UNITS.items() if field.startswith(beginning)), "1")
