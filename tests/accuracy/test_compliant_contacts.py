"""The first contacts with compliant stops of random oscillators: as exact as rounding the data allows.

`python tests/accuracy/test_compliant_contacts.py FIRST LAST` compares the oscillators FIRST ... LAST - 1, a line each;
tests/data/compliant_contacts.log is what it printed.
"""

import sys

import pytest
from support import slow_cases
from support.compliant_contacts import FIELDS, LEAST, compared, drawn, error_of_sections, line, table

COUNT = 1000
FEW_MASSES = [seed for seed in range(18) if drawn(seed)[0].masses <= 2]  # others need kernels of no other fast test


def hold(reports):
    assert not [line(one) for one in reports if one["defect"]]
    assert not [line(one) for one in reports if max(one["errors"].values()) > LEAST]
    assert sum(one["compared"] for one in reports) > 5 * len(reports)


@pytest.mark.slow
def test_contacts_of_one_mass_and_of_two():
    hold([compared(seed) for seed in FEW_MASSES])


@pytest.mark.parametrize("seeds", [*slow_cases(FEW_MASSES, range(20)), pytest.param(range(60), marks=pytest.mark.soak)])
def test_sections_of_sweeps(seeds):
    """Of eight orbits side by side, over six periods."""
    errors = [error for error in map(error_of_sections, seeds) if error is not None]
    assert len(errors) > len(seeds) / 2 and max(errors) <= LEAST


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(60), 205, 936])  # these two bounce on a preload ever lower
def test_contacts_of_an_oscillator(seed):
    report = compared(seed)
    assert not report["defect"] and max(report["errors"].values()) <= LEAST


@pytest.mark.soak
def test_contacts_of_a_thousand_oscillators(capsys):
    reports = [compared(seed) for seed in range(COUNT)]
    with capsys.disabled():
        print("\n" + "\n".join(table(reports)))
    hold(reports)


if __name__ == "__main__":
    print(
        f" seed N {'release':12s}  n "
        + " ".join(f"{name[-8:]:>8s}" for name in FIELDS)
        + ": in units of what rounding does"
    )
    reports = []
    for seed in range(*map(int, sys.argv[1:])):
        reports.append(compared(seed))
        print(line(reports[-1]), flush=True)
    print("\n".join(table(reports)))
