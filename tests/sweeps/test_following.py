"""Grouping orbits in pieces and following attractors along a curve of points: against slow versions."""

import math

import numpy as np
import pytest
from support import slow_cases

from vibro_sweep.analysis.attractors import following
from vibro_sweep.analysis.attractors.following import Attractors, Follower

# Following


def slow_distance(one, other):
    """Between two attractors (period, mean, error, size): infinite where they cannot be the same."""
    if (one[0] > 0) != (other[0] > 0):
        return math.inf
    result, rate = 0.0, max(*one[1][4:], *other[1][4:], 1e-9)
    for i in range(6):
        change = abs(one[1][i] - other[1][i]) - 4 * (one[2][i] + other[2][i])
        if i >= 4 and one[0] > 0 and change > 1e-9:
            return math.inf
        result = max(result, change / (max(one[3], other[3]) if i < 4 else rate))
    return result if result <= 0.1 else math.inf


def slow_pairs(before, here):
    """{key of here: key of before}, nearest first."""
    found = sorted((slow_distance(a, b), m, n) for m, a in before.items() for n, b in here.items())
    pairs = {}
    for distance, m, n in found:
        if distance < math.inf and m not in pairs.values() and n not in pairs:
            pairs[n] = m
    return pairs


def slow_numbers(points):
    """Point by point: `points` are lists of attractors in the order of their first orbits."""
    last, lost, result, count = {}, {}, [], 0
    for point in points:
        here = dict(enumerate(point))
        names = slow_pairs(last, here)
        lost |= {number: known for number, known in last.items() if number not in names.values()}
        nameless = {n: known for n, known in here.items() if n not in names}
        for n, number in slow_pairs(lost, nameless).items():
            names[n] = number
            del lost[number]
        for n in here:
            if n not in names:
                names[n] = count = count + 1
        last = {names[n]: known for n, known in here.items()}
        result.append([names[n] for n in here])
    return result


def invented(seed, points=300):
    """Branches that drift, end, begin, are missed, change their place, and become chaotic."""
    random = np.random.default_rng(seed)
    branches, result = [], []
    for _ in range(points):
        branches = [branch for branch in branches if random.uniform() > 0.03]
        if random.uniform() < 0.15:
            period = int(random.integers(0, 4))
            rates = random.integers(0, 4, 2) / max(period, 1)
            branches.append([period, np.concatenate([random.normal(size=4), rates]), random.normal(size=6) / 100])
        for branch in branches:
            branch[2][4:] *= branch[0] == 0
            branch[1] = branch[1] + branch[2]
            branch[0] *= 2 if random.uniform() < 0.02 else 1
        here = []
        for period, mean, _ in branches:
            if random.uniform() > 0.2:
                error = np.full(6, 0.01 if period == 0 else 1e-6) * [1, 1, 1, 1, period == 0, period == 0]
                mean = np.concatenate([mean[:4], abs(mean[4:])])
                here.append((period, mean, error, max(1.0, abs(mean[:4]).max())))
        random.shuffle(here)
        result.append(here)
    return result


def arrays_of(points, random):
    """The same for the package: attractors in any order among those of a point, told by their first orbits."""
    found = following.none(len(points), max(map(len, points)))
    places = []
    for n, here in enumerate(points):
        order = random.permutation(len(here))
        for at, which in enumerate(order):
            period, mean, error, size = here[which]
            found.period[n, at], found.mean[n, at], found.error[n, at] = period, mean, error
            found.size[n, at], found.first[n, at] = size, which
        places.append(np.argsort(order))
    return found, places


@pytest.mark.parametrize("part", [1, *slow_cases(7, 1000)])
@pytest.mark.parametrize("seed", [0, 1, *slow_cases(*range(2, 6))])
def test_numbers_are_those_of_the_slow_version(seed, part):
    """However the points are handed over."""
    points = invented(seed)
    found, places = arrays_of(points, np.random.default_rng(seed))
    follower = Follower()
    numbers = np.concatenate([follower.number(found.at(slice(n, n + part))) for n in range(0, len(points), part)])
    expected = slow_numbers(points)
    assert [numbers[n, place].tolist() for n, place in enumerate(places)] == expected
    assert max(map(len, points)) > 3 and max(map(max, filter(None, expected))) > 20


def test_how_many_pairs_at_once_does_not_matter(monkeypatch):
    found, _ = arrays_of(invented(0), np.random.default_rng(0))
    whole = Follower().number(found)
    monkeypatch.setattr(following, "PAIRS", 50)
    assert np.array_equal(Follower().number(found), whole)


def test_lost_attractors_are_forgotten_in_the_end():
    """The one that was lost first, when there is no more room; then its number does not come back."""
    room = following.REMEMBERED

    def one(n):
        mean = np.array([[[float(n), 0, 0, 0, 0, 0]]])
        return Attractors(np.array([[1]]), mean, np.zeros((1, 1, 6)), np.ones((1, 1)), np.zeros((1, 1), int))

    for others, expected in ((room - 2, 1), (room - 1, room + 2)):
        follower = Follower()
        numbers = [int(follower.number(one(n))[0, 0]) for n in [*range(others + 1), others + 1, 0]]
        assert numbers[-1] == expected and numbers[:-1] == list(range(1, others + 3))


def test_a_symmetric_attractor_that_splits_hands_its_number_to_one_image():
    """To the nearer one; of two that are equally near, to the one that an earlier start reaches. No third is born."""
    for left, right, expected in ((0.02, 0.02, [1, 2]), (0.03, 0.02, [2, 1]), (0.02, 0.03, [1, 2])):
        means = [[0.0], [0.0], [-left, right], [-2 * left, 2 * right]]
        found = following.none(4, 2)
        for n, here in enumerate(means):
            for at, x in enumerate(here):
                found.period[n, at], found.mean[n, at], found.first[n, at] = 1, [x, 0, 0, 0, 1, 1], at
        numbers = Follower().number(found)
        assert numbers[:2, 0].tolist() == [1, 1]
        assert numbers[2].tolist() == numbers[3].tolist() == expected


def test_a_graze_and_chaos_end_a_number_and_a_doubled_period_does_not():
    def path(*points):
        found = following.none(len(points), 1)
        for n, (period, x, right) in enumerate(points):
            found.period[n], found.mean[n], found.first[n] = period, [x, 0, 0, 0, right, 0], 0
        return Follower().number(found)[:, 0].tolist()

    assert path((3, 1.0, 1 / 3), (6, 1.01, 1 / 3), (12, 1.02, 4 / 12)) == [1, 1, 1]
    assert path((3, 1.0, 1 / 3), (3, 1.01, 2 / 3), (3, 1.02, 1 / 3)) == [1, 2, 1]  # with another impact, and back
    assert path((3, 1.0, 1 / 3), (0, 1.01, 1 / 3), (0, 1.02, 0.34), (3, 1.03, 1 / 3)) == [1, 2, 2, 1]
    assert path((3, 1.0, 1 / 3), (3, 1.09, 1 / 3), (3, 1.3, 1 / 3)) == [1, 1, 2]  # too far
