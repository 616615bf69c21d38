"""The shape of the file: chunks, and a file of 10^9 points."""

import h5py
import numpy as np
import pytest
from support.faults import TEXT
from support.scene_texts import parsed

from vibro_sweep import store
from vibro_sweep.store import datasets, layout


@pytest.mark.parametrize("follow", [False, True])
def test_chunks(follow):
    """Large enough to be read at once, small enough to be written for a block, and cut as blocks are."""
    scene = parsed(
        TEXT.replace("sweep:", "sweep: {R: {start: 0.5, stop: 0.9, num: 3000},").replace(", {b:", ", b:")
        + "start: {follow: up}" * follow
    )
    assert scene.sweep_shape == (3000, 400)
    shapes = {n: layout.chunk_shape(scene, scene.shape + (60,) * (n == "x1"), 8) for n in ("x1", "lyapunov_residual")}
    assert shapes == (
        {"x1": (273, 1, 60), "lyapunov_residual": (3000, 5)}
        if follow
        else {"x1": (1, 200, 60), "lyapunov_residual": (40, 400)}
    )
    for shape in shapes.values():
        assert layout.CHUNK_BYTES / 2 < 8 * np.prod(shape) <= layout.CHUNK_BYTES


def test_a_large_file_is_made_at_once(path):
    """10^9 points: what is not computed takes no place, and reads as such."""
    scene = parsed(
        TEXT.replace("sweep:", "sweep: {R: {start: 0.5, stop: 0.9, num: 31600},")
        .replace(", {b:", ", b:")
        .replace("num: 400", "num: 31600")
        .replace("[section, lyapunov, impacts]", "[impacts]")
    )
    assert store.size(scene) > 39e9
    with h5py.File(path, "w", libver="v110") as file:
        datasets.create(file, scene)
        assert file["status"].size > 9.98e8 and file["status"][31599, 31599] == -1
        assert np.isnan(file["sticking_time"][5, 7])
    assert path.stat().st_size < 3e6
