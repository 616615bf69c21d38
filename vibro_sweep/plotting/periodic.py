"""Picture of one orbit: phase portrait of the gap and its time history, impacts marked."""

import matplotlib as mpl
import numpy as np

from vibro_sweep.plotting.style import DASHES, FAINT, IMPACT, INK, LEFT, RIGHT, STYLE, page


def plot_periodic(times, gap, rate, impact_t, side, v_in, v_out, stops, title: str, names=("gap", "gap velocity")):
    """times, gap, rate: (m,), with the impacts' times among them; impact_t, side, v_in, v_out: (impacts,). A Figure."""
    with mpl.rc_context(STYLE):
        fig = page(3.4, title)
        portrait, history = fig.subplots(1, 2, width_ratios=(1, 1.4))
        # each flight starts with the velocity after its impact
        at = np.searchsorted(times, impact_t)
        x, v = np.insert(gap, at + 1, gap[at]), np.insert(rate, at + 1, v_out)
        breaks = at + 1 + np.argsort(np.argsort(at))
        x, v = np.insert(x, breaks, np.nan), np.insert(v, breaks, np.nan)
        portrait.plot(x, v, color=INK, lw=0.7)
        for before, after, where in zip(v_in, v_out, gap[at], strict=True):
            portrait.plot([where, where], [before, after], color=IMPACT, lw=1.2, ls=(0, (1, 1)))
        portrait.set(xlabel=names[0], ylabel=names[1])
        history.plot(times, gap, color=INK, lw=0.7)
        for one, colour in ((1, RIGHT), (-1, LEFT)):
            hit = side == one
            history.plot(impact_t[hit], gap[at][hit], "o", ms=3, color=colour)
        for stop in stops:
            if np.isfinite(stop):
                portrait.axvline(stop, color=FAINT, lw=0.6, ls=DASHES)
                history.axhline(stop, color=FAINT, lw=0.6, ls=DASHES)
        history.set(xlabel="time $t$", ylabel=names[0])
        return fig
