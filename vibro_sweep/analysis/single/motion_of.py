"""The motion of an Orbit or a PeriodicOrbit between two times, as its pictures take it; and these."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.analysis.single.result import shows_force
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.oscillator.linear import Linear, forcing_period
from vibro_sweep.results.motion import Motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAMPLES = 400  # in a forcing period
IN_CONTACT = 65  # in a contact, besides; the first and the last one
EDGE = 1e-6  # of its length within it: at the touch itself rounding says on which side of the stop the mass is


def motion_of(orbit: Any, q: Linear, begin: float, end: float, repeats: bool = False) -> Motion:
    """The motion from begin to end, with the times of impacts and contacts. repeats : whether it is one period of an
    orbit that repeats itself, whose impacts may be listed at later ones"""

    def within(times: np.ndarray) -> np.ndarray:
        return begin + (times - begin) % (end - begin) if repeats else times

    impacts, contacts = orbit.impacts, orbit.contacts
    struck = within(impacts["t"])
    chosen = (struck >= begin) & (struck <= end)
    impacts, struck = impacts[chosen], struck[chosen]
    touched, released = contacts["t_touch"], np.nan_to_num(contacts["t_release"], nan=end)
    inside = within(touched + (released - touched) * np.linspace(EDGE, 1 - EDGE, IN_CONTACT)[:, None]).ravel()
    even = np.linspace(begin, end, max(2, round((end - begin) / forcing_period(q) * SAMPLES)))
    times = np.unique(np.concatenate([even, struck, inside[(inside >= begin) & (inside <= end)]]))
    motion = sampled(orbit, q, times)
    at, sides, speeds = np.searchsorted(times, struck), impacts["side"], impacts["v1"]
    motion.gap[at], motion.rate[at] = q.stop(sides), speeds  # before the impact
    return replace(motion, impacts=np.stack([struck, sides, speeds, -q.restitution(sides) * speeds], axis=1))


def sampled(orbit: Any, q: Linear, times: np.ndarray) -> Motion:
    """The motion at these times, and the positions of its masses."""
    states = orbit.sample(times)
    positions = {f"x{i}": values for i, values in enumerate(states[:, 0::2].T, 1)}
    return Motion(q, times, states[:, 0::2] @ q.normal, states[:, 1::2] @ q.normal, positions=positions)


def orbit_figure(motion: Motion, kind: str | None, title: str, system: Any, names, width: float | None) -> "Figure":
    """The picture of an orbit that `kind` asks for. Raises ArgumentError for another word, and for forces of rigid
    stops."""
    from vibro_sweep.plotting.periodic import forces, portrait_and_history

    if not shows_force(kind):
        return portrait_and_history(motion, title, system, names, width)
    if not motion.soft:
        raise ArgumentError('kind "contact-force": the stops of this orbit are rigid')
    return forces(motion, title, system, names, width)
