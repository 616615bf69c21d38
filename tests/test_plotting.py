"""Pictures: what a file can show, and that the figure holds the file's numbers."""

import ast
import itertools
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import matplotlib.pyplot
import numpy as np
import pytest
from matplotlib.colors import LogNorm
from support.old_files import OLD

from vibro_sweep import plotting
from vibro_sweep.plotting import PlotError, density, sweeps
from vibro_sweep.plotting.style import BRANCHES, INK, edges, limits

SETTINGS = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=6.6, tau=2.2293, stops="both")
SETTINGS |= dict(b_star=6.70571674097302, model="flow", section="phase", transient=300, record=20)
OWN = {"lyapunov": ("exponent",), "x1": ("sample",), "v1": ("sample",), "phase": ("sample",)}
OWN |= {"lyapunov_running": ("elapsed", "exponent"), "lyapunov_error": ("exponent",)}
OWN |= {f"trajectory_{name}": ("time",) for name in ("x1", "v1", "x2", "v2")}
OWN |= {f"trajectory_section_{name}": ("trajectory_section",) for name in ("x1", "v1", "x2")}
OWN |= {f"trajectory_impact_{name}": ("trajectory_impact",) for name in ("time", "side", "v1", "v1_after", "x2")}


def write(path, coordinates, quantities, done=None, settings=SETTINGS, time=(), along=None):
    """A result file by the contract: `coordinates` in order, then each quantity's own dimensions (OWN).

    along: numbers that follow from swept ones, name -> (key, values).
    """
    shape = tuple(len(values) for values in coordinates.values())
    quantities = {"status": np.where(np.ones(shape, bool) if done is None else done, 0, -1), **quantities}
    with h5py.File(path, "w") as file:
        along = along or {}
        file.attrs.update({name: v for name, v in settings.items() if name not in coordinates and name not in along})
        file.attrs.update({"scene": "", "title": "", "history": "", "provenance": "{}"})
        names = [name for name in quantities if name != "status"]
        file.attrs["sweep_dimensions"] = [name for name in coordinates if name != "start"] or h5py.Empty("S1")
        file.attrs["quantities"] = names or h5py.Empty("S1")
        known = dict(coordinates)
        for name, values in quantities.items():
            data = file.create_dataset(name, data=values)
            for i, dim in enumerate((*coordinates, *OWN.get(name, ()))):
                known.setdefault(dim, time if dim == "time" else np.arange(np.shape(values)[i]))
                if dim not in file:
                    file[dim] = known[dim]
                    file[dim].make_scale(dim)
                data.dims[i].attach_scale(file[dim])
        for name, (key, values) in along.items():
            file[name] = values
            file[name].dims[0].attach_scale(file[key])
        if "lyapunov_error" in file:
            file["lyapunov_error"].attrs["significant"] = 2.0
    return path


def exponents(*shape):
    """A spectrum that is chaotic in the last quarter of the first dimension."""
    spectrum = np.tile([-0.01, -0.02, -0.05, -0.1], (*shape, 1))
    spectrum[3 * shape[0] // 4 :, ..., 0] = 0.004
    return spectrum


@pytest.fixture
def sweep(tmp_path):
    b = np.linspace(6.5, 6.9, 40)
    x1 = b[:, None] - np.random.default_rng(0).uniform(0, 1, (40, 20))
    counts = {"impacts_right": np.full(40, 10), "impacts_left": np.full(40, 5)}
    return write(tmp_path / "sweep.h5", {"b": b}, {"x1": x1, "lyapunov": exponents(40), **counts})


@pytest.fixture
def branches(tmp_path):
    b = np.linspace(6.6, 6.8, 30)
    x1 = np.stack([np.tile(b[:, None], 20) - 1, np.tile(b[:, None], 20) - 2], axis=1)
    coordinates = {"b": b, "start": np.array([b"up", b"down"], dtype=object)}
    return write(tmp_path / "follow.h5", coordinates, {"x1": x1, "lyapunov": exponents(30, 2)})


@pytest.fixture
def trajectory(tmp_path):
    """Bounces between walls at +-2 with speed 1, impacts at t = 2, 6, 10, 14; the forcing period is 8 too."""
    time = np.linspace(0, 16, 41)  # no sample meets an impact
    x1 = np.abs((time - 2) % 8 - 4) - 2
    v1 = np.where((time - 2) % 8 < 4, -1.0, 1.0)
    side = np.array([1, -1, 1, -1, 0])
    nan = np.full(1, np.nan)
    quantities = {
        **{"trajectory_x1": x1, "trajectory_v1": v1, "trajectory_x2": x1 / 2, "x1": np.zeros(2)},
        **{"trajectory_section_x1": np.zeros(3), "trajectory_section_v1": np.ones(3)},
        **{"trajectory_section_x2": np.zeros(3), "trajectory_impacts": 4, "trajectory_impact_side": side},
        "trajectory_impact_time": np.append([2, 6, 10, 14], nan) / 8,
        "trajectory_impact_v1": np.append(side[:4], nan),
        "trajectory_impact_v1_after": np.append(-side[:4], nan),
        "trajectory_impact_x2": np.append(side[:4], nan),
    }
    settings = SETTINGS | dict(b=2.0, omega=2 * np.pi / 8, R=1.0)
    return write(tmp_path / "one.h5", {}, quantities, settings=settings, time=time / 8)


def drawn(ax):
    """All points drawn as single dots."""
    return np.concatenate([line.get_xydata() for line in ax.lines if line.get_linestyle() == "None"])


def image(ax):
    (only,) = ax.images
    return only


# --- kinds, outputs, errors


def test_kinds_follow_from_what_the_file_holds(tmp_path, sweep, branches, trajectory):
    assert plotting.kinds(sweep) == ["bifurcation", "lyapunov", "impacts", "iteration"]
    assert plotting.kinds(branches) == ["bifurcation", "lyapunov", "iteration"]
    assert plotting.kinds(trajectory) == ["phase-portrait", "configuration", "history", "iteration"]
    b = np.arange(1.0, 4)
    only = write(tmp_path / "only.h5", {"b": b}, {"lyapunov": exponents(3)})
    assert plotting.kinds(only) == ["lyapunov"]
    plane = write(tmp_path / "plane.h5", {"b": b, "R": b / 10}, {"period": np.ones((3, 3), int)})
    assert plotting.kinds(plane) == ["plane"]


@pytest.mark.parametrize(("suffix", "magic"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF")])
def test_the_suffix_is_the_format(sweep, tmp_path, suffix, magic):
    output = tmp_path / f"figure{suffix}"
    assert plotting.plot(sweep, output) == [output]
    assert output.read_bytes().startswith(magic)


def test_the_picture_lies_in_the_current_folder_unless_told_otherwise(sweep, tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert plotting.plot(sweep) == [Path("sweep.png")]
    part = sweep.rename(tmp_path / "other.h5.part")
    assert plotting.plot(part) == [Path("other.png")]
    assert sorted(path.name for path in Path().iterdir()) == ["other.png", "sweep.png"]


def test_kind_all_writes_each_kind(trajectory, tmp_path):
    written = plotting.plot(trajectory, tmp_path / "fig.svg", kind="all")
    assert [path.name for path in written] == [
        "fig-phase-portrait.svg",
        "fig-configuration.svg",
        "fig-history.svg",
        "fig-iteration.svg",
    ]
    assert all(path.stat().st_size > 1000 for path in written)


@pytest.mark.parametrize("output", ["figure.jpg", "figure", "figure.h5"])
def test_an_output_of_another_format_is_refused(sweep, tmp_path, output):
    with pytest.raises(PlotError, match=r"\.png, \.svg, \.pdf"):
        plotting.plot(sweep, tmp_path / output)
    assert not (tmp_path / output).exists()


def test_an_unknown_kind_names_the_ones_there_are(sweep):
    with pytest.raises(PlotError, match=r"'plane'.*bifurcation, lyapunov, impacts, iteration"):
        plotting.plot(sweep, kind="plane")


def test_the_result_is_never_overwritten(sweep, tmp_path):
    odd = sweep.rename(tmp_path / "result.png")
    before = odd.read_bytes()
    with pytest.raises(PlotError, match="the result file itself"):
        plotting.plot(odd, odd)
    assert odd.read_bytes() == before


def test_a_folder_that_is_not_there(sweep, tmp_path):
    with pytest.raises(PlotError, match="cannot be written"):
        plotting.plot(sweep, tmp_path / "nowhere" / "figure.png")


def test_files_that_are_no_results(tmp_path):
    with pytest.raises(PlotError, match="no such file"):
        plotting.kinds(tmp_path / "missing.h5")
    text = tmp_path / "text.h5"
    text.write_text("system: {}\n" * 100)
    with pytest.raises(PlotError, match="not an HDF5 file"):
        plotting.plot(text)
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["status"] = np.zeros(3)
    with pytest.raises(PlotError, match="none that vibro-sweep wrote"):
        plotting.kinds(tmp_path / "foreign.h5")


def test_nothing_to_show(tmp_path):
    b = np.arange(1.0, 4)
    none = write(tmp_path / "none.h5", {"b": b}, {"x1": np.full((3, 2), np.nan)}, done=np.zeros(3, bool))
    assert plotting.kinds(none) == []
    with pytest.raises(PlotError, match="no point is computed"):
        plotting.plot(none)
    numbers = write(tmp_path / "numbers.h5", {}, {"lyapunov": np.zeros(4)})
    with pytest.raises(PlotError, match="lyapunov, status"):
        plotting.figure(numbers)


def test_drawing_needs_no_display_and_no_engine(sweep):
    code = (
        "import sys; from vibro_sweep import plotting; plotting.plot(sys.argv[1], kind='all');"
        "heavy = {'numba', 'pydantic', 'matplotlib.pyplot', 'vibro_sweep.engine',"
        " 'vibro_sweep.scene', 'vibro_sweep.driver', 'vibro_sweep.analysis', 'yaml'};"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code, sweep], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_figure_leaves_pyplot_alone(sweep):
    plotting.figure(sweep)
    assert matplotlib.pyplot.get_fignums() == []


def test_plotting_imports_nothing_that_computes():
    """Neither at its start nor within a function."""
    modules = list(Path(plotting.__file__).parent.glob("*.py"))
    assert len(modules) > 8
    for module in modules:
        for node in ast.walk(ast.parse(module.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0, module
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            for name in names:
                if name.startswith("vibro_sweep."):
                    assert name.split(".")[1] in ("plotting", "store", "model"), (module.name, name)
                assert name.split(".")[0] != "yaml", module.name


# --- one parameter


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
    ax = plotting.figure(window, look=plotting.Look(ylim=(0.2, 0.25))).axes[0]
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
    quantities = {"x1": np.ones((10, 3)), "lyapunov": np.zeros((10, 4)), "impacts_right": np.zeros(10, int)}
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


# --- two parameters


@pytest.fixture
def plane(tmp_path):
    b, omega = np.linspace(6, 7, 4), np.array([0.5, 0.6, 0.8])
    spectrum = np.full((4, 3, 2, 4), -0.1)
    spectrum[1, 2, 0, 0], spectrum[1, 2, 1, 0] = -0.05, 0.02
    period = np.ones((4, 3, 2), int)
    period[1, 2] = 5, 0
    period[3, 0] = 40
    done = np.ones((4, 3, 2), bool)
    done[0, 0] = False
    coordinates = {"b": b, "omega": omega, "start": np.arange(2)}
    return write(tmp_path / "plane.h5", coordinates, {"lyapunov": spectrum, "period": period}, done=done)


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


def test_ticks_are_round_numbers(tmp_path):
    rng = np.random.default_rng(0)
    largest = np.concatenate([-0.0372 * rng.uniform(0, 1, 300), 0.0191 * rng.uniform(0, 1, 100)])
    spectrum = np.full((20, 20, 4), -0.1)
    spectrum[..., 0] = largest.reshape(20, 20)
    coordinates = {"b": np.arange(20.0), "R": np.linspace(0, 1, 20)}
    fig = plotting.figure(write(tmp_path / "p.h5", coordinates, {"lyapunov": spectrum}))
    (bar,) = (ax for ax in fig.axes if ax.get_label() == "<colorbar>")
    assert np.round(bar.get_xticks(), 6).tolist() == [-0.03, -0.02, -0.01, 0, 0.005, 0.01, 0.015]
    told = [label.get_text().replace("\N{MINUS SIGN}", "-") for label in bar.get_xticklabels()]
    assert told == ["-0.03", "-0.02", "-0.01", "0", "0.005", "0.01", "0.015"]


@pytest.mark.parametrize("size", [40, 1300])
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


@pytest.mark.parametrize("value", [-0.02, 0.03, 0.0])
def test_plane_of_one_sign(tmp_path, value):
    coordinates = {"b": [1.0, 2.0], "R": [0.1, 0.2]}
    file = write(tmp_path / "s.h5", coordinates, {"lyapunov": np.full((2, 2, 4), value)})
    fig = plotting.figure(file)
    fig.draw_without_rendering()
    assert np.sign(image(fig.axes[0]).norm(value) - 0.5) == np.sign(value)


# --- orbits


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


@pytest.mark.parametrize("scene", ["", "system: [", "[1, 2]", "system: 3", "system: {b: high, omega: 1e-1}"])
def test_an_illegible_scene_of_version_0_1_costs_only_its_numbers(tmp_path, scene):
    path = shutil.copy(OLD / "orbit.h5", tmp_path)
    with h5py.File(path, "a") as file:
        file.attrs["scene"] = scene
    assert len(plotting.plot(path, tmp_path / "old.png", kind="all")) == 5


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
    assert r"\pm 4 \times 10^{-3}$ (± 2 standard errors)" in ax.get_title()
    assert len(spectrum.lines) == 8


# --- grazing and errors


def test_the_graze_is_marked_where_b_is_swept(sweep, tmp_path):
    marks = [
        line.get_xdata()[0] for ax in plotting.figure(sweep).axes for line in ax.lines if line.get_gid() == "grazing"
    ]
    assert marks == pytest.approx([6.70571674097302] * 3)
    quantities = {"x1": np.full((5, 4), 1.0)}
    other = plotting.figure(write(tmp_path / "R.h5", {"R": np.linspace(0, 1, 5)}, quantities)).axes[0]
    assert not any(line.get_gid() == "grazing" for line in other.lines)


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


# --- small tools


def test_edges_lie_halfway():
    np.testing.assert_allclose(edges([1, 2, 4]), [0.5, 1.5, 3, 5])
    np.testing.assert_allclose(edges([0]), [-0.5, 0.5])


def test_limits_ignore_gaps():
    low, high = limits([np.nan, 1, 3])
    assert low < 1
    assert 3 < high < 3.2
