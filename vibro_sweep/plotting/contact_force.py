"""The force of compliant stops along a motion: over time, and against the gap as a loop."""

from vibro_sweep.plotting.drawn_motion import force, legend
from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.orbit_pictures import FINER, shows_trajectory
from vibro_sweep.plotting.stored_motion import stored_motion
from vibro_sweep.plotting.style import stop_names, symbol


def shows(result: DrawnSweep) -> bool:
    """A trajectory; a compliant stop."""
    return shows_trajectory(result) and any(
        result.compliance(side, point.place) for point in result.points(1) for side in result.sides
    )


@picture(shows, of_orbits=True)
def contact_force(result: DrawnSweep) -> Panels:
    """The force of the compliant stops over time; beside it against the gap, where the area of a loop is what the stop
    takes in a contact. One row an orbit."""
    points, name = result.points(), "x1" if result.contact_normal is None else "gap"

    def draw(axes):
        for (over_time, loop), point in zip(axes, points, strict=True):
            force(over_time, loop, stored_motion(result, point).joined().finer(FINER), stop_names(result))
            over_time.set(title=point.label, ylabel="force of the stop" + result.unit("contact_force_max"))
            over_time.margins(x=0)
        axes[-1, 0].set_xlabel("$t / T$ (forcing periods)")
        axes[-1, 1].set_xlabel(symbol(name) + result.unit(name))
        legend(axes)

    grid = {"width_ratios": (2, 1), "sharey": "row"}
    return Panels(result.title("Contact force"), 2.2 * len(points) + 1.0, draw, len(points), 2, grid)
