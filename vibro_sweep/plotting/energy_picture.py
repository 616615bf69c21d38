"""Over one parameter: what impacts take, and how much each mass moves."""

import numpy as np

from vibro_sweep.plotting.labels import ABOVE
from vibro_sweep.plotting.spectrum_panel import curve
from vibro_sweep.plotting.style import ARROWS, BRANCHES, FAINT, INK, LEFT, RIGHT, symbol
from vibro_sweep.plotting.sweep_result import Result
from vibro_sweep.plotting.sweeps import set_reach
from vibro_sweep.tables.coordinates import MOST_MASSES

COLOURS = (INK, RIGHT, LEFT, FAINT)


def shows(result: Result) -> bool:
    """A sweep over one key; energy."""
    return len(result.sweep) == 1 and "impact_power" in result


def variables(result: Result) -> tuple[str, ...]:
    """The sizes of motion that may be drawn, the default first."""
    names = (f"{size}_{letter}{n}" for size in ("rms", "peak") for letter in "xv" for n in range(1, MOST_MASSES + 1))
    return tuple(name for name in names if name in result)


def energy(result: Result):
    """Power lost in impacts over the parameter; below, the root mean square of each displacement, or one variable."""
    ((key, values),) = result.sweep.items()
    order = np.argsort(values)  # a sweep may run downwards; an axis does not
    power = result.array("impact_power")[order]
    struck = bool(np.any(power > 0)) or result.failed
    fig = result.page(4.6 if struck else 3.0, result.title("Energy" if struck else f"Energy; no {result.meeting}s"))
    axes = fig.subplots(1 + struck, sharex=True, squeeze=False)[:, 0]
    if struck:
        _power(axes[0], values[order], power, result)
    below = axes[-1]
    chosen = result.options.variable
    shown = [chosen] if chosen else [name for name in variables(result) if name.startswith("rms_x")]
    for i, name in enumerate(shown):
        style = {"color": COLOURS[min(i, len(COLOURS) - 1)], "label": symbol(name.partition("_")[2])}
        curve(below, values[order], result.array(name)[order], **style)
    size = "largest size" if chosen and chosen.startswith("peak") else "root mean square"
    of = f" of {symbol(chosen.partition('_')[2])}" if chosen else ""
    below.set(ylabel=f"{size}{of}{result.unit(shown[0])}", xlabel=result.axis(key))
    set_reach(below, values[order])
    for ax in axes:
        ax.set_ylim(bottom=0)
    if len(shown) > 1:
        handles, labels = below.get_legend_handles_labels()
        named = dict(zip(labels, handles, strict=True))  # each start has lines of its own
        below.legend(named.values(), named.keys(), ncols=min(8, len(shown)), **ABOVE)
    fig.align_ylabels(axes)
    return fig


def _power(ax, values, power, result) -> None:
    """power : (values, starts)"""
    ax.set_ylabel(f"power that\nstops take{result.unit('impact_power')}")
    if not result.follow:
        curve(ax, values, power, color=INK)
        return
    for i, (name, colour) in enumerate(BRANCHES.items()):
        curve(ax, values, power[:, i], color=colour, label=ARROWS[name])
    ax.legend(ncols=len(BRANCHES), **ABOVE)
