"""Flights past a compliant stop at 10^-1 .. 10^-14 of the clearance, of one mass to 10^-15: no contact missed, none
invented (tests/support/compliant_grazes.py)."""

import pytest
from numpy.random import default_rng
from support import slow_cases
from support.compliant_grazes import BATCH, judge
from support.decades import DECADES


def rows_of(masses: int, flights: int, batch: int):
    """What the judge has counted of at least so many flights of drawn oscillators."""
    rng, rows, seed = default_rng(masses), 0, 0
    while seed == 0 or rows[0, ..., 0].sum() < flights:
        seed += 1
        rows = rows + judge(masses, seed, batch, rng)
    return rows


@pytest.mark.parametrize(
    ("masses", "flights", "batch"),
    [(1, 500, 400), *slow_cases((1, 10_000, BATCH[1]), (2, 2000, BATCH[2]), (3, 2000, BATCH[3]))],
)
def test_none_missed_and_none_invented(masses, flights, batch):
    """Among flights in every decade; of several masses not at 10^-15, which the terms of the gap round away."""
    rows = rows_of(masses, flights, batch)
    assert (rows[..., 3].sum((1, 2)) > flights / 2).all() and (rows[0, ..., 0] > 0).all()
    assert rows[:, : len(DECADES) - (masses > 1), :, 1:3].sum() == 0


@pytest.mark.slow
def test_the_judge_sees_a_stop_that_is_moved():
    """By 10^-12 of the clearance: outwards contacts are missed, inwards they are invented."""
    missed, invented = (judge(1, 1, 1000, default_rng(1), moved=by) for by in (1e-12, -1e-12))
    assert (missed[:, -3:, :, 1].sum((1, 2)) > 10).all() and (invented[:, -3:, :, 2].sum((1, 2)) > 10).all()
