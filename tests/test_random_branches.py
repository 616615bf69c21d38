"""Branches of attractors of random systems: each stable piece, and both its ends, against simulation."""

import pytest
from support.random_branches import study, summary


def slow(kind, seeds, mark):
    return pytest.param(kind, seeds, marks=mark)


@pytest.mark.parametrize(
    ("kind", "seeds"),
    [
        ("systems", range(1)),
        slow("systems", range(6), pytest.mark.slow),
        slow("oscillators", range(4), pytest.mark.slow),
        slow("systems", range(200), pytest.mark.soak),
        slow("oscillators", range(200), pytest.mark.soak),
    ],
)
def test_stable_pieces_agree_with_simulation(kind, seeds, capsys):
    """Three branches of each; points and ends are compared to 1e-9, and none may disagree."""
    reports = [study(seed, kind) for seed in seeds]
    with capsys.disabled():
        if len(seeds) > 100:
            print("\n" + summary(reports))
    assert sum(report.compared for report in reports) > 15 * len(seeds)
    assert not [line for report in reports for line in report.wrong]
