"""Attractors by kind, for the eye: each kind has a colour in all pictures, and mirror images have one each."""

import numpy as np

from vibro_sweep.plotting.style import INK, LEFT, NOT_COMPUTED, RIGHT

# In the order in which they are stacked: kind -> its name in a legend, its colour.
KINDS = {
    "free": ("non-impacting", "#8cc0a4"),
    "right": ("periodic, more impacts on the right", RIGHT),
    "left": ("periodic, more impacts on the left", LEFT),
    "even": ("periodic, as many on both sides", "#b9a0cf"),
    "aperiodic": ("chaotic or quasi-periodic", INK),
    "unsettled": ("not settled", NOT_COMPUTED),
}


def kind(period, average) -> str:
    """The kind of an attractor with this period (0: none) and these averages (7,), as the file holds them."""
    right, left = average[4:6]
    if np.isnan(right):
        return "unsettled"
    if period == 0:
        return "aperiodic"
    if right == left:
        return "even" if right > 0 else "free"
    return "right" if right > left else "left"


def describe(period, average) -> str:
    """An attractor in words: its period and its impacts."""
    name = kind(period, average)
    if name == "unsettled":
        return KINDS[name][0]
    if name == "aperiodic":
        return f"{KINDS[name][0]}, {average[4]:.3g} + {average[5]:.3g} impacts / $T$"
    right, left = (round(float(rate) * int(period)) for rate in average[4:6])
    if name == "free":
        return f"{KINDS[name][0]}, period {int(period)}"
    return f"period {int(period)}, {right} {'impact' if right == 1 else 'impacts'} right, {left} left"
