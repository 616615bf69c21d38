"""The motion of an Orbit or a PeriodicOrbit between two times, as its pictures take it; and these."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.analysis.single.result import shows_force
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.linear import Linear, forcing_period
from vibro_sweep.results.motion import Motion, with_jumps
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.units import AS_STORED, shown_unit, unit_in

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAMPLES = 400  # in a forcing period
IN_CONTACT = 65  # in a contact, besides; the first and the last one
DECLARED = ("m", "m s-1", "s", "N")  # of lengths, velocities, times and forces
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
    count = round((end - begin) / forcing_period(q) * SAMPLES) + repeats  # of one period the end is the beginning
    even = np.linspace(begin, end, max(2, count))
    times = np.unique(np.concatenate([even, struck, inside[(inside >= begin) & (inside <= end)]]))
    motion = sampled(orbit, q, times)
    at, sides, before = np.searchsorted(times, struck), impacts["side"], impacts["v1"]
    after, jump = -q.contact.restitution(sides) * before, np.full(len(at), np.nan)
    rows = {name: (values[at], jump, values[at]) for name, values in motion.states.items()} | {"t": 3 * (struck,)}
    gap, rate = motion.names
    if gap != "x1":  # all velocities jump: after it they are those of the next sample
        rows |= {name: (values[at], jump, jump) for name, values in motion.states.items() if name.startswith("v")}
    rows |= {gap: (q.contact.stop(sides), jump, q.contact.stop(sides)), rate: (before, jump, after)}
    kept = np.isin(times, struck, invert=True)
    states = with_jumps(times[kept], {name: values[kept] for name, values in motion.states.items()}, rows)
    return replace(motion, t=states.pop("t"), states=states, impacts=np.stack([struck, sides, before, after], axis=1))


def sampled(orbit: Any, q: Linear, times: np.ndarray) -> Motion:
    """The motion at these times, without its impacts."""
    found = orbit.sample(times)
    states = dict(zip(state(found.shape[1] // 2), found.T, strict=True))
    if not (q.contact.normal[0] == 1 and not q.contact.normal[1:].any()):
        states |= {"gap": found[:, 0::2] @ q.contact.normal, "gap_velocity": found[:, 1::2] @ q.contact.normal}
    stops = {side: stop for side, stop in ((1, q.contact.high), (-1, q.contact.low)) if np.isfinite(stop)}
    laws = {side: q.contact.law(side) for side in stops if q.contact.is_compliant(side)}
    return Motion(times, 1.0, states, np.zeros((0, 4)), stops, laws, bool(q.contact.by_force))


def orbit_figure(
    motion: Motion, kind: str | None, title: str, system: Any, names, width: float | None, units: Any
) -> "Figure":
    """The picture of an orbit that `kind` asks for, in these units.

    Raises ArgumentError for another word, for forces of rigid stops, and for units of a system that has none; PlotError
    for names that are no units.
    """
    from vibro_sweep.plotting.plot_options import PlotOptions
    from vibro_sweep.plotting.single_orbit import forces, portrait_and_history

    of_force = shows_force(kind)
    if of_force and not motion.laws:
        raise ArgumentError('kind "contact-force": the stops of this orbit are rigid')
    options = PlotOptions(width=width, units=units)
    of_system = getattr(system, "units", None)
    if units is not None and of_system is None:
        raise ArgumentError(not_allowed("units", units, "left out: the system has no units"))
    shown = {declared: (options.display or AS_STORED).of(unit_in(declared, of_system)) for declared in DECLARED}
    labels = {declared: shown_unit(unit) for declared, (_, unit) in shown.items()}
    motion = motion.scaled(*(factor for factor, _ in shown.values()))
    return options.draw((forces if of_force else portrait_and_history)(motion, title, labels, names))[0].figure
