"""Grouping orbits by their averages, without a run."""

import numpy as np
import pytest
from support.attractors import known_orbits, same_partition

from vibro_sweep.analysis.attractors import grouping


@pytest.mark.parametrize("seed", range(5))
def test_groups(seed):
    truth, period, average, error = known_orbits(300, seed)
    label = grouping.group(period, average, error)
    assert same_partition(label, truth)
    sizes = np.bincount(label)
    assert sizes[0] == 0 and np.all(np.diff(sizes[1:]) <= 0)
    order = np.random.default_rng(seed).permutation(300)
    assert same_partition(grouping.group(period[order], average[order], error[order]), truth[order])


def test_points_do_not_matter_to_each_other():
    some = [known_orbits(40, seed)[1:] for seed in range(12)]
    together = grouping.group(*(np.stack(arrays) for arrays in zip(*some, strict=True)))
    for label, one in zip(together, some, strict=True):
        assert np.array_equal(label, grouping.group(*one))


def test_equal_shares_are_numbered_by_the_first_start():
    _, period, average, error = known_orbits(300, 0)
    first = [int(np.flatnonzero(period == p)[0]) for p in (1, 5, 10)]
    for order in ([0, 1, 2], [2, 0, 1], [1, 2, 0]):
        chosen = np.array(first)[order]
        assert grouping.group(period[chosen], average[chosen], error[chosen]).tolist() == [1, 2, 3]


def test_chaos_that_changes_sides_seldom_is_one():
    """Each orbit has a mean of its own, between those of the sides; many of them fill the range."""
    average, error = np.zeros((40, 7)), np.full((40, 7), 0.01)
    average[:, 1] = np.random.default_rng(0).permutation(np.linspace(-1, 1, 40))
    average[:, 6], error[:, 6] = 0.01, 0.001
    period = np.zeros(40, int)
    assert np.all(grouping.group(period, average, error) == 1)
    apart = abs(average[:, 1]) > 0.8  # nothing between the sides: two
    assert grouping.group(period[apart], average[apart], error[apart]).max() == 2


def test_an_orbit_on_its_way_is_no_attractor():
    """It has no period, need not be chaotic, and has the averages of a periodic one; multiples of a period are one."""
    average, error = np.ones((4, 7)), np.full((4, 7), 1e-6)
    average[:, 6] = [-1e-4, -1e-4, -1e-4, 0.01]
    average[2, :6] += 0.01
    error[2:, :6], error[2:, 6] = 0.01, 1e-3
    period = np.array([35, 105, 0, 0])
    for order in ([0, 1, 2, 3], [2, 3, 1, 0], [3, 2, 0, 1]):
        label = grouping.group(period[order], average[order], error[order])
        assert label.tolist() == [(1, 1, 0, 2)[i] for i in order]


def test_failed_orbits_and_those_that_have_not_settled():
    label = np.array([[1, 1, 0, -1], [-1, -1, -1, -1]])
    share = grouping.share(label)
    assert share[0, :3].tolist() == [2 / 3, 2 / 3, 1 / 3] and np.isnan(share[0, 3]) and np.isnan(share[1]).all()
