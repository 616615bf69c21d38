"""The force of compliant stops along a motion: over time, and against the gap as a loop."""

import numpy as np

from vibro_sweep.plotting import pressed
from vibro_sweep.plotting.orbit_pictures import displacements, legend, shows_trajectory
from vibro_sweep.plotting.paths import path
from vibro_sweep.plotting.style import DASHES, FAINT, LEFT, RIGHT, stop_name, symbol
from vibro_sweep.plotting.sweep_result import Result

COLOURS = {1: RIGHT, -1: LEFT}


def shows(result: Result) -> bool:
    """A trajectory; a compliant stop."""
    return shows_trajectory(result) and any(
        result.compliance(side, point.place) for point in result.points(1) for side in result.sides
    )


def contact_force(result: Result):
    """The force of the compliant stops over time; beside it against the gap, where the area of a loop is what the stop
    takes in a contact. One row an orbit."""
    points = result.points()
    fig = result.page(2.2 * len(points) + 1.0, result.title("Contact force"))
    grid = fig.subplots(len(points), 2, squeeze=False, width_ratios=(2, 1), sharey="row")
    name = displacements(result)[0]
    unit = result.unit("contact_force_max")
    for (over_time, loop), point in zip(grid, points, strict=True):
        way = pressed.finer(result, point, path(result, point).joined())
        for side, stop in result.stops(point.place).items():
            if result.compliance(side, point.place) is None:
                continue
            force, _ = pressed.along(result, point, way, side)
            draw(over_time, loop, way.t, way[name], force, side, stop, stop_name(result, side))
        over_time.set(title=point.label, ylabel="force of the stop" + unit)
        over_time.margins(x=0)
    grid[-1, 0].set_xlabel("$t / T$ (forcing periods)")
    grid[-1, 1].set_xlabel(symbol(name) + result.unit(name))
    legend(fig)
    return fig


def draw(over_time, loop, t, gap, force, side: int, stop: float, label: str) -> None:
    """Draw the force of the stop on this side, which stands at `stop`: t, gap, force (m,)."""
    style = {"color": COLOURS[side], "lw": 1.0, "label": label}
    over_time.plot(t, force, **style)
    loop.plot(gap, np.where(force != 0, force, np.nan), **style)
    loop.axvline(stop, color=FAINT, lw=0.8, ls=DASHES)
