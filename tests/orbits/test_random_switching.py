"""Orbits beyond special points of random oscillators, and branches from there: tests/support/random_switching.py."""

import pytest
from support import slow_cases
from support.random_switching import DRAWN, study
from support.searching import searched


@pytest.mark.parametrize("kind", slow_cases(*range(len(DRAWN))), ids=list(DRAWN))
def test_orbits_that_switch_gives(kind):
    """Three oscillators of each kind; of some no attractor is met."""
    counted, wrong = searched(study, range(kind, 3 * len(DRAWN), len(DRAWN)))
    assert wrong == [] and counted["drawn"] == 3
