"""Pictures and files of oscillators whose gap is not x1, or whose stops are not in the middle."""

import numpy as np
import pytest
from support import slow_cases
from support.figures import kinds
from support.scene_texts import parsed

import vibro_sweep as vs

CAVITY = """
system: {type: ball_in_cavity, mass_ratio: 0.05, zeta: 0.01, F: 0.1, omega: 1, R: 0.7, b: 1}
sweep: {b: {values: [0.8, 1.8]}}
start: {v1: 0.1}
orbit: {transient: 50, record: 20}
observe: [section, lyapunov, impacts, convergence]
"""
PAPER = "mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8"
SHIFTED = f"""
system: {{{PAPER}, offset: 0.2, R_left: 0.6}}
sweep: {{b: {{start: 6, stop: 7, num: 11}}}}
orbit: {{transient: 50, record: 20}}
observe: [section, impacts]
"""
PLANE = f"""
system: {{{PAPER}}}
sweep: {{offset: {{values: [-0.1, 0, 0.1]}}, b: {{values: [6.5, 6.7, 6.9]}}}}
orbit: {{transient: 20, record: 10}}
observe: [impacts]
"""


def run(folder, text):
    path = folder / "out.h5"
    vs.run(parsed(text), path)
    return path


@pytest.fixture(scope="module")
def cavity(tmp_path_factory):
    """With trajectories, whose kernels of two masses no fast test needs."""
    return run(tmp_path_factory.mktemp("cavity"), CAVITY + "trajectory: {periods: 2, samples: 200}\n")


def test_the_file_has_the_gap(tmp_path):
    with vs.open(run(tmp_path, CAVITY)) as data:
        np.testing.assert_array_equal(data.gap, data.x2 - data.x1)
        assert data.attrs["contact_normal"].tolist() == [-1, 1] and data.attrs["type"] == "ball_in_cavity"
        assert 0 < np.abs(data.gap).max() <= 1.8


@pytest.mark.slow
def test_impacts_of_its_trajectories_have_the_gap(cavity):
    with vs.open(cavity) as data:
        at_impact = data.trajectory_impact_x2 - data.trajectory_impact_x1
        wanted = data.trajectory_impact_side * data.b
        struck = np.isfinite(at_impact.values)
        assert struck.sum() > 4
        np.testing.assert_allclose(
            at_impact.values[struck], wanted.broadcast_like(at_impact).values[struck], rtol=1e-14
        )
        speed = (data.trajectory_impact_v2 - data.trajectory_impact_v1).values[struck]
        np.testing.assert_allclose(speed, data.trajectory_impact_gap_velocity.values[struck], rtol=1e-13)
        np.testing.assert_allclose(data.trajectory_impact_gap_velocity_after.values[struck], -0.7 * speed, rtol=1e-13)


@pytest.mark.slow
def test_all_kinds_are_drawn(cavity):
    able = kinds(cavity)
    assert {"bifurcation", "lyapunov", "impacts", "phase-portrait", "configuration", "history"} <= {*able}
    for kind in able:
        assert vs.plot(cavity, kind).axes


@pytest.mark.parametrize("scene", [SHIFTED, *slow_cases(CAVITY)], ids=["shifted", "cavity"])
def test_energies_are_drawn(scene, tmp_path):
    path = run(tmp_path, scene.replace("impacts", "impacts, energy"))
    assert "energy" in kinds(path) and vs.plot(path, "energy").axes


@pytest.mark.slow
def test_a_portrait_is_that_of_the_gap(cavity):
    ax = vs.plot(cavity, "phase-portrait").axes[0]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$g$", r"$\dot g$")
    line = ax.lines[0]
    assert np.nanmax(np.abs(line.get_xdata())) == pytest.approx(0.8, rel=1e-12)


@pytest.mark.slow
def test_stops_of_a_contact_between_masses_slant(cavity):
    ax = vs.plot(cavity, "configuration").axes[0]
    walls = {line.get_label(): line for line in ax.lines if "stop" in str(line.get_label())}
    for label, gap in (("right stop, $g = b$", 0.8), ("left stop, $g = -b$", -0.8)):
        x1, x2 = walls[label].get_data()
        np.testing.assert_allclose(x2 - x1, gap, rtol=1e-12)


def test_both_grazes_and_both_stops_over_the_clearance(tmp_path):
    ax = vs.plot(run(tmp_path, SHIFTED), "bifurcation").axes[0]
    touch = vs.grazing(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6, offset=0.2))
    marks = {line.get_label(): line.get_xdata()[0] for line in ax.lines if line.get_gid() == "grazing"}
    assert marks == {
        r"grazing, $b_{\mathrm{right}}$": pytest.approx(touch.b_right, rel=1e-14),
        r"grazing, $b_{\mathrm{left}}$": pytest.approx(touch.b_left, rel=1e-14),
    }
    stops = {line.get_label(): line for line in ax.lines if line.get_gid() == "stop"}
    label = "right stop, $x_1 = b_0+b$"
    np.testing.assert_allclose(stops[label].get_ydata() - stops[label].get_xdata(), 0.2, rtol=1e-12)


@pytest.mark.slow
def test_the_double_graze_unfolds_in_a_plane(tmp_path):
    ax = vs.plot(run(tmp_path, PLANE)).axes[0]
    curves = {line.get_label(): line.get_data() for line in ax.lines if line.get_gid() == "grazing"}
    assert len(curves) == 2
    star = vs.grazing(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)).b
    for label, (offset, b) in curves.items():
        sign = -1 if "right" in label else 1
        np.testing.assert_allclose(b, star + sign * np.asarray(offset), rtol=1e-14)


@pytest.mark.parametrize("name", ["cavity", "one"])
def test_a_single_orbit(name):
    """As a Dataset, and as a picture of its gap."""
    if name == "cavity":
        system = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.1, omega=1.0, R=0.7, b=1.0)
        start = (0, 0.1, 0, 0)
    else:
        system, start = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4, offset=0.5), (0, 0, 0, 0)
    orbit = vs.simulate(system, start, 40)
    data = orbit.to_xarray()
    assert data.x2.shape == (41,) and len(data.impact_t) == len(orbit.impacts) > 10
    portrait = orbit.plot().axes[0]
    low, high = (-3.5, 4.5) if name == "one" else (-1, 1)
    x = portrait.lines[0].get_xdata()
    assert np.nanmin(x) == pytest.approx(low, abs=1e-12) and np.nanmax(x) <= high + 1e-12
    if name == "cavity":
        np.testing.assert_allclose(data.impact_x2 - data.impact_x1, data.impact_side, rtol=1e-14)
        assert (portrait.get_xlabel(), data.attrs["mass_ratio"]) == ("$g$", 0.05)


def test_own_matrices_whose_gap_is_x1_have_the_lines_of_their_stops():
    numbers = {"M": [[1, 0], [0, 2]], "K": [[2, -1], [-1, 1]], "C": [[0.1, 0], [0, 0.1]], "force": [1, 0]}
    machine = vs.Oscillator(**numbers, contact_normal=[1, 0], omega=0.8, b=1, R=0.7, stops="right", tau=0)
    ax, *_ = vs.plot(vs.sweep(machine, {"b": np.linspace(0.01, 0.4, 12)}, transient=50, record=20)).axes
    assert [line.get_gid() for line in ax.lines].count("stop") == 1
