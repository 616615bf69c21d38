"""Errors that are stated for births of doubled and asymmetric orbits (tests/support/births.py)."""

import pytest
from mpmath import mp, mpf
from support.births import births, summary
from support.branches import exact as in_digits


@pytest.mark.parametrize(
    "seeds",
    [
        pytest.param([6, 7], marks=pytest.mark.slow),  # kernels of one mass
        pytest.param([340, 442], marks=pytest.mark.slow),  # in narrow bounds the errors were too small
        pytest.param(range(100), marks=pytest.mark.slow),
        pytest.param(range(100, 1100), marks=pytest.mark.soak),
    ],
    ids=len,
)
def test_births_located_several_times(seeds, capsys):
    found = [one for seed in seeds for one in births(seed)]
    if len(seeds) > 3:
        with capsys.disabled():
            print("\n" + summary(found, len(seeds)))
    assert len(found) > len(seeds) / 2
    assert [one for one in found if one.ratio > 1] == []


@pytest.mark.slow
def test_births_in_many_digits():
    """Against 45 digits; orbits of four to sixteen impacts."""
    counted = 0
    for seed, impacts in ((0, 5), (7, 16), (44, 4)):
        found = [one for one in births(seed) if one.impacts == impacts]
        points = {id(point): point for one in found for point in one.points}.values()
        ((name, _),) = found[0].points[0].parameters.items()
        with mp.workdps(30):
            exact = in_digits(found[0].points[0], name)
            assert all(abs(mpf(point.parameters[name]) - exact) < point.error for point in points), found[0].where
        counted += len(points)
    assert counted == 9
