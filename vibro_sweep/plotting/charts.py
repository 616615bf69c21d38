"""Files of bifurcation curves as charts in two parameters: alone, or over the plane of a sweep."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from vibro_sweep.checks.refusals import shown
from vibro_sweep.plotting import planes
from vibro_sweep.plotting.drawn_curves import Drawn, chart_of, draw, frame_of, handles, name_points
from vibro_sweep.plotting.drawn_sweep import DrawnSweep, PlotError
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.ragged import RaggedFile, in_units_of, sweep_below
from vibro_sweep.plotting.relative import axis_label, check_relative
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, CURVES
from vibro_sweep.tables.file_columns import CHART

NAMED = 14  # points of codimension two that are named over a plane


@contextmanager
def chart(path: str | Path, options: PlotOptions) -> Iterator[Panels]:
    """The chart of a file of curves, over a plane where the options name one, which is read while it is drawn. Raises
    PlotError."""
    options = in_units_of(options, path)
    file = RaggedFile(path, CHART, options.display)
    if not len(file["branch_type"]):
        raise PlotError(f"{file.name}: nothing to show, it has no curves")
    if options.over is not None:
        with DrawnSweep(sweep_below(options.over), options.replace(over=None)) as plane:
            yield _over(file, plane, options)
        return
    if options.variable is not None:
        raise PlotError(
            f"variable {shown(options.variable)} is not allowed; a chart has one where it lies over a plane"
        )
    names = file.parameters
    curves = drawn(file, names, options.relative)
    labels = [axis_label(name, options.relative, file.unit(name)) for name in names]
    units = [file.stored_unit(name) for name in names]
    yield chart_of(f"Bifurcation curves: {file.title}", 5.0, curves, names, labels, options, units)


def drawn(file: RaggedFile, names: list[str], relative: bool = False) -> list[Drawn]:
    """The curves of a file with these parameters as axes. relative: b in parts of the grazing clearance b*."""
    if relative:
        check_relative(file.name, names, file["b_star"])
    order = [file.parameters.index(name) for name in names]
    values = np.column_stack([file[name] for name in names])
    places = file["special_value"][:, order].copy()
    if relative:
        axis = names.index("b")
        values[:, axis] /= file["b_star"]
        places[:, axis] /= file["b_star"][file["special_point"]]
    periods = file["branch_period"].tolist()
    kinds = [CODIMENSION_TWO[code].name for code in file["special_type"].tolist()]
    ends = np.cumsum(file["branch_row_size"])
    result = []
    for i, (code, end) in enumerate(zip(file["branch_type"].tolist(), ends.tolist(), strict=True)):
        along = slice(end - int(file["branch_row_size"][i]), end)
        points_of_curve = np.flatnonzero(file["special_branch"] == i)
        special = [(kinds[s], *places[s].tolist()) for s in points_of_curve]
        virtual, bounds = file["status"][along] != 0, file["unstable"][along] == 0
        result.append(Drawn(CURVES[code], *values[along].T, virtual, special, bounds, periods[i]))
    return result


def _over(file: RaggedFile, result: DrawnSweep, options: PlotOptions) -> Panels:
    """Over the plane of a sweep in the same two numbers."""
    if sorted(result.sweep) != sorted(file.parameters) or not planes.shows(result):
        raise PlotError(f"over: {result.path} is not a plane over {' and '.join(file.parameters)}")
    if options.variable is not None and options.variable not in planes.variables(result):
        variables = ", ".join(planes.variables(result))
        raise PlotError(f"variable {shown(options.variable)} is not allowed; there are {variables}")
    curves = drawn(file, list(result.sweep), options.relative)

    def over(panel):
        frame = panel.get_xlim(), panel.get_ylim()
        draw(panel, curves, halo=True)
        panel.set(xlim=frame[0], ylim=frame[1])

    def named(panel):
        return name_points(panel, curves, NAMED)

    panels = planes.plane(result, planes.Overlay(over, lambda panel: handles(curves, frame_of(panel)), named))
    return panels._replace(measurable=tuple(result.sweep))
