"""`vibro_sweep.plot`: a picture for a notebook or a script."""

import math
from collections.abc import Mapping
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any, overload

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibro_sweep.checks.arguments import check_type, checked_flag, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import checked_path, file_to_write
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.plotting import PlotError, PlotOptions, check_suffix, figure
from vibro_sweep.plotting.pictures import check_output, save
from vibro_sweep.tables.picture_kinds import Plottable

if TYPE_CHECKING:
    import xarray

A_FILE = "the path of a file, a Dataset, a branch, a curve or windows"


@overload
def plot(
    data: "str | Path | xarray.Dataset | Plottable", kind: str | None = None, ax: None = None, **options: Any
) -> Figure: ...


@overload
def plot(
    data: "str | Path | xarray.Dataset | Plottable", kind: str | None = None, ax: Axes = ..., **options: Any
) -> Figure | None: ...


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
    output: str | Path | None = None,
    overwrite: bool = False,
) -> Figure | None:
    """A picture of a file, of a Dataset of `vibro_sweep.open` or `vibro_sweep.sweep`, or of a result: an orbit, a
    branch, a curve or windows; a matplotlib Figure. Of an orbit `width` is an option, and `kind` "contact-force".

    A notebook shows it as the value of a cell. In axes of pyplot, which shows them itself, it is not returned too.
    Options have the names that they have on the command line.

    kind : by default the first that the data can show
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
    output : FILE.png, .svg or .pdf, to which the picture is written as well; .gif or .mp4 of a film
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
    if _is_result(data) and hasattr(data, "sample"):  # an orbit, whose motion is computed as it is drawn
        given = {"ax": ax, "at": at, "variable": variable, "xlim": xlim, "ylim": ylim, "size": size}
        given |= {"dpi": dpi, "windows": windows, "over": over, "relative": relative or None, "output": output}
        for name, value in given.items():
            if value is not None:
                raise PlotError(f"{name}: of an orbit `width` and `kind` are the only options; the Figure has more")
        return data.plot(width=width, kind=kind)
    check_type("kind", kind, (str, NoneType), "the name of a kind of picture, or None")
    check_type("variable", variable, (str, NoneType), "the name of a variable, or None")
    check_type("at", at, (Mapping, NoneType), "a mapping from names of swept numbers to values, or None")
    chosen = {}
    for name, value in (at or {}).items():
        check_type("at", name, str, "of names of swept numbers")
        chosen[name] = number_of(value)
        if chosen[name] is None or not math.isfinite(chosen[name]):
            raise PlotError(not_allowed(f"at.{name}", value, "a finite number"))
    if ax is not None and not (size is None and dpi is None):
        raise PlotError("size and dpi: are those of a new figure; leave them out where `ax` is given")
    limits = [_pair(name, pair) for name, pair in (("xlim", xlim), ("ylim", ylim), ("size", size))]
    if dpi is not None and number_of(dpi) is None:
        raise PlotError(not_allowed("dpi", dpi, "a number of pixels an inch"))
    beside = [None if given is None else _data(name, given) for name, given in (("windows", windows), ("over", over))]
    options = PlotOptions(chosen, variable, *limits, number_of(dpi), *beside, checked_flag("relative", relative), width)
    data = _data("data", data)  # last: the Dataset of a branch takes longer than all checks
    inputs = [Path(one) for one in (data, *beside) if isinstance(one, (str, Path))]
    place = None if output is None else file_to_write("output", output)
    if place is not None:
        kind = check_suffix(place, kind)
        check_output(place, checked_flag("overwrite", overwrite), inputs)
    drawn = figure(data, kind, options, ax)
    if place is not None:
        save(drawn, place, overwrite, inputs)
    return None if ax is not None and drawn.canvas.manager is not None else drawn


def _is_result(given) -> bool:
    return type(given).__module__.startswith("vibro_sweep.analysis")


def _data(name: str, given) -> "Path | xarray.Dataset":
    if isinstance(given, (str, Path)):
        return checked_path(name, given)
    from xarray import Dataset  # it is imported already where it is one

    try:
        data = given.to_xarray() if _is_result(given) and hasattr(given, "to_xarray") else given
    except ArgumentError as error:
        raise PlotError(f"{name}: {error}") from None
    check_type(name, data, Dataset, A_FILE)
    return data


def _pair(name: str, given) -> tuple[float, float] | None:
    values = None if given is None else array_of(given, 1)
    if given is not None and (values is None or values.shape != (2,)):
        raise PlotError(not_allowed(name, given, "two numbers"))
    return None if values is None else (float(values[0]), float(values[1]))
