"""Draw docs/oscillator.svg, the sketch in README.md and docs/how/models.md: `python docs/oscillator.py`."""

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

FLOOR, MIDDLE = 0.0, 0.6  # heights of the ground and of the masses' centres
INK, FORCE = "black", "tab:red"


def spring(ax: Axes, left: float, right: float, y: float, label: str) -> None:
    """A zigzag between two places."""
    ends, turns = 0.25 * (right - left), 9
    x = np.concatenate([[left], np.linspace(left + ends, right - ends, turns), [right]])
    zigzag = np.concatenate([[0, 0], 0.09 * (-1.0) ** np.arange(turns - 2), [0, 0]])
    ax.plot(x, y + zigzag, color=INK, lw=1)
    ax.text((left + right) / 2, y + 0.15, label, ha="center", va="bottom")


def dashpot(ax: Axes, left: float, right: float, y: float, label: str) -> None:
    """A piston in a cylinder that is open to the right."""
    middle, half = (left + right) / 2, 0.13
    ax.plot([left, middle - 0.1], [y, y], color=INK, lw=1)
    ax.plot([middle + 0.15, middle - 0.1, middle - 0.1, middle + 0.15], y + half * np.array([-1, -1, 1, 1]), INK, lw=1)
    ax.plot([middle + 0.05] * 2, [y - 0.7 * half, y + 0.7 * half], color=INK, lw=1)
    ax.plot([middle + 0.05, right], [y, y], color=INK, lw=1)
    ax.text((left + right) / 2, y - 0.18, label, ha="center", va="top")


def mass(ax: Axes, left: float, width: float, label: str, displacement: str, force: str) -> None:
    """A block on wheels, with its displacement above it and the force on it."""
    ax.add_patch(Rectangle((left, 0.12), width, 0.96, facecolor="0.9", edgecolor=INK))
    for x in (left + 0.2 * width, left + 0.8 * width):
        ax.plot(x, 0.06, "o", ms=6, mfc="white", mec=INK)
    x = left + width / 2
    ax.text(x, 0.82, label, ha="center", va="center")
    ax.plot([x, x], [1.08, 1.45], color=INK, lw=0.7)
    arrow(ax, x, x + 0.45, 1.35, displacement, INK)
    arrow(ax, x - 0.35, x + 0.35, 0.36, force, FORCE)


def arrow(ax: Axes, start: float, end: float, y: float, label: str, colour: str, style: str = "->") -> None:
    ax.annotate("", (end, y), (start, y), arrowprops={"arrowstyle": style, "color": colour, "shrinkA": 0, "shrinkB": 0})
    ax.text((start + end) / 2, y + 0.04, label, ha="center", va="bottom", color=colour, size="small")


def wall(ax: Axes, x: float, bottom: float, top: float, side: int) -> None:
    """A vertical face, hatched on the side (+1 right, -1 left) where it is solid."""
    ax.add_patch(Rectangle((min(x, x + side * 0.14), bottom), 0.14, top - bottom, fill=False, hatch="/////", lw=0))
    ax.plot([x, x], [bottom, top], color=INK, lw=1.5)


def sketch() -> Figure:
    """The oscillator of eqs. (3) and (4): ground, M2, M1, and the stops C and A beside a finger that M1 carries."""
    fig = Figure(figsize=(8.2, 3.2), layout="constrained")
    ax = fig.add_subplot()
    ax.set_aspect("equal")
    ax.set_axis_off()
    wall(ax, 0.0, FLOOR, 1.3, -1)
    ax.plot([0, 6.4], [FLOOR, FLOOR], color=INK, lw=1.5)
    ax.add_patch(Rectangle((0, -0.12), 6.4, 0.12, fill=False, hatch="/////", lw=0))
    spring(ax, 0, 1.5, 0.85, r"$K_2$: $\mu_k$")
    dashpot(ax, 0, 1.5, 0.4, r"$C_2$: $2\zeta\mu_k$")
    mass(ax, 1.5, 1.2, r"$M_2$: $\mu_m$", "$x_2$", r"$f_2 \,\sin(\omega t + \tau)$")
    spring(ax, 2.7, 4.2, 0.85, "$K_1$: $1$")
    dashpot(ax, 2.7, 4.2, 0.4, r"$C_1$: $2\zeta$")
    mass(ax, 4.2, 1.2, "$M_1$: $1$", "$x_1$", r"$(1 - f_2)\,\sin(\omega t + \tau)$")
    # the finger that strikes the stops
    finger = 4.8
    ax.plot([finger, finger], [1.45, 2.05], color=INK, lw=3, solid_capstyle="butt")
    for x, side, name in ((finger - 0.9, -1, "C"), (finger + 0.9, 1, "A")):
        wall(ax, x, 1.62, 2.25, side)
        ax.text(x + side * 0.22, 1.93, f"stop {name}", ha="left" if side > 0 else "right", va="center")
    arrow(ax, finger - 0.9, finger, 1.7, "$b$", INK, "<->")
    arrow(ax, finger, finger + 0.9, 1.7, "$b$", INK, "<->")
    ax.text(finger, 2.12, r"$\dot x_1 \to -R\,\dot x_1$", ha="center", va="bottom")
    ax.set_xlim(-0.2, 6.6)
    ax.set_ylim(-0.15, 2.4)
    return fig


if __name__ == "__main__":
    with matplotlib.rc_context({"svg.hashsalt": "oscillator", "mathtext.fontset": "stix"}):
        sketch().savefig(Path(__file__).with_suffix(".svg"), metadata={"Date": None})
