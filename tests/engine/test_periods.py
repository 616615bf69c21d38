"""The least period of section points, of orbits that are still on their way to a periodic one."""

from typing import NamedTuple

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.engine import periods
from vibro_sweep.engine.simd.jit import exported

NUMBERS = 4
find_period = exported(periods.find_period.__wrapped__)


class Orbit(NamedTuple):
    c: np.ndarray
    largest: np.ndarray


def approaching(rng, period: int) -> np.ndarray:
    """Section points of an orbit of that period, which one or two modes of any multiplier have not quite left."""
    points = rng.normal(size=(period, NUMBERS))
    count = int(rng.choice([24, 40, 60, 100, 200]))
    points, size = points[np.arange(count) % period], 10 ** rng.uniform(-9, -4)
    for _ in range(rng.integers(1, 3)):
        radius = 1 - 10 ** rng.uniform(-2.5, -0.5)
        angle = rng.choice([0, np.pi / 2, 2 * np.pi / 3, np.pi]) + 0.05 * rng.normal()
        multiplier = radius * np.exp(1j * (rng.uniform(0, np.pi) if rng.random() < 0.7 else angle))
        mode = rng.normal(size=NUMBERS) + 1j * rng.normal(size=NUMBERS)
        points += size * 10 ** rng.uniform(-2, 0) * (multiplier ** np.arange(count)[:, None] * mode).real
    return points


@pytest.mark.parametrize("period", [1, 2, 3, 4])
def test_no_multiple_of_the_least_period_is_found(period):
    """Of 3000 orbits some 1500 repeat themselves in the end; of 1000 at most 25 after a multiple, where it was 50."""
    rng, found = np.random.default_rng(period), []
    for _ in range(3000):
        points = approaching(rng, period)
        largest = np.abs(points).max(axis=0)
        found.append(find_period(points, Orbit(np.zeros(NUMBERS // 2), largest), np.zeros(NUMBERS), 1e-10))
    found = np.array(found)
    assert np.sum(found > 0) > 1000 and np.mean(found[found > 0] == period) > 0.975


@pytest.mark.slow  # a kernel of its own is compiled
def test_a_spiral_by_a_quarter_has_no_longer_period():
    """Multiplier 0.054 + 0.976 i: after four points it is nearer to where it was than after one."""
    system = vs.Oscillator(
        M=[[2, 0], [0, 1]], K=[[3, -1], [-1, 1]], C=[[0.1, 0], [0, 0.1]], force=[1, 0], contact_normal=[-1, 1], b=0.8,
        omega=0.62, k_stop=40, c_stop=2, release="force", tau=0,
    )  # fmt: skip
    for transient in range(400, 800, 10):
        assert vs.sweep(system, {"omega": [0.62]}, transient=transient, record=60, observe=["section"]).period in (0, 1)
