"""Branches without impacts: no resonance peak at which the motion passes a stop is stepped over."""

import pytest
from support.free_peaks import study
from support.searching import searched


@pytest.mark.slow
def test_no_peak_of_the_free_motion_is_passed():
    counted, wrong = searched(study, range(40))
    assert wrong == [] and counted["peaks"] > 12
