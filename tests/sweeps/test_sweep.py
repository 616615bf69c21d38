"""From a scene to numbers: the same whoever computes them, in whatever pieces; and what they say of the oscillator."""

import math

import numpy as np
import pytest
from support import ROOT, sample
from support.contents import arrays_of, assert_same_bits, described
from support.scenes import ALL, PAPER, SCENES, run, scene_of

import vibro_sweep as vs

COORDINATES = ("b", "omega", "R", "tau", "b_star", "start", "sample", "exponent", "t_over_T")


# What the numbers are


def test_one_orbit_is_that_of_simulate(tmp_path):
    """No sweep, so no dimension but the quantities' own. A small clearance: M1 chatters and sticks."""
    text = f"start: {{x1: 0.1, v2: 0.2}}\norbit: {{transient: 30, record: 20}}\n{ALL}"
    small = PAPER.replace("6.6", "0.5").replace("0.8", "0.3")
    data = run(tmp_path, text, small)
    system = scene_of(text, small).system
    orbit = vs.simulate(system, (0.1, 0, 0, 0.2), 50)
    begin, end = 30 * system.period, 50 * system.period
    late = orbit.impacts[orbit.impacts["t"] > begin]
    for i, name in enumerate(("x1", "v1", "x2", "v2")):
        assert data[name].shape == (20,) and np.array_equal(data[name], orbit.section[31:, i])
    assert data["impacts_right"].shape == () and data["lyapunov"].shape == (4,)
    assert data["impacts_right"] == np.count_nonzero(late["side"] > 0) > 20
    assert data["impacts_left"] == np.count_nonzero(late["side"] < 0) > 20
    assert orbit.status.chatters and data["min_impact_speed"] == 0.0
    rests = np.clip(orbit.sticking["t_off"], begin, end) - np.clip(orbit.sticking["t_on"], begin, end)
    assert data["sticking_time"] == pytest.approx(rests.sum(), abs=1e-10) and rests.sum() > 10
    np.testing.assert_allclose(data["lyapunov"], vs.lyapunov(system, (0.1, 0, 0, 0.2), 30, 20))


def test_impact_section(tmp_path):
    """The impacts of `simulate` on that stop, in order; and NaN where there are no more."""
    orbit = "orbit: {transient: 50, record: 60}"
    for stop, side in (("right", 1), ("left", -1)):
        text = f"sweep: {{b: {{values: [0.7, 6.68]}}}}\n{orbit}\nsection: {{kind: impact, stop: {stop}}}"
        data = run(tmp_path, text)
        for i, b in enumerate((0.7, 6.68)):
            system = scene_of(text).system.replace(b=b)
            impacts = vs.simulate(system, (0, 0, 0, 0), 110).impacts
            impacts = impacts[(impacts["t"] > 50 * system.period) & (impacts["side"] == side)][:60]
            count = len(impacts)
            assert count == 60 if b == 0.7 else 0 < count < 60
            assert np.all(data["x1"][i, :count] == side * b) and np.all(side * data["v1"][i, :count] > 0)
            for name in ("v1", "x2", "v2"):
                assert np.array_equal(data[name][i, :count], impacts[name])
            phase = data["phase"][i, :count]
            assert np.all((phase >= 0) & (phase < 2 * np.pi))
            turn = np.exp(1j * (phase - 0.63 * impacts["t"]))
            np.testing.assert_allclose(turn, 1, atol=1e-10)
            for name in ("x1", "v1", "x2", "v2", "phase"):
                assert np.all(np.isnan(data[name][i, count:]))


def test_trajectory(tmp_path):
    """The motion after the last section point: that of `simulate`, also through impacts and rest."""
    text = """
sweep: {b: {values: [0.5, 6.68]}}
orbit: {transient: 40, record: 10}
observe: [section]
trajectory: {periods: 3, samples: 101}"""
    data = run(tmp_path, text, PAPER.replace("0.8", "0.4"))
    base = scene_of(text, PAPER.replace("0.8", "0.4")).system
    np.testing.assert_allclose(data["t_over_T"], np.linspace(0, 3, 101), rtol=1e-15)
    for i, b in enumerate((0.5, 6.68)):
        last = np.array([data[name][i, -1] for name in ("x1", "v1", "x2", "v2")])
        orbit = vs.simulate(base.replace(b=b), last, 3)
        expected = orbit.sample(np.minimum(data["t_over_T"] * base.period, orbit.section_times[-1]))
        for j, name in enumerate(("x1", "v1", "x2", "v2")):
            np.testing.assert_allclose(data[f"trajectory_{name}"][i], expected[:, j], rtol=0, atol=1e-11)
        assert np.all(abs(data["trajectory_x1"][i]) <= b * (1 + 1e-15))


def test_follow_starts_where_the_last_point_ended(tmp_path):
    text = "sweep: {b: {values: [6.6, 6.65, 6.7]}}\nstart: {follow: DIR}\norbit: {transient: 20, record: 10}"
    for direction in ("up", "down"):
        data = run(tmp_path, text.replace("DIR", direction))
        X, order = (0, 0, 0, 0), (0, 1, 2) if direction == "up" else (2, 1, 0)
        for i in order:
            section = vs.simulate(scene_of(text.replace("DIR", "up")).system.replace(b=data["b"][i]), X, 30).section
            assert np.array_equal(data["x1"][i], section[21:, 0])
            X = section[-1]


@pytest.mark.parametrize("direction", sample(1, ["up", "down", "both"]))
def test_up_is_up_on_a_falling_axis(tmp_path, direction):
    rising = SCENES["follow"].replace("both", direction)
    falling = rising.replace("start: 6.5, stop: 6.8, num: 9", "start: 6.8, stop: 6.5, num: 9")
    one, other = run(tmp_path, rising), run(tmp_path, falling)
    for name in one:
        if name not in COORDINATES:
            assert one[name].tobytes() == np.ascontiguousarray(other[name][::-1]).tobytes(), name


def test_order_of_two_keys(tmp_path):
    one = run(tmp_path, SCENES["plane"])
    omega, b = "omega: {start: 0.5, stop: 0.8, num: 5}", "b: {start: 0.3, stop: 6.8, num: 7}"
    swapped = SCENES["plane"].replace(f"{omega}, {b}", f"{b}, {omega}")
    other = run(tmp_path, swapped)
    assert one["status"].shape == (5, 7) and other["status"].shape == (7, 5)
    assert_same_bits(
        {k: v if k in COORDINATES else np.ascontiguousarray(v.swapaxes(0, 1)) for k, v in other.items()}, one
    )


def test_a_point_of_a_plane_is_a_point(tmp_path):
    """`grazing` is resolved at each frequency. Of an orbit that strikes no more the transient is jumped over."""
    data = run(tmp_path, SCENES["plane"])
    coasting = 0
    for i, j in np.ndindex(data["v2"].shape[:2]):
        system = scene_of(SCENES["plane"]).system.replace(omega=data["omega"][i], b=data["b"][j])
        orbit = vs.simulate(system, (0, 0, 0, 0), 100)
        free = not (orbit.impacts["t"] > 60 * system.period).any()
        coasting += free
        np.testing.assert_allclose(data["v2"][i, j], orbit.section[61:, 3], rtol=0, atol=1e-15 if free else 0)
    assert 5 < coasting < 30


def test_one_stop(tmp_path):
    """M1 passes where the other stop would be."""
    for stop, side in (("right", 1), ("left", -1)):
        data = run(tmp_path, SCENES["plane"], f"{PAPER}, stops: {stop}")
        struck, free = data[f"impacts_{stop}"], data["impacts_left" if side > 0 else "impacts_right"]
        assert np.all(struck[:, 0] > 0) and np.all(free == 0)
        assert np.all(side * data["x1"] <= data["b"][:, None]) and np.any(side * data["x1"] < -data["b"][:, None])


def test_a_point_that_cannot_be_computed_has_a_status(tmp_path):
    """The rates of the first system are too far apart; its neighbours do not notice."""
    text = f"sweep: {{zeta: {{values: [1.0e+6, 0.1, 0.05]}}}}\norbit: {{transient: 5, record: 5}}\n{ALL}"
    path = tmp_path / "bad.h5"
    report = vs.run(scene_of(text), path)
    data = arrays_of(path)
    assert data["status"].tolist() == [3, 0, 0]
    assert (report.points, report.bad, report.statuses) == (3, 1, {"ok": 2, "rates_too_far_apart": 1})
    assert np.isnan(data["x1"][0]).all() and np.isfinite(data["x1"][1:]).all()
    lines = described(path).splitlines()
    advice = lines[lines.index("  rates_too_far_apart: 1") + 1].strip()
    assert f"  *What to do:* {advice}\n" in (ROOT / "docs/reference/statuses.md").read_text()


# What the oscillator does


@pytest.fixture(scope="module")
def attractors(tmp_path_factory):
    """Sixteen random starts at three clearances. 8 x 13 x 29 periods are recorded: counts come out even, and the
    exponents of chaos stand out from their fluctuations."""
    text = f"""
sweep: {{b: {{values: [6.6, 6.68, 6.69]}}}}
start: {{random: 16, seed: 1}}
orbit: {{transient: 4000, record: 3016}}
{ALL}"""
    return run(tmp_path_factory.mktemp("attractors"), text)


def test_chaos_at_6_68(attractors):
    assert np.all(attractors["period"][1] == 0)
    assert np.all(attractors["lyapunov"][1, :, 0] > 0)
    assert np.all(attractors["impacts_right"][1] > 0) and np.all(attractors["impacts_left"][1] > 0)


def test_period_29_at_6_69(attractors):
    assert np.all(attractors["period"][2] == 29)
    for side in ("right", "left"):
        assert np.all(attractors[f"impacts_{side}"][2] == 4 * 3016 / 29)
    np.testing.assert_allclose(attractors["lyapunov"][2, :, 0], -0.0054, atol=5e-5)


def test_mirror_images_at_6_6(attractors):
    """Two orbits of period 13 with four impacts on one side; half a period later, one is the negative of the other."""
    right, left = attractors["impacts_right"][0], attractors["impacts_left"][0]
    assert np.all(attractors["period"][0] == 13)
    assert {*zip(right.tolist(), left.tolist(), strict=True)} == {(4 * 3016 / 13, 0), (0, 4 * 3016 / 13)}
    np.testing.assert_allclose(attractors["lyapunov"][0, :, 0], -0.0072, atol=5e-5)
    section = np.stack([attractors[name][0] for name in ("x1", "v1", "x2", "v2")], axis=-1)
    here, there = section[np.argmax(right)], section[np.argmax(left)]
    system = scene_of("orbit: {transient: 1, record: 1}").system
    mirrored = -vs.simulate(system, here[-1], 1).sample(system.period / 2)[0]
    assert abs(there - mirrored).max(axis=1).min() < 1e-9


def test_sum_rule_everywhere(tmp_path):
    """Around the double grazing: by the file's own account; and anew from its counts, where the orbit is chaotic."""
    text = """
sweep: {b: {start: 6.5, stop: 6.9, step: 0.0002}}
orbit: {transient: 1300, record: 200}
observe: [section, lyapunov, impacts]"""
    scene, data = scene_of(text), run(tmp_path, text)
    assert data["status"].shape == (2001,) and np.isin(data["status"], (0, 6)).all()
    residual = abs(data["lyapunov_residual"])
    assert np.count_nonzero(residual < 1e-12) >= 1999  # of an orbit of period 77 the multipliers leave 1e-10
    assert np.all(residual < np.maximum(1e-12, 2 * data["lyapunov_error"].sum(-1)))
    chaotic = data["period"] == 0
    rate = (data["impacts_right"] + data["impacts_left"]) / (scene.record * scene.system.period)
    exact = -2 * 0.05 * (1 + (1 + 5) / 10) + 2 * rate * math.log(0.8)
    assert np.count_nonzero(chaotic) > 100
    assert np.max(abs(data["lyapunov"].sum(axis=-1) - exact)[chaotic]) < 1e-12


def test_hysteresis(tmp_path):
    """Upwards M1 goes on striking the stops beyond b* = 6.7057; downwards it swings freely until there."""
    text = """
sweep: {b: {start: 6.66, stop: 6.8, step: 0.002}}
start: {follow: both}
orbit: {transient: 1000, record: 100}
observe: [impacts, section]"""
    data = run(tmp_path, text)
    assert data["start"].tolist() == [b"up", b"down"]
    up, down = (data["impacts_right"] + data["impacts_left"]).T > 0
    beyond = data["b"] > 6.70571674097302
    assert np.count_nonzero(up & beyond) > 15 and np.all(up[data["b"] < 6.75]) and not up[-1]
    assert np.array_equal(down, ~beyond)
    assert np.all(data["period"][beyond, 1] == 1)
