"""Which orbits end on the same attractor: against whole section clouds compared point by point, and what is known."""

import numpy as np
import pytest
from support import sample
from support.attractors import same_partition
from support.drawn_starts import drawn_starts
from support.oscillators import PAPER_NUMBERS
from support.scenes import run, scene_of

import vibro_sweep as vs


def by_hand(system, starts, periods, record=400):
    """A label for each start, slowly: periodic orbits are one if the section points of each lie on those of the other.

    Pairwise, and nothing is shared with the package but the orbits of `simulate`.
    """
    clouds = [vs.simulate(system, start, periods).section[-record:] for start in starts]
    labels, kept = [], []
    for cloud in clouds:
        for number, other in enumerate(kept):
            distance = np.linalg.norm(cloud[:, None] - other[None], axis=-1)
            if max(distance.min(axis=0).max(), distance.min(axis=1).max()) < 1e-4:
                labels.append(number)
                break
        else:
            labels.append(len(kept))
            kept.append(cloud)
    return np.array(labels), kept


@pytest.fixture(scope="module")
def coexistence(tmp_path_factory):
    """Random starts at clearances whose attractors are known."""
    text = """
sweep: {b: {values: [6.6, 6.68, 6.69, 6.734, 6.8]}}
start: {random: 12, seed: 3}
orbit: {transient: 8000, record: 1000}
observe: [attractors, impacts, lyapunov]"""
    return scene_of(text), run(tmp_path_factory.mktemp("coexistence"), text)


def test_each_attractor_of_the_brute_force(coexistence):
    """Section points of `simulate` from the same random starts, compared in pairs."""
    scene, data = coexistence
    starts = drawn_starts(scene.system, data["b"], 12, seed=3)
    for i, b in enumerate(data["b"]):
        if b == 6.68:  # chaos: its points never meet
            continue
        label, kept = by_hand(scene.system.replace(b=b), starts[i], 8000)
        assert same_partition(label, data["attractor"][i]), b
        assert data["attractor"][i].max() == len(kept)


def test_what_is_known_of_them(coexistence):
    data = coexistence[1]
    at = {b: i for i, b in enumerate(data["b"].tolist())}
    number = data["attractor"].max(axis=1)
    assert [int(number[at[b]]) for b in (6.6, 6.68, 6.69, 6.8)] == [2, 1, 1, 1]
    assert set(data["period"][at[6.6]]) == {13} and set(data["period"][at[6.69]]) == {29}
    assert set(data["period"][at[6.68]]) == {0}
    free = at[6.8]
    assert np.all(data["share"][free] == 1) and np.all(data["period"][free] == 1)
    assert np.all(data["average"][free, :, 4:6] == 0) and np.all(data["impacts_right"][free] == 0)


def test_mirror_images_are_two(coexistence):
    """At b = 6.6: as often right in one as left in the other, the same exponents; and X(t + T/2) = -X'(t)."""
    scene, data = coexistence
    label, average = data["attractor"][0], data["average"][0]
    one, other = (average[label == number][0] for number in (1, 2))
    assert sorted((one[4], one[5])) == [0, 4 / 13] and (one[4], one[5]) == (other[5], other[4])
    assert one[6] == pytest.approx(other[6], rel=1e-6) and not np.allclose(one[:4], other[:4], rtol=0.01)
    system = scene.system.replace(b=6.6)
    starts = drawn_starts(scene.system, data["b"][:1], 12, seed=3)[0]
    orbits = [vs.simulate(system, starts[label == number][0], 4013) for number in (1, 2)]
    times = (4000 + np.arange(13)) * system.period
    mirrored = -orbits[0].sample(times - system.period / 2)
    np.testing.assert_allclose(mirrored.mean(axis=0), other[:4], rtol=0, atol=1e-4)
    for orbit, known in zip(orbits, (one, other), strict=True):
        np.testing.assert_allclose(orbit.section[-13:].mean(axis=0), known[:4], rtol=0, atol=1e-4)


def test_shares(coexistence):
    data = coexistence[1]
    for label, share in zip(data["attractor"], data["share"], strict=True):
        assert sum(share[label == number][0] for number in np.unique(label)) == pytest.approx(1)
        sizes = np.bincount(label)[1:]
        assert np.all(np.diff(sizes) <= 0) and np.all(share == np.bincount(label)[label] / len(label))


def test_impacts_are_those_that_were_counted(coexistence):
    data = coexistence[1]
    for side, column in (("right", 4), ("left", 5)):
        counted = data[f"impacts_{side}"] / 1000
        whole = data["average"][..., column] * np.maximum(data["period"], 1)
        assert np.all((data["period"] == 0) | (abs(whole - whole.round()) < 1e-9))
        within = np.where(data["period"] > 0, 8 / 1000, 1e-12)  # a part of a period more or less
        assert np.all(abs(counted - data["average"][..., column]) <= within)


def test_the_free_motion_and_what_it_coexists_with(tmp_path):
    """Above b*: it is there and stable from its own state; from rest the mass goes on striking the stops."""
    text = """
sweep: {x1: {values: [0, 6.7]}, b: {values: [6.72, 6.74, 6.78]}}
start: {x2: 3.2286, v2: 0.2475}
orbit: {transient: 20000, record: 600}
observe: [attractors]"""
    data = run(tmp_path, text)
    impacts = data["average"][..., 4] + data["average"][..., 5]
    assert np.all(impacts[1] == 0) and impacts[0, 2] == 0 and np.all(impacts[0, :2] > 0.1)


# Initial states as the plane of a sweep


BASINS = """
sweep: {x1: {start: -6.7, stop: 6.7, num: 8}, v1: {values: [3, 0, -0.3]}}
start: {x2: 3.2286, v2: 0.2475}
orbit: {transient: 5000, record: 200}
observe: [attractors, section]"""


@pytest.fixture(scope="module")
def basins(tmp_path_factory):
    return run(tmp_path_factory.mktemp("basins"), BASINS, f"{PAPER_NUMBERS}, b: 6.734")


def test_basins_against_simulate(basins):
    """Each state of the plane ends where `simulate` from it does."""
    system = scene_of(BASINS, f"{PAPER_NUMBERS}, b: 6.734").system
    assert basins["start_x1"].shape == (8,) and basins["start_v1"].tolist() == [3, 0, -0.3]
    assert basins["x1"].shape == (8, 3, 200) and basins["attractor"].shape == (8, 3)
    states = [(x1, v1, 3.2286, 0.2475) for x1 in basins["start_x1"] for v1 in basins["start_v1"]]
    for at in (0, 10, 21, 23):
        orbit = vs.simulate(system, states[at], 5200)
        assert np.array_equal(orbit.section[-200:, 0], basins["x1"].reshape(24, 200)[at])
    slow, kept = by_hand(system, states, 5200, record=160)
    label = basins["attractor_id"].ravel()
    assert len(kept) == label.max() == 3 and same_partition(slow, label)


@pytest.mark.parametrize("key", sample(2, ["x1", "v1", "x2", "v2"]))
def test_every_swept_state(tmp_path, key):
    """Alone, and with a number of the system."""
    text = f"sweep: {{{key}: {{values: [-0.4, 0.3]}}, R: {{values: [0.7, 0.8]}}}}\norbit: {{transient: 0, record: 3}}"
    rest = ", ".join(f"{name}: {0.1 * n:.1f}" for n, name in enumerate(("x1", "v1", "x2", "v2"), 1) if name != key)
    data = run(tmp_path, f"start: {{{rest}}}\n{text}", f"{PAPER_NUMBERS}, b: 0.5")
    for i, value in enumerate(data[f"start_{key}"]):
        for j, restitution in enumerate(data["R"]):
            state = dict(x1=0.1, v1=0.2, x2=0.3, v2=0.4) | {key: value}
            system = scene_of(text, f"{PAPER_NUMBERS}, b: 0.5").system.replace(R=restitution)
            assert np.array_equal(vs.simulate(system, list(state.values()), 3).section[1:, 2], data["x2"][i, j])


def test_too_short_a_transient_is_said(tmp_path):
    """A weakly damped free motion: its exponents say that it settles, and its section points that it has not yet."""
    text = "start: {random: 4}\norbit: {transient: 10, record: 400}\nobserve: [attractors]"
    system = PAPER_NUMBERS.replace("0.05", "0.005") + ", b: 1.0e+6"
    data = run(tmp_path, text, system)
    assert np.all(data["period"] == 0) and np.all(data["attractor"] == 0) and np.all(data["share"] == 1)
    data = run(tmp_path, text.replace("10,", "2000,"), system)
    assert np.all(data["period"] == 1) and np.all(data["attractor"] == 1)


@pytest.mark.slow
def test_an_orbit_that_arrives_within_the_record_has_not_settled(tmp_path):
    """At b = 6.7524 chaos ends in free motion after some 10^4 periods: such an orbit is on neither, and is not a
    third."""
    text = """
start: {random: 32, seed: 1}
orbit: {transient: 0, record: 40000}
observe: [attractors, section]"""
    data = run(tmp_path, text, f"{PAPER_NUMBERS}, b: 6.7524")
    free = np.all(abs(np.diff(data["x1"][:, -3000:], axis=1)) < 1e-6, axis=1)
    arrived = free & (data["period"] == 0)
    assert np.any(arrived) and not np.all(free) and np.all(data["attractor"][arrived] == 0)


def test_a_point_that_cannot_be_computed_has_no_attractor(tmp_path):
    text = "sweep: {zeta: {values: [1.0e+6, 0.05]}}\nstart: {random: 3}\norbit: {transient: 100, record: 20}"
    data = run(tmp_path, f"{text}\nobserve: [attractors]", f"{PAPER_NUMBERS}, b: 6.8")
    assert np.all(data["attractor"][0] == -1) and np.isnan(data["share"][0]).all() and np.all(data["attractor"][1] >= 0)
    assert not {"x1", "lyapunov", "impacts_right"} & data.keys()


def test_no_stop_no_bound():
    text = "sweep: {x1: {values: [-9, 6.7]}}\norbit: {transient: 1, record: 1}"
    assert scene_of(text, f"{PAPER_NUMBERS}, b: 6.7, stops: right").shape == (2,)
    assert scene_of(f"dynamics: map\n{text}".replace("6.7", "7"), f"{PAPER_NUMBERS}, b: 6.7").shape == (2,)
