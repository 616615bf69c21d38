"""The continuous orbit of a file: against `simulate` from where the record ends."""

import h5py
import numpy as np
import pytest
from support.contents import arrays_of
from support.oscillators import PAPER_NUMBERS
from support.scene_texts import parsed

import vibro_sweep as vs

STATE = ("x1", "v1", "x2", "v2")


def run(folder, text, system=PAPER_NUMBERS):
    """The scene, and its file."""
    scene = parsed(f"system: {{{system}}}\n{text}")
    path = folder / "out.h5"
    vs.run(scene, path, mode="overwrite")
    return scene, path


@pytest.fixture(scope="module")
def orbits(tmp_path_factory):
    """Sticking, chaos, a symmetric orbit of period 1 and one that strikes seldom."""
    text = """
sweep: {b: {values: [0.02, 0.5, 3, 6.6]}}
orbit: {transient: 300, record: 2}
trajectory: {periods: 4, samples: 200}"""
    return run(tmp_path_factory.mktemp("trajectory"), text)


def simulated(scene, data, i):
    """`simulate` from the last section point of the record. Of a rest only the state is known, and that is enough."""
    system = scene.system.replace(b=float(data["b"][i]))
    return vs.simulate(system, [data[name][i, -1] for name in STATE], 4)


def test_impacts_are_those_of_simulate(orbits):
    scene, path = orbits
    data = arrays_of(path)
    counts = []
    for i, b in enumerate(data["b"]):
        orbit = simulated(scene, data, i)
        assert orbit.status == "ok" and data["trajectory_impacts"][i] == len(orbit.impacts)
        hits = orbit.impacts
        if len(hits) > 200:  # the ends of chatter sequences are left out
            hits = hits[abs(hits["v1"]) > np.sort(abs(hits["v1"]))[-201]]
        stored = {
            name: data[f"trajectory_impact_{name}"][i] for name in ("t_over_T", "side", "v1", "v1_after", "x2", "v2")
        }
        there = np.isfinite(stored["t_over_T"])
        assert there[: len(hits)].all() and not there[len(hits) :].any()
        assert np.all(stored["side"][~there] == 0)
        np.testing.assert_allclose(stored["t_over_T"][there], hits["t"] / scene.system.period, rtol=1e-13)
        np.testing.assert_array_equal(stored["side"][there], hits["side"])
        for name in ("v1", "x2", "v2"):
            np.testing.assert_allclose(stored[name][there], hits[name], rtol=0, atol=1e-12 * b)
        np.testing.assert_array_equal(stored["v1_after"][there], -0.8 * stored["v1"][there])
        counts.append(len(orbit.impacts))
    assert counts[0] > 400 and min(counts) > 0  # the room of 200 is too small once, and that is seen


def test_section_points_are_exact(orbits):
    scene, path = orbits
    data = arrays_of(path)
    for i in range(4):
        expected = simulated(scene, data, i).section
        stored = np.stack([data[f"trajectory_section_{name}"][i] for name in STATE], axis=-1)
        np.testing.assert_allclose(stored, expected, rtol=0, atol=1e-12)
        ends = np.stack([data[f"trajectory_{name}"][i, [0, -1]] for name in STATE], axis=-1)
        np.testing.assert_allclose(ends, stored[[0, -1]], rtol=0, atol=1e-14)
        assert np.array_equal(stored[0], [data[name][i, -1] for name in STATE])


def test_samples_lie_between_the_stops_without_being_cut_there(orbits):
    """Rounding may pass a stop, and is left as it is: a larger error would be seen."""
    with h5py.File(orbits[1]) as file:
        beyond = abs(file["trajectory_x1"][()]) - file["b"][()][:, None]
    assert beyond.max() < 1e-14


def test_an_orbit_of_period_1_shows_one_dot(orbits):
    """Not one for each period, beside each other, as samples that do not meet the sections would."""
    path = orbits[1]
    (ax,) = vs.plot(path, kind="phase-portrait", at={"b": 3}).axes
    dots = [line for line in ax.lines if line.get_label() == r"$t = 0$ mod $T$"]
    (line,) = dots
    assert len(line.get_xdata()) == 5 and np.ptp(line.get_xydata(), axis=0).max() < 1e-9
    with h5py.File(path) as file:
        t, x1 = file["t_over_T"][()], file["trajectory_x1"][2]
        nearest = x1[[np.argmin(abs(t - n)) for n in range(5)]]
        assert np.ptp(nearest) > 1e-2  # what was drawn before
        assert np.array_equal(line.get_xdata(), file["trajectory_section_x1"][2])


@pytest.mark.slow
def test_portraits_reach_the_walls_where_the_orbit_does(orbits):
    """Between samples too, on both sides of each impact, and nowhere else."""
    fig = vs.plot(orbits[1], kind="phase-portrait")
    with h5py.File(orbits[1]) as file:
        for i in (1, 2, 3):
            ax, count = fig.axes[i], int(file["trajectory_impacts"][i])
            x, v = ax.lines[0].get_data()
            at = np.flatnonzero(np.isnan(x))
            assert len(at) == count
            assert np.array_equal(v[at - 1], file["trajectory_impact_v1"][i, :count])
            assert np.array_equal(v[at + 1], file["trajectory_impact_v1_after"][i, :count])
            assert np.all(abs(x[at - 1]) == file["b"][i]) and np.array_equal(x[at - 1], x[at + 1])


@pytest.mark.parametrize("start", ["{follow: both}", "{random: 3}"])
def test_every_start_has_its_own(tmp_path, start):
    text = f"""
sweep: {{b: {{values: [5, 6.6]}}}}
start: {start}
orbit: {{transient: 20, record: 3}}
trajectory: {{periods: 2, samples: 9}}"""
    scene, path = run(tmp_path, text)
    data = arrays_of(path)
    for i, b in enumerate(data["b"]):
        for n in range(len(data["start"])):
            state = [data[name][i, n, -1] for name in STATE]
            orbit = vs.simulate(scene.system.replace(b=b), state, 2)
            count = len(orbit.impacts)
            assert data["trajectory_impacts"][i, n] == count
            np.testing.assert_allclose(data["trajectory_impact_v1"][i, n, :count], orbit.impacts["v1"], atol=1e-12)
            np.testing.assert_allclose(data["trajectory_section_v2"][i, n], orbit.section[:, 3], atol=1e-12)
