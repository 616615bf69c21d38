"""The continuous motion of an orbit as a file holds it, with its impacts put in."""

import numpy as np

from vibro_sweep.plotting.drawn_sweep import DrawnSweep, Point
from vibro_sweep.results.motion import Motion, with_jumps
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.observables import jumping

GAP = {"gap": "x", "gap_velocity": "v"}  # what is formed of the positions, and of the velocities


def stored_motion(result: DrawnSweep, point: Point) -> Motion:
    """The trajectory of an orbit; t in forcing periods."""
    t, along = result.coordinate("t_over_T"), result.contact_normal
    names = state(result.masses)
    states = {name: _stored(result, f"trajectory_{name}", point, len(t)) for name in names}
    velocity = jumping(along is not None)
    when, side, speed, after = (
        result.at_point(f"trajectory_impact_{name}", point)
        for name in ("t_over_T", "side", velocity, f"{velocity}_after")
    )
    hits = np.isfinite(when)
    at_impact = {name: _stored(result, f"trajectory_impact_{name}", point, len(when))[hits] for name in names}
    when, side, speed, after = (values[hits] for values in (when, side, speed, after))
    stops = result.stops(point.place)
    stop = np.array([stops.get(sign, np.nan) for sign in side.tolist()])
    jump = np.full(len(when), np.nan)
    rows = {name: (values, jump, values) for name, values in at_impact.items()} | {"t": (when, when, when)}
    if along is None:
        rows |= {"x1": (stop, jump, stop), "v1": (speed, jump, after)}
    else:
        states |= {name: gap_of(states, along, letter) for name, letter in GAP.items()}
        rows |= {name: (at_impact[name], jump, jump) for name in names[1::2]}  # after it: from the next sample on
        rows |= {"gap": (stop, jump, stop), "gap_velocity": (speed, jump, after)}
    states = with_jumps(t, states, rows)
    impacts = np.stack([when, side, speed, after], axis=1)
    laws = {stop_side: law for stop_side in stops if (law := result.compliance(stop_side, point.place)) is not None}
    unit, by_force = 2 * np.pi / result.number("omega", point.place), result.settings.get("release") == "force"
    return Motion(states.pop("t"), unit, states, impacts, stops, laws, by_force)


def gap_of(motion: dict[str, np.ndarray], along: np.ndarray, letter: str) -> np.ndarray:
    """n.x, or of velocities n.v."""
    return sum(n * motion[f"{letter}{i}"] for i, n in enumerate(along, 1))


def _stored(result: DrawnSweep, name: str, point: Point, count: int) -> np.ndarray:
    return result.at_point(name, point) if name in result else np.full(count, np.nan)
