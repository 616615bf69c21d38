"""Diagrams over one number hold the numbers of the data, as dots, or as a density where there are too many."""

import itertools

import numpy as np
import pytest
from matplotlib.colors import LogNorm
from support.figures import dots, entries, exponents, golden, image, made, many, marked, swept

import vibro_sweep as vs

UP, DOWN, INK = "#1f6fb4", "#e1570f", "#1a1a2e"  # the two ways along a sweep, and both


def borders_of(values):
    """Cells reach halfway to their neighbours."""
    middle = (values[1:] + values[:-1]) / 2
    return np.r_[2 * values[0] - middle[0], middle, 2 * values[-1] - middle[-1]]


def extents(artists, axis):
    return [tuple(getattr(artist.get_paths()[0].get_extents(), f"interval{axis}")) for artist in artists]


def test_a_diagram_shows_every_point_over_the_spectrum():
    data = swept()
    section, spectrum, impacts = vs.plot(data).axes
    np.testing.assert_array_equal(dots(section), np.column_stack([np.repeat(data.b, 20), np.ravel(data.x1)]))
    assert section.lines[0].get_rasterized()
    assert all(section.get_shared_x_axes().joined(section, ax) for ax in (spectrum, impacts))
    curves = {line.get_label(): line.get_ydata() for line in spectrum.lines}
    for i in range(4):
        np.testing.assert_array_equal(curves[rf"$\lambda_{i + 1}$"], data.lyapunov[:, i])
    (tint,) = marked(spectrum, "chaos")  # of ten neighbours
    edges = borders_of(data.b.values)
    assert len(tint.get_paths()) == 1 and extents([tint], "x") == [pytest.approx((edges[30], edges[40]))]
    assert any(np.all(np.asarray(line.get_ydata()) == 0) for line in spectrum.lines)
    grazes = [line.get_xdata()[0] for ax in (section, spectrum, impacts) for line in marked(ax, "grazing")]
    assert grazes == pytest.approx([6.70571674097302] * 3)
    counts = {line.get_label(): line.get_ydata() for line in impacts.lines}
    assert np.all(counts["right"] == 10 / 20) and np.all(counts["left"] == 5 / 20)  # in a forcing period


def test_bands_of_errors_are_two_of_them():
    error = ("b", "exponent"), np.full((40, 4), 0.003), {"significant": 2.0}
    (ax,) = vs.plot(swept().assign(lyapunov_error=error), "lyapunov").axes
    band = ax.collections[-1].get_paths()[0].vertices[:, 1]  # of the largest exponent, which is drawn last
    assert band.max() == pytest.approx(0.004 + 2 * 0.003) and band.min() == pytest.approx(-0.01 - 2 * 0.003)


def test_an_impact_section_skips_missing_samples():
    v1 = np.full((5, 4), np.nan)
    v1[2:, :2] = 1.5
    quantities = {"x1": v1 * 0 + 3, "v1": v1, "phase": v1 * 0}
    data = made({"omega": np.linspace(0.5, 0.6, 5)}, quantities, section="impact", section_stop="left")
    ax = vs.plot(data).axes[0]
    assert dots(ax).shape == (6, 2)
    assert (ax.get_xlabel(), ax.get_ylabel()) == (r"forcing frequency $\omega$", "$v_1$ before impact, left stop")


def test_falling_values_are_drawn_upwards():
    b = np.linspace(3, 1, 5)
    section, spectrum = vs.plot(made({"b": b}, {"x1": b[:, None] / 2, "lyapunov": exponents(5)})).axes
    np.testing.assert_array_equal(dots(section), np.column_stack([b, b / 2])[::-1])
    low, high = spectrum.get_xlim()
    assert low < 1 and 3 < high


def test_both_ways_are_told_apart():
    b = np.linspace(6.6, 6.8, 30)
    x1 = np.stack([np.tile(b[:, None], 20) - 1, np.tile(b[:, None], 20) - 2], axis=1)
    fig = vs.plot(made({"b": b, "start": ["up", "down"]}, {"x1": x1, "lyapunov": exponents(30, 2)}))
    section, spectrum = fig.axes
    assert [text.get_text() for text in section.get_legend().get_texts()] == ["grazing, $b^*$", "up →", "← down"]
    up, down = section.lines[:2]
    assert np.all(up.get_ydata() - down.get_ydata() == pytest.approx(1))
    assert len(up.get_xdata()) == len(down.get_xdata()) == 30 * 20
    assert up.get_markersize() > down.get_markersize() and up.get_color() != down.get_color()
    curves = [line for line in spectrum.lines if line.get_gid() != "grazing"]
    assert [line.get_color() for line in curves[-2:]] == [up.get_color(), down.get_color()] == [UP, DOWN]
    assert spectrum.get_ylabel() == r"$\lambda_1$ per unit of $t$"


def test_stops_differ():
    b = np.linspace(1, 2, 5)
    right, left = marked(vs.plot(made({"b": b}, {"x1": np.stack([-1.5 * b, 1.5 * b], axis=1)})).axes[0], "stop")
    assert right.get_linestyle() != left.get_linestyle() and np.array_equal(left.get_ydata(), -b)


def test_points_of_all_starts_are_there():
    x1 = np.arange(3 * 4 * 5.0).reshape(3, 4, 5)
    fig = vs.plot(made({"b": [1.0, 2, 3], "start": np.arange(4)}, {"x1": x1}))
    assert np.array_equal(dots(fig.axes[0])[:, 1], x1.ravel())


def test_a_part_of_a_run_shows_what_is_computed():
    b, done = np.linspace(1, 2, 10), np.arange(10) < 4
    quantities = {"x1": np.ones((10, 3)), "lyapunov": np.zeros((10, 4)), "impacts_right": np.ones(10, int)}
    quantities["impacts_left"] = quantities["impacts_right"]
    fig = vs.plot(made({"b": b}, quantities, done))
    assert np.array_equal(np.unique(dots(fig.axes[0])[:, 0]), b[:4])
    assert np.isfinite(fig.axes[2].lines[0].get_ydata()).sum() == 4


def test_lost_directions_leave_a_gap_and_strips_that_do_not_stretch_the_axis():
    spectrum = exponents(40)
    spectrum[10:20, 2:] = -np.inf
    spectrum[15:20] = -np.inf
    b = np.linspace(6.5, 6.9, 40)
    fig = vs.plot(made({"b": b}, {"lyapunov": spectrum}))
    (ax,), edges = fig.axes, borders_of(b)
    strips = marked(ax, "lost")
    assert extents(strips, "x") == [pytest.approx((edges[first], edges[20])) for first in (10, 10, 15, 15)]
    heights = extents(strips, "y")
    assert all(low[1] < high[0] for low, high in itertools.pairwise(heights))
    low, high = ax.get_ylim()
    assert low + heights[-1][1] * (high - low) < np.nanmin(spectrum[np.isfinite(spectrum)])  # below all curves
    assert any(r"-\infty" in text and "rest on a stop" in text for text in entries(fig))
    lost = exponents(30)
    lost[:, 2:] = -np.inf
    assert -0.03 < vs.plot(made({"b": np.linspace(1, 2, 30)}, {"lyapunov": lost})).axes[0].get_ylim()[0] < -0.02


def test_a_density_counts_all_points_where_they_are():
    x1 = np.random.default_rng(1).normal(size=(3000, 40))
    x1[7] = np.nan
    ax = vs.plot(made({"R": np.linspace(0, 1, 3000)}, {"x1": x1})).axes[0]
    picture = image(ax)
    cells, (low, high) = np.asarray(picture.get_array().filled(0)), picture.get_extent()[2:]
    assert isinstance(picture.norm, LogNorm) and not any(line.get_linestyle() == "None" for line in ax.lines)
    assert cells.shape == (450, 1000)  # three values a column: never two in some, three in others
    rows = np.minimum((x1 - low) / (high - low) * len(cells), len(cells) - 1)
    expected = np.zeros_like(cells)
    there = np.isfinite(x1)
    np.add.at(expected, (rows[there].astype(int), np.repeat(np.arange(1000), 120).reshape(x1.shape)[there]), 1)
    assert expected.sum() == 2999 * 40 and (cells != expected).sum() < 20  # but for points on the border of a cell
    np.testing.assert_array_equal(cells.sum(axis=0), expected.sum(axis=0))


def test_limits_are_those_asked_for():
    """And what is left to the picture fits what is in view."""
    data = swept()
    section, spectrum, impacts = vs.plot(data, xlim=(6.55, 6.65), ylim=(6, 6.5)).axes
    assert section.get_xlim() == impacts.get_xlim() == (6.55, 6.65) and section.get_ylim() == (6, 6.5)
    b = data.b.values
    assert {*dots(section)[:, 0]} == {*b[(b >= 6.55) & (b <= 6.65)]}
    lost = data.lyapunov.where(data.b < 6.8, 1000)  # beyond the limits
    spectrum = vs.plot(data.assign(lyapunov=lost), xlim=(6.55, 6.65)).axes[1]
    assert -0.2 < spectrum.get_ylim()[0] < spectrum.get_ylim()[1] < 1
    portraits = vs.plot(golden()["orbits"], "phase-portrait", xlim=(0, 7), ylim=(-1, 2)).axes
    assert [(ax.get_xlim(), ax.get_ylim()) for ax in portraits if ax.lines] == [((0, 7), (-1, 2))] * 3
    low, high = vs.plot(made({"b": [1.0, 2.0, 3.0]}, {"x1": [[np.nan], [1.0], [3.0]]})).axes[0].get_ylim()
    assert low < 1 and 3 < high < 3.2


def test_a_density_of_a_part_has_the_cells_of_its_limits():
    data = made({"b": np.linspace(1, 8, 3000)}, {"x1": np.random.default_rng(0).uniform(0, 1, (3000, 60))})
    ax = vs.plot(data, xlim=(2, 7), ylim=(0.05, 0.9)).axes[0]
    x1 = data.x1.sel(b=slice(2, 7))
    assert image(ax).get_array().sum() == ((x1 >= 0.05) & (x1 <= 0.9)).sum()
    assert tuple(image(ax).get_extent()[2:]) == (0.05, 0.9)


def test_dots_of_a_part_are_those_of_the_data_and_larger_where_they_are_few():
    assert image(vs.plot(many()).axes[0])
    parts = [{"xlim": (2, 2.5)}, {"ylim": (0.5, 0.52)}, {"xlim": (2, 5), "ylim": (0.1, 0.2)}, {"xlim": (2, 2.05)}]
    for part, least in zip(parts, (1.2, 1.2, 1.2, 2.5), strict=True):
        (ax,) = vs.plot(many(), **part).axes
        (line,) = (line for line in ax.lines if line.get_linestyle() == "None")
        assert not ax.images and line.get_markersize() >= least
    x1 = many().x1.sel(b=slice(2, 2.5))
    points = dots(vs.plot(many(), xlim=(2, 2.5)).axes[0])
    np.testing.assert_array_equal(points, np.column_stack([np.repeat(x1.b, 200), np.ravel(x1)]))


def test_dots_of_periodic_orbits_are_counted_once():
    x1, sizes = np.tile(np.random.default_rng(0).uniform(0, 1, (30, 4)), 50), []
    for period in (4, 0):
        ax = vs.plot(made({"b": np.linspace(1, 2, 30)}, {"x1": x1, "period": np.full(30, period)})).axes[0]
        sizes += [line.get_markersize() for line in ax.lines if line.get_linestyle() == "None"]
    assert sizes[0] > 1.5 * sizes[1]


def test_few_columns_of_many_points_are_a_density():
    x1 = np.random.default_rng(0).uniform(0, 1, (6, 5000))
    assert image(vs.plot(made({"b": np.arange(6.0)}, {"x1": x1})).axes[0]).get_array().shape[1] == 6


def window(b, samples, first, last):
    """Chaos, then an orbit of period 3 whose branches cross, then one of period 1 that jumps in its middle."""
    x1, n = np.random.default_rng(0).uniform(0, 1, (len(b), samples)), last - first
    t, jump = np.linspace(0, 0.1, n), (last + len(b)) // 2
    x1[first:last] = np.tile(np.stack([t + 0.2, 0.3 - t, 0.5 + t], axis=1), samples // 3)
    x1[last:jump], x1[jump:] = 0.9, 0.1
    period = np.r_[np.zeros(first, int), np.full(n, 3), np.ones(len(b) - last, int)]
    return made({"b": b}, {"x1": x1, "period": period})


def test_periodic_orbits_are_lines_in_a_density():
    b = np.linspace(1, 4, 30)
    fig = vs.plot(window(b, 480, 10, 20))
    ax, edges = fig.axes[0], borders_of(b)
    assert image(ax).get_array().sum() == 10 * 480  # the cells have chaos alone
    single, three = (line.get_xydata() for line in marked(ax, "periodic"))
    gaps = np.isnan(single[:, 0])
    assert gaps.sum() == 2 and single[0].tolist() == [edges[20], 0.9]  # the jump is none of a branch
    (first,) = np.flatnonzero(gaps[:-1])
    assert single[first - 1].tolist() == [edges[25], 0.9] and single[first + 1].tolist() == [edges[25], 0.1]
    for branch in np.split(three, np.flatnonzero(np.isnan(three[:, 0])) + 1)[:3]:
        assert (branch[0, 0], branch[-2, 0]) == (edges[10], edges[20])
        assert np.abs(np.diff(branch[:-1, 1])).max() < 0.02  # from point to point, never to another branch
    norm, colour = image(ax).norm, image(ax).cmap
    assert [line.get_color() for line in marked(ax, "periodic")] == [colour(norm(480)), colour(norm(160))]
    assert [text.get_text() for text in fig.legends[0].get_texts()] == ["line: periodic orbit"]


def test_lines_do_not_break_in_a_part_of_the_picture():
    """Branches that move far across a narrow range of the axis are branches still."""
    ax = vs.plot(window(np.linspace(1, 4, 90), 2400, 30, 60), ylim=(0.2, 0.25)).axes[0]
    _, three = (line.get_xydata() for line in marked(ax, "periodic"))
    assert np.isnan(three[:, 0]).sum() == 3


def test_values_that_share_a_column_are_a_line_only_where_all_repeat():
    """Three values a column, and both ends of the window within one."""
    b = np.linspace(1, 4, 3600)
    ax = vs.plot(window(b, 42, 1201, 2399)).axes[0]
    assert image(ax).get_array().sum() == 42 * (1200 + 3 + 3)  # chaos, and the columns of both ends
    (_, three), edges = (line.get_xydata() for line in marked(ax, "periodic")), borders_of(b)
    assert np.isnan(three[:, 0]).sum() == 3  # one line a branch
    assert (np.nanmin(three[:, 0]), np.nanmax(three[:, 0])) == (edges[1203], edges[2397])


def test_dense_ways_are_dark_only_where_both_are():
    x1 = np.zeros((40, 2, 40))
    x1[:20, 0] = 1  # up: 1, then 0; down: 0 throughout
    fig = vs.plot(made({"b": np.linspace(1, 2, 40), "start": ["up", "down"]}, {"x1": x1}))
    colours = np.asarray(image(fig.axes[0]).get_array())
    up, down, both = colours[-15:, 0].min(axis=0), colours[:15, 0].min(axis=0), colours[:15, -1].min(axis=0)
    assert up[2] > up[0] and down[0] > down[2]  # blue, orange
    np.testing.assert_allclose(both, up * down)
    assert np.all(colours[len(colours) // 2] == 1) and entries(fig)[-1] == "both"


def test_ways_that_agree_are_one_line():
    x1 = np.zeros((40, 2, 40))
    x1[:20, 0] = 1
    axes = {"b": np.linspace(1, 2, 40), "start": ["up", "down"]}
    ax = vs.plot(made(axes, {"x1": x1, "period": np.ones((40, 2), int)})).axes[0]
    up, down, both = marked(ax, "periodic")
    assert np.nanmin(up.get_ydata()) == 1 and np.nanmax(down.get_ydata()) == np.nanmax(both.get_ydata()) == 0
    assert np.nanmax(up.get_xdata()) == np.nanmax(down.get_xdata()) == np.nanmin(both.get_xdata())
    assert [line.get_color() for line in (up, down, both)] == [UP, DOWN, INK]


def test_periods_of_impacts_are_counted_in_impacts():
    """Two impacts in five forcing periods, of which 400 are recorded; above, more than there is room for."""
    v1 = np.tile([1.0, 2.0], (6, 200))
    v1[:3, 160:] = np.nan
    quantities = {"v1": v1, "phase": v1 * 0, "period": np.full(6, 5)}
    settings = {"section": "impact", "section_stop": "right", "record": 400}
    ax = vs.plot(made({"b": np.arange(6.0)}, quantities, **settings)).axes[0]
    (line,) = marked(ax, "periodic")
    assert set(line.get_ydata()[np.isfinite(line.get_ydata())]) == {1.0, 2.0}
    assert np.nanmax(line.get_xdata()) == 2.5 and image(ax).get_array().sum() == 3 * 400


def test_rests_are_tinted_where_they_are():
    b, counts = np.linspace(1, 2, 40), np.full(40, 20)
    quantities = {
        "impacts_right": counts,
        "impacts_left": counts,
        "sticking_time": np.where(np.arange(40) < 10, 0.5, 0),
    }
    (tint,) = marked(vs.plot(made({"b": b}, quantities), "impacts").axes[0], "rest")
    edges = borders_of(b)
    assert extents([tint], "x") == [pytest.approx((edges[0], edges[10]))]
