"""Pictures of one orbit: phase portrait of the gap and its time history, or forces of its stops."""

from collections.abc import Mapping

import numpy as np

from vibro_sweep.plotting import drawn_motion, sticking_marks
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.style import DASHES, FAINT, INK, LEFT, RIGHT
from vibro_sweep.results.motion import Motion

Units = Mapping[str, str]  # of what is declared in SI, as the name of an axis has them
STOPS = {1: "right stop", -1: "left stop"}


def portrait_and_history(motion: Motion, title: str, units: Units, names=("gap", "gap velocity")) -> Panels:
    """units : of lengths, velocities and times; names : of the gap and its velocity"""
    x_label, v_label, t_label = names[0] + units["m"], names[1] + units["m s-1"], "time $t$" + units["s"]
    gap, rate = motion.names

    def draw(axes):
        portrait, history = axes[0]
        length = motion.t[-1] - motion.t[0]
        drawn_motion.portrait(portrait, motion, gap, rate, motion.t[0] + length * np.array(drawn_motion.ARROWS_AT))
        drawn_motion.walls(portrait, motion.stops, motion.laws, STOPS)
        portrait.set(xlabel=x_label, ylabel=v_label)
        joined = motion.joined()
        history.plot(joined.t, joined[gap], color=INK, lw=0.7)
        sticking_marks.along(history, joined, "t", gap)
        drawn_motion.contacts(history, joined, "t", gap)
        times, sides = motion.impacts[:, :2].T
        for side, marker, colour, text in ((1, ">", RIGHT, "right"), (-1, "<", LEFT, "left")):
            if (hit := times[sides == side]).size:
                stop, label = np.full(len(hit), motion.stops[side]), f"impact on the {text}"
                history.plot(hit, stop, marker, ls="none", ms=3.5, color=colour, label=label)
        for stop in motion.stops.values():
            history.axhline(stop, color=FAINT, lw=0.6, ls=DASHES)
        history.set(xlabel=t_label, ylabel=x_label)
        drawn_motion.legend(axes)

    return Panels(title, 3.7, draw, columns=2, grid={"width_ratios": (1, 1.4)})


def forces(motion: Motion, title: str, units: Units, names=("gap", "gap velocity")) -> Panels:
    """The force of the compliant stops over time, and against the gap."""
    t_label, x_label, label = "time $t$" + units["s"], names[0] + units["m"], "force of the stop" + units["N"]

    def draw(axes):
        over_time, loop = axes[0]
        drawn_motion.force(over_time, loop, motion.joined(), STOPS)
        over_time.set(xlabel=t_label, ylabel=label)
        over_time.margins(x=0)
        loop.set(xlabel=x_label)
        drawn_motion.legend(axes)

    return Panels(title, 3.2, draw, columns=2, grid={"width_ratios": (2, 1), "sharey": True})
