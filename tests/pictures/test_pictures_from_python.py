"""Pictures of Datasets are those of their files, also in axes of the caller."""

import h5py
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from support import slow_cases
from support.figures import chart, kinds

import vibro_sweep as vs

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
SHORT = dict(transient=20, record=10)


def drawn(fig):
    canvas = FigureCanvasAgg(fig)
    canvas.draw()
    return np.array(canvas.buffer_rgba())


@pytest.mark.parametrize(
    "kind", ["bifurcation", *slow_cases("history", "lyapunov", "phase-portrait", "configuration", "iteration")]
)
def test_pictures_of_a_dataset_are_those_of_its_file(tmp_path, kind):
    orders = dict(trajectory={"periods": 2, "samples": 50}, start={"follow": "both"}, observe=["section", "lyapunov"])
    data = vs.sweep(SYSTEM, {"b": [6.5, 6.6, 6.7]}, output=tmp_path / "a.h5", **orders, **SHORT)
    assert kinds(data) == kinds(tmp_path / "a.h5")
    assert np.array_equal(drawn(vs.plot(data, kind)), drawn(vs.plot(tmp_path / "a.h5", kind)))
    assert np.array_equal(drawn(vs.plot(data.transpose(), kind)), drawn(vs.plot(data, kind)))


@pytest.fixture(scope="module")
def line():
    """A sweep with everything that a picture of one key can show."""
    orders = dict(trajectory={"periods": 2, "samples": 50}, observe=["section", "lyapunov", "impacts"])
    return vs.sweep(SYSTEM, {"b": [6.5, 6.55, 6.6]}, **orders, **SHORT)


def lines_of(ax):
    """Their points, also those that are NaN, byte for byte."""
    return [drawn.get_xydata().tobytes() for drawn in ax.lines]


@pytest.mark.parametrize(
    "kind", ["bifurcation", "phase-portrait", *slow_cases("lyapunov", "impacts", "configuration", "history")]
)
def test_a_picture_in_the_axes_of_the_caller(line, kind):
    fig = Figure()
    other, ax = fig.subplots(1, 2)
    at = None if kind in ("bifurcation", "lyapunov", "impacts") else {"b": 6.55}
    assert vs.plot(line, kind, ax=ax, at=at) is ax
    assert fig.axes == [other, ax] and not other.lines
    alone = vs.plot(line, kind, at=at).axes
    assert lines_of(ax) == lines_of(alone[0]) != []
    assert ax.get_title() and (ax.get_xlabel(), ax.get_ylabel()) == (alone[-1].get_xlabel(), alone[0].get_ylabel())
    assert len(drawn(fig))


@pytest.mark.slow
@pytest.mark.parametrize("variables", [["lyapunov", "section"], *slow_cases(["section"], ["impacts"])])
def test_a_plane_in_the_axes_of_the_caller(variables):
    data = vs.sweep(SYSTEM, {"b": [6.5, 6.6, 6.7], "R": [0.7, 0.8]}, observe=variables, **SHORT)
    ax = Figure().subplots()
    assert vs.plot(data, ax=ax) is ax
    assert np.array_equal(ax.images[0].get_array(), vs.plot(data).axes[0].images[0].get_array())


def test_a_figure_that_is_drawn_is_the_callers(line):
    """What is drawn into its axes afterwards has its legend in these, keeps their title, and the figure its size."""
    fig = vs.plot(line, "lyapunov", width=85)
    legends, size, title = list(fig.legends), fig.get_size_inches().tolist(), fig.axes[0].set_title("mine").get_text()
    curve = np.array([[6.5, 6.55, 6.6], [0.0, -0.01, -0.02]])
    assert vs.plot(chart(("graze", curve, 1)), ax=fig.axes[0]) is fig.axes[0]
    assert fig.legends == legends and fig.get_size_inches().tolist() == size
    assert fig.axes[0].get_legend() is not None and fig.axes[0].get_title() == title == "mine"


def test_curves_over_a_plane_leave_its_file_alone(tmp_path):
    plane = {"b": [6.5, 6.6], "omega": [0.62, 0.63]}
    vs.sweep(SYSTEM, plane, output=tmp_path / "plane.h5", observe=["lyapunov", "impacts"], **SHORT)
    figure = vs.plot(chart(("graze", np.array([*plane.values()]), 1)), over=tmp_path / "plane.h5")
    assert figure.axes[0].images
    with h5py.File(tmp_path / "plane.h5", "r+"):  # which fails while somebody reads it
        pass
