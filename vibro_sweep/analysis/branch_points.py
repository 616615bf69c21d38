"""The points of a branch as a Dataset."""

import numpy as np
import xarray as xr

from vibro_sweep.analysis.periodic import PeriodicOrbit, orbit_of


def dataset(system, parameter: str, points) -> xr.Dataset:
    """Over `point`, in order: the parameter; `multiplier_re`, `multiplier_im` (multiplier) of the whole period;
    `unstable`, the number of multipliers outside the unit circle; the state x1 v1 .. at t = 0; `margin`;
    `min_impact_speed`; `residual`; and `impact_t`, `impact_side`, `impact_v` (impact) as `orbit.impacts` of the first
    point, from there on continuous: times are not wrapped.
    """
    frame = orbit_of(system, points[0].solution)._canonical_frame
    orbits = [PeriodicOrbit(system.replace(**{parameter: point.p}), "ok", point.solution, frame) for point in points]
    multipliers = np.array([orbit.multipliers for orbit in orbits])
    states = np.array([orbit.state for orbit in orbits])
    impacts = np.array([orbit.impacts for orbit in orbits])
    names = [f"{kind}{i + 1}" for i in range(states.shape[1] // 2) for kind in "xv"]
    variables = {
        parameter: ("point", np.array([point.p for point in points])),
        "multiplier_re": (("point", "multiplier"), multipliers.real),
        "multiplier_im": (("point", "multiplier"), multipliers.imag),
        "unstable": ("point", np.count_nonzero(np.abs(multipliers) > 1, axis=1)),
        **{name: ("point", states[:, i]) for i, name in enumerate(names)},
        "margin": ("point", np.array([orbit.margin for orbit in orbits])),
        "min_impact_speed": ("point", np.abs(impacts["v1"]).min(axis=1, initial=np.inf)),
        "residual": ("point", np.array([orbit.residual for orbit in orbits])),
        "impact_t": (("point", "impact"), impacts["t"]),
        "impact_side": (("point", "impact"), impacts["side"]),
        "impact_v": (("point", "impact"), impacts["v1"]),
    }
    return xr.Dataset(variables)
