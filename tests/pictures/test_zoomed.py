"""Parts of diagrams, where few points are in view; and panels: what is lost, rests, decades, and nothing."""

import itertools

import numpy as np
import pytest
from support.pictures import SETTINGS, drawn, exponents, write

from vibro_sweep import plotting
from vibro_sweep.plotting import PlotOptions, branch_diagram, decades, style


def entries(fig):
    return [text.get_text() for legend in fig.legends for text in legend.get_texts()]


@pytest.fixture
def large(tmp_path):
    """700 values of 200 points: 140 000, of which every second value is periodic, of period 4."""
    x1 = np.random.default_rng(0).uniform(0, 1, (700, 200))
    x1[::2] = np.tile(x1[::2, :4], 50)
    period = np.where(np.arange(700) % 2, 0, 4)
    return write(tmp_path / "large.h5", {"b": np.linspace(1, 8, 700)}, {"x1": x1, "period": period})


def test_the_whole_is_a_density_and_a_part_of_few_points_is_dots(large):
    assert plotting.figure(large).axes[0].images
    for options in (
        PlotOptions(xlim=(2, 2.5)),
        PlotOptions(ylim=(0.5, 0.52)),
        PlotOptions(xlim=(2, 5), ylim=(0.1, 0.2)),
    ):
        ax = plotting.figure(large, options=options).axes[0]
        assert not ax.images
        (dots,) = (line for line in ax.lines if line.get_linestyle() == "None")
        assert dots.get_markersize() >= 1.2
    few = plotting.figure(large, options=PlotOptions(xlim=(2, 2.05))).axes[0]
    (dots,) = (line for line in few.lines if line.get_linestyle() == "None")
    assert dots.get_markersize() > 2.5


def test_dots_of_periodic_orbits_are_counted_once(tmp_path):
    x1 = np.tile(np.random.default_rng(0).uniform(0, 1, (30, 4)), 50)
    sizes = []
    for name, period in (("periodic", 4), ("other", 0)):
        quantities = {"x1": x1, "period": np.full(30, period)}
        ax = plotting.figure(write(tmp_path / f"{name}.h5", {"b": np.linspace(1, 2, 30)}, quantities)).axes[0]
        sizes += [line.get_markersize() for line in ax.lines if line.get_linestyle() == "None"]
    assert sizes[0] > 1.5 * sizes[1]


def test_columns_of_many_points_are_a_density_also_if_they_are_few(tmp_path):
    x1 = np.random.default_rng(0).uniform(0, 1, (6, 5000))
    ax = plotting.figure(write(tmp_path / "s.h5", {"b": np.arange(6.0)}, {"x1": x1})).axes[0]
    assert ax.images and ax.images[0].get_array().shape[1] == 6


def test_a_part_without_points_says_so(large):
    ax = plotting.figure(large, options=PlotOptions(ylim=(2, 3))).axes[0]
    assert [text.get_text() for text in ax.texts] == ["no section points"] and ax.get_ylim() == (2, 3)


def test_lost_exponents_are_strips_that_are_explained(tmp_path):
    spectrum = exponents(40)
    spectrum[10:20, 2:] = -np.inf
    spectrum[15:20] = -np.inf
    fig = plotting.figure(write(tmp_path / "s.h5", {"b": np.linspace(6.5, 6.9, 40)}, {"lyapunov": spectrum}))
    (ax,) = fig.axes
    strips = [one for one in ax.collections if one.get_gid() == "lost"]
    assert len(strips) == 4
    borders = style.edges(np.linspace(6.5, 6.9, 40))
    reached = [tuple(one.get_paths()[0].get_extents().intervalx) for one in strips]  # the last exponent first
    assert reached == [pytest.approx((borders[first], borders[20])) for first in (10, 10, 15, 15)]
    heights = [one.get_paths()[0].get_extents().intervaly for one in strips]
    assert all(low[1] < high[0] for low, high in itertools.pairwise(heights))
    low, high = ax.get_ylim()
    assert low + heights[-1][1] * (high - low) < np.nanmin(spectrum[np.isfinite(spectrum)])  # below all curves
    assert any(r"-\infty" in text and "rest on a stop" in text for text in entries(fig))
    fig = plotting.figure(write(tmp_path / "n.h5", {"b": np.linspace(6.5, 6.9, 40)}, {"lyapunov": exponents(40)}))
    assert not any("infty" in text for text in entries(fig))


def impacts(tmp_path, right, left, settings=SETTINGS, **more):
    values = {"impacts_right": right, "impacts_left": left, **more}
    b = np.linspace(1, 2, len(right))
    return plotting.figure(write(tmp_path / "i.h5", {"b": b}, values, settings=settings), "impacts")


def test_impacts_that_span_decades_have_a_logarithmic_axis(tmp_path):
    few, many = np.full(40, 20), np.full(40, 20)
    many[30:] = 20 * np.arange(10, 40, 3)
    ax = impacts(tmp_path, few, many).axes[0]
    assert ax.get_yscale() == "log" and ax.get_ylim()[0] < 1 and ax.get_ylim()[1] > 37
    assert [text.get_text() for text in ax.get_yticklabels()][:2] == ["1", "10"]
    few[:5] = 0
    ax = impacts(tmp_path, few, many).axes[0]
    assert ax.get_yscale() == "symlog" and ax.get_ylim()[0] == 0
    assert [text.get_text() for text in ax.get_yticklabels()][:2] == ["0", "1"]
    ax = impacts(tmp_path, few, np.full(40, 35)).axes[0]
    assert ax.get_yscale() == "linear" and ax.get_ylim()[0] == 0


def test_when_numbers_span_decades():
    assert decades.spans([1, 1, 1, 26]) and decades.spans([0, 1, 1, 1, 26, np.nan])
    assert not decades.spans([1, 2, 5]) and not decades.spans([0, 0]) and not decades.spans([-1, 1, 100])
    assert not decades.spans([0.005, 0.2, 0.3, 0.4, 1.0])  # a few small ones do not make the others illegible
    assert decades.norm([1, 2, 5]) is None
    for values in ([1, 1, 1, 26], [0, 1, 1, 1, 26]):
        place = decades.norm(np.array(values, float))
        assert place(1.0) < place(5.0) < place(26.0) == 1 and place(5.0) > 0.4


def test_planes_of_impacts_that_span_decades(tmp_path):
    counts = np.ones((10, 12), int)
    counts[:2, :2] = 5000
    coordinates = {"b": np.arange(10.0), "R": np.linspace(0, 1, 12)}
    fig = plotting.figure(write(tmp_path / "p.h5", coordinates, {"impacts_right": counts, "impacts_left": counts}))
    norm = fig.axes[0].images[0].norm
    assert norm(100.0) == pytest.approx(np.log(50) / np.log(5000))


def test_rests_are_tinted(tmp_path):
    counts, times = np.full(40, 20), np.where(np.arange(40) < 10, 0.5, 0)
    fig = impacts(tmp_path, counts, counts, sticking_time=times)
    (tint,) = (one for one in fig.axes[0].collections if one.get_gid() == "rest")
    borders = style.edges(np.linspace(1, 2, 40))
    assert tuple(tint.get_paths()[0].get_extents().intervalx) == pytest.approx((borders[0], borders[10]))
    assert "rests on a stop for a part of the time" in entries(fig)
    assert not impacts(tmp_path, counts, counts, sticking_time=0 * times).legends


def test_a_stop_that_is_not_there_has_no_curve(tmp_path):
    zero, counts = np.zeros(40, int), np.full(40, 20)
    ax = impacts(tmp_path, zero, counts, SETTINGS | {"stops": "left"}).axes[0]
    assert [line.get_label() for line in ax.lines] == ["left"] and [text.get_text() for text in ax.texts] == ["left"]


def test_panels_that_would_show_nothing_are_left_out(tmp_path):
    b, zero = np.linspace(7, 8, 30), np.zeros(30, int)
    energies = {"impact_power": np.zeros(30), "rms_x1": np.ones(30), "rms_x2": np.ones(30)}
    quantities = {"x1": np.ones((30, 20)), "lyapunov": exponents(30), "impacts_right": zero, "impacts_left": zero}
    file = write(tmp_path / "free.h5", {"b": b}, quantities | energies)
    fig = plotting.figure(file)
    assert len(fig.axes) == 2 and fig.get_suptitle().startswith("Bifurcation diagram; no impacts")
    fig = plotting.figure(file, "energy")
    assert len(fig.axes) == 1 and fig.get_suptitle().startswith("Energy; no impacts")
    assert "no impacts" in [text.get_text() for text in plotting.figure(file, "impacts").axes[0].texts]
    some = np.where(np.arange(30) < 10, 20, 0)
    file = write(tmp_path / "some.h5", {"b": b}, quantities | {"impacts_right": some})
    assert len(plotting.figure(file).axes) == 3
    assert len(plotting.figure(file, options=PlotOptions(xlim=(7.5, 8))).axes) == 2  # none in this part


def test_rests_of_a_motion_are_marked(tmp_path):
    """Eight samples a period, at rest on the right stop for three of them."""
    x1, v1 = np.array([0, 1, 2, 2, 2, 1, 0, -1, 0.0]), np.array([1, 1, 0, 0, 0, -1, -1, 0, 1.0])
    none = np.full(1, np.nan)
    quantities = {f"trajectory_{name}": values for name, values in (("x1", x1), ("v1", v1), ("x2", x1 / 2))}
    quantities |= {f"trajectory_impact_{name}": none for name in ("t_over_T", "v1", "v1_after", "x2")}
    quantities |= {"trajectory_impact_side": np.zeros(1, int), "trajectory_impacts": 0}
    file = write(tmp_path / "o.h5", {}, quantities, settings=SETTINGS | {"b": 2.0}, time=np.arange(9) / 8)
    for kind, expected in (("phase-portrait", 0.0), ("history", 2.0), ("configuration", 1.0)):
        fig = plotting.figure(file, kind)
        (rest,) = (line for line in fig.axes[0].lines if line.get_gid() == "rest")
        known = rest.get_ydata()[np.isfinite(rest.get_ydata())]
        assert known.tolist() == [expected] * 3 and "a rest on a stop" in entries(fig)


def test_dots_of_a_part_are_those_of_the_file(large):
    ax = plotting.figure(large, options=PlotOptions(xlim=(2, 2.5))).axes[0]
    points = drawn(ax)
    assert len(points) % 200 == 0 and points[:, 0].min() >= 2 and points[:, 0].max() <= 2.5


class Branches(dict):
    """Two branches along b = 0 .. 10, x1 = b and x1 = -b, as a file has them; both have the same fold at b = 0."""

    name, parameters, title = "made up", ["b"], "made up"

    def __init__(self):
        b = np.concatenate([np.linspace(0, 10, 40)] * 2)
        kinds = ("fold", "flip", "sticking", "fold", "nonsmooth_fold")
        points = np.array([0, 10, 39, 40, 79])
        arrays = {"b": b, "x1": np.where(np.arange(80) < 40, b, -b), "unstable": np.zeros(80, int)}
        arrays |= {"branch_period": np.ones(2, int), "branch_row_size": np.full(2, 40), "special_point": points}
        arrays |= {"special_value": b[points][:, None], "special_branch": np.array([0, 0, 0, 1, 1])}
        arrays |= {"branch_begins": np.array([0, 3]), "branch_ends": np.array([2, 4])}
        super().__init__(arrays)
        self.arrays, self.kinds = arrays, kinds

    def unit(self, _):
        return ""

    def types(self):
        return list(self.kinds)


def test_branches(monkeypatch):
    """Each point is named once, the onset of sticking has a line; of a part the axis and the legend are those of it."""
    monkeypatch.setattr(branch_diagram, "RaggedFile", lambda *_: Branches())
    fig = branch_diagram.branches("made up", PlotOptions())
    (ax,) = fig.axes
    assert sorted(text.get_text() for text in ax.texts) == ["GR", "LP", "PD", "ST"]
    (line,) = (line for line in ax.lines if line.get_gid() == "sticking")
    assert set(line.get_xdata()) == {10.0}
    assert len(entries(fig)) == 6
    fig = branch_diagram.branches("made up", PlotOptions(xlim=(-0.1, 3)))
    (ax,) = fig.axes
    assert 2.5 < ax.get_ylim()[1] < 3.5 and sorted(text.get_text() for text in ax.texts) == ["LP", "PD"]
    assert entries(fig)[2:] == ["LP fold", "PD flip"]
