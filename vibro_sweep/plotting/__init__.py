"""Pictures of a result file, from the file alone.

`kinds` says what a file can show, `figure` draws one kind for a notebook, `plot` writes pictures. Nothing
here computes an orbit: what is not in the file is not in the picture. No display is needed or touched.
"""

from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from vibro_sweep.plotting import basins, coexistence, orbits, planes, sweeps
from vibro_sweep.plotting.result import PlotError, Result
from vibro_sweep.plotting.style import STYLE

__all__ = ["SUFFIXES", "PlotError", "figure", "kinds", "plot"]

SUFFIXES = (".png", ".svg", ".pdf")

# In order of preference: the first that a file can show is its default.
_KINDS = {
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


def kinds(path) -> list[str]:
    """Kinds of picture that the file can show, the default one first; empty where it has nothing to show.

    Raises `PlotError` where the file is not one of vibro-sweep's.
    """
    with Result(path) as result:
        return _kinds(result)


def figure(path, kind: str | None = None) -> Figure:
    """One picture of the file (default: the first of `kinds`), about 7 inches wide.

    Raises `PlotError` where the file cannot be read or cannot show that kind.
    """
    with Result(path) as result:
        return _draw(result, _chosen(result, kind)[0])


def plot(path, output=None, kind: str | None = None) -> list[Path]:
    """Write pictures of the file; the paths written.

    `output` is FILE.png beside the file unless given; its suffix (one of `SUFFIXES`) is the format. `kind` is
    one of `kinds` (default: the first) or "all": then each goes to its own file, named FILE-kind.
    Raises `PlotError` for a file, a kind or an output that will not do.
    """
    path = Path(path)
    output = _beside(path) if output is None else Path(output)
    if output.suffix.lower() not in SUFFIXES:
        raise PlotError(f"output {output}: the suffix is the format and must be one of {', '.join(SUFFIXES)}")
    with Result(path) as result:
        chosen = _chosen(result, kind)
        if kind != "all":
            return [_save(_draw(result, chosen[0]), output, path)]
        return [_save(_draw(result, one), output.with_stem(f"{output.stem}-{one}"), path) for one in chosen]


def _kinds(result: Result) -> list[str]:
    return [kind for kind, (shows, _) in _KINDS.items() if shows(result)] if result.done.any() else []


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


def _draw(result: Result, kind: str) -> Figure:
    with matplotlib.rc_context(STYLE):
        fig = _KINDS[kind][1](result)
        if result.failed:
            for ax in fig.axes:
                if ax.get_label() != "<colorbar>":
                    text = "all points failed; `vibro-sweep info` says how"
                    ax.text(0.5, 0.55, text, transform=ax.transAxes, ha="center")
        return fig


def _beside(path: Path) -> Path:
    name = path.name.removesuffix(".part")
    return path.with_name(name.removesuffix(".h5") + ".png")


def _save(fig: Figure, output: Path, source: Path) -> Path:
    if output.resolve() == source.resolve():
        raise PlotError(f"output {output}: that is the result file itself")
    try:
        with matplotlib.rc_context(STYLE):  # some settings are looked up only when the picture is written
            fig.savefig(output)
    except OSError as error:
        raise PlotError(f"output {output}: cannot be written ({error.strerror or error})") from error
    return output
