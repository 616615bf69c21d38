"""`vibro_sweep.plot`, and the pictures of the command line: which kinds there are, and which one is drawn."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from importlib import import_module
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any, overload

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibro_sweep.checks.arguments import check_type, checked_flag, names_its_arguments
from vibro_sweep.checks.errors import ArgumentTypeError
from vibro_sweep.checks.file_names import file_to_write
from vibro_sweep.checks.refusals import not_allowed, shown
from vibro_sweep.plotting import branch_diagram, charts
from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.kind import Kind
from vibro_sweep.plotting.measured import check_drawn
from vibro_sweep.plotting.picture_files import FILMS, SUFFIXES, PlotError, check_output, default_name
from vibro_sweep.plotting.pictures import save
from vibro_sweep.plotting.plot_options import PlotOptions, data_of, is_result
from vibro_sweep.plotting.source import name_of, readable
from vibro_sweep.tables.file_columns import CHART
from vibro_sweep.tables.picture_kinds import PICTURES, Plottable

if TYPE_CHECKING:
    import xarray


def _kind(place: str) -> Kind:
    module, _, name = place.partition(".")
    return getattr(import_module(f"vibro_sweep.plotting.{module}"), name).kind


KINDS: dict[str, Kind] = {name: _kind(place) for name, place in PICTURES.items()}


@overload
def plot(
    data: "str | Path | xarray.Dataset | Plottable", kind: str | None = None, ax: None = None, **options: Any
) -> Figure: ...


@overload
def plot(
    data: "str | Path | xarray.Dataset | Plottable", kind: str | None = None, ax: Axes = ..., **options: Any
) -> Axes: ...


@names_its_arguments
def plot(
    data: "str | Path | xarray.Dataset | Plottable",
    kind: str | None = None,
    ax: Axes | None = None,
    at: Mapping[str, float] | None = None,
    variable: str | None = None,
    width: float | None = None,
    *,
    xlim: tuple[float, float] | None = None,
    ylim: tuple[float, float] | None = None,
    size: tuple[float, float] | None = None,
    dpi: float | None = None,
    windows: "str | Path | xarray.Dataset | Plottable | None" = None,
    over: "str | Path | xarray.Dataset | None" = None,
    relative: bool = False,
    units: str | Sequence[str] | None = None,
    points: "str | Path | Mapping[str, Any] | None" = None,
    output: str | Path | None = None,
    overwrite: bool = False,
) -> Figure | Axes:
    """A picture of a file, of a Dataset of `vibro_sweep.open` or `vibro_sweep.sweep`, or of a result: an orbit, a
    branch, a curve or windows; a matplotlib Figure. Of an orbit `width`, `units` and `kind` are options.

    A notebook shows it as the value of a cell. Where `ax` is given, that is returned.
    Options have the names that they have on the command line.

    kind : by default the first that the data can show; of an orbit "contact-force"
    ax : axes to draw into, by default those of a new Figure. Of a bifurcation diagram or a plane they show the first
        panel; other kinds must have one, which `at` chooses where each orbit has its own
    at : where single orbits are drawn, as {"b": 6.6}: the nearest point; by default some, evenly spread
    variable : what is drawn, of what that kind can show, as "v1"
    width : mm, as 85 for one column of a journal, with type of 8 points; by default 178
    xlim, ylim : ranges of the axes, of several panels those of the first
    size : (width, height) in inches, in place of `width`
    dpi : pixels an inch, by default 200
    windows : windows of the sweep, to be shown with it
    over : the sweep over which branches or curves are drawn
    relative : of curves and planes: b in parts of the grazing clearance b*
    units : names of units in which numbers are shown, whatever the data have, as "mm, Hz"; also `at`, xlim and ylim
    points : measured points, a CSV file or columns by name, as frequency and x1, in the units of the picture or those
        of their heads, as "x1 [mm]"; drawn into diagrams and planes whose axes have these names
    output : FILE.png, .jpg, .svg, .pdf or .eps, to which the picture is written as well; .gif or .mp4 of a film
    overwrite : replace an `output` that exists, also one that is not a picture of this program

    Raises `PlotError` where the data cannot be read or cannot show that kind; it says which can be shown.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": {"start": 6, "stop": 6.4, "num": 21}}, transient=100, record=50)
    >>> figure = vs.plot(data, output="picture.png")
    >>> figure.axes[0].get_ylabel()
    '$x_1$ at $t = 0$ mod $T$'
    """
    if is_result(data) and hasattr(data, "sample"):  # an orbit, whose motion is computed as it is drawn
        refused = {"ax": ax, "at": at, "variable": variable, "xlim": xlim, "ylim": ylim, "size": size}
        refused |= {
            "points": points,
            "dpi": dpi,
            "windows": windows,
            "over": over,
            "relative": relative or None,
            "output": output,
        }
        for name, value in refused.items():
            if value is not None:
                raise PlotError(
                    f"{name}: of an orbit `width`, `kind` and `units` are the only options; the Figure has more"
                )
        if getattr(data, "_solution", data) is None:
            raise PlotError(not_allowed("data", data, "an orbit that has a motion: this one was not found"))
        return data.plot(width=width, kind=kind, units=units)
    check_type("kind", kind, (str, NoneType), "the name of a kind of picture, or None")
    if ax is not None and not isinstance(ax, Axes):
        raise ArgumentTypeError(not_allowed("ax", ax, "matplotlib axes"))
    options = PlotOptions(at, variable, xlim, ylim, size, dpi, windows, over, relative, width, units, points)
    source = data_of("data", data)  # last: the Dataset of a branch takes longer than all checks
    inputs = [read for read in (source, *options.beside) if isinstance(read, Path)]
    place = None if output is None else file_to_write("output", output)
    if place is not None:
        kind = check_suffix(place, kind)
        check_output(place, checked_flag("overwrite", overwrite), inputs)
    ((_, figure),) = _figures(source, None if kind == "all" else kind, options, ax)
    if place is not None:
        save(figure, place, overwrite, inputs)
    return figure if ax is None else ax


def kinds(data: "str | Path | xarray.Dataset") -> list[str]:
    """Kinds of picture that a file, or a Dataset, can show, the default one first; empty where it has nothing to show.

    Raises `PlotError` where it is not one of vibro-sweep's.
    """
    with DrawnSweep(data, PlotOptions()) as result:
        return _kinds(result)


def write_pictures(
    path: Path, output: Path | None = None, kind: str | None = None, overwrite: bool = False, **options: Any
) -> list[Path]:
    """Write pictures of a file, with the options of `plot`; the paths written.

    `output` is FILE.png in the current folder unless given; its suffix is the format. `kind` may be "all": then each
    goes to its own file, named FILE-kind, and so do, by default, pictures of single orbits, which `at` asks for.
    Raises `PlotError` for a file, a kind or an output that will not do, and without `overwrite` for an output that
    exists, unless it is a picture that this function drew and nobody has changed since.
    """
    chosen = PlotOptions(**options)
    named_by_kind = kind == "all" or (output is None and bool(chosen.at))
    output = Path(default_name(path)) if output is None else output
    kind = check_suffix(output, kind)
    inputs = [path, *(read for read in chosen.beside if isinstance(read, Path))]

    def place(name: str) -> Path:
        return output.with_stem(f"{output.stem}-{name}") if named_by_kind and name else output

    def check(names: list[str]) -> None:  # before the work of drawing
        for name in names:
            check_output(place(name), overwrite, inputs)

    return [save(figure, place(name), overwrite, inputs) for name, figure in _figures(path, kind, chosen, None, check)]


def _figures(
    data: "Path | xarray.Dataset",
    kind: str | None,
    options: PlotOptions,
    ax: Axes | None = None,
    check: Callable[[list[str]], None] = lambda names: None,
) -> Iterator[tuple[str, Figure]]:
    """The pictures that are asked for, each with the name of its kind; those of branches and curves have none.

    check : is called with all names before the first is drawn
    """
    data, holds = readable(data)
    if holds is not None:
        _check_ragged(data, holds, kind, options)
        check([""])
        chart = charts.chart(data, options) if holds == CHART else nullcontext(branch_diagram.branches(data, options))
        with chart as panels:
            axes = options.draw(panels, ax)
            check_drawn(options.points, axes, panels.measurable)
            yield "", axes[0].figure
        return
    with DrawnSweep(data, options) as result, matplotlib.rc_context(options.style):
        chosen = _chosen(result, kind)
        check(chosen)
        for name in chosen:
            axes = options.draw(KINDS[name].panels(result), ax)
            check_drawn(options.points, axes, (*result.sweep, *result.measurable))
            for panel in axes if result.failed else ():
                text = "all points failed; `vibro-sweep info` says how"
                panel.text(0.5, 0.55, text, transform=panel.transAxes, ha="center")
            yield name, axes[0].figure


def check_suffix(output: Path, kind: str | None) -> str | None:
    """The kind of picture for an output: a film where its suffix is that of one. Raises PlotError for any other."""
    suffix = output.suffix.lower()
    if suffix in FILMS and kind in (None, "film"):
        return "film"
    if suffix not in SUFFIXES:
        allowed = (*SUFFIXES, *(f"{ending} for a film" for ending in FILMS))
        raise PlotError(f"output {output}: the suffix is the format and must be one of {', '.join(allowed)}")
    return kind


def _check_ragged(path, holds: str, kind: str | None, options: PlotOptions) -> None:
    """Refuse what belongs to pictures of sweeps."""
    chosen = {"kind": kind not in (None, "all"), "at": options.at, "windows": options.windows}
    chosen |= {} if holds == CHART else {"relative": options.relative}
    for name, value in chosen.items():
        if value:
            raise PlotError(f"{name}: does not belong to {holds}, which {name_of(path)} holds")


def _kinds(result: DrawnSweep) -> list[str]:
    """The kinds that the data can show, first the picture that the scene names."""
    if not result.done.any():
        return []
    able = [name for name, kind in KINDS.items() if kind.shows(result)]
    first = result.settings.get("picture") or ("poincare" if not result.sweep and "phase" in result else None)
    return sorted(able, key=lambda name: name != first)


def _chosen(result: DrawnSweep, kind: str | None) -> list[str]:
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
