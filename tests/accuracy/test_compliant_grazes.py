"""Flights past a compliant stop at 10^-1 .. 10^-14 of the clearance, of one mass to 10^-15: no contact missed, none
invented.

`pytest -m soak` has 10^5 flights for each number of masses; tests/data/compliant_grazes.log has these of one mass,
and 10^4 of two and of three.
"""

import pytest
from numpy.random import default_rng
from support.compliant_grazes import PATHS, judge
from support.decades import DECADES, show

BATCH = {1: 4000, 2: 400, 3: 400}  # flights drawn for an oscillator: some end behind a stop where they should begin


def search(masses, flights, batch):
    rng, rows, seed = default_rng(masses), 0, 0
    while seed == 0 or rows[0, ..., 0].sum() < flights:
        seed += 1
        rows = rows + judge(masses, seed, batch, rng)
    return rows


def wrong(rows, masses):
    """How many were missed or invented; of several masses not at 10^-15, which the terms of the gap round away."""
    return rows[:, : len(DECADES) - (masses > 1), :, 1:3].sum()


@pytest.mark.parametrize(
    ("masses", "flights", "batch"),
    [
        (1, 500, 400),
        *(pytest.param(n, m, BATCH[n], marks=pytest.mark.slow) for n, m in ((1, 10_000), (2, 2000), (3, 2000))),
    ],
)
def test_none_missed_and_none_invented(masses, flights, batch):
    rows = search(masses, flights, batch)
    assert (rows[..., 3].sum((1, 2)) > flights / 2).all() and (rows[0, ..., 0] > 0).all()
    assert wrong(rows, masses) == 0


@pytest.mark.soak
@pytest.mark.parametrize("masses", [1, 2, 3])
def test_a_hundred_thousand_flights(masses, capsys):
    rows = search(masses, 100_000, BATCH[masses])
    with capsys.disabled():
        for path, found in zip(PATHS, rows, strict=True):
            show(f"{masses} masses, {path}: {found[..., 0].sum()} flights, {found[..., 3].sum()} contacts", found)
    assert wrong(rows, masses) == 0


@pytest.mark.slow
def test_the_judge_sees_a_stop_that_is_moved():
    """By 10^-12 of the clearance: outwards contacts are missed, inwards they are invented."""
    missed, invented = (judge(1, 1, 1000, default_rng(1), moved=by) for by in (1e-12, -1e-12))
    assert (missed[:, -3:, :, 1].sum((1, 2)) > 10).all() and (invented[:, -3:, :, 2].sum((1, 2)) > 10).all()
