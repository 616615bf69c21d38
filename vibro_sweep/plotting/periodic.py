"""Pictures of one orbit: phase portrait of the gap and its time history, impacts marked; forces of its stops."""

import matplotlib as mpl
import numpy as np

from vibro_sweep.plotting import contact_force
from vibro_sweep.plotting.orbit_pictures import ARROWS_AT, arrows, legend
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.pressed import STYLE as CONTACT
from vibro_sweep.plotting.style import DASHES, FAINT, IMPACT, INK, LEFT, RIGHT, with_unit
from vibro_sweep.results.motion import Motion


def portrait_and_history(motion: Motion, title: str, system, names=("gap", "gap velocity"), width=None):
    """A Figure. system : whose units the axes have; names : of the gap and its velocity; width : mm"""
    options, declared = PlotOptions(width=width), ("m", "m s-1", "s")
    x_label, v_label, t_label = map(with_unit, (*names, "time $t$"), declared, 3 * [system])
    times, gap, rate, pressed = motion.t, motion.gap, motion.rate, motion.pressed
    impact_t, side, v_in, v_out = motion.impacts.T
    with mpl.rc_context(options.style):
        fig = options.page(3.7, title)
        portrait, history = fig.subplots(1, 2, width_ratios=(1, 1.4))
        # each flight starts with the velocity after its impact
        at = np.searchsorted(times, impact_t)
        t, x, v = (np.insert(old, at + 1, new) for old, new in ((times, impact_t), (gap, gap[at]), (rate, v_out)))
        breaks = at + 1 + np.argsort(np.argsort(at))
        t, x, v = np.insert(t, breaks, impact_t), np.insert(x, breaks, np.nan), np.insert(v, breaks, np.nan)
        portrait.plot(x, v, color=INK, lw=0.7)
        arrows(portrait, t, x, v, times[0] + np.array(ARROWS_AT) * (times[-1] - times[0]))
        for before, after, where in zip(v_in, v_out, gap[at], strict=True):
            portrait.plot([where, where], [before, after], color=IMPACT, lw=1.2, ls=(0, (1, 1)), label="impact")
        portrait.set(xlabel=x_label, ylabel=v_label)
        history.plot(times, gap, color=INK, lw=0.7)
        if pressed.any():
            portrait.plot(np.where(pressed, gap, np.nan), np.where(pressed, rate, np.nan), **CONTACT)
            history.plot(times, np.where(pressed, gap, np.nan), **CONTACT)
        for one, marker, colour, text in ((1, ">", RIGHT, "right"), (-1, "<", LEFT, "left")):
            hit = side == one
            label = f"impact on the {text}" if hit.any() else None
            history.plot(impact_t[hit], gap[at][hit], marker, ls="none", ms=3.5, color=colour, label=label)
        for stop in motion.stops.values():
            portrait.axvline(stop, color=FAINT, lw=0.6, ls=DASHES, label="stop")
            history.axhline(stop, color=FAINT, lw=0.6, ls=DASHES)
        history.set(xlabel=t_label, ylabel=x_label)
        legend(fig)
        return fig


def forces(motion: Motion, title: str, system, names=("gap", "gap velocity"), width=None):
    """The force of the compliant stops over time, and against the gap: a Figure."""
    options = PlotOptions(width=width)
    t_label, x_label, label = (
        with_unit(text, unit, system) for text, unit in (("time $t$", "s"), (names[0], "m"), ("force of the stop", "N"))
    )
    with mpl.rc_context(options.style):
        fig = options.page(3.2, title)
        over_time, loop = fig.subplots(1, 2, width_ratios=(2, 1), sharey=True)
        for side, stop in motion.soft.items():
            force, name = motion.force(side)[0], f"{'right' if side > 0 else 'left'} stop"
            contact_force.draw(over_time, loop, motion.t, motion.gap, force, side, stop, name)
        over_time.set(xlabel=t_label, ylabel=label)
        over_time.margins(x=0)
        loop.set(xlabel=x_label)
        legend(fig)
        return fig
