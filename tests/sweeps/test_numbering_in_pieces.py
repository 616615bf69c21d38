"""Attractors are numbered piece by piece: how much is read at once changes no number, and bounds the memory."""

import tracemalloc

import numpy as np
import pytest
from support.attractors import ALONG_B, PLANE, ROWS, WINDOW, in_order, same_partition
from support.oscillators import PAPER_NUMBERS
from support.scenes import run, scene_of

from vibro_sweep.analysis.attractors import grouping
from vibro_sweep.driver.attractor_ids import number_attractors


def numbers_again(scene, data, room):
    return number_attractors(scene, data.__getitem__, room)["attractor_id"]


@pytest.mark.parametrize(
    "text, rooms",
    [
        (WINDOW, (1, 6, 12, 60, 10**6)),
        (PLANE, (1, 3, 5, 26, 27)),
        *((text, (1, 2, 4, 5, 11)) for text in ALONG_B.values()),
        pytest.param(ROWS, (1, 6, 30, 71, 72, 73, 144, 10**6), marks=pytest.mark.slow),
    ],
)
def test_how_much_is_read_at_once_does_not_matter(tmp_path, text, rooms):
    system = f"{PAPER_NUMBERS}, b: 6.734"
    data = run(tmp_path, text, system)
    for room in rooms:
        assert np.array_equal(numbers_again(scene_of(text, system), data, room), data["attractor_id"]), room


def test_a_plane_of_states_is_grouped_as_a_whole(tmp_path):
    data = run(tmp_path, PLANE, f"{PAPER_NUMBERS}, b: 6.734")
    flat = (data["period"].ravel(), data["average"].reshape(-1, 7), data["average_error"].reshape(-1, 7))
    assert same_partition(data["attractor_id"].ravel(), grouping.group(*flat))


@pytest.mark.slow
def test_many_points_need_little_memory():
    """Of 10^5 points, made as they are read, less than half of what the file holds of them is ever there at once."""
    count = 100_000
    sweep = f"sweep: {{b: {{start: 1, stop: 2, num: {count}}}}}\norbit: {{transient: 1, record: 10}}\n"
    scene = scene_of(sweep + "observe: [attractors]")

    class Made:
        """Windows of 100 points, and chaos between them."""

        def __init__(self, name):
            self.name = name

        def __getitem__(self, box):
            n = np.arange(box[0].start, box[0].stop)
            window = np.where(n % 300 < 100, n // 300 % 20 + 1, 0)
            if self.name == "attractor":
                return np.ones(len(n), np.int64)
            if self.name == "period":
                return window
            values = np.full((len(n), 7), 1e-6)
            if self.name == "average":
                values[:, 0] = window
                values[:, 4] = np.where(window > 0, 1 / np.maximum(window, 1), 0.3)
                values[:, 6] = np.where(window > 0, -0.1, 0.1)
            return values

    file = {name: Made(name) for name in ("attractor", "period", "average", "average_error")}
    file |= {"attractor_id": np.full(count, -1, np.int32), "share": None}
    tracemalloc.start()
    numbers = number_attractors(scene, file.__getitem__, room=5_000)["attractor_id"]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < count * 16 * 8 / 2
    assert numbers.max() == 21 and in_order(numbers)
