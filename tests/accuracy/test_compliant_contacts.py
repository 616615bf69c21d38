"""The first contacts with compliant stops of random oscillators: as exact as rounding the data allows."""

import pytest
from support import slow_cases
from support.compliant_contacts import drawn, study, study_of_sections
from support.searching import searched

FEW_MASSES = [seed for seed in range(18) if drawn(seed)[0].masses <= 2]  # others need kernels of no other fast test


# 205 and 936 bounce on a preload ever lower
@pytest.mark.parametrize("seeds", slow_cases(FEW_MASSES, [*range(60), 205, 936]), ids=len)
def test_contacts(seeds):
    counted, wrong = searched(study, seeds)
    assert wrong == [] and counted["contacts"] > 5 * len(seeds)


@pytest.mark.parametrize("seeds", slow_cases(FEW_MASSES, range(20)), ids=len)
def test_sections_of_sweeps(seeds):
    """Of eight orbits side by side, over six periods."""
    counted, wrong = searched(study_of_sections, seeds)
    assert wrong == [] and counted["compared"] > len(seeds) / 2
