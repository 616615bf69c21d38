"""Pictures of single orbits hold the numbers of the data, and say which way time goes."""

import itertools

import numpy as np
import pytest
from support.figures import bouncing, dots, entries, golden, made, marked, overlaps
from support.oscillators import PAPER

import vibro_sweep as vs


def labelled(ax):
    return {line.get_label(): line for line in ax.lines}


def test_a_portrait_has_the_impacts_and_section_points_of_the_data():
    (ax,) = vs.plot(bouncing()).axes
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
    section = labelled(ax)[r"$t = 0$ mod $T$"]
    assert section.get_xdata().tolist() == [0, 0, 0] and section.get_ydata().tolist() == [1, 1, 1]


@pytest.mark.parametrize("kind", ["phase-portrait", "configuration"])
def test_arrows_say_which_way_time_goes(kind):
    fig = vs.plot(bouncing(), kind)
    (ax,) = fig.axes
    steps = [list(pair) for pair in itertools.pairwise(ax.lines[0].get_xydata().tolist())]
    arrows = [text for text in ax.texts if text.get_gid() == "time"]
    assert len(arrows) == 4 and all([list(arrow.xyann), list(arrow.xy)] in steps for arrow in arrows)
    assert {"direction of time", "right stop, $x_1 = b$", "left stop, $x_1 = -b$"} <= {*entries(fig)}


def test_a_history_reaches_the_stops():
    lines = labelled(vs.plot(bouncing(), "history").axes[0])
    assert lines["$x_1$"].get_xdata()[-1] == pytest.approx(2) and len(lines["$x_2$"].get_xdata()) == 41 + 2 * 4
    assert np.nanmax(np.abs(lines["$x_1$"].get_ydata())) == 2
    assert lines["right stop, $x_1 = b$"].get_ydata()[0] == 2 and lines["left stop, $x_1 = -b$"].get_ydata()[0] == -2


def test_a_configuration_shows_both_displacements():
    x1, x2 = vs.plot(bouncing(), "configuration").axes[0].lines[0].get_data()
    assert len(x1) == 41 + 2 * 4
    np.testing.assert_array_equal(x2, x1 / 2)


@pytest.mark.parametrize("name", ["x1", "v1", "x2", "v2"])
def test_what_is_drawn_of_an_orbit_is_the_variable_that_was_asked_for(name):
    data = golden()["orbits"].sel(b=4.9)
    (ax,) = vs.plot(data, "history", variable=name).axes
    assert {*data[f"trajectory_{name}"].values} <= {*ax.lines[0].get_ydata()}
    assert ax.get_ylabel() == ax.lines[0].get_label() == f"${name[0]}_{name[1]}$"
    assert (len(ax.lines) == 3) == (name == "x1")  # with both stops
    (ax,) = vs.plot(data, "iteration", variable=name).axes
    assert np.array_equal(dots(ax)[:, 1], data[name])
    diagram = vs.plot(golden()["orbits"], "bifurcation", variable=name).axes[0]
    assert diagram.get_ylabel() == f"${name[0]}_{name[1]}$ at $t = 0$ mod $T$"
    assert bool(marked(diagram, "stop")) == (name == "x1")
    points = dots(diagram)
    assert np.array_equal(points[points[:, 0] == 4.9, 1], data[name])


def test_a_portrait_and_a_section_of_the_second_mass():
    data = golden()["orbits"].sel(b=4.9)
    (ax,) = vs.plot(data, "phase-portrait", variable="x2").axes
    x, v = ax.lines[0].get_data()
    assert {*data.trajectory_x2.values} <= {*x} and {*data.trajectory_v2.values} <= {*v}
    assert np.array_equal(labelled(ax)["$t = 0$ mod $T$"].get_ydata(), data.trajectory_section_v2)
    for x, v in (("x1", "v1"), ("x2", "v2")):
        (ax,) = vs.plot(data, "poincare", variable=x).axes
        np.testing.assert_array_equal(dots(ax), np.column_stack([data[x], data[v]]))
    impacts = golden()["impacts"].isel(b=0)
    (ax,) = vs.plot(impacts, "poincare").axes
    np.testing.assert_array_equal(dots(ax), np.column_stack([impacts.phase, impacts.v1]))


def test_the_nearest_point_of_a_sweep_is_drawn():
    data = golden()["sweep"]
    (ax,) = vs.plot(data, "iteration", at={"b": float(data.b[3]) + 1e-3}).axes
    assert np.array_equal(dots(ax)[:, 1], data.x1[3]) and f"{float(data.b[3]):.6g}" in ax.get_title()
    assert vs.plot(golden()["orbits"], at={"b": 4.9}).get_suptitle().startswith("Phase portrait")
    plane = golden()["plane"]
    orbits = min(4, plane.sizes["omega"])
    assert len(vs.plot(plane, "iteration", at={"b": float(plane.b[1])}).axes) == orbits > 1
    both = {"b": float(plane.b[1]), "omega": float(plane.omega[2])}
    (ax,) = vs.plot(plane, "iteration", at=both).axes
    assert np.array_equal(dots(ax)[:, 1], plane.x1.sel(both))
    assert len(vs.plot(golden()["orbits"].isel(b=slice(1, 3)), "history").axes) == 2
    assert "b = 4.9" in vs.plot(golden()["orbits"].sel(b=4.9), "history").get_suptitle()


def test_what_has_no_picture_says_so():
    with pytest.raises(vs.PlotError, match="allowed: nothing, it is one point"):
        vs.plot(golden()["one orbit"], at={"b": 6.6})
    with pytest.raises(vs.PlotError, match="no point is computed"):
        vs.plot(made({"b": [1.0, 2.0, 3.0]}, {"x1": np.full((3, 2), np.nan)}, done=np.zeros(3, bool)))
    with pytest.raises(vs.PlotError, match="lyapunov, status"):
        vs.plot(made({}, {"lyapunov": np.zeros(4)}))


def test_iteration_of_a_fixed_point_does_not_show_rounding():
    x1 = 6.7 + 1e-15 * np.arange(20)
    (ax,) = vs.plot(made({}, {"x1": x1})).axes
    low, high = ax.get_ylim()
    assert high - low > 1e-3 and np.array_equal(dots(ax)[:, 1], x1)


def test_convergence_ends_at_the_exponents():
    running = np.array([0.01, -0.02, -0.05, -0.1]) + np.random.default_rng(0).normal(size=(50, 4)) / 1000
    quantities = {"lyapunov_running": running, "lyapunov": running[-1], "lyapunov_error": np.full(4, 0.002)}
    fig = vs.plot(made({}, quantities))
    ax, spectrum = fig.axes
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), running[:, 0])
    assert ax.lines[1].get_ydata()[0] == running[-1, 0] and len(spectrum.lines) == 8
    assert ax.get_title().endswith(r"\pm 4 \times 10^{-3}$") and "± 2 standard errors" in entries(fig)


def test_two_orbits_have_titles_beside_each_other():
    noise = np.random.default_rng(0).normal(size=(2, 2, 50, 4)) / 1000
    running = np.tile([0.01, -0.02, -0.05, -0.1], (2, 2, 50, 1)) + noise
    quantities = {"lyapunov_running": running, "lyapunov": running[:, :, -1]}
    quantities["lyapunov_error"] = np.full((2, 2, 4), 0.002)
    axes = {"b": np.array([6.51234, 6.6789]), "omega": np.array([0.634567, 0.641234])}
    fig = vs.plot(made(axes, quantities), "convergence", size=(5, 4))
    fig.draw_without_rendering()
    assert not overlaps([ax.title for ax in fig.axes])


@pytest.mark.parametrize("kind, height", [("phase-portrait", 0.0), ("history", 2.0), ("configuration", 1.0)])
def test_rests_of_a_motion_are_marked(kind, height):
    """Eight samples a period, at rest on the right stop for three of them."""
    x1, v1 = np.array([0, 1, 2, 2, 2, 1, 0, -1, 0.0]), np.array([1, 1, 0, 0, 0, -1, -1, 0, 1.0])
    none = np.full(1, np.nan)
    quantities = {f"trajectory_{name}": values for name, values in (("x1", x1), ("v1", v1), ("x2", x1 / 2))}
    quantities |= {f"trajectory_impact_{name}": none for name in ("t_over_T", "v1", "v1_after", "x2")}
    quantities |= {"trajectory_impact_side": np.zeros(1, int), "trajectory_impacts": 0}
    fig = vs.plot(made({}, quantities, time=np.arange(9) / 8, b=2.0), kind)
    (rest,) = marked(fig.axes[0], "rest")
    known = rest.get_ydata()[np.isfinite(rest.get_ydata())]
    assert known.tolist() == [height] * 3 and "a rest on a stop" in entries(fig)


def test_a_simulated_orbit_is_drawn_as_it_was_computed():
    orbit = vs.simulate(PAPER, (0, 0, 0, 0), 50)
    portrait, history = orbit.plot(periods=3).axes
    begin, end = orbit.section_times[-4], orbit.section_times[-1]
    t = history.lines[0].get_xdata()
    assert (t[0], t[-1]) == (begin, end)
    inside = orbit.impacts[(orbit.impacts["t"] >= begin) & (orbit.impacts["t"] <= end)]
    marks = np.concatenate([line.get_xdata() for line in history.lines[1:3]])
    assert len(inside) > 1 and np.array_equal(np.sort(marks), inside["t"])
    b = PAPER.b
    jumps = [line for line in portrait.lines if list(line.get_xdata()) in ([b, b], [-b, -b])]
    assert [tuple(line.get_ydata()) for line in jumps][: len(inside)] == [(v, -PAPER.R * v) for v in inside["v1"]]
    arrows = [text for text in portrait.texts if text.get_gid() == "time"]
    assert len(arrows) == 4 and all((a.xy[0] - a.xyann[0]) * a.xy[1] > 0 for a in arrows)  # to the right where v1 > 0
    assert {"impact", "right stop", "direction of time"} < {*entries(portrait.figure)}
    with pytest.raises(ValueError, match="no motion to draw"):
        vs.simulate(PAPER, (0, 0, 0, 0), 0).plot()
