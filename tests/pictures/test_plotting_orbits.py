"""Pictures of orbits: the figure holds the file's numbers."""

import itertools

import numpy as np
import pytest
from support.pictures import drawn, write

from vibro_sweep import plotting


def test_a_portrait_has_the_impacts_and_section_points_of_the_file(trajectory):
    ax = plotting.figure(trajectory).axes[0]
    x, v = ax.lines[0].get_data()
    assert len(x) == 41 + 3 * 4 and np.isnan(x).sum() == 4
    assert np.nanmax(x) == 2 and np.nanmin(x) == -2  # up to the walls, between the samples
    across = np.abs(np.diff(v)) > 0.1
    assert not across.any()  # NaN compares false: no line from one side of a jump to the other
    jumps = [line for line in ax.lines if line.get_label() == "impact"]
    assert [line.get_xdata()[0] for line in jumps] == [2, -2, 2, -2]
    assert [list(line.get_ydata()) for line in jumps] == [[1, -1], [-1, 1], [1, -1], [-1, 1]]
    walls = [line.get_xdata()[0] for line in ax.lines if line.get_transform() == ax.get_xaxis_transform()]
    assert sorted(walls) == [-2, 2]
    (section,) = (line for line in ax.lines if line.get_label() == r"$t = 0$ mod $T$")
    assert section.get_xdata().tolist() == [0, 0, 0] and section.get_ydata().tolist() == [1, 1, 1]


def test_a_portrait_says_which_way_time_goes(trajectory):
    for kind in ("phase-portrait", "configuration"):
        fig = plotting.figure(trajectory, kind)
        (ax,) = fig.axes
        steps = [list(pair) for pair in itertools.pairwise(ax.lines[0].get_xydata().tolist())]
        arrows = [text for text in ax.texts if text.get_gid() == "time"]
        assert len(arrows) == 4
        for arrow in arrows:
            assert [list(arrow.xyann), list(arrow.xy)] in steps
        named = [text.get_text() for text in fig.legends[0].get_texts()]
        assert {"direction of time", "right stop, $x_1 = b$", "left stop, $x_1 = -b$"} <= set(named)


def test_a_history_reaches_the_stops_and_counts_forcing_periods(trajectory):
    ax = plotting.figure(trajectory, "history").axes[0]
    lines = {line.get_label(): line for line in ax.lines}
    assert lines["$x_1$"].get_xdata()[-1] == pytest.approx(2)
    assert np.nanmax(np.abs(lines["$x_1$"].get_ydata())) == 2
    assert len(lines["$x_2$"].get_xdata()) == 41 + 2 * 4
    assert lines["right stop, $x_1 = b$"].get_ydata()[0] == 2 and lines["left stop, $x_1 = -b$"].get_ydata()[0] == -2
    assert "forcing periods" in ax.get_xlabel()


def test_a_sweep_shows_four_orbits_and_both_branches_side_by_side(tmp_path, sweep, branches):
    titles = [ax.get_title() for ax in plotting.figure(sweep, "iteration").axes]
    assert titles == [f"$b = {value:.6g}$" for value in np.linspace(6.5, 6.9, 40)[[0, 13, 26, 39]]]
    titles = [ax.get_title() for ax in plotting.figure(branches, "iteration").axes]
    assert titles == ["$b = 6.6$, up", "$b = 6.6$, down", "$b = 6.8$, up", "$b = 6.8$, down"]


def test_iteration_of_a_fixed_point_does_not_show_rounding(tmp_path):
    x1 = 6.7 + 1e-15 * np.arange(20)
    ax = plotting.figure(write(tmp_path / "f.h5", {}, {"x1": x1})).axes[0]
    low, high = ax.get_ylim()
    assert high - low > 1e-3
    np.testing.assert_array_equal(drawn(ax)[:, 1], x1)
    assert "300 periods" in ax.get_xlabel()


def test_configuration_shows_both_displacements(trajectory):
    ax = plotting.figure(trajectory, "configuration").axes[0]
    x1, x2 = ax.lines[0].get_data()
    assert len(x1) == 41 + 2 * 4
    np.testing.assert_array_equal(x2, x1 / 2)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$x_1$", "$x_2$")


def test_convergence_ends_at_the_exponents(tmp_path):
    running = np.array([0.01, -0.02, -0.05, -0.1]) + np.random.default_rng(0).normal(size=(50, 4)) / 1000
    quantities = {"lyapunov_running": running, "lyapunov": running[-1], "lyapunov_error": np.full(4, 0.002)}
    ax, spectrum = plotting.figure(write(tmp_path / "c.h5", {}, quantities)).axes
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), running[:, 0])
    assert ax.lines[1].get_ydata()[0] == running[-1, 0]
    assert ax.get_title().endswith(r"\pm 4 \times 10^{-3}$")
    assert "± 2 standard errors" in [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert len(spectrum.lines) == 8
