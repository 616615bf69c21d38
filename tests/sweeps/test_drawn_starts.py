"""Starts that a sweep draws at random."""

import numpy as np
from support.scenes import scene_of

from vibro_sweep.driver import blocks
from vibro_sweep.driver.drawn_starts import starts_of


def test_drawn_starts():
    """They depend on the place in the sweep, and are spread over |x_i| < b, |v_i| < omega b."""
    text = "sweep: {b: {values: [1, 2]}}\nstart: {random: 500, seed: SEED}\norbit: {transient: 0, record: 1}"
    (block,) = blocks.blocks(scene_of(text.replace("SEED", "1")), points_per_block=2)
    starts = starts_of(block) / np.array([1, 0.63, 1, 0.63])
    assert starts.shape == (2, 500, 4) and len(np.unique(starts)) == starts.size
    for b, drawn in zip((1, 2), starts / np.array([[[1]], [[2]]]), strict=True):
        assert np.all(abs(drawn) < 1), b
        np.testing.assert_allclose(drawn.mean(axis=0), 0, atol=0.1)
        np.testing.assert_allclose((drawn**2).mean(axis=0), 1 / 3, atol=0.05)
