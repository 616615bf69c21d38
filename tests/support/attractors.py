"""Orbits on known attractors, and whether two labellings are one."""

import numpy as np


def same_partition(one, other) -> bool:
    """Whether two labellings differ in the names of the parts alone."""
    pairs = set(zip(np.ravel(one).tolist(), np.ravel(other).tolist(), strict=True))
    return len(pairs) == len({a for a, _ in pairs}) == len({b for _, b in pairs})


def known_orbits(n, seed):
    """Orbits on known attractors, in random order: their truth, period, average and error."""
    random = np.random.default_rng(seed)
    period = np.array([0, 0, 1, 5, 5, 10])
    middle = np.tile(random.normal(size=7), (6, 1))
    middle[:, 6] = [0.01, 0.01, -0.1, -0.02, -0.02, -0.01]
    middle[1, 1] += 3  # chaotic twins
    middle[2, 4:6] = 0  # no impacts
    middle[4, 0] += 0.1  # periodic twins
    middle[5, 2] += 0.1  # the period doubled one is another
    truth = random.integers(0, 6, n)
    error = np.where(period[truth, None] > 0, 1e-6, 0.05) * np.ones(7)
    error[:, 6] = 1e-3
    average = middle[truth] + error * random.normal(size=(n, 7)).clip(-2, 2)
    return truth, period[truth], average, error
