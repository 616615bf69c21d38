"""Pictures over two numbers hold the numbers of the data, and say what has none."""

import h5py
import numpy as np
import pytest
from matplotlib.colors import Normalize, to_hex
from support import slow_cases
from support.figures import bars, entries, image, made, marked, overlaps, plane
from support.oscillators import PAPER
from support.programs import ended

import vibro_sweep as vs


def spectrum_of(largest):
    spectrum = np.full((*np.shape(largest), 4), -0.1)
    spectrum[..., 0] = largest
    return spectrum


def test_a_plane_shows_the_start_with_the_largest_exponent():
    fig = vs.plot(plane())
    largest, period = fig.axes[:2]
    values, periods = image(largest).get_array(), image(period).get_array()
    assert values.shape == (3, 4)  # rows: the second key
    assert values[2, 1] == 0.02 and periods[2, 1] == 0
    assert values.mask[0, 0] and periods.mask[0, 0] and values.mask.sum() == 1
    assert largest.patch.get_hatch() and entries(fig)[1:] == ["no number"]


def test_colours_change_sign_at_zero_and_count_periods():
    largest, period = vs.plot(plane()).axes[:2]
    norm, picture = image(largest).norm, image(period)
    assert norm(0.0) == 0.5 and norm.vmin < 0 < norm.vmax
    assert len({tuple(picture.cmap(picture.norm(n))) for n in range(14)}) == 14
    assert picture.get_array()[0, 3] == 13  # 40, beyond the colours


def test_one_unit_on_both_sides_of_zero():
    rng = np.random.default_rng(0)
    largest = np.concatenate([-0.0372 * rng.uniform(0, 1, 300), 0.0191 * rng.uniform(0, 1, 100)]).reshape(20, 20)
    axes = {"b": np.arange(20.0), "R": np.linspace(0, 1, 20)}
    norm = image(vs.plot(made(axes, {"lyapunov": spectrum_of(largest)})).axes[0]).norm
    assert norm(0.01) - 0.5 == pytest.approx(0.5 - norm(-0.01)) and 0.036 < norm.vmax == -norm.vmin < 0.0372


@pytest.mark.parametrize("value", [-0.02, 0.03, 0.0])
def test_a_plane_of_one_sign(value):
    axes = {"b": [1.0, 2.0], "R": [0.1, 0.2]}
    fig = vs.plot(made(axes, {"lyapunov": np.full((2, 2, 4), value)}))
    fig.draw_without_rendering()
    assert np.sign(image(fig.axes[0]).norm(value) - 0.5) == np.sign(value)


def test_what_errors_do_not_tell_from_zero_has_the_neutral_colour(tmp_path):
    """By two errors, and nothing else, however small it is; and `info` counts as colours do."""
    path, axes = tmp_path / "plane.h5", {"b": np.arange(1.0, 6.0), "R": [0.1, 0.2]}
    vs.sweep(PAPER, axes, transient=5, record=5, observe=["lyapunov"], output=path).close()
    largest = np.transpose([[0.1, 0.01, 0.01, -0.01, -0.01], [1e-9, 0.0, -1e-9, 1e-9, -0.1]])
    error = np.transpose([[0.0, 0.0051, 0.0049, 0.0051, 0.0049], [0.0, 0.0, 0.0, 1e-9, 0.0]])
    with h5py.File(path, "r+") as file:
        file["lyapunov"][...], file["lyapunov_error"][...] = spectrum_of(largest), error[..., None] * [1, 0, 0, 0]
    fig = vs.plot(path)
    picture = image(fig.axes[0])
    colours = picture.cmap(picture.norm(picture.get_array()))
    red_less_blue = np.sign(colours[..., 0] - colours[..., 2])
    assert red_less_blue.tolist() == [[1, 0, 1, 0, -1], [1, 0, -1, 0, -1]]
    assert {to_hex(colour) for colour in colours[red_less_blue == 0]} == {"#f7f7f7"}
    assert "within 2 standard errors of 0" in entries(fig)[0]
    assert "above zero by more than 2 errors: 3 of 10 orbits; not told from zero: 4" in ended("info", path).out


@pytest.mark.parametrize("size", [40, *slow_cases(1300)])
def test_periods_are_written_where_there_is_room(size):
    period, side = np.ones((size, size), np.int8), 3 * size // 8
    period[:side, :side] = 25  # beyond the colours
    period[3 * size // 4, 3 * size // 4] = 7  # one cell
    axes = {"b": np.arange(float(size)), "R": np.linspace(0, 1, size)}
    ax = vs.plot(made(axes, {"period": period})).axes[0]
    found = {text.get_text(): text.get_position() for text in ax.texts}
    assert found.keys() == {"1", "25"}
    (b, R), (far, _) = found["25"], found["1"]
    assert 0.1 < b / side < 0.9 and 0.05 < R < 0.3 and far > side


@pytest.mark.parametrize("keys", [("b", "omega"), ("omega", "b")])
def test_the_grazing_curve(keys):
    axes = {key: {"b": np.linspace(3, 9, 4), "omega": np.array([0.66, 0.63, 0.6])}[key] for key in keys}
    shape = tuple(len(values) for values in axes.values())
    fig = vs.plot(made(axes, {"period": np.ones(shape, int)}, along={"b_star": ("omega", [9.0, 6.7, 5.0])}))
    (curve,) = marked(fig.axes[0], "grazing")
    omega, b = curve.get_data()[:: 1 if keys[1] == "b" else -1]
    assert omega.tolist() == [0.6, 0.63, 0.66] and b.tolist() == [5.0, 6.7, 9.0]
    assert "$b^*$" in entries(fig)[0]


def test_a_line_beyond_the_frame_is_not_in_the_legend():
    axes, star = {"b": np.linspace(3, 9, 5), "omega": np.linspace(0.6, 0.66, 4)}, [6.7, 6.6, 6.5, 6.4]
    data = made(axes, {"period": np.ones((5, 4), int)}, along={"b_star": ("omega", star)})
    assert any("b^*" in text for text in entries(vs.plot(data)))
    assert not any("b^*" in text for text in entries(vs.plot(data, xlim=(7, 8), ylim=(0.6, 0.65))))


def test_a_part_has_its_own_numbers_and_colours():
    period, largest = np.ones((60, 50), int), np.full((60, 50), -0.1)
    period[:20, :20], largest[40:, 40:] = 7, -5.0
    axes = {"b": np.linspace(3, 9, 60), "R": np.linspace(0.3, 0.9, 50)}
    data = made(axes, {"lyapunov": spectrum_of(largest), "period": period})
    fig = vs.plot(data, xlim=(3, 3.4), ylim=(0.3, 0.35))
    assert [text.get_text() for text in fig.axes[1].texts] == ["7"]
    assert fig.axes[0].images[0].norm.vmin == pytest.approx(-0.1)
    for ax in fig.axes[:2]:
        assert (ax.get_xlim(), ax.get_ylim()) == ((3, 3.4), (0.3, 0.35))


def test_cells_of_a_part_keep_the_borders_that_they_have_in_the_whole():
    """Also where there is one of them."""
    data = made({"b": np.array([1.0, 2.0, 4.0, 8.0]), "R": [0.1, 0.2]}, {"period": np.ones((4, 2), int)})
    assert image(vs.plot(data, xlim=(1.6, 2.9)).axes[0]).get_extent()[:2] == (1.5, 3.0)
    alone = made({"b": [1.0, 2.0, 4.0], "R": [0.0]}, {"period": np.ones((3, 1), int)})
    assert np.ravel(image(vs.plot(alone).axes[0]).get_extent())[2:] == pytest.approx((-0.5, 0.5))


@pytest.mark.slow
def test_what_is_not_drawn_is_not_read(tmp_path, monkeypatch):
    """It takes long of 10^6 points."""
    path, axes = tmp_path / "plane.h5", {"b": [4.6, 5.9], "R": [0.7, 0.8]}
    vs.sweep(PAPER, axes, start={"random": 2}, transient=30, record=10, observe=["lyapunov"], output=path).close()
    read, reading = [], h5py.Dataset.__getitem__

    def read_data(data, index, **options):
        read.append(data.name)
        return reading(data, index, **options)

    monkeypatch.setattr(h5py.Dataset, "__getitem__", read_data)
    vs.plot(path)
    assert "/lyapunov" in read and "/lyapunov_residual" not in read


@pytest.mark.slow
def test_planes_relative_to_the_grazing_clearance():
    axes = {"b": np.linspace(3, 5, 5), "omega": np.linspace(0.6, 0.606, 4)}
    data = vs.sweep(PAPER, axes, transient=30, record=10, observe=["section"])
    fig = vs.plot(data, "plane", relative=True)
    (mesh,) = fig.axes[0].collections
    x, y = mesh.get_coordinates().transpose(2, 0, 1)
    assert x.shape == (5, 6) and np.all(np.diff(y[:, 0]) > 0) and np.ptp(y, axis=1).max() == 0
    middle = (x[:-1, :-1] + x[1:, 1:] + x[1:, :-1] + x[:-1, 1:]) / 4
    stars = [vs.grazing(PAPER.replace(omega=omega)).b for omega in axes["omega"]]
    assert middle == pytest.approx(axes["b"] / np.array(stars)[:, None], rel=1e-3)
    assert "outside of the sweep" in entries(fig)
    assert not {"no number", "outside of the sweep"} & {*entries(vs.plot(data))}


def test_what_is_drawn_of_a_plane_is_what_was_asked_for():
    axes = {"omega": [0.6, 0.63, 0.66], "b": [2.0, 4.0]}
    observe = ["energy", "impacts", "lyapunov", "section"]
    data = vs.sweep(PAPER.replace(b=4), axes, observe=observe, transient=50, record=20)
    for name in ("min_impact_speed", "impacts_right", "period", "lyapunov_residual", "impact_power"):
        shown = image(vs.plot(data, variable=name).axes[0]).get_array().filled(np.nan)
        np.testing.assert_array_equal(shown, data[name].transpose("b", "omega"))
    assert len(bars(vs.plot(data, variable="lyapunov"))) == 1
    fig = vs.plot(data[["impact_power", "status"]])  # what a run of energies alone has
    np.testing.assert_array_equal(image(fig.axes[0]).get_array(), data.impact_power.transpose("b", "omega"))
    assert "power" in bars(fig)[0].get_xlabel()


def test_numbers_of_impacts_that_span_decades():
    counts = np.ones((10, 12), int)
    counts[:2, :2] = 5000
    axes = {"b": np.arange(10.0), "R": np.linspace(0, 1, 12)}
    norm = image(vs.plot(made(axes, {"impacts_right": counts, "impacts_left": counts})).axes[0]).norm
    assert norm(100.0) == pytest.approx(np.log(50) / np.log(5000))


@pytest.mark.parametrize(
    "values, decades", [([1, 1, 1, 26], True), ([0, 1, 1, 1, 26, np.nan], True), ([1, 2, 5], False), ([0, 0], False)]
)
def test_colours_of_numbers_that_span_decades(values, decades):
    """The largest do not take all colours, also where some are zero; others have even colours."""
    counts = np.tile(values, (2, 1))
    axes = {"b": [1.0, 2.0], "R": np.linspace(0, 1, len(values))}
    norm = image(vs.plot(made(axes, {"impacts_right": counts, "impacts_left": 0 * counts})).axes[0]).norm
    assert (type(norm) is not Normalize) == decades
    assert not decades or (norm(1.0) < norm(5.0) < norm(26.0) == 1 and norm(5.0) > 0.4)


def test_rests_are_hatched_by_rows_of_cells():
    times = np.zeros((4, 5))
    times[:2, 1:3] = 0.3
    quantities = {"impacts_right": np.ones((4, 5), int), "impacts_left": np.ones((4, 5), int), "sticking_time": times}
    fig = vs.plot(made({"b": np.arange(4.0), "R": np.linspace(0, 1, 5)}, quantities))
    (hatched,) = (area for area in marked(fig.axes[0], "rest") if area.get_hatch())
    assert len(hatched.get_paths()) == 2 and "rests on a stop for a part of the time" in entries(fig)


def test_labels_of_a_colour_bar_have_room_on_a_small_page():
    """Of 4 x 3 inches, where those of both bars would overlap; 0 and both ends stay."""
    period = np.random.default_rng(5).choice([*range(1, 20), *range(100, 120)], (40, 50))
    axes = {"b": np.linspace(3, 9, 40), "omega": np.linspace(0.58, 0.68, 50)}
    spectrum = spectrum_of(np.where(period > 12, 0.02, -0.04))
    fig = vs.plot(made(axes, {"lyapunov": spectrum, "period": period}), size=(4, 3))
    fig.draw_without_rendering()
    labels = bars(fig)[1].get_xticklabels()
    told = [label.get_text() for label in labels]
    assert told[0] == "0" and told[-1] == ">12" and 4 < len(told) < 14 and not overlaps(labels)
