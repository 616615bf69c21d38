"""Over one parameter: what impacts take, how much each mass moves, how deep compliant stops are pressed."""

import numpy as np

from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.labels import ABOVE
from vibro_sweep.plotting.spectrum_panel import curve
from vibro_sweep.plotting.style import ARROWS, BRANCHES, FAINT, INK, LEFT, RIGHT, symbol
from vibro_sweep.plotting.sweeps import OF_CONTACTS, set_reach, shows_contacts
from vibro_sweep.tables.coordinates import MOST_MASSES

DASHED = {"up": {"ls": "-"}, "down": {"ls": (0, (4, 2))}}  # where colours tell coordinates apart
COLOURS = (INK, RIGHT, LEFT, FAINT)


def shows_energy(result: DrawnSweep) -> bool:
    """A sweep over one key; energy."""
    return len(result.sweep) == 1 and "impact_power" in result


def variables(result: DrawnSweep) -> tuple[str, ...]:
    """The sizes of motion that may be drawn, the default first."""
    names = (f"{size}_{letter}{n}" for size in ("rms", "peak") for letter in "xv" for n in range(1, MOST_MASSES + 1))
    return tuple(name for name in names if name in result)


@picture(shows_contacts)
def contacts(result: DrawnSweep) -> Panels:
    """The largest penetration of a compliant stop, and its largest force, over the parameter."""
    rows = [(label + result.unit(name), {name: {}}) for name, label in OF_CONTACTS.items()]
    return _lines(result, "Contacts", 4.2, rows)


@picture(shows_energy, variables)
def energy(result: DrawnSweep) -> Panels:
    """Power lost in impacts over the parameter; below, the root mean square of each displacement, or one variable."""
    struck = bool(np.any(result.array("impact_power") > 0)) or result.failed
    chosen = result.options.variable
    names = [chosen] if chosen else [name for name in variables(result) if name.startswith("rms_x")]
    size = "largest size" if chosen and chosen.startswith("peak") else "root mean square"
    of = f" of {symbol(chosen.partition('_')[2])}" if chosen else ""
    styles = {
        name: {"color": COLOURS[min(i, len(COLOURS) - 1)], "label": symbol(name.partition("_")[2])}
        for i, name in enumerate(names)
    }
    rows = [(f"power that\nstops take{result.unit('impact_power')}", {"impact_power": {}})] if struck else []
    rows.append((f"{size}{of}{result.unit(names[0])}", styles))
    return _lines(result, "Energy" if struck else f"Energy; no {result.meeting}s", 4.6 if struck else 3.0, rows)


def _lines(result, subject, height, rows) -> Panels:
    """Panels of quantities that are not below zero. rows : of each its label, and names with the styles of their lines;
    one without a style shows upward and downward sweeps."""
    ((key, values),) = result.sweep.items()
    order = np.argsort(values)  # a sweep may run downwards; an axis does not

    def draw(axes):
        for ax, (label, styles) in zip(axes[:, 0], rows, strict=True):
            for name, style in styles.items():
                ordinates = result.array(name)[order]
                if result.follow and not style:
                    for i, (way, colour) in enumerate(BRANCHES.items()):
                        curve(ax, values[order], ordinates[:, i], color=colour, label=ARROWS[way])
                elif result.follow:
                    for i, (way, dashes) in enumerate(DASHED.items()):
                        named = {"label": f"{style['label']} {ARROWS[way]}"} if "label" in style else {}
                        curve(ax, values[order], ordinates[:, i], **style | dashes | named)
                else:
                    curve(ax, values[order], ordinates, **style or {"color": INK})
            ax.set(ylabel=label)
            ax.set_ylim(bottom=0)
            for name in styles:
                result.measured_in(ax, key, name)
            handles, labels = ax.get_legend_handles_labels()
            named = dict(zip(labels, handles, strict=True))  # each start has lines of its own
            if len(named) > 1 and (len(styles) > 1 or ax is axes[0, 0]):
                columns = 2 if getattr(ax.figure, "narrow", False) else 8
                ax.legend(named.values(), named.keys(), ncols=min(columns, len(named)), **ABOVE)
        axes[-1, 0].set_xlabel(result.axis(key))
        set_reach(axes[-1, 0], values[order])

    return Panels(result.title(subject), height, draw, len(rows), grid={"sharex": True})
