"""Exponents with compliant stops: of periodic orbits against eighty digits, and their sum against its exact value.

`python tests/test_compliant_exponents.py FIRST LAST` compares the oscillators FIRST ... LAST - 1, and
`python tests/test_compliant_exponents.py sums FIRST LAST` computes such planes, a line for each;
tests/data/compliant_exponents.log is what they printed.
"""

import sys

import numpy as np
import pytest
from support import compliant_exponents, compliant_sums, slow_cases

ORBITS, PLANES = 200, 200
WITHIN = 5  # times the stated error
MOST = 1e-12  # of a residual; the share of contact, a sum of many, is known to less


def hold(reports):
    for one in reports:
        assert np.all(one.errors <= WITHIN * one.stated), one
        assert np.all(one.multiplier_errors <= WITHIN * one.multipliers_stated), one


def test_exponents_of_an_orbit_against_eighty_digits():
    report = compliant_exponents.compared(0)
    assert report.period
    hold([report])


@pytest.mark.slow
def test_exponents_of_twenty_orbits(capsys):
    reports = [compliant_exponents.compared(seed) for seed in range(22)]
    with capsys.disabled():
        print("\n" + "\n".join(compliant_exponents.table(reports)))
    hold(reports)
    assert sum(one.period > 0 and one.stated.max() < 1e-9 for one in reports) >= 18


@pytest.mark.soak
def test_exponents_of_two_hundred_oscillators(capsys):
    reports = [compliant_exponents.compared(seed) for seed in range(ORBITS)]
    with capsys.disabled():
        print("\n" + "\n".join(compliant_exponents.table(reports)))
    hold(reports)


@pytest.mark.parametrize("seeds", [(0, 1), *slow_cases(range(2, 16))])
def test_sums_of_exponents(seeds):
    """As they are stored, and as the share of contact and the impacts of the file give them."""
    for report in map(compliant_sums.summed, seeds):
        assert report.worst < MOST and report.apart < 10 * MOST, report


@pytest.mark.soak
def test_sums_of_two_hundred_planes():
    reports = [compliant_sums.summed(seed) for seed in range(PLANES)]
    assert max(one.worst for one in reports) < MOST and max(one.apart for one in reports) < 10 * MOST


if __name__ == "__main__":
    sums, (first, last) = sys.argv[1] == "sums", map(int, sys.argv[-2:])
    function = compliant_sums.summed if sums else compliant_exponents.compared
    reports = []
    for seed in range(first, last):
        reports.append(function(seed))
        print(reports[-1], flush=True)
    print("\n".join((compliant_sums if sums else compliant_exponents).table(reports)))
