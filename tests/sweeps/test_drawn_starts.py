"""Starts that a sweep draws at random."""

import numpy as np
from support.drawn_starts import drawn_starts
from support.oscillators import PAPER


def test_they_depend_on_the_place_and_are_spread_between_the_stops():
    """Over |x_i| < b, |v_i| < omega b."""
    starts = drawn_starts(PAPER, [1, 2], 500, seed=1) / np.array([1, 0.63, 1, 0.63])
    assert starts.shape == (2, 500, 4) and len(np.unique(starts)) == starts.size
    for b, drawn in zip((1, 2), starts / np.array([[[1]], [[2]]]), strict=True):
        assert np.all(abs(drawn) < 1), b
        np.testing.assert_allclose(drawn.mean(axis=0), 0, atol=0.1)
        np.testing.assert_allclose((drawn**2).mean(axis=0), 1 / 3, atol=0.05)
