"""Flights of any number of masses past a stop: no contact missed, none invented (tests/support/near_grazes.py)."""

import pytest
from numpy.random import default_rng
from support import slow_cases
from support.near_grazes import MASSES, judge, study
from support.searching import searched


@pytest.mark.parametrize("masses", slow_cases(*MASSES))
def test_none_missed_and_none_invented(masses):
    counted, wrong = searched(study, range(MASSES.index(masses), 6 * len(MASSES), len(MASSES)))
    assert wrong == [] and counted["decades without flights"] == 0
    assert counted["flights"] > 8000 and counted["contacts"] > counted["flights"] / 2


@pytest.mark.slow
def test_the_judge_sees_a_stop_that_is_moved():
    """By 10^-12 of the clearance: outwards contacts are missed, inwards they are invented."""
    missed = judge(3, 1, 1000, default_rng(1), moved=1e-12)
    invented = judge(3, 1, 1000, default_rng(1), moved=-1e-12)
    assert missed[-3:, :, 1].sum() > 10 and invented[-3:, :, 2].sum() > 10
