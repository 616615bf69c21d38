"""Runs killed at random moments and resumed."""

import pytest
from support import kills


@pytest.mark.slow
@pytest.mark.parametrize("by, count", [("1 worker", 4), ("2 workers", 6), ("Dask", 8)])
def test_killed_at_random_moments(by, count):
    """Each costs about the block that each worker is at."""
    found, _, same = kills.measure(count, by, 7)
    assert same and len(found) == count
    assert {kill.how for kill in found} & {"KILL", "INT", "KILL the scheduler"}
    assert all(0 <= kill.blocks <= (1 if by == "1 worker" else 2) for kill in found)
