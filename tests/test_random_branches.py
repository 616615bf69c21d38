"""Branches of attractors of random systems: each stable piece, and both its ends, against simulation."""

import pytest
from support.random_branches import study, summary


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(200), marks=pytest.mark.soak)], ids=["some", "all"])
def test_stable_pieces_agree_with_simulation(seeds, capsys):
    reports = [study(seed) for seed in seeds]
    with capsys.disabled():
        if len(seeds) > 100:
            print("\n" + summary(reports))
    assert sum(report.compared for report in reports) > 8 * len(seeds)
    assert not [line for report in reports for line in report.wrong]
