"""A simulated orbit as an `xarray.Dataset`, and as a picture."""

from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.analysis.single.result import columns_of
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.oscillator.models.declaration import UNITS
from vibro_sweep.oscillator.stop_force import force_of
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.units import unit_in

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from vibro_sweep.analysis.single.orbit import Orbit
    from vibro_sweep.plotting.film import Film

_UNITS = {"t": "s", "xdot": "m s-1", "x": "m", "v": "m s-1", "max_p": "m", "max_f": "N"}  # in SI, of fields
SAMPLES = 400  # of a picture, in a forcing period
IN_CONTACT = 65  # in a contact, besides; the first and the last one
EDGE = 1e-6  # of its length within it: at the touch itself rounding says on which side of the stop the mass is


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


def _last(orbit: "Orbit", periods: int) -> tuple[float, float]:
    """Begin and end of the last forcing periods that were simulated. Raises ArgumentError where there are none."""
    reached = orbit.section_times[np.isfinite(orbit.section[:, 0])]
    if not len(reached) or reached[-1] <= orbit.start_time:
        raise ArgumentError(
            f"this orbit has no motion to draw: its status is {orbit.status!r}, its periods are too few"
        )
    return max(orbit.start_time, reached[-1] - periods * orbit.system.period), float(reached[-1])


def film_of(orbit: "Orbit", periods: int) -> "Film":
    """The last forcing periods that were simulated as a film."""
    from vibro_sweep.plotting.film import FRAMES, new_film

    (begin, end), system, q = _last(orbit, periods), orbit.system, orbit.system.linear
    times = np.linspace(begin, end, 8 * FRAMES)
    states = orbit.sample(times)
    positions = {f"x{i}": states[:, 2 * i - 2] for i in range(1, system.masses + 1)}
    name = "x1" if system.gap_is_x1 else "gap"
    gap = name, states[:, 0::2] @ q.normal, states[:, 1::2] @ q.normal
    laws = {1: (q.high, q.k_high, q.c_high, q.p_high), -1: (q.low, q.k_low, q.c_low, q.p_low)}
    stops = {
        stop: side * force_of(times, side * (gap[1] - stop), side * gap[2], law if law[0] > 0 else None, q.by_force)[1]
        for side, (stop, *law) in laws.items()
        if np.isfinite(stop)
    }
    return new_film(times / system.period, positions, gap, stops, f"b = {system.b:.6g}")


def _title(orbit: "Orbit", begin: float, end: float) -> str:
    return f"{begin:.6g} < t < {end:.6g}, b = {orbit.system.b:.6g}"


def _names(orbit: "Orbit") -> tuple[str, str]:
    """Of the gap and its velocity."""
    return ("$x_1$", "$v_1$") if orbit.system.gap_is_x1 else ("$g$", r"$\dot g$")


def force_figure_of(orbit: "Orbit", periods: int, width: float | None) -> "Figure":
    """The force of the compliant stops over the last forcing periods that were simulated, and against the gap."""
    begin, end = _last(orbit, periods)
    return force_figure(orbit, orbit.system.linear, begin, end, _title(orbit, begin, end), _names(orbit)[0], width)


def force_figure(
    orbit: Any, q: Linear, begin: float, end: float, title: str, name: str, width: float | None
) -> "Figure":
    """The same of an Orbit or a PeriodicOrbit of the oscillator q, between two times. name: of the gap.

    Raises ArgumentError where no stop is compliant.
    """
    from vibro_sweep.plotting.contact_force import contact_force_of_orbit

    laws = {1: (q.high, q.k_high, q.c_high, q.p_high), -1: (q.low, q.k_low, q.c_low, q.p_low)}
    laws = {side: law for side, law in laws.items() if np.isfinite(law[0]) and law[1] > 0}
    if not laws:
        raise ArgumentError('kind "contact-force": the stops of this orbit are rigid')
    touched, released = orbit.contacts["t_touch"], np.nan_to_num(orbit.contacts["t_release"], nan=end)
    inside = touched + (released - touched) * np.linspace(EDGE, 1 - EDGE, IN_CONTACT)[:, None]
    count = max(2, round((end - begin) * q.omega / (2 * np.pi) * SAMPLES))
    times = np.concatenate([np.linspace(begin, end, count), inside.ravel()])
    times = np.unique(times[(times >= begin) & (times <= end)])
    states = orbit.sample(times)
    gap, rate = states[:, 0::2] @ q.normal, states[:, 1::2] @ q.normal
    forces = [
        (side, stop, force_of(times, side * (gap - stop), side * rate, law, q.by_force)[0])
        for side, (stop, *law) in laws.items()
    ]
    return contact_force_of_orbit(times, gap, forces, title, orbit.system, name, width)


def figure_of(orbit: "Orbit", periods: int, width: float | None) -> "Figure":
    """Phase portrait and time history of the gap over the last forcing periods that were simulated."""
    from vibro_sweep.plotting.periodic import plot_periodic

    (begin, end), system, q = _last(orbit, periods), orbit.system, orbit.system.linear
    impacts = orbit.impacts[(orbit.impacts["t"] >= begin) & (orbit.impacts["t"] <= end)]
    count = max(2, round((end - begin) / system.period * SAMPLES))
    times = np.unique(np.concatenate([np.linspace(begin, end, count), impacts["t"]]))
    states = orbit.sample(times)
    gap, rate = states[:, 0::2] @ q.normal, states[:, 1::2] @ q.normal
    at = np.searchsorted(times, impacts["t"])
    gap[at], rate[at] = q.stop(impacts["side"]), impacts["v1"]  # before the impact
    title = _title(orbit, begin, end)
    jumps = (impacts["t"], impacts["side"], impacts["v1"], -q.restitution(impacts["side"]) * impacts["v1"])
    names = _names(orbit)
    stops = [one for one in (q.high, q.low) if np.isfinite(one)]
    pressed = np.zeros(len(times), bool)
    for touch, release in zip(orbit.contacts["t_touch"], orbit.contacts["t_release"], strict=True):
        pressed |= (times >= touch) & ~(times > release)  # NaN: it goes on
    return plot_periodic(times, gap, rate, *jumps, stops, title, system, names, width, pressed)
