"""Where a compliant stop is pressed along a sampled motion, with which force, and where the stop is."""

import numpy as np

from vibro_sweep.oscillator.stop_force import force_of
from vibro_sweep.plotting.paths import Path
from vibro_sweep.plotting.style import IMPACT
from vibro_sweep.plotting.sweep_result import Point, Result


def along(result: Result, point: Point, way: Path, side: int) -> tuple[np.ndarray, np.ndarray]:
    """The force of the stop on this side, and by how much it is pressed in, (n,) of a motion; of a rigid one 0."""
    gap, rate = _names(way)
    t = 2 * np.pi / result.number("omega", point.place) * way.t
    stop, law = result.stops(point.place)[side], result.compliance(side, point.place)
    by_force = result.settings.get("release") == "force"
    return force_of(t, side * (way[gap] - stop), side * way[rate], law, by_force)


def finer(result: Result, point: Point, way: Path) -> Path:
    """The motion of the gap alone, at more times."""
    return way.finer(*_names(way), 2 * np.pi / result.number("omega", point.place), FINER)


def _names(way: Path) -> tuple[str, str]:
    """Of the gap, and its velocity."""
    return ("gap", "gap_velocity") if "gap" in way.states else ("x1", "v1")


def mark(ax, result: Result, point: Point, way: Path, x: str, y: str) -> None:
    """Mark the contacts of a motion in the plane of two of its numbers, or over its time "t"."""
    for side in result.stops(point.place):
        there = along(result, point, way, side)[0] != 0
        if there.any():
            ax.plot(*(np.where(there, way[name], np.nan) for name in (x, y)), **STYLE)


FINER = 32  # times the samples of a file
STYLE = {"color": IMPACT, "lw": 1.6, "zorder": 2.2, "label": "contact"}
