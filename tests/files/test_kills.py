"""Runs of every kind of file killed at random moments and resumed."""

import pytest
from support import kills


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, by",
    [
        ("sweep", "1 worker"),
        ("follow", "2 workers"),
        ("plane", "Dask"),
        ("linear", "2 workers"),
        ("windows", "2 workers"),
        ("branches", "1 worker"),
        ("curves", "Dask"),
        ("compliant", "Dask"),
    ],
)
def test_killed_at_random_moments(name, by, tmp_path, monkeypatch):
    """The same numbers; nothing that was kept is computed again, and no file and no process is left."""
    monkeypatch.chdir(tmp_path)
    found = kills.measure(tmp_path, name, by, 2, 7)
    if by != "Dask":  # whose workers send pieces together
        assert any(0 < kill.kept < run.total for run in found for kill in run.kills)
