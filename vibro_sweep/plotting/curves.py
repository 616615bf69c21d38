"""Picture of bifurcation curves in the plane of two parameters, with their points of codimension two."""

from typing import NamedTuple

import matplotlib as mpl
import numpy as np

from vibro_sweep.plotting.orbits import legend
from vibro_sweep.plotting.style import FAINT, INK, STYLE, axis_name, page

COLOURS = {
    "fold": "#2f8fd8",
    "flip": "#e0a030",
    "pitchfork": "#b2182b",
    "neimark_sacker": "#1a1a5e",
    "graze": FAINT,
    "sticking": "#9600fa",
}
LABELS = {"neimark_sacker": "Neimark-Sacker"}
APART = (0.045, 0.03)  # of the axes: room for a name
VIRTUAL = (0, (1, 1.5))  # dots of what is no motion
SHORT = {  # beside the points; the labels of MatCont where it has one
    "cusp": "CP",
    "fold_flip": "LPPD",
    "fold_neimark_sacker": "LPNS",
    "flip_neimark_sacker": "PDNS",
    "resonance_1_1": "R1",
    "resonance_1_2": "R2",
    "resonance_1_3": "R3",
    "resonance_1_4": "R4",
    "degenerate_flip": "GPD",
    "degenerate_neimark_sacker": "CH",
    "fold_graze": "LPGR",
    "flip_graze": "PDGR",
    "pitchfork_graze": "PFGR",
    "neimark_sacker_graze": "NSGR",
    "resonant_graze": "RG",
    "double_graze": "GRGR",
    "sticking_graze": "STGR",
}


class Drawn(NamedTuple):
    """A curve: its type, both parameters and `virtual` (points,), points of codimension two as (type, p, q)."""

    type: str
    p: np.ndarray
    q: np.ndarray
    virtual: np.ndarray
    special: list[tuple[str, float, float]]


def plot_curves(curves: list[Drawn], names: tuple[str, str]):
    """All curves in one panel. Returns a matplotlib Figure."""
    with mpl.rc_context(STYLE):
        fig = page(4.2, "bifurcation curves")
        ax = fig.subplots()
        for curve in curves:
            for virtual in (False, True):
                hidden = curve.virtual != virtual
                inside = ~hidden
                inside[1:] |= ~hidden[:-1] & virtual  # the virtual part begins where the real one ends
                p, q = (np.where(inside, values, np.nan) for values in (curve.p, curve.q))
                style = {"ls": VIRTUAL, "lw": 0.8} if virtual else {"ls": "-", "lw": 1.2}
                label = None if virtual or hidden.all() else LABELS.get(curve.type, curve.type)
                ax.plot(p, q, color=COLOURS[curve.type], label=label, **style)
        if any(curve.virtual.any() for curve in curves):
            ax.plot([], [], color=INK, ls=VIRTUAL, lw=0.8, label="virtual")
        places = {(kind, f"{p:.9g}", f"{q:.9g}"): (p, q) for curve in curves for kind, p, q in curve.special}
        for (kind, _, _), place in places.items():
            if kind in SHORT:
                ax.plot(*place, "o", ms=3.5, color=INK, mfc="white", mew=0.7, zorder=4)
        ax.set(xlabel=axis_name(names[0]), ylabel=axis_name(names[1]))
        _label(ax, [(SHORT[kind], place) for (kind, _, _), place in places.items() if kind in SHORT])
        legend(fig)
        return fig


def _label(ax, points) -> None:
    """Names beside the points; of points close to each other, beside the first."""
    scale = np.array([np.diff(ax.get_xlim())[0], np.diff(ax.get_ylim())[0]])
    taken: list[np.ndarray] = []
    for name, place in points:
        where = np.array(place) / scale
        if all(np.any(np.abs(where - other) > APART) for other in taken):
            ax.annotate(name, place, (3, 3), textcoords="offset points", size=6)
            taken.append(where)
