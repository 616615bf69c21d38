"""Texts of pictures: none covers another, and legends say what names, hatching and lines mean."""

import itertools

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from support.pictures import exponents, write

import vibro_sweep as vs
from vibro_sweep import plotting
from vibro_sweep.plotting import PlotOptions, drawn_curves, labels
from vibro_sweep.plotting.drawn_curves import Drawn, plot_curves
from vibro_sweep.plotting.style import STYLE, edges


def boxes(texts):
    return [text.get_window_extent() for text in texts if text.get_visible() and text.get_text()]


def overlaps(texts):
    return [(a, b) for a, b in itertools.combinations(boxes(texts), 2) if a.overlaps(b)]


def entries(fig):
    return [text.get_text() for legend in fig.legends for text in legend.get_texts()]


def bars(fig):
    return [ax for ax in fig.axes if ax.get_label() == "<colorbar>"]


def planes_of(rng, tmp_path, name, along=None):
    """A plane with regions of random periods, a few or many, and its periods (b, omega)."""
    shape, regions = rng.integers(20, 160, 2), rng.integers(5, 120)
    seeds, place = rng.uniform(0, 1, (regions, 2)), np.indices(shape).transpose(1, 2, 0) / shape
    nearest = np.linalg.norm(place[:, :, None] - seeds, axis=-1).argmin(axis=-1)
    period = rng.choice([*range(1, 20), *range(100, 120)], regions)[nearest]
    spectrum = np.full((*shape, 4), -0.1)
    spectrum[..., 0] = rng.choice([-0.0371, 0.0191], shape) * rng.uniform(0, 1, shape)
    coordinates = {"b": np.linspace(3, 9, shape[0]), "omega": np.linspace(0.58, 0.68, shape[1])}
    if along:
        along = {"b_star": ("omega", np.sort(rng.uniform(5, 8, shape[1])))}
    return write(tmp_path / name, coordinates, {"lyapunov": spectrum, "period": period}, along=along), period


def searched(rng, tmp_path, cases):
    """Draw random planes on random pages; how many numbers were written in them."""
    written = 0
    for case in range(cases):
        relative = case % 3 == 2
        file, period = planes_of(rng, tmp_path, f"{case}.h5", relative)
        size = tuple(rng.uniform((4, 3), (9, 6)))
        fig = plotting.figure(file, options=PlotOptions(size=size, relative=relative))
        fig.draw_without_rendering()
        for bar in bars(fig):
            assert not overlaps(bar.get_xticklabels())
        ax = next(ax for ax in fig.axes if any(text.get_gid() == "period" for text in ax.texts))
        texts = [text for text in ax.texts if text.get_gid() == "period"]
        assert not overlaps(texts)
        written += len(texts)
        for text in texts:
            digits = text.get_window_extent()
            high = 0.5 * text.get_fontsize() * fig.dpi / 72  # of the ink
            x = np.linspace(digits.x0, digits.x1, 9)
            y = (digits.y0 + digits.y1) / 2 + np.linspace(-high / 2, high / 2, 5)
            points = ax.transData.inverted().transform(np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2))
            assert set(period_at(file, points, relative, period)) == {int(text.get_text())}
    return written


def period_at(file, points, relative, period):
    """What a plane over b and omega has at points of its picture, by the nearest of its points."""
    with plotting.Result(file) as result:
        b, omega = result.sweep["b"], result.sweep["omega"]
        star = result.grazing("omega")["b_star"] if relative else np.ones(len(omega))
    x, y = points.T
    column = np.abs(omega[:, None] - y).argmin(axis=0)
    row = np.abs(b[:, None] - x * np.interp(y, edges(omega), edges(star))).argmin(axis=0)  # cells are quadrilaterals
    return period[row, column]


@pytest.mark.slow
def test_numbers_lie_in_their_regions(tmp_path):
    """On 4 random planes, one of them relative to a random b*."""
    assert searched(np.random.default_rng(0), tmp_path, 4) > 10


@pytest.mark.slow
def test_ticks_of_a_colour_bar():
    """Of bars with arrows at their ends, which take a part of their place: 0 is kept, and what else has room."""
    thinned = 0
    for width in np.linspace(2, 7, 8):
        fig = Figure(figsize=(width, 2), layout="constrained")
        ax = fig.subplots()
        image = ax.pcolorfast(np.zeros((3, 3)), vmin=-0.035, vmax=0.035)
        bar = fig.colorbar(image, ax=ax, location="bottom", extend="both", ticks=np.arange(-3, 4) / 100)
        labels.arrange(fig)
        labels.thin_ticks(bar)
        fig.draw_without_rendering()
        told = [label.get_text() for label in bar.ax.get_xticklabels()]
        assert not overlaps(bar.ax.get_xticklabels()) and 3 <= len(told) <= 7 and "0.00" in told
        thinned += len(told) < 7
    assert 2 < thinned < 7


def test_a_colour_bar_keeps_the_power_of_ten_of_its_ticks():
    fig = Figure(figsize=(2, 2), layout="constrained")
    ax = fig.subplots()
    image = ax.pcolorfast(np.zeros((3, 3)), vmin=-3.5e-6, vmax=3.5e-6)
    bar = fig.colorbar(image, ax=ax, location="bottom", ticks=np.arange(-35, 36, 5) * 1e-7)
    labels.arrange(fig)
    labels.thin_ticks(bar)
    fig.draw_without_rendering()
    assert len(bar.ax.get_xticks()) < 15 and bar.ax.xaxis.get_offset_text().get_text() == "1e\u22126"


def test_small_numbers_have_room_in_a_narrow_panel():
    """Of 0.00012 m zeros would be most of a label."""
    system = vs.Oscillator.named(
        "chain", m=[2, 8], k=[0, 2000, 10_000], c=[0, 5, 25], force=[0.3, 0], omega=26.0, R=0.7, b=0.00012, units="SI"
    )
    fig = vs.simulate(system, np.zeros(4), 20).plot(width=85)
    fig.draw_without_rendering()
    for ax in fig.axes:
        assert not overlaps(ax.get_xticklabels())
    assert fig.axes[0].xaxis.get_offset_text().get_text() == "1e\u22124"


@pytest.mark.slow
def test_names_cover_neither_each_other_nor_marks():
    """4 random crowds of marks."""
    rng, named, left_out = np.random.default_rng(0), 0, 0
    for _ in range(4):
        fig = Figure(figsize=rng.uniform(2, 5, 2), layout="constrained")
        ax = fig.subplots()
        places = rng.normal(size=(rng.integers(5, 150), 2)) * rng.choice([0.1, 1], (1, 2))
        names = rng.choice(["R1", "GRGR", "LPNS"], len(places)).tolist()
        ax.plot(*places.T, "o")
        labels.arrange(fig)
        corner = ax.transAxes.transform([(0, 0), (0.2, 0.2)])
        taken = labels.name_beside(ax, names, places, lines=places[:3], taken=[corner])
        fig.draw_without_rendering()
        texts = [text for text in ax.texts if text.get_gid() == "name"]
        assert len(texts) == len(taken) - 1 and not overlaps(texts)
        marks = ax.transData.transform(places)
        for box in boxes(texts):
            edge = 2.0 * fig.dpi / 72  # of a mark, of 4 points
            inside = (box.min - edge < marks) & (marks < box.max + edge)
            assert not inside.all(axis=1).any()
            assert ax.bbox.x0 - 1 <= box.x0 and box.x1 <= ax.bbox.x1 + 1
            assert not (box.x0 < corner[1, 0] - 1 and box.y0 < corner[1, 1] - 1)
        named, left_out = named + len(texts), left_out + len(places) - len(texts)
    assert named > 100 and left_out > 25


def test_a_legend_is_no_wider_than_the_page():
    handles = [Line2D([], [], label=f"a long text {i}") for i in range(9)]
    for width, height in ((3, 3), (5, 4), (9, 4)):
        fig = Figure(figsize=(width, height), layout="constrained")
        ax = fig.subplots()
        labels.legend_below(fig, handles, 9)
        labels.arrange(fig)
        (legend,) = fig.legends
        assert legend.get_window_extent().width <= fig.bbox.width
        assert ax.bbox.height > 0.3 * fig.bbox.height


def circle(kind, radius, period=1, special=()):
    t = np.linspace(0, 6, 50)
    special = [(name, radius * np.cos(t[at]), radius * np.sin(t[at])) for name, at in special]
    return Drawn(kind, radius * np.cos(t), radius * np.sin(t), np.zeros(50, bool), special, None, period)


def test_a_chart_says_what_its_names_mean():
    special = [("resonant_graze", 5), ("degenerate_flip", 20)], [("flip_neimark_sacker", 9), ("boundary", 0)]
    fig = plot_curves([circle("graze", 1, special=special[0]), circle("flip", 2, special=special[1])], ("b", "omega"))
    names = {text.get_text() for text in fig.axes[0].texts}
    assert names == {"RG", "GPD", "PDNS"}
    told = entries(fig)
    assert {"RG resonant graze", "GPD degenerate flip", "PDNS flip + Neimark-Sacker"} <= set(told)
    assert len(told) == 5


def test_curves_of_one_type_are_told_apart_by_their_periods():
    grazes = [circle("graze", radius, period) for radius, period in ((1, 8), (2, 8), (3, 1), (4, 13))]
    fig = plot_curves([*grazes, circle("neimark_sacker", 5)], ("b", "omega"))
    colours = [line.get_color() for line in fig.axes[0].lines if line.get_gid() == "curve"]
    assert colours[0] == colours[1] and len(set(colours)) == 4 and colours[-1] == drawn_curves.COLOURS["neimark_sacker"]
    assert set(entries(fig)) == {"graze, period 1", "graze, period 8", "graze, period 13", "Neimark-Sacker"}
    mixed = [circle("graze", 1, 1), circle("fold", 2, 8), circle("flip", 3, 13)]
    assert entries(plot_curves(mixed, ("b", "omega"))) == ["fold", "flip", "graze"]
    many = [circle("graze", radius, radius) for radius in range(1, 31)]
    told = entries(plot_curves(many, ("b", "omega")))
    assert len(told) == len(drawn_curves.ORBITS) + 1 and told[-1] == "graze, longer periods"


@pytest.mark.slow
def test_a_plane_says_what_its_hatching_means(tmp_path):
    rng = np.random.default_rng(3)
    file, _ = planes_of(rng, tmp_path, "p.h5", True)
    assert "outside of the sweep" in entries(plotting.figure(file, options=PlotOptions(relative=True)))
    assert not {"no number", "outside of the sweep"} & set(entries(plotting.figure(file)))
    coordinates = {"b": np.arange(4.0), "R": np.linspace(0, 1, 5)}
    times = np.zeros((4, 5))
    times[:2, 1:3] = 0.3
    counts = np.ones((4, 5), int)
    quantities = {"impacts_right": counts, "impacts_left": counts, "sticking_time": times}
    fig = plotting.figure(write(tmp_path / "r.h5", coordinates, quantities))
    assert "rests on a stop for a part of the time" in entries(fig)
    (hatched,) = (one for one in fig.axes[0].collections if one.get_gid() == "rest" and one.get_hatch())
    assert len(hatched.get_paths()) == 2  # rows of cells
    fig = plotting.figure(write(tmp_path / "n.h5", coordinates, quantities | {"sticking_time": 0 * times}))
    assert not [one for one in fig.axes[0].collections if one.get_gid() == "rest"]


@pytest.mark.slow
def test_a_line_beyond_the_frame_is_not_in_the_legend(tmp_path):
    file, _ = planes_of(np.random.default_rng(4), tmp_path, "p.h5")  # b* = 6.7057
    assert any("b^*" in text for text in entries(plotting.figure(file)))
    assert not any(
        "b^*" in text for text in entries(plotting.figure(file, options=PlotOptions(ylim=(0.6, 0.65), xlim=(7, 8))))
    )
    b = np.linspace(6.5, 6.9, 40)
    sweep = write(tmp_path / "s.h5", {"b": b}, {"lyapunov": exponents(40)})
    for limits, there in ((None, True), ((6.5, 6.6), False), ((6.7, 6.75), True)):
        ax = plotting.figure(sweep, options=PlotOptions(xlim=limits)).axes[0]
        assert any(line.get_gid() == "grazing" for line in ax.lines) == (ax.get_legend() is not None) == there


def test_a_part_of_a_plane_has_its_own_numbers_and_colours(tmp_path):
    period = np.ones((60, 50), int)
    period[:20, :20], spectrum = 7, np.full((60, 50, 4), -0.1)
    spectrum[40:, 40:] = -5.0
    coordinates = {"b": np.linspace(3, 9, 60), "R": np.linspace(0.3, 0.9, 50)}
    file = write(tmp_path / "p.h5", coordinates, {"lyapunov": spectrum, "period": period})
    fig = plotting.figure(file, options=PlotOptions(xlim=(3, 3.4), ylim=(0.3, 0.35)))
    assert [text.get_text() for text in fig.axes[1].texts] == ["7"]
    assert fig.axes[0].images[0].norm.vmin == pytest.approx(-0.1)


def test_a_part_of_a_plane_of_uneven_steps(tmp_path):
    """The cells keep the borders that they have in the whole, also where there is one of them."""
    b = np.array([1.0, 2.0, 4.0, 8.0])
    file = write(tmp_path / "p.h5", {"b": b, "R": np.array([0.1, 0.2])}, {"period": np.ones((4, 2), int)})
    (image,) = plotting.figure(file, options=PlotOptions(xlim=(1.6, 2.9))).axes[0].images
    assert image.get_extent()[:2] == (1.5, 3.0)


def test_a_map_without_numbers_is_left_out(tmp_path):
    coordinates = {"b": np.arange(4.0), "R": np.linspace(0, 1, 5)}
    quantities = {"lyapunov": np.full((4, 5, 4), np.nan), "period": np.ones((4, 5), int)}
    fig = plotting.figure(write(tmp_path / "p.h5", coordinates, quantities))
    assert len(fig.axes) == 2 and "period" in bars(fig)[0].get_xlabel()


def test_labels_have_their_size_before_they_find_their_places(tmp_path):
    """On a page of 4 x 3 inches the labels of both colour bars would overlap; 0 and both ends stay."""
    file, _ = planes_of(np.random.default_rng(5), tmp_path, "p.h5")
    fig = plotting.figure(file, options=PlotOptions(size=(4, 3)))
    fig.draw_without_rendering()
    period = bars(fig)[1]
    told = [label.get_text() for label in period.get_xticklabels()]
    assert told[0] == "0" and told[-1] == ">12" and 4 < len(told) < 14 and not overlaps(period.get_xticklabels())


def test_two_orbits_have_titles_beside_each_other(tmp_path):
    noise = np.random.default_rng(0).normal(size=(2, 2, 50, 4)) / 1000
    running = np.tile([0.01, -0.02, -0.05, -0.1], (2, 2, 50, 1)) + noise
    quantities = {"lyapunov_running": running, "lyapunov": running[:, :, -1]}
    quantities["lyapunov_error"] = np.full((2, 2, 4), 0.002)
    coordinates = {"b": np.array([6.51234, 6.6789]), "omega": np.array([0.634567, 0.641234])}
    fig = plotting.figure(write(tmp_path / "c.h5", coordinates, quantities), "convergence", PlotOptions(size=(5, 4)))
    fig.draw_without_rendering()
    assert not overlaps([ax.title for ax in fig.axes])


def test_style_has_the_sizes_that_are_tried():
    assert labels.SIZES[0] == STYLE["legend.fontsize"]
