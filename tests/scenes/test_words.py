"""Words of scenes: phases in parts of pi, what moves, contacts between masses, boxes of starts, other files."""

import re

import numpy as np
import pytest
from support.programs import ended

import vibro_sweep as vs
from vibro_sweep.types import Start, Trajectory

PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)


@pytest.mark.parametrize(
    "text, value",
    [("pi", np.pi), ("pi/2", np.pi / 2), ("-pi/4", -np.pi / 4), ("0.3 pi", 0.3 * np.pi), ("2*pi/3", 2 * np.pi / 3),
     ("1.5pi", 1.5 * np.pi), ("cos", np.pi / 2)],
)  # fmt: skip
def test_a_phase_in_parts_of_pi(tmp_path, text, value):
    assert PAPER.replace(tau=text).tau == pytest.approx(value, rel=1e-15)
    (tmp_path / "scene.yaml").write_text(
        f"system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 4, tau: {text}}}\n"
        "orbit: {transient: 0, record: 1}\n"
    )
    assert vs.load_scene(tmp_path / "scene.yaml").system.tau == PAPER.replace(tau=text).tau


@pytest.mark.parametrize("text", ["pi/0", "grasing", "two pi", "", "sin", "pi pi", "1e400 pi"])
def test_what_is_no_phase(text):
    with pytest.raises(vs.ParameterError, match="tau: "):
        PAPER.replace(tau=text)


def test_the_mass_of_one_mass():
    """m x'' + 2 zeta x' + k x = F sin(omega t): the free motion is |F/(k - m omega^2 + 2 i zeta omega)|."""
    numbers = dict(m=2.5, k=3.0, zeta=0.1, F=1.5, omega=1.2, R=0.5, b=1.0)
    size = 1.5 / abs(3.0 - 2.5 * 1.2**2 + 2j * 0.1 * 1.2)
    assert vs.grazing(vs.Oscillator.named("one_mass", **numbers)).b == pytest.approx(size, rel=1e-14)
    chain = vs.Oscillator.named("chain", m=[2.5], k=[3, 0], c=[0.2, 0], force=[1.5], omega=1.2, R=0.5, b=1.0)
    one, other = (
        vs.simulate(system, None, 20).section for system in (vs.Oscillator.named("one_mass", **numbers), chain)
    )
    assert np.allclose(one, other, atol=1e-12)


def test_stops_that_move_alone():
    """On y = x + F sin(omega t + tau), the place of the mass, its spring and its weight act alone: the free motion of
    the gap is that of the stop, and without contacts y is free vibration."""
    numbers = dict(m=2.0, k=1.3, zeta=0.15, F=0.7, constant=-0.2, omega=1.9, R=0.6, b=5.0, stops="left", tau=0.4)
    system = vs.Oscillator.named("one_mass", base="stop", **numbers)
    touch = vs.grazing(system)
    assert touch.b_left == pytest.approx(0.7 + 0.2 / 1.3, rel=1e-13)
    orbit, t = vs.simulate(system, (0.3, 0.1), 4), np.linspace(0, 3 * system.period, 50)
    x, v = orbit.sample(t).T
    shaken = x + 0.7 * np.sin(1.9 * t + 0.4), v + 0.7 * 1.9 * np.cos(1.9 * t + 0.4)
    rate = np.array([[0, 1], [-1.3 / 2, -0.3 / 2]])
    values, vectors = np.linalg.eig(rate)
    rest = np.array([-0.2 / 1.3, 0])
    begin = np.linalg.solve(vectors, np.array([shaken[0][0], shaken[1][0]]) - rest)
    free = (vectors @ (begin[:, None] * np.exp(values[:, None] * t))).real + rest[:, None]
    assert len(orbit.impacts) == 0 and np.allclose(shaken, free, atol=1e-12)
    with pytest.raises(vs.ParameterError, match="base: 'wall' is not allowed; it must be false, true or stop"):
        vs.Oscillator.named("one_mass", base="wall", **numbers)


def test_a_contact_between_two_masses_of_a_chain():
    numbers = dict(omega=1.1, R=0.5, b=0.4, force=[1, 0])
    chain = vs.Oscillator.named("chain", m=[1.2, 3.4], k=[5, 0, 9], c=[0.2, 0, 0.4], stop_between=[1, 2], **numbers)
    other = vs.Oscillator(
        [[1.2, 0], [0, 3.4]], [[5, 0], [0, 9]], [[0.2, 0], [0, 0.4]], contact_normal=[-1, 1], **numbers
    )
    assert np.array_equal(vs.simulate(chain, None, 30).section, vs.simulate(other, None, 30).section)
    for pair, said in (([1, 3], "from 1 to 2"), ([1, 1], "two different whole numbers"), ([1, 1.5], "two different")):
        with pytest.raises(vs.ParameterError, match=f"stop_between: .* {said}"):
            chain.replace(stop_between=pair)


def test_without_a_state_orbits_begin_where_a_sweep_does():
    assert np.array_equal(vs.simulate(PAPER, periods=5).section, vs.simulate(PAPER, (0, 0, 0, 0), 5).section)
    held = vs.Oscillator.named("one_mass", zeta=0.1, F=1, omega=0.8, R=0.5, b=-0.3, stops="right")
    data = vs.sweep(held, {"F": [1.0]}, transient=0, record=6, observe=["section"])
    assert np.array_equal(vs.simulate(held, periods=6).section[1:, 0], data.x1[0])
    assert np.array_equal(vs.lyapunov(PAPER, None, 10, 20), vs.lyapunov(PAPER, (0, 0, 0, 0), 10, 20))
    assert vs.periodic_orbit(PAPER).ok and "+-" in repr(vs.lyapunov(PAPER, None, 10, 20))


def test_random_starts_in_a_box():
    start = {"random": 200, "seed": 3, "box": {"x1": [-0.5, 0.25], "v2": [1, 2]}}
    data = vs.sweep(PAPER, {"b": [3.0, 4.0]}, start=start, trajectory=Trajectory(1, 3, "start"), transient=0, record=1)
    first = {name: data[f"trajectory_{name}"].values[..., 0] for name in ("x1", "v1", "x2", "v2")}
    for name, low, high in (("x1", -0.5, 0.25), ("v2", 1, 2)):
        assert low <= first[name].min() < low + 0.05 * (high - low) and high >= first[name].max() > high - 0.05 * (
            high - low
        )
    usual = vs.sweep(PAPER, {"b": [3.0, 4.0]}, start={"random": 200, "seed": 3}, trajectory=Trajectory(1, 3, "start"),
                     transient=0, record=1)  # fmt: skip
    assert np.array_equal(usual.trajectory_x2[..., 0], first["x2"])  # nothing is said of it
    assert Start("random", count=2, box=(("x1", -1.0, 1.0),)).box
    for box, said in (
        ({"x9": [0, 1]}, "a coordinate"),
        ({"x1": [1, 0]}, "the lower end"),
        ({"x1": [1]}, "two numbers"),
    ):
        with pytest.raises(vs.SceneError, match=said):
            vs.sweep(PAPER, {"b": [3.0]}, start={"random": 2, "box": box}, transient=0, record=1)


def test_a_trajectory_from_the_start():
    """It is the simulated orbit, with its impacts, whatever is recorded later."""
    state = (1.0, 0.5, -0.3, 0.2)
    data = vs.sweep(PAPER, {"b": [1.5]}, start=state, trajectory=Trajectory(3, 601, "start"), transient=40, record=4)
    orbit = vs.simulate(PAPER.replace(b=1.5), state, 3)
    t = data.t_over_T.values * PAPER.period
    shown = np.stack([data[f"trajectory_{name}"].values[0] for name in ("x1", "v1", "x2", "v2")], -1)
    assert np.allclose(shown, orbit.sample(t), atol=1e-11)
    times = data.trajectory_impact_t_over_T.values[0]
    assert np.allclose(times[np.isfinite(times)] * PAPER.period, orbit.impacts["t"], atol=1e-12)
    with pytest.raises(vs.SceneError, match=r"trajectory\.from"):
        vs.sweep(
            PAPER, {"b": [1.5, 2]}, start={"follow": "up"}, trajectory=Trajectory(1, 9, "start"), transient=1, record=1
        )


def test_windows_of_a_sweep_with_impact_sections():
    axes, short = {"b": np.linspace(3, 4.3, 6)}, dict(transient=500, record=60, observe=["section"])
    found = vs.windows(vs.sweep(PAPER, axes, **short))
    again = vs.windows(vs.sweep(PAPER, axes, section={"kind": "impact"}, **short))
    assert len(found) > 1 and [one.itinerary for one in found] == [one.itinerary for one in again]
    assert np.allclose([(one.lo, one.hi) for one in found], [(one.lo, one.hi) for one in again], atol=1e-9)


def test_one_itinerary_with_two_orbits():
    """The ball on a table: one bounce a period at cos = -+ a/F; the sum of the multipliers in closed form."""
    F, R = 1.5, 0.5
    ball = vs.Oscillator.named(
        "one_mass", k=0, zeta=0, constant=-1, base=True, F=F, omega=1, R=R, b=0, stops="left", tau=0
    )
    a = np.pi * (1 - R) / (1 + R)
    sums = [1 + R * R + sign * (1 + R) ** 2 * np.sqrt(F * F - a * a) for sign in (1, -1)]
    orbits = [vs.periodic_orbit(ball, itinerary="L", which=which) for which in (0, 1)]
    assert np.allclose(sorted(orbit.multipliers.sum().real for orbit in orbits), sorted(sums), atol=1e-9)
    assert [orbit.others for orbit in orbits] == [1, 1] and "another orbit has this itinerary" in repr(orbits[0])
    with pytest.raises(ValueError, match="which: 2 is not allowed; it must be at most 1"):
        vs.periodic_orbit(ball, itinerary="L", which=2)
    with pytest.raises(ValueError, match="which: 1 is not allowed"):
        vs.periodic_orbit(ball, (0, 1), which=1)


def test_what_goes_away_has_not_settled():
    ball = vs.Oscillator.named("one_mass", k=0, zeta=0, F=1, omega=1, R=0.5, b=0, stops="left", tau=0)
    data = vs.sweep(ball, {"F": [0.5, 1.0]}, start=(1, 1), transient=50, record=40, observe=["section"])
    words = dict(
        zip(data.status.attrs["flag_values"].tolist(), data.status.attrs["flag_meanings"].split(), strict=True)
    )
    assert {words[code] for code in data.status.values.tolist()} == {"not_settled"}
    undamped = vs.Oscillator.named("one_mass", k=1.3, zeta=0, F=1, omega=1, R=0.5, b=90, stops="left")
    assert not vs.sweep(undamped, {"F": [1.0]}, start=(1, 1), transient=50, record=40, observe=["section"]).status.any()


def test_a_system_of_another_scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert ended("new", "lever_plane").out.split() == ["lever_plane.yaml", "lever.yaml", "scene.schema.json"]
    plane, line = vs.load_scene("lever_plane.yaml"), vs.load_scene("lever.yaml")
    assert (
        plane.system == line.system.replace(b=plane.sweep["b"][0], frequency=5)
        and plane.system_file.name == "lever.yaml"
    )
    assert "lever.yaml" not in plane.text and "m: [2.4]" in plane.text
    small = plane.replace(sweep={"frequency": [20, 21]}, settle=None)
    vs.run(small, tmp_path / "plane.h5")
    assert "m: [2.4]" in vs.open(tmp_path / "plane.h5").attrs["scene"]
    for text, said in (("nothing.yaml", "cannot be read"), ("scene.schema.json", "a scene with a system of its own")):
        (tmp_path / "wrong.yaml").write_text(f"system: {text}\norbit: {{transient: 0, record: 1}}\n")
        with pytest.raises(vs.SceneError, match=said):
            vs.load_scene("wrong.yaml")


def test_tables(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = vs.sweep(PAPER, {"b": [3.0, 4.0]}, transient=5, record=3, observe=["section"], output="a.h5")
    rows = [line.split(",") for line in ended("table", "a.h5", "--variable", "x1", "--variable", "v2").out.splitlines()]
    assert rows[0] == ["b", "sample", "x1", "v2"]
    assert np.array_equal(np.array(rows[1:], float)[:, 2].reshape(2, 3), data.x1.values)
    head, first, _ = ended("table", "a.h5").out.splitlines()
    assert head.startswith("b,status,period") and first.startswith("3.0,ok,")
    assert ended("table", "a.h5", "-o", "a.csv").out == "a.csv\n" and (tmp_path / "a.csv").read_text().startswith(
        "b,status"
    )
    status, _, errors = ended("table", "a.h5", "-o", "a.csv")
    assert status == 2 and "exists; --overwrite" in errors
    status, _, errors = ended("table", "a.h5", "--variable", "x9")
    assert status == 2 and re.search("--variable x9: there are .*x1", errors)
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="R"), "b", (3.9, 4.1))
    branch.save("branch.h5")
    head, *rows = ended("table", "branch.h5").out.splitlines()
    assert head.startswith("branch,b,x1,v1") and len(rows) == branch.points.sizes["point"]
    assert rows[0].split(",")[-1] == "ok"
