"""Logarithmic scales for what spans decades: an even one would show its largest numbers only."""

import numpy as np
from matplotlib.colors import LogNorm, Normalize, SymLogNorm
from matplotlib.ticker import FixedLocator, NullLocator

from vibro_sweep.oscillator.contact_laws import OTHER_STOPS

SPAN = 10.0  # the largest of the numbers over their lower quartile, from which on they span decades
FEW = 1.5  # decades of an axis on which 2 and 5 are named as well
DECADES, EVEN = 2.0, 5.0  # values in proportion: so many at least, and of swept ones the largest step over the smallest
OF_STOPS = frozenset(number.name for number in OTHER_STOPS)
ZERO = 0.5  # the part of the axis from 0 to the least number above it, in decades


def spans(values) -> bool:
    """Whether numbers (any shape, NaN among them) that are not below 0 differ so much, zeros left out."""
    known = np.asarray(values)[np.isfinite(values)]
    above = known[known > 0]
    return above.size > 0 and bool((known >= 0).all()) and above.max() >= SPAN * np.quantile(above, 0.25)


def in_proportion(values) -> bool:
    """Whether rising values take steps in proportion to themselves, over decades, as 1, 2, 5, 10, ... do."""
    if len(values) < 3 or not values[0] > 0:
        return False
    steps = np.diff(np.log10(values))
    return bool(steps.sum() >= DECADES and steps.max() <= EVEN * steps.min())


def along_axis(values):
    """The functions from rising values to where they lie along their axis, and back."""
    return (np.log, np.exp) if in_proportion(values) else (np.asarray, np.asarray)


def scale_of(name: str, values) -> str:
    """The scale of the axis of a number that branches and curves pass through, as matplotlib calls it: stiffnesses and
    dampers of stops go over decades, where most of what happens would lie on the edge."""
    known = np.asarray(values)[np.isfinite(values)]
    over_decades = name in OF_STOPS and known.size > 0 and known.min() > 0
    return "log" if over_decades and known.max() >= 10**DECADES * known.min() else "linear"


def scale_axis(ax, values) -> None:
    """The y axis from zero on; logarithmic for values that span decades, with a place for zero where there is one."""
    if not spans(values):
        ax.set_ylim(bottom=0)
        return
    least, most, zero = _ends(values)
    if zero:
        ax.set_yscale("symlog", linthresh=least, linscale=ZERO)
        ax.set_ylim(0, 1.2 * most)
    else:
        ax.set_yscale("log")
        ax.set_ylim(least / 1.2, 1.2 * most)
    steps = (1, 2, 5) if np.log10(most / least) <= FEW else (1,)
    powers = range(int(np.floor(np.log10(least))), int(np.log10(most)) + 1)
    ticks = [step * 10.0**power for power in powers for step in steps]
    ax.yaxis.set_major_locator(FixedLocator([0] * zero + [tick for tick in ticks if least <= 1.001 * tick]))
    ax.yaxis.set_minor_locator(NullLocator())
    ax.yaxis.set_major_formatter("{x:g}")


def norm(values) -> Normalize | None:
    """The norm of a colour scale for these values, None for an even one."""
    if not spans(values):
        return None
    least, most, zero = _ends(values)
    return SymLogNorm(least, linscale=ZERO, vmin=0, vmax=most, base=10) if zero else LogNorm(least, most)


def _ends(values) -> tuple[float, float, bool]:
    """The least and the largest number above zero, and whether there is a zero."""
    known = np.asarray(values)[np.isfinite(values)]
    above = known[known > 0]
    return float(above.min()), float(above.max()), len(above) < len(known)
