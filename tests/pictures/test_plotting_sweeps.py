"""Pictures over one parameter: the figure holds the file's numbers."""

import h5py
import numpy as np
import pytest
from matplotlib.colors import LogNorm
from support.pictures import SETTINGS, drawn, exponents, image, write

from vibro_sweep import plotting
from vibro_sweep.plotting import density, sweeps
from vibro_sweep.plotting.style import BRANCHES, INK, edges, equation


def test_bifurcation_shows_every_point_over_the_spectrum(sweep):
    section, spectrum, impacts = plotting.figure(sweep).axes
    with h5py.File(sweep) as file:
        expected = np.column_stack([np.repeat(file["b"], 20), np.ravel(file["x1"])])
    np.testing.assert_array_equal(drawn(section), expected)
    assert section.lines[0].get_rasterized()
    assert section.get_shared_x_axes().joined(section, spectrum)
    assert section.get_shared_x_axes().joined(section, impacts)
    assert (section.get_ylabel(), spectrum.get_ylabel()) == (
        r"$x_1$ at $t = 0$ mod $T$",
        r"$\lambda_i$ per unit of $t$",
    )
    assert impacts.get_xlabel() == "clearance $b$"
    assert r"\mu_m = 10" in section.figure.get_suptitle()
    assert "b =" not in section.figure.get_suptitle()  # it is swept


def test_spectrum_has_a_zero_line_names_and_a_tint_where_chaotic(sweep):
    ax = plotting.figure(sweep, "lyapunov").axes[0]
    curves = {line.get_label(): line.get_ydata() for line in ax.lines}
    np.testing.assert_array_equal(curves[r"$\lambda_1$"], exponents(40)[:, 0])
    np.testing.assert_array_equal(curves[r"$\lambda_4$"], exponents(40)[:, 3])
    assert any(np.all(np.asarray(line.get_ydata()) == 0) for line in ax.lines)
    assert [text.get_text() for text in ax.texts] == [rf"$\lambda_{i}$" for i in (1, 2, 3, 4)]
    (tint,) = (artist for artist in ax.collections if artist.get_gid() == "chaos")
    (path,) = tint.get_paths()  # ten neighbours
    assert [text.get_text() for text in ax.figure.legends[0].get_texts()] == [r"$\lambda_1$ > 0: chaos"]
    borders = edges(np.linspace(6.5, 6.9, 40))
    assert (path.vertices[:, 0].min(), path.vertices[:, 0].max()) == pytest.approx((borders[30], borders[40]))


def test_lost_directions_leave_a_gap_and_do_not_stretch_the_axis(tmp_path):
    spectrum = exponents(30)
    spectrum[:, 2:] = -np.inf
    file = write(tmp_path / "stick.h5", {"b": np.linspace(1, 2, 30)}, {"lyapunov": spectrum})
    fig = plotting.figure(file)
    fig.draw_without_rendering()
    assert -0.03 < fig.axes[0].get_ylim()[0] < -0.02


def test_impacts_are_counted_by_forcing_period(sweep):
    ax = plotting.figure(sweep, "impacts").axes[0]
    curves = {line.get_label(): line.get_ydata() for line in ax.lines}
    assert np.all(curves["right"] == 10 / 20)
    assert np.all(curves["left"] == 5 / 20)


def test_an_impact_section_shows_velocities_and_skips_missing_samples(tmp_path):
    v1 = np.full((5, 4), np.nan)
    v1[2:, :2] = 1.5
    quantities = {"x1": v1 * 0 + 3, "v1": v1, "phase": v1 * 0}
    settings = SETTINGS | dict(section="impact", section_stop="left")
    file = write(tmp_path / "impact.h5", {"omega": np.linspace(0.5, 0.6, 5)}, quantities, settings=settings)
    ax = plotting.figure(file).axes[0]
    assert drawn(ax).shape == (6, 2)
    assert ax.get_ylabel() == "$v_1$ before impact, left stop"
    assert ax.get_xlabel() == r"forcing frequency $\omega$"


def test_a_downward_sweep_is_drawn_upwards(tmp_path):
    b = np.linspace(3, 1, 5)
    file = write(tmp_path / "down.h5", {"b": b}, {"x1": b[:, None] / 2, "lyapunov": exponents(5)})
    section, spectrum = plotting.figure(file).axes
    np.testing.assert_array_equal(drawn(section), np.column_stack([b, b / 2])[::-1])
    low, high = spectrum.get_xlim()
    assert low < 1
    assert 3 < high


def test_many_points_become_a_density_that_counts_them_all(tmp_path, monkeypatch):
    monkeypatch.setattr(sweeps, "MANY", 1000)
    rng = np.random.default_rng(1)
    x1 = rng.normal(size=(3000, 4))
    x1[7] = np.nan
    file = write(tmp_path / "many.h5", {"R": np.linspace(0, 1, 3000)}, {"x1": x1})
    ax = plotting.figure(file).axes[0]
    picture = image(ax)
    assert isinstance(picture.norm, LogNorm)
    assert picture.get_array().sum() == 2999 * 4
    assert picture.get_array().shape == (
        density.ROWS,
        1000,
    )  # three values a column: never two in some, three in others
    assert not any(line.get_linestyle() == "None" for line in ax.lines)


def test_density_puts_points_where_they_are():
    points = np.array([[0.0, 0.0], [1.0, np.nan], [0.5, 1.0]])
    cells = density.counts(points, 0, 1, group=1)
    assert cells.sum() == 5
    assert (cells[0, 0], cells[-1, 1], cells[-1, 2], cells[density.ROWS // 2, 2]) == (2, 1, 1, 1)


@pytest.fixture
def window(tmp_path, monkeypatch):
    """30 values: chaos, then an orbit of period 3 whose branches cross, then one of period 1 far away; and a jump."""
    monkeypatch.setattr(sweeps, "MANY", 100)
    b = np.linspace(1, 4, 30)
    x1 = np.random.default_rng(0).uniform(0, 1, (30, 12))
    period = np.zeros(30, int)
    period[10:20], period[20:] = 3, 1
    t = np.linspace(0, 0.1, 10)
    x1[10:20] = np.tile(np.stack([t + 0.2, 0.3 - t, 0.5 + t], axis=1), 4)
    x1[20:25], x1[25:] = 0.9, 0.1
    return write(tmp_path / "window.h5", {"b": b}, {"x1": x1, "period": period})


def test_periodic_orbits_are_lines_in_a_density(window):
    ax = plotting.figure(window).axes[0]
    borders = edges(np.linspace(1, 4, 30))
    assert image(ax).get_array().sum() == 10 * 12  # the cells have chaos alone
    one, three = (line.get_xydata() for line in ax.lines if line.get_gid() == "periodic")
    gaps = np.isnan(one[:, 0])
    assert gaps.sum() == 2 and one[0].tolist() == [borders[20], 0.9]  # the jump is none of a branch
    (first,) = np.flatnonzero(gaps[:-1])
    assert one[first - 1].tolist() == [borders[25], 0.9] and one[first + 1].tolist() == [borders[25], 0.1]
    branches = np.split(three, np.flatnonzero(np.isnan(three[:, 0])) + 1)[:3]
    for branch in branches:
        assert (branch[0, 0], branch[-2, 0]) == (borders[10], borders[20])
        assert np.abs(np.diff(branch[:-1, 1])).max() < 0.02  # from point to point, never to another branch
    colours = [line.get_color() for line in ax.lines if line.get_gid() == "periodic"]
    norm, colour = image(ax).norm, image(ax).cmap
    assert colours == [colour(norm(12)), colour(norm(4))]  # by the points at each place
    named = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert named == ["line: periodic orbit"]


def test_lines_do_not_break_in_a_part_of_the_picture(window):
    """Branches that move far across a narrow range of the axis are branches still."""
    ax = plotting.figure(window, options=plotting.PlotOptions(ylim=(0.2, 0.25))).axes[0]
    three = [line.get_xydata() for line in ax.lines if line.get_gid() == "periodic"][1]
    assert np.isnan(three[:, 0]).sum() == 3


def test_values_that_share_a_column_are_a_line_only_where_all_repeat(window, monkeypatch):
    monkeypatch.setattr(density, "COLUMNS", 10)  # of three values each
    monkeypatch.setattr(density, "REACH", 0.1)
    ax = plotting.figure(window).axes[0]
    assert image(ax).get_array().sum() == 12 * (9 + 3 + 3)  # chaos; the columns of both ends of period 3
    _, three = (line.get_xydata() for line in ax.lines if line.get_gid() == "periodic")
    borders = edges(np.linspace(1, 4, 30))
    assert len(three[np.isnan(three[:, 0])]) == 3  # one line a branch
    assert (np.nanmin(three[:, 0]), np.nanmax(three[:, 0])) == (borders[12], borders[18])


def test_branches_that_agree_are_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(sweeps, "MANY", 100)
    x1 = np.zeros((40, 2, 10))
    x1[:20, 0] = 1  # up: 1, then 0; down: 0 throughout
    coordinates = {"b": np.linspace(1, 2, 40), "start": np.array([b"up", b"down"], dtype=object)}
    quantities = {"x1": x1, "period": np.ones((40, 2), int)}
    ax = plotting.figure(write(tmp_path / "dense.h5", coordinates, quantities)).axes[0]
    up, down, both = (line for line in ax.lines if line.get_gid() == "periodic")
    assert np.nanmin(up.get_ydata()) == 1 and np.nanmax(down.get_ydata()) == np.nanmax(both.get_ydata()) == 0
    assert np.nanmax(up.get_xdata()) == np.nanmax(down.get_xdata()) == np.nanmin(both.get_xdata())
    assert [line.get_color() for line in (up, down, both)] == [*BRANCHES.values(), INK]


def test_periods_of_impacts_are_counted_in_impacts(tmp_path, monkeypatch):
    """Two impacts in five forcing periods, of which 20 are recorded; above, more than there is room for."""
    monkeypatch.setattr(sweeps, "MANY", 10)
    v1 = np.full((6, 20), np.nan)
    v1[:3, :8] = np.tile([1.0, 2.0], 4)
    v1[3:] = np.tile([1.0, 2.0], 10)
    quantities = {"v1": v1, "phase": v1 * 0, "period": np.full(6, 5)}
    settings = SETTINGS | dict(section="impact", section_stop="right")
    ax = plotting.figure(write(tmp_path / "i.h5", {"b": np.arange(6.0)}, quantities, settings=settings)).axes[0]
    (line,) = (line for line in ax.lines if line.get_gid() == "periodic")
    assert set(line.get_ydata()[np.isfinite(line.get_ydata())]) == {1.0, 2.0}
    assert np.nanmax(line.get_xdata()) == 2.5 and image(ax).get_array().sum() == 60


def test_both_stops_are_named(tmp_path):
    b = np.linspace(1, 2, 5)
    ax = plotting.figure(write(tmp_path / "s.h5", {"b": b}, {"x1": np.stack([-1.5 * b, 1.5 * b], axis=1)})).axes[0]
    named = {text.get_text() for text in ax.get_legend().get_texts()}
    assert {"right stop, $x_1 = b$", "left stop, $x_1 = -b$"} == named
    right, left = (line for line in ax.lines if line.get_gid() == "stop")
    assert right.get_linestyle() != left.get_linestyle() and np.array_equal(left.get_ydata(), -b)


def test_branches_are_told_apart(branches):
    section, spectrum = plotting.figure(branches).axes
    labels = [text.get_text() for text in section.get_legend().get_texts()]
    assert labels == ["grazing, $b^*$", "up \N{RIGHTWARDS ARROW}", "\N{LEFTWARDS ARROW} down"]
    up, down = section.lines[:2]
    assert len(up.get_xdata()) == len(down.get_xdata()) == 30 * 20
    assert np.all(up.get_ydata() - down.get_ydata() == pytest.approx(1))
    assert up.get_markersize() > down.get_markersize()
    assert up.get_color() != down.get_color()
    curves = [line for line in spectrum.lines if line.get_gid() != "grazing"]
    assert [line.get_color() for line in curves[-2:]] == [up.get_color(), down.get_color()]
    assert spectrum.get_ylabel() == r"$\lambda_1$ per unit of $t$"


def test_dense_branches_are_dark_only_where_both_are(tmp_path, monkeypatch):
    monkeypatch.setattr(sweeps, "MANY", 100)
    x1 = np.zeros((40, 2, 10))
    x1[:20, 0] = 1  # up: 1, then 0; down: 0 throughout
    coordinates = {"b": np.linspace(1, 2, 40), "start": np.array([b"up", b"down"], dtype=object)}
    ax = plotting.figure(write(tmp_path / "dense.h5", coordinates, {"x1": x1})).axes[0]
    colours = image(ax).get_array()
    up, down, both = colours[-15:, 0].min(axis=0), colours[:15, 0].min(axis=0), colours[:15, -1].min(axis=0)
    assert up[2] > up[0]  # blue
    assert down[0] > down[2]  # orange
    np.testing.assert_allclose(both, up * down)
    assert np.all(colours[density.ROWS // 2] == 1)
    assert [text.get_text() for text in ax.get_legend().get_texts()][-1] == "both"


def test_several_starts_are_all_there(tmp_path):
    x1 = np.arange(3 * 4 * 5.0).reshape(3, 4, 5)
    file = write(tmp_path / "r.h5", {"b": np.arange(1.0, 4), "start": np.arange(4)}, {"x1": x1})
    fig = plotting.figure(file)
    assert np.array_equal(drawn(fig.axes[0])[:, 1], x1.ravel())
    assert "4 starts" in fig.get_suptitle()


def test_a_partial_file_shows_what_is_there(tmp_path):
    b = np.linspace(1, 2, 10)
    done = np.arange(10) < 4
    quantities = {"x1": np.ones((10, 3)), "lyapunov": np.zeros((10, 4)), "impacts_right": np.ones(10, int)}
    quantities["impacts_left"] = quantities["impacts_right"]
    file = write(tmp_path / "p.h5.part", {"b": b}, quantities, done=done)
    fig = plotting.figure(file)
    assert np.array_equal(np.unique(drawn(fig.axes[0])[:, 0]), b[:4])
    assert np.isfinite(fig.axes[2].lines[0].get_ydata()).sum() == 4
    assert "4 of 10 points computed" in fig.get_suptitle()


def test_one_value_and_no_section_points(tmp_path):
    file = write(tmp_path / "v.h5", {"b": [2.0]}, {"x1": np.full((1, 3), np.nan), "lyapunov": exponents(1)})
    section, spectrum = plotting.figure(file).axes
    assert section.texts[0].get_text() == "no section points"
    assert spectrum.get_xlim() == pytest.approx((1.9, 2.1))


def test_the_graze_is_marked_where_b_is_swept(sweep, tmp_path):
    marks = [
        line.get_xdata()[0] for ax in plotting.figure(sweep).axes for line in ax.lines if line.get_gid() == "grazing"
    ]
    assert marks == pytest.approx([6.70571674097302] * 3)
    quantities = {"x1": np.full((5, 4), 1.0)}
    other = plotting.figure(write(tmp_path / "R.h5", {"R": np.linspace(0, 1, 5)}, quantities)).axes[0]
    assert not any(line.get_gid() == "grazing" for line in other.lines)


def test_chaos_is_claimed_beyond_two_standard_errors(sweep):
    with h5py.File(sweep, "a") as file:
        error = file.create_dataset("lyapunov_error", data=np.full((40, 4), 0.003))  # lambda_1 = 0.004 where chaotic
        error.attrs["significant"] = 2.0
        for i, name in enumerate(("b", "exponent")):
            error.dims[i].attach_scale(file[name])
    ax = plotting.figure(sweep, "lyapunov").axes[0]
    assert [artist.get_gid() for artist in ax.collections] == ["error"] * 4  # no tint; a band for each exponent
    band = ax.collections[-1].get_paths()[0].vertices[:, 1]  # of lambda_1, which is drawn last
    assert band.max() == pytest.approx(0.004 + 2 * 0.003) and band.min() == pytest.approx(-0.01 - 2 * 0.003)
    named = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert named == ["exponent ± 2 standard errors"]


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0395285, "0.0395285"), (1e6, "10^{6}"), (-1e-5, "-10^{-5}"), (2.5e-7, r"2.5 \cdot 10^{-7}"), (0.0, "0")],
)
def test_powers_of_ten_in_a_title(value, text):
    assert equation("b", value) == f"$b = {text}$"


def test_lists_of_numbers_in_a_title(tmp_path):
    """One by one where one of them is swept; else "m = 8" would be the mass of all."""
    settings = {"type": "chain", "m1": 2.0, "m2": 8.0, "k1": 0.0, "k2": 2000.0, "k3": 1e4, "record": 3}
    quantities = {"x1": np.zeros((6, 3)), "lyapunov": exponents(6)}
    whole = write(tmp_path / "b.h5", {"b": np.arange(6.0)}, quantities, settings=settings)
    swept = write(tmp_path / "m.h5", {"m1": np.arange(1.0, 7.0)}, quantities, settings=settings)
    whole, swept = (plotting.figure(file).get_suptitle() for file in (whole, swept))
    assert "$m = 2, 8$, $k = 0, 2000, 10000$" in whole
    assert "$m_{2} = 8$" in swept and "$m =" not in swept and "$k = 0, 2000, 10000$" in swept
