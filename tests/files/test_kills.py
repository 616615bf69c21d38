"""Runs killed at random moments and resumed; those of every kind of file by `tools.search kills`."""

import pytest
from support import kills


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, by",
    [
        ("sweep", "1 worker"),
        ("follow", "2 workers"),
        ("plane", "Dask"),
        ("branches", "1 worker"),
    ],
)
def test_killed_at_random_moments(name, by, tmp_path, monkeypatch):
    """The same numbers; nothing that was kept is computed again, and no file and no process is left."""
    monkeypatch.chdir(tmp_path)
    found = kills.measure(tmp_path, name, by, 2, 7)
    if by != "Dask":  # whose workers send pieces together
        assert any(0 < kill.kept < run.total for run in found for kill in run.kills)
