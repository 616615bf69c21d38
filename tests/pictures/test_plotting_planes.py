"""Pictures over two parameters: the figure holds the file's numbers."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from support import slow_cases
from support.contents import described
from support.oscillators import PAPER
from support.pictures import image, write

import vibro_sweep as vs
from vibro_sweep import plotting
from vibro_sweep.model.exponents import sign_of
from vibro_sweep.plotting import source
from vibro_sweep.plotting.style import NEUTRAL
from vibro_sweep.store import opening as opening_of


def test_plane_shows_the_start_with_the_largest_exponent(plane):
    fig = plotting.figure(plane)
    largest, period = fig.axes[:2]
    assert (largest.get_xlabel(), largest.get_ylabel()) == ("clearance $b$", r"forcing frequency $\omega$")
    values, periods = image(largest).get_array(), image(period).get_array()
    assert values.shape == (3, 4)  # rows: the second key
    assert values[2, 1] == 0.02
    assert periods[2, 1] == 0
    assert values.mask[0, 0]
    assert periods.mask[0, 0]
    assert values.mask.sum() == 1
    assert "2 starts" in fig.get_suptitle()
    assert "22 of 24" in fig.get_suptitle()


def test_plane_colours_change_sign_at_zero_and_count_periods(plane):
    largest, period = plotting.figure(plane).axes[:2]
    norm, picture = image(largest).norm, image(period)
    assert norm(0.0) == 0.5
    assert norm.vmin < 0 < norm.vmax
    shades = [tuple(picture.cmap(picture.norm(n))) for n in range(14)]
    assert len(set(shades)) == 14
    assert picture.get_array()[0, 3] == 13  # 40, beyond the colours


def test_one_unit_on_both_sides_of_zero(tmp_path):
    rng = np.random.default_rng(0)
    largest = np.concatenate([-0.0372 * rng.uniform(0, 1, 300), 0.0191 * rng.uniform(0, 1, 100)])
    spectrum = np.full((20, 20, 4), -0.1)
    spectrum[..., 0] = largest.reshape(20, 20)
    coordinates = {"b": np.arange(20.0), "R": np.linspace(0, 1, 20)}
    fig = plotting.figure(write(tmp_path / "p.h5", coordinates, {"lyapunov": spectrum}))
    norm = image(fig.axes[0]).norm
    assert norm(0.01) - 0.5 == pytest.approx(0.5 - norm(-0.01)) and 0.036 < norm.vmax == -norm.vmin < 0.0372


def test_what_errors_do_not_tell_from_zero_has_the_neutral_colour(tmp_path):
    """By the rule that kernels, windows and diagrams use, and nothing else, however small it is."""
    spectrum, error = np.full((5, 2, 4), -0.1), np.zeros((5, 2, 4))
    spectrum[..., 0] = np.transpose([[0.1, 0.01, 0.01, -0.01, -0.01], [1e-9, 0.0, -1e-9, 1e-9, -0.1]])
    error[..., 0] = np.transpose([[0.0, 0.0051, 0.0049, 0.0051, 0.0049], [0.0, 0.0, 0.0, 1e-9, 0.0]])
    coordinates = {"b": np.arange(5.0), "R": [0.1, 0.2]}
    file = write(tmp_path / "p.h5", coordinates, {"lyapunov": spectrum, "lyapunov_error": error})
    fig = plotting.figure(file)
    picture = image(fig.axes[0])
    colours = picture.cmap(picture.norm(picture.get_array()))
    red_less_blue = np.sign(colours[..., 0] - colours[..., 2])
    assert red_less_blue.tolist() == [[1, 0, 1, 0, -1], [1, 0, -1, 0, -1]]
    assert (colours[red_less_blue == 0] == to_rgba(NEUTRAL)).all()
    assert "within 2 standard errors of 0" in fig.legends[0].get_texts()[0].get_text()
    signs = sign_of(spectrum[..., 0], error[..., 0])
    assert (red_less_blue == signs.T).all()
    assert "above zero by more than 2 errors: 3 of 10 orbits; not told from zero: 4" in described(file)


@pytest.mark.parametrize("size", [40, *slow_cases(1300)])
def test_periods_are_written_where_there_is_room(tmp_path, size):
    period = np.ones((size, size), np.int8)
    side = 3 * size // 8
    period[:side, :side] = 25  # beyond the colours
    period[3 * size // 4, 3 * size // 4] = 7  # one cell
    coordinates = {"b": np.arange(float(size)), "R": np.linspace(0, 1, size)}
    ax = plotting.figure(write(tmp_path / "p.h5", coordinates, {"period": period})).axes[0]
    found = {text.get_text(): text.get_position() for text in ax.texts}
    assert found.keys() == {"1", "25"}
    (b, R), (far, _) = found["25"], found["1"]
    assert 0.1 < b / side < 0.9 and 0.05 < R < 0.3 and far > side


def test_what_has_no_number_is_hatched_and_named(plane):
    fig = plotting.figure(plane)
    assert fig.axes[0].patch.get_hatch()
    assert [text.get_text() for text in fig.legends[0].get_texts()][1:] == ["no number"]


@pytest.mark.slow
@pytest.mark.parametrize("value", [-0.02, *slow_cases(0.03, 0.0)])
def test_plane_of_one_sign(tmp_path, value):
    coordinates = {"b": [1.0, 2.0], "R": [0.1, 0.2]}
    file = write(tmp_path / "s.h5", coordinates, {"lyapunov": np.full((2, 2, 4), value)})
    fig = plotting.figure(file)
    fig.draw_without_rendering()
    assert np.sign(image(fig.axes[0]).norm(value) - 0.5) == np.sign(value)


@pytest.mark.parametrize("keys", [("b", "omega"), ("omega", "b")])
def test_the_grazing_curve_on_a_plane(tmp_path, keys):
    coordinates = {key: {"b": np.linspace(3, 9, 4), "omega": np.array([0.66, 0.63, 0.6])}[key] for key in keys}
    shape = tuple(len(values) for values in coordinates.values())
    along = {"b_star": ("omega", np.array([9.0, 6.7, 5.0]))}
    ax = plotting.figure(write(tmp_path / "p.h5", coordinates, {"period": np.ones(shape, int)}, along=along)).axes[0]
    (curve,) = (line for line in ax.lines if line.get_gid() == "grazing")
    omega, b = curve.get_data()[:: 1 if keys[1] == "b" else -1]
    assert omega.tolist() == [0.6, 0.63, 0.66] and b.tolist() == [5.0, 6.7, 9.0]
    assert "$b^*$" in ax.figure.legends[0].get_texts()[0].get_text()


def test_no_numbers_no_grazing_curve(tmp_path):
    coordinates = {"b": np.linspace(3, 9, 4), "omega": np.array([0.6, 0.63])}
    file = write(tmp_path / "p.h5", coordinates, {"period": np.ones((4, 2), int)}, settings={"record": 20})
    assert not plotting.figure(file).axes[0].lines


@pytest.mark.slow
def test_planes_relative_to_the_grazing_clearance(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    axes = {"b": np.linspace(3, 5, 5), "omega": np.linspace(0.6, 0.606, 4)}
    data = vs.sweep(PAPER, axes, transient=30, record=10, observe=["section"], output="plane.h5", workers=1)
    (mesh,) = plotting.figure(data, "plane", plotting.PlotOptions(relative=True)).axes[0].collections
    x, y = mesh.get_coordinates().transpose(2, 0, 1)
    assert x.shape == (5, 6) and np.all(np.diff(y[:, 0]) > 0) and np.ptp(y, axis=1).max() == 0
    middle = (x[:-1, :-1] + x[1:, 1:] + x[1:, :-1] + x[:-1, 1:]) / 4
    stars = [vs.grazing(PAPER.replace(omega=one)).b for one in axes["omega"]]
    assert middle == pytest.approx(axes["b"] / np.array(stars)[:, None], rel=1e-3)
    data.close()


@pytest.mark.slow
def test_a_plane_is_opened_twice_and_each_number_read_once(plane, tmp_path, monkeypatch):
    """To see what the file holds, and to draw it; of the exponents the largest alone. It takes long of 10^6 points."""
    opened, read = [], []
    opening, reading = opening_of.checked, source.FileSource.read
    monkeypatch.setattr(opening_of, "checked", lambda *given: opened.append(given) or opening(*given))
    monkeypatch.setattr(source.FileSource, "read", lambda self, *given: read.append(given) or reading(self, *given))
    plotting.plot(plane, tmp_path / "x.png")
    assert len(opened) == 2
    assert len(read) == len({*read})
    assert [given for given in read if given[0] == "lyapunov"] == [("lyapunov", (..., 0))]


def test_a_plane_of_energy_alone_shows_the_power():
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    axes = {"omega": [0.6, 0.63, 0.66], "b": [2.0, 4.0]}
    data = vs.sweep(system, axes, observe=["energy"], transient=50, record=20)
    fig = vs.plot(data)
    shown = image(fig.axes[0]).get_array()
    assert np.allclose(np.ravel(shown), data.impact_power.transpose("b", "omega").values.ravel())
    assert any("power" in text.get_text() for ax in fig.axes for text in (ax.xaxis.label, ax.yaxis.label))
