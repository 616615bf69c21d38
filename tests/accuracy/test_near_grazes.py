"""Flights of any number of masses past a stop: no contact missed, none invented (tests/support/near_grazes.py)."""

import numpy as np
import pytest
from numpy.random import default_rng
from support import slow_cases
from support.near_grazes import MASSES, judge

BATCH = 4000  # flights drawn for an oscillator: some end behind a stop where they should begin


def rows_of(masses: int, flights: int):
    """What the judge has counted of at least so many flights of drawn oscillators."""
    rng, rows, seed = default_rng(masses), 0, 0
    while np.sum(rows) == 0 or rows[..., 0].sum() < flights:
        seed += 1
        rows = rows + judge(masses, seed, BATCH, rng)
    return rows


@pytest.mark.parametrize("masses", slow_cases(*MASSES))
def test_none_missed_and_none_invented(masses):
    """Among flights in every decade of distances from the stop."""
    rows = rows_of(masses, 4_000)
    assert rows[..., 3].sum() > 2_000 and (rows[..., 0] > 0).all()
    assert rows[..., 1:3].sum() == 0


@pytest.mark.slow
def test_the_judge_sees_a_stop_that_is_moved():
    """By 10^-12 of the clearance: outwards contacts are missed, inwards they are invented."""
    missed = judge(3, 1, 1000, default_rng(1), moved=1e-12)
    invented = judge(3, 1, 1000, default_rng(1), moved=-1e-12)
    assert missed[-3:, :, 1].sum() > 10 and invented[-3:, :, 2].sum() > 10
