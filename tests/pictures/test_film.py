"""Films of orbits: what a frame shows, the files, and what is refused."""

import numpy as np
import pytest
from matplotlib.animation import FFMpegWriter, FuncAnimation
from PIL import Image
from support import sample
from support.programs import main

import vibro_sweep as vs

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
FRAMES = 200


@pytest.fixture(scope="module")
def data():
    trajectory = {"periods": 2, "samples": 200}
    return vs.sweep(SYSTEM, {"b": [3.9, 4.0]}, observe=["section"], transient=300, record=20, trajectory=trajectory)


@pytest.fixture
def few(monkeypatch):
    """Films are shortened to two of their frames."""
    whole = FuncAnimation.__init__

    def shortened(self, figure, show, frames, **options):
        assert frames == FRAMES
        whole(self, figure, show, 2, **options)

    monkeypatch.setattr(FuncAnimation, "__init__", shortened)


def test_a_frame_shows_the_masses_where_they_are(data):
    shown = vs.plot(data, "film", at={"b": 4.0})
    there = data.sel(b=4.0)
    shown.show(FRAMES - 1)
    (first, _), (second, _) = shown.boxes
    for box, name in ((first, "trajectory_x1"), (second, "trajectory_x2")):
        assert box.get_x() + box.get_width() / 2 == pytest.approx(float(there[name][-1]), abs=1e-12)
    shown.show(0)
    assert first.get_x() + first.get_width() / 2 == pytest.approx(float(there.trajectory_x1[0]), abs=1e-12)
    assert [dot.get_xdata()[0] for dot in shown.dots] == pytest.approx([0.0, float(there.trajectory_x1[0])])


def test_of_two_starts_the_first_is_shown():
    trajectory = {"periods": 2, "samples": 50}
    both = vs.sweep(SYSTEM, {"b": [3.9, 4.0]}, start={"follow": "both"}, transient=20, record=5, trajectory=trajectory)
    (first, _), _ = (shown := vs.plot(both, "film", at={"b": 4.0})).boxes
    shown.show(0)
    place = float(both.sel(b=4.0, start="up").trajectory_x1[0])
    assert first.get_x() + first.get_width() / 2 == pytest.approx(place, abs=1e-12)


@pytest.mark.parametrize("suffix", sample(1, [".gif", ".mp4"]))
def test_files(data, tmp_path, few, suffix):
    """A file that nobody has changed is replaced; the suffix asks for a film."""
    if suffix == ".mp4" and not FFMpegWriter.isAvailable():
        with pytest.raises(vs.PlotError, match=r"ffmpeg.*\.gif"):
            vs.plot(data, output=tmp_path / "film.mp4")
        return
    place = tmp_path / f"film{suffix}"
    for _ in range(2):
        vs.plot(data, at={"b": 4.0}, dpi=60, output=place)
    if suffix == ".gif":
        with Image.open(place) as moving:
            assert moving.n_frames == 2 and moving.size[0] > 400
    place.write_bytes(place.read_bytes() + b"x")
    with pytest.raises(vs.PlotError, match="exists"):
        vs.plot(data, output=place)


@pytest.mark.slow
def test_width_and_resolution_are_those_asked_for(data, tmp_path, few):
    place = tmp_path / "narrow.gif"
    vs.plot(data, "film", at={"b": 4.0}, width=101.6, dpi=60, output=place)
    with Image.open(place) as moving:
        assert moving.size[0] == 240


@pytest.mark.slow
def test_from_the_command_line(tmp_path, few, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    vs.sweep(SYSTEM, {"b": [4.0]}, transient=50, record=10, trajectory={"periods": 1, "samples": 60}, output="one.h5")
    assert main(["plot", "one.h5", "--kind", "film", "-o", "film.gif"]) == 0
    assert (tmp_path / "film.gif").stat().st_size > 1000
    assert main(["plot", "one.h5", "--kind", "history", "-o", "history.gif"]) == 2
    assert "suffix" in capsys.readouterr().err


def test_of_a_simulated_orbit(few):
    ball = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.1, omega=1, R=0.7, b=2.2)
    orbit = vs.simulate(ball, (0, 0.1, 0, 0), 30)
    moving = orbit.animate(periods=2)
    assert isinstance(moving, FuncAnimation) and "<img" in moving.to_jshtml(fps=2)
    for periods in (0, 1.5, None):
        with pytest.raises(ValueError, match="periods"):
            orbit.animate(periods)
    assert np.isfinite(orbit.section).all()


def test_a_compliant_stop_is_pressed_in():
    system = vs.Oscillator.named(
        "one_mass", zeta=0.02, F=0.6, omega=0.9, k_stop=20, c_stop=8, b=1, tau=0, release="force", stops="right"
    )
    trajectory = {"periods": 2, "samples": 1601}
    observe = ["section", "contacts"]
    data = vs.sweep(system, {"omega": [0.8]}, transient=50, record=20, observe=observe, trajectory=trajectory)
    film = vs.plot(data, "film")
    ((line, place),) = film.stops
    assert place.max() - place.min() == pytest.approx(data.penetration_max.values[0], rel=1e-3)
    film.show(0)
    before = line.get_xdata()[0]
    film.show(int(np.argmax(place) / (len(place) - 1) * (FRAMES - 1)))
    assert line.get_xdata()[0] > before
