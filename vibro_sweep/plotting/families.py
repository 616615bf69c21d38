"""Attractors by kind, for the eye: each kind has a colour in all pictures, and mirror images have one each."""

from collections.abc import Mapping

import numpy as np
from matplotlib.colors import to_rgb

from vibro_sweep.plotting.style import INK, LEFT, NOT_COMPUTED, RIGHT
from vibro_sweep.tables.observables import averaged

_LAST = averaged(0)  # they stand after the coordinates
RATES = [_LAST.index(name) - len(_LAST) for name in ("impacts_right", "impacts_left")]  # places among the averages

# In the order in which they are stacked: kind -> its name in a legend, its colour.
KINDS = {
    "free": ("non-impacting", "#77bbff"),
    "right": ("periodic, more impacts on the right", RIGHT),
    "left": ("periodic, more impacts on the left", LEFT),
    "even": ("periodic, as many on both sides", "#887766"),
    "aperiodic": ("chaotic or quasi-periodic", INK),
    "unsettled": ("not settled", NOT_COMPUTED),
}
OF_CONTACTS = {  # the names where all stops are compliant
    "free": "without contact",
    "right": "periodic, more contacts on the right",
    "left": "periodic, more contacts on the left",
}
SHADES = (0.0, 0.45, -0.35, 0.7)  # of attractors of one kind, towards white or black
MARKERS = {"free": "o", "right": ">", "left": "<", "even": "D", "aperiodic": "."}


def kind(period, average) -> np.ndarray:
    """The kinds of attractors with these periods (...), 0: none, and averages, as the file holds them."""
    right, left = (average[..., place] for place in RATES)
    known = [
        (np.isnan(right), "unsettled"),
        (period == 0, "aperiodic"),
        ((right == left) & (right > 0), "even"),
        (right == left, "free"),
        (right > left, "right"),
    ]
    return np.select([where for where, _ in known], [name for _, name in known], "left")


def colours(kinds: Mapping[float, str]) -> dict[float, tuple[float, float, float]]:
    """The colour of each attractor by its number in the file, of which the kinds are given: that of its kind, in shades
    by rising number. It is the same in all pictures."""
    seen: dict[str, int] = {}
    result = {}
    for number in sorted(kinds):
        which = kinds[number]
        seen[which] = seen.get(which, -1) + 1
        towards = SHADES[seen[which] % len(SHADES)]
        end = 1.0 if towards > 0 else 0.0
        red, green, blue = ((1 - abs(towards)) * part + abs(towards) * end for part in to_rgb(KINDS[which][1]))
        result[number] = (red, green, blue)
    return result


def named(which: str, meeting: str) -> str:
    """The name of a kind in a legend. meeting: what masses have at the stops, impact or contact."""
    return (OF_CONTACTS if meeting == "contact" else {}).get(which, KINDS[which][0])


def describe(period, average, meeting: str = "impact") -> str:
    """An attractor in words: its period and its impacts or, at compliant stops, contacts."""
    name, (right, left) = str(kind(period, average)), average[RATES]
    if name == "unsettled":
        return KINDS[name][0]
    if name == "aperiodic":
        return f"{KINDS[name][0]}, {right:.3g} + {left:.3g} {meeting}s / $T$"
    right, left = (round(float(rate) * int(period)) for rate in (right, left))
    if name == "free":
        return f"{named(name, meeting)}, period {int(period)}"
    return f"period {int(period)}, {right} {meeting if right == 1 else f'{meeting}s'} right, {left} left"
