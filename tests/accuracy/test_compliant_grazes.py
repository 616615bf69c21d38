"""Flights past a compliant stop at 10^-1 .. 10^-14 of the clearance, of one mass to 10^-15: no contact missed, none
invented (tests/support/compliant_grazes.py)."""

from functools import partial

import pytest
from numpy.random import default_rng
from support import slow_cases
from support.compliant_grazes import MASSES, judge, study
from support.searching import searched


@pytest.mark.parametrize(
    ("masses", "batch", "count"), [(1, 400, 3), *slow_cases((1, 4000, 6), (2, 400, 11), (3, 400, 11))]
)
def test_none_missed_and_none_invented(masses, batch, count):
    """Of so many batches."""
    seeds = range(MASSES.index(masses), count * len(MASSES), len(MASSES))
    counted, wrong = searched(partial(study, batch=batch), seeds)
    assert wrong == [] and counted["decades without flights"] == 0
    for path in ("alone", "side by side"):
        assert counted[f"flights {path}"] > 0.4 * batch * count
        assert counted[f"contacts {path}"] > counted[f"flights {path}"] / 2


@pytest.mark.slow
def test_the_judge_sees_a_stop_that_is_moved():
    """By 10^-12 of the clearance: outwards contacts are missed, inwards they are invented."""
    missed, invented = (judge(1, 1, 1000, default_rng(1), moved=by) for by in (1e-12, -1e-12))
    assert (missed[:, -3:, :, 1].sum((1, 2)) > 10).all() and (invented[:, -3:, :, 2].sum((1, 2)) > 10).all()
