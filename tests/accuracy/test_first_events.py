"""Random oscillators of two masses over the whole allowed range: tests/support/first_events.py."""

import pytest
from support.first_events import checked, study
from support.searching import searched


@pytest.mark.slow
def test_a_few_orbits():
    """The first, and some that once failed: M1 beyond a stop, M2 moved, while chatter is summed up."""
    orbits = [*range(2), 1783, 4019, 4025]
    assert searched(study, orbits).wrong == []
    assert max(checked(n).get("beyond", 0.0) for n in orbits) > 0  # x1 is not cut off at the stops


@pytest.mark.slow
def test_two_hundred_orbits():
    """And one of which a contact was once missed."""
    counted, wrong = searched(study, [*range(200), 2101])
    assert wrong == [] and counted["accepted"] > 180 and counted["checked"] > 20 * counted["accepted"]
