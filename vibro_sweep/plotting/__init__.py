"""Pictures of a result file or a Dataset, from these alone.

`kinds` says what a file can show, `figure` draws one kind for a notebook, `plot` writes pictures. Nothing
here computes an orbit: what is not in the file is not in the picture. No display is needed or touched.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibro_sweep.checks.errors import ArgumentTypeError
from vibro_sweep.checks.refusals import not_allowed, shown
from vibro_sweep.plotting import (
    basins,
    branch_diagram,
    charts,
    coexistence,
    contact_force,
    contacts_picture,
    convergence,
    energy_picture,
    film,
    orbit_pictures,
    planes,
    sweeps,
)
from vibro_sweep.plotting.panel import Panel
from vibro_sweep.plotting.pictures import check_output, save
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.source import name_of, readable
from vibro_sweep.plotting.sweep_result import PlotError, Result
from vibro_sweep.tables.file_columns import CHART
from vibro_sweep.tables.picture_kinds import PICTURES

if TYPE_CHECKING:
    import xarray

__all__ = ["SUFFIXES", "PlotError", "PlotOptions", "check_output", "default_name", "figure", "kinds", "plot"]

SUFFIXES = (".png", ".svg", ".pdf")


class Kind(NamedTuple):
    """A kind of picture: what it needs, how it is drawn, variables to choose among, whether it shows single orbits, and
    whether b may be relative to b*."""

    shows: Callable[[Result], bool]
    draw: Callable[[Result], Figure]
    variables: Callable[[Result], tuple[str, ...]] = lambda result: ()
    of_orbits: bool = False
    relative: bool = False


_DRAWN = {
    "basins": Kind(basins.shows, basins.basins),
    "coexistence": Kind(coexistence.shows, coexistence.coexistence),
    "plane": Kind(planes.shows, planes.plane, planes.variables, relative=True),
    "bifurcation": Kind(sweeps.shows_bifurcation, sweeps.bifurcation, sweeps.section_variables),
    "lyapunov": Kind(sweeps.shows_lyapunov, sweeps.lyapunov),
    "impacts": Kind(sweeps.shows_impacts, sweeps.impacts),
    "contacts": Kind(contacts_picture.shows, contacts_picture.contacts),
    "energy": Kind(energy_picture.shows, energy_picture.energy, energy_picture.variables),
    "phase-portrait": Kind(
        orbit_pictures.shows_trajectory, orbit_pictures.phase_portrait, orbit_pictures.displacements, True
    ),
    "configuration": Kind(orbit_pictures.shows_both_masses, orbit_pictures.configuration, of_orbits=True),
    "history": Kind(orbit_pictures.shows_trajectory, orbit_pictures.history, orbit_pictures.coordinates, True),
    "contact-force": Kind(contact_force.shows, contact_force.contact_force, of_orbits=True),
    "film": Kind(orbit_pictures.shows_trajectory, film.film, of_orbits=True),
    "poincare": Kind(orbit_pictures.shows_poincare, orbit_pictures.poincare, orbit_pictures.abscissae, True),
    "iteration": Kind(orbit_pictures.shows_section, orbit_pictures.iteration, sweeps.section_variables, True),
    "convergence": Kind(convergence.shows_convergence, convergence.convergence, of_orbits=True),
}
KINDS = {name: _DRAWN[name] for name in PICTURES}


def kinds(data: "str | Path | xarray.Dataset") -> list[str]:
    """Kinds of picture that a file, or a Dataset, can show, the default one first; empty where it has nothing to show.

    Raises `PlotError` where it is not one of vibro-sweep's.
    """
    with Result(data) as result:
        return _kinds(result)


def figure(
    data: "str | Path | xarray.Dataset",
    kind: str | None = None,
    options: PlotOptions | None = None,
    ax: Axes | None = None,
) -> Figure:
    """One picture of a file or a Dataset (default: the first of `kinds`), 7 inches wide unless `options` differ.

    Of a file of branches their diagram, of curves their chart.

    ax : where its first or only panel is drawn, by default a new Figure; `options` has no size or resolution then
    Raises `PlotError` where the data cannot be read or cannot show that kind.
    """
    if ax is not None and not isinstance(ax, Axes):
        raise ArgumentTypeError(not_allowed("ax", ax, "matplotlib axes"))
    data, of = readable(data)
    if of is not None:
        _check_ragged(data, of, kind, options or PlotOptions())
        with matplotlib.rc_context((options or PlotOptions()).style):
            drawn = (charts.chart if of == CHART else branch_diagram.branches)(data, options or PlotOptions(), ax)
            if ax is None and options is not None:
                options.applied(drawn)
            return drawn
    with Result(data, options, ax) as result:
        drawn = _draw(result, _chosen(result, kind)[0])
    return drawn.ax.figure if isinstance(drawn, Panel) else drawn


def plot(
    path, output=None, kind: str | None = None, overwrite: bool = False, options: PlotOptions | None = None
) -> list[Path]:
    """Write pictures of the file; the paths written.

    `output` is FILE.png in the current folder unless given; its suffix (one of `SUFFIXES`) is the format. `kind` is
    one of `kinds` (default: the first) or "all": then each goes to its own file, named FILE-kind, and so do, by
    default, pictures of single orbits, which `at` of the options asks for.
    Raises `PlotError` for a file, a kind or an output that will not do, and without `overwrite` for an output that
    exists, unless it is a picture that this function drew and nobody has changed since.
    """
    path = Path(path)
    named_by_kind = kind == "all" or (output is None and options is not None and bool(options.at))
    output = Path(default_name(path)) if output is None else Path(output)
    kind = check_suffix(output, kind)
    beside = (options.windows, options.over) if options else ()
    inputs = [path, *(one for one in beside if isinstance(one, Path))]
    data, of = readable(path)
    if of is not None:
        check_output(output, overwrite, inputs)
        return [save(figure(data, kind, options), output, overwrite, inputs)]
    with Result(data, options) as result:
        chosen = _chosen(result, kind)
        places = [output.with_stem(f"{output.stem}-{one}") if named_by_kind else output for one in chosen]
        for place in places:  # before the work of drawing
            check_output(place, overwrite, inputs)
        return [save(_draw(result, one), place, overwrite, inputs) for one, place in zip(chosen, places, strict=True)]


def check_suffix(output: Path, kind: str | None) -> str | None:
    """The kind of picture for an output: a film where its suffix is that of one. Raises PlotError for any other."""
    suffix = output.suffix.lower()
    if suffix in film.SUFFIXES and kind in (None, "film"):
        return "film"
    if suffix not in SUFFIXES:
        allowed = (*SUFFIXES, *(f"{one} for a film" for one in film.SUFFIXES))
        raise PlotError(f"output {output}: the suffix is the format and must be one of {', '.join(allowed)}")
    return kind


def _check_ragged(path, of: str, kind: str | None, options: PlotOptions) -> None:
    """Refuse what belongs to pictures of sweeps."""
    chosen = {"kind": kind not in (None, "all"), "at": options.at, "windows": options.windows}
    chosen |= {} if of == CHART else {"relative": options.relative}
    for name, value in chosen.items():
        if value:
            raise PlotError(f"{name}: does not belong to {of}, which {name_of(path)} holds")


def _kinds(result: Result) -> list[str]:
    """The kinds that the data can show, first the picture that the scene names."""
    if not result.done.any():
        return []
    able = [name for name, kind in KINDS.items() if kind.shows(result)]
    return sorted(able, key=lambda name: name != result.settings.get("picture"))


def _chosen(result: Result, kind: str | None) -> list[str]:
    """The kinds to draw. Without a word for one: the first that can show what the options ask for."""
    available = _kinds(result)
    if not result.done.any():
        raise PlotError(f"{result.path}: nothing to show yet, no point is computed")
    if result.options.over is not None:
        raise PlotError(f"over: branches and curves are drawn over a sweep; {result.path} is one itself")
    if not available:
        raise PlotError(f"{result.path}: nothing to show, there is no picture of {result.contents()} alone")
    if kind not in (None, "all", *available):
        needed = (KINDS[kind].shows.__doc__ or "").rstrip(".") if kind in KINDS else ""
        more = f"; {kind} needs {needed[:1].lower()}{needed[1:]}" if needed else ""
        raise PlotError(f"kind {shown(kind)}: {result.path} can show {', '.join(available)} (or all){more}")
    candidates = available if kind in (None, "all") else [kind]
    at, variable = result.options.at, result.options.variable
    fitting = [name for name in candidates if not at or KINDS[name].of_orbits]
    if not fitting:
        which = f"kind {kind} shows the whole sweep" if kind else f"{result.path} has no single orbits to show"
        raise PlotError(f"at: {which}; {_those(available, lambda name: KINDS[name].of_orbits)}")
    if result.options.relative:
        fitting = [name for name in fitting if KINDS[name].relative]
        if not fitting:
            raise PlotError(f"relative: belongs to charts and planes; {result.path} can show {', '.join(available)}")
    if variable:
        choices = {name: KINDS[name].variables(result) for name in fitting}
        fitting = [name for name in fitting if variable in choices[name]]
        if not fitting:
            named = "; ".join(f"{name}: {', '.join(names)}" for name, names in choices.items() if names)
            raise PlotError(f"variable {shown(variable)} is not allowed; there are {named or 'none to choose among'}")
    return fitting if kind == "all" else fitting[:1]


def _those(available: list[str], fits: Callable[[str], bool]) -> str:
    names = [name for name in available if fits(name)]
    return f"those of single points are {', '.join(names)}" if names else "there is none of single points"


def _draw(result: Result, kind: str) -> Figure | Panel:
    with matplotlib.rc_context(result.options.style):
        fig = KINDS[kind].draw(result)
        if isinstance(fig, Figure):
            result.options.applied(fig)
        if result.failed:
            for ax in fig.axes:
                if ax.get_label() != "<colorbar>":
                    text = "all points failed; `vibro-sweep info` says how"
                    ax.text(0.5, 0.55, text, transform=ax.transAxes, ha="center")
        return fig


def default_name(path: Path) -> str:
    """The default name of the picture of a file, FILE.png."""
    return path.name.removesuffix(".part").removesuffix(".h5") + ".png"
