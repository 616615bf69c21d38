"""The same number for the same attractor all over a file, whatever is swept and however it is computed."""

import numpy as np
import pytest
from support import sample
from support.attractors import ALONG_B, PLANE, ROWS, WINDOW, in_order, same_partition
from support.oscillators import PAPER_NUMBERS
from support.scenes import run, scene_of

import vibro_sweep as vs


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    """The two mirror images of period 13, 4 impacts on one side, and what there is beside their window."""
    return run(tmp_path_factory.mktemp("window"), WINDOW)


def test_mirror_images_are_followed_through_their_window(window):
    """Each keeps its number, whichever start reaches it and whichever has the larger share."""
    number, period = window["attractor_id"], window["period"]
    right, left = (window["average"][..., column] * period for column in (4, 5))
    inside = period == 13
    assert inside.all(axis=1).sum() > 25
    sides = {number[inside & (abs(one - 4) < 1e-9)].tolist()[0] for one in (right, left)}
    for one in (right, left):
        assert len(set(number[inside & (abs(one - 4) < 1e-9)].tolist())) == 1
    assert len(sides) == 2 and not sides & set(number[period == 0].tolist())
    ranks = window["attractor"][inside.all(axis=1)]
    assert any(ranks[n][right[inside.all(axis=1)][n] > 0].min() == 2 for n in range(len(ranks)))  # the rank changes


def test_numbers_and_ranks_agree_at_each_point(window):
    """Another name for the same groups; in the order of the sweep."""
    for rank, number in zip(window["attractor"], window["attractor_id"], strict=True):
        assert same_partition(rank, number) and np.array_equal(rank == 0, number == 0)
    assert in_order(window["attractor_id"]) and window["attractor_id"].dtype == np.int32


@pytest.mark.slow
def test_neither_workers_nor_blocks_matter(tmp_path, window):
    again = run(tmp_path, WINDOW, workers=2, block=2)
    for name in window:
        assert np.array_equal(window[name], again[name], equal_nan=window[name].dtype.kind == "f"), name


def test_an_interrupted_run_has_no_numbers_and_then_the_same(tmp_path, window):
    path = tmp_path / "out.h5"

    def stop(done, total):
        if 0 < done < total:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        vs.run(scene_of(WINDOW), path, workers=1, progress=stop, block=4)
    with vs.open(path) as part:
        assert np.all(part.attractor_id == -1) and np.any(part.attractor > 0)
    vs.run(scene_of(WINDOW), path, mode="resume")
    with vs.open(path) as data:
        assert np.array_equal(data.attractor_id, window["attractor_id"])


def test_a_sweep_that_falls_is_numbered_in_its_own_order(tmp_path, window):
    falling = WINDOW.replace("start: 6.594, stop: 6.612", "start: 6.612, stop: 6.594").replace(
        "start: {random: 6, seed: 2}", ""
    )
    rising = WINDOW.replace("start: {random: 6, seed: 2}", "")
    one, other = run(tmp_path, rising), run(tmp_path, falling)
    assert np.array_equal(one["average"], other["average"][::-1], equal_nan=True)
    assert in_order(one["attractor_id"]) and in_order(other["attractor_id"])
    settled = one["period"] == 13  # one start meets now the one, now the other image
    assert same_partition(one["attractor_id"][settled], other["attractor_id"][::-1][settled])
    assert len(set(one["attractor_id"][settled].tolist())) == 2


def test_a_doubled_period_keeps_its_number(tmp_path):
    """At b = 5.774 period 17 (9 impacts on one side) becomes 34: the averages go on, and so does the number."""
    text = """
sweep: {b: {start: 5.765, stop: 5.79, num: 51}}
start: {random: 6, seed: 1}
orbit: {transient: 6000, record: 400}
observe: [attractors]"""
    data = run(tmp_path, text)
    doubled = np.unique(data["attractor_id"][data["period"] == 34])
    assert len(doubled) == 2 and 0 not in doubled
    assert np.array_equal(np.unique(data["attractor_id"][data["period"] == 17]), doubled)
    assert not np.isin(data["attractor_id"][data["period"] == 8], doubled).any()  # another motion, with 4 impacts


def test_branches_of_a_hysteresis_meet_and_part(tmp_path):
    """Up and down are on one attractor where their numbers are equal, and only there."""
    text = """
sweep: {b: {start: 6.70, stop: 6.78, num: 41}}
start: {follow: both}
orbit: {transient: 3000, record: 200}
observe: [attractors]"""
    data = run(tmp_path, text)
    up, down = data["attractor_id"].T
    impacts = data["average"][..., 4:6]
    free = (impacts == 0).all(axis=-1)
    differ = free[:, 0] != free[:, 1]
    assert 3 < differ.sum() < 41 and np.all(up[differ] != down[differ])
    both = free.all(axis=1)
    assert both.any() and np.all(up[both] == down[both]) and len({*up[both], *down[free[:, 1]]}) == 1
    settled = (data["status"] == 0).all(axis=1)  # beside chaos one may be on its way to a long period
    assert differ.sum() - (differ & settled).sum() <= 1
    assert np.all(data["share"][differ & settled] == 0.5) and np.all(data["share"][both] == 1)
    assert {tuple(sorted(row)) for row in data["attractor"][differ & settled].tolist()} == {(1, 2)}
    assert same_partition(data["attractor"][both], np.ones_like(data["attractor"][both]))


def test_basins_are_in_the_file(tmp_path):
    """One grouping of the whole plane, in the order in which the plane meets the attractors."""
    data = run(tmp_path, PLANE, f"{PAPER_NUMBERS}, b: 6.734")
    number = data["attractor_id"]
    assert set(np.unique(number)) == {1, 2, 3} and set(np.unique(data["attractor"])) == {1}
    assert in_order(number)
    impacts = data["average"][..., 4:6]
    assert len(np.unique(number[(impacts == 0).all(axis=-1)])) == 1


@pytest.mark.parametrize("keys", sample(1, [(keys,) for keys in ALONG_B]))
def test_initial_states_along_a_parameter(tmp_path, keys):
    """Orbits that differ in where they start are grouped, whichever axis that is; clearances are followed."""
    data = run(tmp_path, ALONG_B[keys])
    number, impacts = data["attractor_id"], data["average"][..., 4:6]
    free = (impacts == 0).all(axis=-1)
    along = 0 if keys[0] == "x1" else 1
    assert free.any(axis=along).sum() >= 2 and len(np.unique(number[free])) == 1
    assert not np.isin(number[~free], number[free]).any() and np.all(number > 0)


@pytest.mark.slow
def test_a_plane_of_parameters_is_followed_there_and_back(tmp_path):
    """A window is one, though the first row leaves it before the second comes to it."""
    data = run(tmp_path, ROWS)
    number, period = data["attractor_id"], data["period"]
    right = data["average"][..., 4] * period
    for side in (4, 0):
        inside = (period == 13) & (abs(right - side) < 1e-9)
        assert np.all(inside.any(axis=(1, 2))) and len(np.unique(number[inside])) == 1


def test_one_point_and_what_has_no_attractor(tmp_path):
    text = "start: {random: 4, seed: 1}\norbit: {transient: 6000, record: 400}\nobserve: [attractors]"
    data = run(tmp_path, text, f"{PAPER_NUMBERS}, b: 6.6")
    assert same_partition(data["attractor_id"], data["attractor"]) and in_order(data["attractor_id"])
    one = run(tmp_path, text.replace("start: {random: 4, seed: 1}", ""), f"{PAPER_NUMBERS}, b: 6.6")
    assert one["attractor_id"].shape == () and one["attractor_id"] == 1
    text = "sweep: {zeta: {values: [1.0e+6, 0.05]}}\nstart: {random: 3}\norbit: {transient: 10, record: 400}"
    data = run(tmp_path, f"{text}\nobserve: [attractors]", PAPER_NUMBERS.replace("zeta: 0.05, ", "") + ", b: 6.6")
    assert np.all(data["attractor_id"][0] == -1)  # cannot be computed
    assert np.array_equal(data["attractor_id"] == 0, data["attractor"] == 0)


def test_scenes_without_attractors_have_no_numbers(tmp_path):
    assert "attractor_id" not in run(tmp_path, "orbit: {transient: 1, record: 10}", f"{PAPER_NUMBERS}, b: 6.6")
