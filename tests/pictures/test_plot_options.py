"""What a user chooses of a picture: the point, the variable, limits, size and resolution; by Python and by commands."""

from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from support import sample, slow_cases
from support.programs import main
from support.scene_texts import parsed

import vibro_sweep as vs
from vibro_sweep import plotting
from vibro_sweep.plotting import PlotOptions, sweeps

SYSTEM = (
    "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\norbit: {transient: 20, record: 8}"
)
SWEEP = "sweep: {b: {values: [6.7, 6.6, 6.5, 6.4]}}\ntrajectory: {periods: 2, samples: 50}"
PLANE = "sweep: {b: {values: [6, 6.6, 7]}, R: {values: [0.7, 0.8]}}"
ALL = "observe: [section, lyapunov, impacts]"


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("looks")
    for name, text in (("sweep", SWEEP), ("plane", PLANE), ("one", "trajectory: {periods: 3, samples: 60}")):
        vs.run(parsed(f"{SYSTEM}\n{text}\n{ALL}"), folder / f"{name}.h5")
    text = f"{SYSTEM}\nsection: {{kind: impact, stop: left}}\nobserve: [section]\nsweep: {{b: {{values: [2, 3]}}}}"
    vs.run(parsed(text), folder / "impacts.h5")
    return folder


@pytest.fixture
def here(files, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return files


def dots(ax):
    return np.concatenate([line.get_xydata() for line in ax.lines if line.get_linestyle() == "None"])


def test_point(files):
    data = vs.open(files / "sweep.h5")
    (ax,) = plotting.figure(files / "sweep.h5", "iteration", PlotOptions(at={"b": 6.58})).axes
    assert ax.get_title() == "$b = 6.6$" and np.array_equal(dots(ax)[:, 1], data.x1.sel(b=6.6))
    (ax,) = plotting.figure(files / "plane.h5", "iteration", PlotOptions(at={"b": 6, "R": 0.8})).axes
    assert ax.get_title() == "$b = 6$, $R = 0.8$"
    assert len(plotting.figure(files / "plane.h5", "iteration", PlotOptions(at={"b": 6})).axes) == 2


@pytest.mark.slow
def test_a_point_asks_for_a_picture_of_single_orbits(files, tmp_path):
    fig = plotting.figure(files / "sweep.h5", options=PlotOptions(at={"b": 6.6}))
    assert fig.get_suptitle().startswith("Phase portrait")
    written = plotting.plot(files / "plane.h5", tmp_path / "x.png", "all", options=PlotOptions(at={"b": 6}))
    assert [path.name for path in written] == ["x-iteration.png", "x-poincare.png"]


@pytest.mark.parametrize("name", ["x1", "v2", *slow_cases("v1", "x2")])
def test_variable_of_section_points(files, name):
    data = vs.open(files / "sweep.h5")
    ax = vs.plot(files / "sweep.h5", variable=name).axes[0]
    points = dots(ax)
    assert np.array_equal(points[points[:, 0] == 6.6, 1], data[name].sel(b=6.6))
    assert ax.get_ylabel() == f"${name[0]}_{name[1]}$ at $t = 0$ mod $T$"
    assert any(line.get_gid() == "stop" for line in ax.lines) == (name == "x1")
    ax = vs.plot(files / "sweep.h5", "iteration", at={"b": 6.6}, variable=name).axes[0]
    assert np.array_equal(dots(ax)[:, 1], data[name].sel(b=6.6)) and ax.get_ylabel() == f"${name[0]}_{name[1]}$"


@pytest.mark.parametrize("name", ["x1", "v2", *slow_cases("v1", "x2")])
def test_variable_over_time(files, name):
    data = vs.open(files / "one.h5")
    (ax,) = vs.plot(data, "history", variable=name).axes
    line = ax.lines[0]
    assert set(data[f"trajectory_{name}"].values) <= set(line.get_ydata())
    assert ax.get_ylabel() == line.get_label() == f"${name[0]}_{name[1]}$"
    assert (len(ax.lines) == 3) == (name == "x1")  # with both stops


@pytest.mark.slow
def test_variable_of_a_plane(files):
    data = vs.open(files / "plane.h5")
    for name in ("min_impact_speed", "impacts_right", "period", "lyapunov_residual"):
        ax = vs.plot(data, variable=name).axes[0]
        shown = ax.images[0].get_array()
        expected = data[name].values.T
        assert np.array_equal(shown.filled(-1), np.where(np.isnan(expected), -1, expected))
    assert len(vs.plot(data).axes) == 4 and len(vs.plot(data, variable="lyapunov").axes) == 2


def test_phase_portrait_of_the_second_mass(files):
    data = vs.open(files / "one.h5")
    (ax,) = vs.plot(data, "phase-portrait", variable="x2").axes
    x, v = ax.lines[0].get_data()
    assert set(data.trajectory_x2.values) <= set(x) and set(data.trajectory_v2.values) <= set(v)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$x_2$", "$v_2$")
    marks = next(line for line in ax.lines if line.get_label() == "$t = 0$ mod $T$")
    assert np.array_equal(marks.get_ydata(), data.trajectory_section_v2)


def test_poincare_section(files):
    data = vs.open(files / "sweep.h5").sel(b=6.6)
    for x, v in (("x1", "v1"), ("x2", "v2")):
        (ax,) = vs.plot(data, "poincare", variable=x).axes
        np.testing.assert_array_equal(dots(ax), np.column_stack([data[x], data[v]]))
        assert ax.get_ylabel() == f"$v_{v[1]}$ at $t = 0$ mod $T$"
    (ax,) = vs.plot(vs.open(files / "impacts.h5").sel(b=2), "poincare").axes
    data = vs.open(files / "impacts.h5").sel(b=2)
    np.testing.assert_array_equal(dots(ax), np.column_stack([data.phase, data.v1]))
    assert (ax.get_xlabel(), ax.get_ylabel()) == (r"$\omega t$ mod $2\pi$", "$v_1$ before impact")


def test_limits(files, monkeypatch):
    options = PlotOptions(xlim=(6.45, 6.65), ylim=(6, 6.5))
    section, spectrum, impacts = plotting.figure(files / "sweep.h5", options=options).axes
    assert section.get_xlim() == impacts.get_xlim() == options.xlim and section.get_ylim() == options.ylim
    assert spectrum.get_ylim()[1] < 1
    assert set(dots(section)[:, 0]) == {6.5, 6.6}  # and the spectrum's range is that of these two
    for ax in plotting.figure(files / "sweep.h5", "phase-portrait", PlotOptions(xlim=(0, 7), ylim=(-1, 2))).axes:
        assert (ax.get_xlim(), ax.get_ylim()) == ((0, 7), (-1, 2))
    monkeypatch.setattr(sweeps, "MANY", 5)
    data = vs.open(files / "sweep.h5").isel(sample=slice(4))
    inside = ((data.x1 >= 6) & (data.x1 <= 6.5)).sel(b=[6.5, 6.6]).sum().item()
    section = plotting.figure(data.drop_vars("period"), options=options).axes[0]
    (picture,) = section.images
    assert 0 < picture.get_array().sum() == inside < 8  # the cells are those of the limits
    assert tuple(picture.get_extent()[2:]) == (6, 6.5)


@pytest.mark.slow
def test_limits_of_a_plane(files):
    for ax in plotting.figure(files / "plane.h5", options=PlotOptions(xlim=(6.2, 6.8), ylim=(0.72, 0.81))).axes:
        if ax.get_label() != "<colorbar>":
            assert (ax.get_xlim(), ax.get_ylim()) == ((6.2, 6.8), (0.72, 0.81))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "arguments", "kind", "options"),
    [
        ("sweep", ["--size", "4", "3", "--dpi", "50"], None, PlotOptions(size=(4, 3), dpi=50)),
        *slow_cases(
            ("sweep", ["--at", "b=6.58"], None, PlotOptions(at={"b": 6.6})),
            ("plane", ["--at", "b=6", "--at", "R=0.7"], None, PlotOptions(at={"b": 6, "R": 0.7})),
            ("sweep", ["--variable", "v1", "--kind", "history"], "history", PlotOptions(variable="v1")),
            (
                "sweep",
                ["--xlim", "6.45", "6.65", "--ylim", "-2", "7"],
                None,
                PlotOptions(xlim=(6.45, 6.65), ylim=(-2, 7)),
            ),
        ),
    ],
)
def test_commands(here, file, arguments, kind, options):
    file = here / f"{file}.h5"
    assert main(["plot", str(file), "-o", "a.png", *arguments]) == 0
    plotting.plot(file, "b.png", kind, options=options)
    plotting.plot(file, "c.png", kind)
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes() != Path("c.png").read_bytes()
    if options.dpi:
        assert matplotlib.image.imread("a.png").shape[:2] == (150, 200)


@pytest.mark.slow
def test_limits_of_a_frequency_are_said_in_hertz_too(tmp_path):
    system = vs.Oscillator.named("one_mass", zeta=0.1, F=1, omega=6, R=0.5, b=1, units="SI")
    data = vs.sweep(system, {"omega": [2 * np.pi, 4 * np.pi]}, transient=2, record=2)
    with pytest.raises(vs.PlotError, match=r"has omega from 6.28319 to 12.5664 \[rad/s\], which is 1 to 2 Hz"):
        vs.plot(data, xlim=(1, 2))
    with pytest.raises(vs.PlotError, match=r"'Hz' is not swept; allowed: omega \[rad/s\]"):
        vs.plot(data, "iteration", at={"Hz": 1})


@pytest.mark.slow
def test_a_single_orbit_does_not_replace_the_diagram(here, tmp_path):
    assert main(["plot", str(here / "sweep.h5")]) == 0
    diagram = Path("sweep.png").read_bytes()
    assert main(["plot", str(here / "sweep.h5"), "--at", "b=6.6", "--kind", "poincare"]) == 0
    assert Path("sweep.png").read_bytes() == diagram and Path("sweep-poincare.png").exists()


def test_a_single_point_has_no_sweep_to_choose_from(files):
    with pytest.raises(vs.PlotError, match="allowed: nothing, it is one point"):
        plotting.figure(files / "one.h5", options=PlotOptions(at={"b": 6.6}))


@pytest.mark.parametrize("kind", sample(1, ["history", "configuration", "iteration"]))
def test_the_scene_names_its_picture(tmp_path, kind):
    """As those of the paper's figures 3 and 4 do, whose data are those of figure 2."""
    text = f"{SYSTEM}\ntrajectory: {{periods: 2, samples: 20}}\npicture: {kind}"
    scene = parsed(text)
    assert parsed(scene.to_yaml()).picture == kind and scene.replace(picture=None).picture is None
    vs.run(scene, tmp_path / "a.h5")
    assert plotting.kinds(tmp_path / "a.h5")[0] == kind
    assert len(plotting.kinds(tmp_path / "a.h5")) == 6


def test_a_picture_that_the_file_has_no_data_for(tmp_path):
    vs.run(parsed(f"{SYSTEM}\npicture: plane"), tmp_path / "a.h5")
    assert plotting.kinds(tmp_path / "a.h5") == ["iteration", "poincare"]
