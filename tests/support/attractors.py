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


def in_order(numbers) -> bool:
    """Whether 1, 2, ... appear first in this order."""
    seen = [int(number) for number in dict.fromkeys(np.ravel(numbers).tolist()) if number > 0]
    return seen == list(range(1, len(seen) + 1))


WINDOW = """
sweep: {b: {start: 6.594, stop: 6.612, num: 37}}
start: {random: 6, seed: 2}
orbit: {transient: 6000, record: 400}
observe: [attractors]"""
PLANE = """
sweep: {x1: {start: -6.7, stop: 6.7, num: 9}, v1: {values: [3, 0, -0.3]}}
start: {x2: 3.2286, v2: 0.2475}
orbit: {transient: 5000, record: 200}
observe: [attractors]"""
AXES = {"x1": "{values: [-6, -3, 0, 3, 6]}", "b": "{values: [6.72, 6.734, 6.74]}"}
ALONG_B = {  # initial states along a clearance, and clearances along an initial state
    keys: f"""
sweep: {{{", ".join(f"{key}: {AXES[key]}" for key in keys)}}}
start: {{x2: 3.2286, v2: 0.2475}}
orbit: {{transient: 5000, record: 200}}
observe: [attractors]"""
    for keys in (("x1", "b"), ("b", "x1"))
}
ROWS = """
sweep: {R: {values: [0.799, 0.8, 0.801]}, b: {start: 6.598, stop: 6.609, num: 12}}
start: {random: 6, seed: 1}
orbit: {transient: 6000, record: 200}
observe: [attractors]"""
