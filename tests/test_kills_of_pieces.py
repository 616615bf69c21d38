"""Runs of windows, of branches and of curves killed at random moments and resumed."""

import pytest
from support import kills_of_pieces as kills
from support.kills import BY


@pytest.mark.slow
@pytest.mark.parametrize(
    "what, by, count", [("windows", "2 workers", 1), ("branches", "1 worker", 1), ("curves", "2 workers", 1)]
)
def test_killed_at_random_moments(what, by, count, tmp_path):
    """The same numbers; nothing that was kept is computed again, and no process is left."""
    found, same = kills.measure(tmp_path, what, by, count, 11)
    assert same and sum(one.kills for one in found) >= count
    assert all(0 < one.kept < one.pieces for one in found)


@pytest.mark.soak
@pytest.mark.parametrize("by", BY)
@pytest.mark.parametrize("what", kills.WHAT)
def test_killed_many_times(what, by, tmp_path):
    found, same = kills.measure(tmp_path, what, by, 12, 5)
    assert same
    print(what, by, found)
