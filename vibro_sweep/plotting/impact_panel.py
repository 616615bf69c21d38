"""How often a mass strikes each stop, over a parameter."""

import numpy as np

from vibro_sweep.plotting import scales, sticking_marks
from vibro_sweep.plotting.spectrum_panel import branches, curve, margin_note
from vibro_sweep.plotting.style import FAINT, INK, LEFT, RIGHT

NONE = "no impacts"


def there_are(result, order) -> bool:
    """Whether an orbit of these values strikes a stop."""
    return any(np.any(result.array(f"impacts_{side}")[order] > 0) for side in ("right", "left"))


def impact_counts(ax, result, values, order):
    """Impacts in a forcing period; logarithmic where they span decades. Where masses rest on a stop there is a tint."""
    per = result.number("record") or 1
    # (values, starts)
    right, left = (result.array(f"impacts_{side}")[order] / per for side in ("right", "left"))
    sides = result.rigid
    which = "both stops" if len(result.starts) > 1 and len(sides) > 1 else ""
    if len(sides) == 1 < len(result.sides):  # the other one is compliant
        which = f"{'right' if sides[0] > 0 else 'left'} stop"
    ax.set_ylabel("\n".join(filter(None, ("impacts" if per == 1 else "impacts / $T$", which))))
    sticking_marks.tint(ax, result, values, order)
    if result.follow:
        shown = right + left
        branches(ax, values, shown)
    elif len(result.starts) > 1:  # mirror images exchange right and left: only the sum is worth comparing
        shown = right + left
        curve(ax, values, shown, color=INK)
    else:
        shown = np.stack([{1: right, -1: left}[side] for side in sides or result.sides])
        wide = {"lw": 2.8, "alpha": 0.5} if len(sides) > 1 else {"lw": 0.8}
        if 1 in sides:
            curve(ax, values, right, color=RIGHT, label="right", **wide)
            margin_note(ax, 0.75, "right", RIGHT, fontsize=8)
        if -1 in sides:
            curve(ax, values, left, color=LEFT, label="left", lw=0.8)
            margin_note(ax, 0.25, "left", LEFT, fontsize=8)
    scales.scale_axis(ax, shown)
    if not np.any(shown > 0) and not result.failed:
        ax.text(0.5, 0.5, NONE, transform=ax.transAxes, ha="center", color=FAINT)
