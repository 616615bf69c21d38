"""Over one parameter: how deep compliant stops are pressed, and with which force."""

import numpy as np

from vibro_sweep.plotting.labels import ABOVE
from vibro_sweep.plotting.spectrum_panel import curve
from vibro_sweep.plotting.style import ARROWS, BRANCHES, INK
from vibro_sweep.plotting.sweep_result import Result
from vibro_sweep.plotting.sweeps import set_reach

SIZES = {"penetration_max": "largest penetration", "contact_force_max": "largest force"}


def shows(result: Result) -> bool:
    """A sweep over one key; contacts."""
    return len(result.sweep) == 1 and all(name in result for name in SIZES)


def contacts(result: Result):
    """The largest penetration of a compliant stop, and its largest force, over the parameter."""
    ((key, values),) = result.sweep.items()
    order = np.argsort(values)  # a sweep may run downwards; an axis does not
    fig = result.page(4.2, result.title("Contacts"))
    axes = fig.subplots(2, sharex=True)
    for ax, (name, label) in zip(axes, SIZES.items(), strict=True):
        sizes = result.array(name)[order]
        if result.follow:
            for i, (way, colour) in enumerate(BRANCHES.items()):
                curve(ax, values[order], sizes[:, i], color=colour, label=ARROWS[way])
        else:
            curve(ax, values[order], sizes, color=INK)
        ax.set(ylabel=label + result.unit(name))
        ax.set_ylim(bottom=0)
    if result.follow:
        axes[0].legend(ncols=len(BRANCHES), **ABOVE)
    axes[-1].set_xlabel(result.axis(key))
    set_reach(axes[-1], values[order])
    fig.align_ylabels(axes)
    return fig
