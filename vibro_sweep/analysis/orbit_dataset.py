"""A simulated orbit as an `xarray.Dataset`, and as a picture."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from vibro_sweep.analysis.orbit import Orbit

SAMPLES = 400  # of a picture, in a forcing period
STATE = ("x1", "v1", "x2", "v2")
SIDES = {"right": (1,), "left": (-1,), "both": (1, -1)}


def dataset_of(orbit: "Orbit") -> "xarray.Dataset":
    """States x1 .. v2 over `section`, whose coordinate is t; impacts over `impact`, rests over `rest`.

    These are named as the fields of `Orbit`: `impact_t`, .., `rest_t_on`, .. Attributes: the system's numbers, `stops`,
    `start_time`, `status` and its note.
    """
    import xarray

    variables = {name: ("section", orbit.section[:, i]) for i, name in enumerate(STATE)}
    variables |= {f"impact_{name}": ("impact", orbit.impacts[name]) for name in orbit.impacts.dtype.names}
    variables |= {f"rest_{name}": ("rest", orbit.sticking[name]) for name in orbit.sticking.dtype.names}
    attributes = orbit.system.parameters() | {"stops": orbit.system.stops, "start_time": orbit.start_time}
    attributes |= {"status": str(orbit.status), "status_note": orbit.status.note}
    return xarray.Dataset(variables, {"t": ("section", orbit.section_times)}, attributes)


def figure_of(orbit: "Orbit", periods: int) -> "Figure":
    """Phase portrait and time history of the last forcing periods that were simulated."""
    from vibro_sweep.plotting.periodic import plot_periodic

    reached = orbit.section_times[np.isfinite(orbit.section[:, 0])]
    if not len(reached) or reached[-1] <= orbit.start_time:
        raise ValueError(f"this orbit has no motion to draw: its status is {orbit.status!r}, its periods are too few")
    end = reached[-1]
    begin = max(orbit.start_time, end - periods * orbit.system.period)
    impacts = orbit.impacts[(orbit.impacts["t"] >= begin) & (orbit.impacts["t"] <= end)]
    count = max(2, round((end - begin) / orbit.system.period * SAMPLES))
    times = np.unique(np.concatenate([np.linspace(begin, end, count), impacts["t"]]))
    states = orbit.sample(times)
    at = np.searchsorted(times, impacts["t"])
    states[at, 0], states[at, 1] = impacts["side"] * orbit.system.b, impacts["v1"]  # before the impact
    stops = [side * orbit.system.b for side in SIDES[orbit.system.stops]]
    title = f"{begin:.6g} < t < {end:.6g}, b = {orbit.system.b:.6g}"
    after = -orbit.system.R * impacts["v1"]
    jumps = (impacts["t"], impacts["side"], impacts["v1"], after)
    return plot_periodic(times, states[:, 0], states[:, 1], *jumps, stops, title, ("$x_1$", "$v_1$"))
