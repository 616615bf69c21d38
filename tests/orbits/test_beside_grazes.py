"""A graze is the same from whichever orbit beside it its branch is followed, however near.

The full counts: tests/data/compliant_bifurcations.log, tests/data/random_branches.log.
"""

from functools import partial

import pytest
from support import slow_cases
from support.beside_grazes import study
from support.searching import searched

# Seeds whose graze was once taken for another one, or lost, from a start 1e-6 to 1e-11 beside it.
THREE_MASSES = slow_cases(("rigid", 74))  # each number of masses compiles kernels of its own
ONCE_LOST = [("rigid", 21), ("rigid", 46), *THREE_MASSES, ("compliant", 1180)]


@pytest.mark.slow
@pytest.mark.parametrize("stops, seed", ONCE_LOST)
def test_a_graze_is_the_same_from_every_orbit_beside_it(stops, seed):
    counted, wrong = study(seed, stops)
    assert counted["starts"] >= 10
    assert not wrong


@pytest.mark.parametrize("stops", slow_cases("rigid", "compliant"))
def test_grazes_of_random_branches_from_orbits_beside_them(stops):
    counted, wrong = searched(partial(study, stops=stops), range(100, 110))
    assert wrong == [] and counted["starts"] >= 30
