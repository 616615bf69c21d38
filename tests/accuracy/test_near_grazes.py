"""Flights of any number of masses past a stop at 10^-1 .. 10^-15 of the clearance: no contact missed, none invented.

`pytest -m soak tests/accuracy/test_near_grazes.py` has 10^5 flights for each number of masses:
tests/data/near_grazes.log.
"""

import numpy as np
import pytest
from numpy.random import default_rng
from support.decades import show
from support.near_grazes import judge

MASSES = (1, 2, 3, 4, 5, 8)
BATCH = 4000  # flights drawn for an oscillator: some end behind a stop where they should begin


def search(masses, flights):
    rng, rows, seed = default_rng(masses), 0, 0
    while np.sum(rows) == 0 or rows[..., 0].sum() < flights:
        seed += 1
        rows = rows + judge(masses, seed, BATCH, rng)
    return rows


@pytest.mark.slow
@pytest.mark.parametrize(
    ("masses", "flights"),
    [(2, 1000), *(pytest.param(n, 10_000, marks=pytest.mark.slow) for n in MASSES)],
)
def test_none_missed_and_none_invented(masses, flights):
    rows = search(masses, flights)
    assert rows[..., 3].sum() > flights / 2 and (rows[..., 0] > 0).all()
    assert rows[..., 1:3].sum() == 0


@pytest.mark.soak
@pytest.mark.parametrize("masses", MASSES)
def test_a_hundred_thousand_flights(masses, capsys):
    rows = search(masses, 100_000)
    with capsys.disabled():
        show(f"{masses} masses: {rows[..., 0].sum()} flights, {rows[..., 3].sum()} contacts", rows)
    assert rows[..., 1:3].sum() == 0


@pytest.mark.slow
def test_the_judge_sees_a_stop_that_is_moved():
    """By 10^-12 of the clearance: outwards contacts are missed, inwards they are invented."""
    missed = judge(3, 1, 1000, default_rng(1), moved=1e-12)
    invented = judge(3, 1, 1000, default_rng(1), moved=-1e-12)
    assert missed[-3:, :, 1].sum() > 10 and invented[-3:, :, 2].sum() > 10
