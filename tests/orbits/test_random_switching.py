"""Orbits beyond special points of random oscillators, and branches from there (tests/support/random_switching.py)."""

import pytest
from support.random_switching import DRAWN, study, summary


@pytest.mark.parametrize(
    "seeds",
    [
        pytest.param(range(3), marks=pytest.mark.slow),
        pytest.param(range(100), marks=pytest.mark.soak),
    ],
)
@pytest.mark.parametrize("kind", DRAWN)
def test_orbits_that_switch_gives(kind, seeds, capsys):
    reports = [study(seed, kind) for seed in seeds]
    with capsys.disabled():
        if len(seeds) > 10:
            print("\n" + summary(reports, kind))
    assert [line for report in reports for line in report.wrong] == []
    assert len(seeds) <= 10 or 2 * sum(report.orbits for report in reports) > len(seeds)
