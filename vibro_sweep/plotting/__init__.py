"""Pictures of a result file or a Dataset, from these alone.

`kinds` says what a file can show, `figure` draws one kind for a notebook, `plot` writes pictures. Nothing
here computes an orbit: what is not in the file is not in the picture. No display is needed or touched.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibro_sweep.plotting import basins, coexistence, orbits, planes, sweeps
from vibro_sweep.plotting.panel import Panel
from vibro_sweep.plotting.pictures import check_output, save
from vibro_sweep.plotting.result import PlotError, Result
from vibro_sweep.plotting.style import STYLE

if TYPE_CHECKING:
    import xarray

__all__ = ["SUFFIXES", "PlotError", "check_output", "default_name", "figure", "kinds", "plot"]

SUFFIXES = (".png", ".svg", ".pdf")

# In order of preference: the first that a file can show is its default. What each needs, and how it is drawn.
KINDS = {
    "basins": (basins.shows, basins.basins),
    "coexistence": (coexistence.shows, coexistence.coexistence),
    "plane": (planes.shows, planes.plane),
    "bifurcation": (sweeps.shows_bifurcation, sweeps.bifurcation),
    "lyapunov": (sweeps.shows_lyapunov, sweeps.lyapunov),
    "impacts": (sweeps.shows_impacts, sweeps.impacts),
    "phase-portrait": (orbits.shows_trajectory, orbits.phase_portrait),
    "configuration": (orbits.shows_both_masses, orbits.configuration),
    "history": (orbits.shows_trajectory, orbits.history),
    "iteration": (orbits.shows_section, orbits.iteration),
    "convergence": (orbits.shows_convergence, orbits.convergence),
}


def kinds(data: "str | Path | xarray.Dataset") -> list[str]:
    """Kinds of picture that a file, or a Dataset, can show, the default one first; empty where it has nothing to show.

    Raises `PlotError` where it is none of vibro-sweep's.
    """
    with Result(data) as result:
        return _kinds(result)


def figure(
    data: "str | Path | xarray.Dataset",
    kind: str | None = None,
    ax: Axes | None = None,
    at: dict[str, float] | None = None,
) -> Figure:
    """One picture of a file or a Dataset (default: the first of `kinds`), about 7 inches wide.

    ax : where its first or only panel is drawn, by default a new Figure
    at : where single orbits are drawn, key -> value of the sweep; by default some, evenly spread

    Raises `PlotError` where the data cannot be read or cannot show that kind.
    """
    if ax is not None and not isinstance(ax, Axes):
        raise TypeError(f"ax: {ax!r} is not allowed; it must be matplotlib axes")
    with Result(data, at, ax) as result:
        drawn = _draw(result, _chosen(result, kind)[0])
    return drawn.ax.figure if isinstance(drawn, Panel) else drawn


def plot(path, output=None, kind: str | None = None, overwrite: bool = False) -> list[Path]:
    """Write pictures of the file; the paths written.

    `output` is FILE.png in the current folder unless given; its suffix (one of `SUFFIXES`) is the format. `kind` is
    one of `kinds` (default: the first) or "all": then each goes to its own file, named FILE-kind.
    Raises `PlotError` for a file, a kind or an output that will not do, and without `overwrite` for an output that
    exists, unless it is a picture that this function drew and nobody has changed since.
    """
    path = Path(path)
    output = Path(default_name(path)) if output is None else Path(output)
    if output.suffix.lower() not in SUFFIXES:
        raise PlotError(f"output {output}: the suffix is the format and must be one of {', '.join(SUFFIXES)}")
    if output.resolve() == path.resolve():
        raise PlotError(f"output {output}: that is the result file itself")
    with Result(path) as result:
        chosen = _chosen(result, kind)
        many = kind == "all"
        places = [output.with_stem(f"{output.stem}-{one}") if many else output for one in chosen]
        for place in places:  # before the work of drawing
            check_output(place, overwrite)
        return [save(_draw(result, one), place, overwrite) for one, place in zip(chosen, places, strict=True)]


def _kinds(result: Result) -> list[str]:
    return [kind for kind, (shows, _) in KINDS.items() if shows(result)] if result.done.any() else []


def _chosen(result: Result, kind: str | None) -> list[str]:
    available = _kinds(result)
    if not result.done.any():
        raise PlotError(f"{result.path}: nothing to show yet, no point is computed")
    if not available:
        raise PlotError(f"{result.path}: nothing to show, there is no picture of {result.contents()} alone")
    if kind is None:
        return available[:1]
    if kind == "all":
        return available
    if kind not in available:
        raise PlotError(f"kind {kind!r}: {result.path} can show {', '.join(available)} (or all)")
    return [kind]


def _draw(result: Result, kind: str) -> Figure | Panel:
    with matplotlib.rc_context(STYLE):
        fig = KINDS[kind][1](result)
        if result.failed:
            for ax in fig.axes:
                if ax.get_label() != "<colorbar>":
                    text = "all points failed; `vibro-sweep info` says how"
                    ax.text(0.5, 0.55, text, transform=ax.transAxes, ha="center")
        return fig


def default_name(path: Path) -> str:
    """Of the picture of a file, FILE.png."""
    return path.name.removesuffix(".part").removesuffix(".h5") + ".png"
