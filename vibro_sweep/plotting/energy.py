"""Over one parameter: what impacts take, and how much each mass moves."""

import numpy as np

from vibro_sweep.model.state import MOST_MASSES
from vibro_sweep.plotting.result import Result
from vibro_sweep.plotting.spectrum import curve
from vibro_sweep.plotting.style import BRANCHES, FAINT, INK, LEFT, RIGHT, axis_name, edges, symbol

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
    fig = result.page(4.6, result.title("Energy"))
    above, below = fig.subplots(2, sharex=True)
    power = result.array("impact_power")[order]
    if result.follow:
        for i, (name, colour) in enumerate(BRANCHES.items()):
            curve(above, values[order], power[:, i], color=colour, label=name)
    else:
        curve(above, values[order], power, color=INK)
    above.set_ylabel("power lost in impacts")
    chosen = result.look.variable
    shown = [chosen] if chosen else [name for name in variables(result) if name.startswith("rms_x")]
    for i, name in enumerate(shown):
        style = {"color": COLOURS[min(i, len(COLOURS) - 1)], "label": symbol(name.partition("_")[2])}
        curve(below, values[order], result.array(name)[order], **style)
    size = "largest size" if chosen and chosen.startswith("peak") else "root mean square"
    below.set(ylabel=f"{size} of {symbol(chosen.partition('_')[2])}" if chosen else size, xlabel=axis_name(key))
    below.set_xlim(*edges(values[order])[[0, -1]])
    for ax in (above, below):
        ax.set_ylim(bottom=0)
    if len(shown) > 1:
        below.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=min(8, len(shown)), borderaxespad=0.1)
    fig.align_ylabels((above, below))
    return fig
