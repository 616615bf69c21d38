"""Whether an orbit has arrived, from its section points alone: of drawn points the way is known."""

from typing import NamedTuple

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.engine.observed import arrival, two_modes
from vibro_sweep.engine.simd.jit import exported

NUMBERS = 4
set_scale, look = exported(arrival.set_scale.__wrapped__), exported(arrival.look.__wrapped__)
FOUND = np.dtype(
    [("period", int), ("approached_period", int), ("approached_distance", float), ("approached_factor", float)]
)


class Orbit(NamedTuple):
    c: np.ndarray


def looked_at(points: np.ndarray) -> np.void:
    """What is found of section points (n, 4)."""
    found, scale = np.zeros(1, FOUND), np.empty(NUMBERS)
    set_scale(scale, np.abs(points).max(axis=0), 2 * np.pi)
    look(points, Orbit(np.zeros((NUMBERS // 2, 1))), scale, arrival.ROUNDING, two_modes.new_fit(), found[0])
    return found[0]


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
    """Of 3000 orbits more than 1000 repeat themselves in the end."""
    rng = np.random.default_rng(period)
    found = np.array([looked_at(approaching(rng, period))["period"] for _ in range(3000)])
    assert np.sum(found > 0) > 1000 and np.mean(found[found > 0] == period) > 0.975


@pytest.mark.parametrize("period", [1, 2, 3, 5])
def test_how_far_it_is_and_how_fast_it_goes(period):
    """One pair of multipliers, turning by any angle, or a real one: 400 orbits of each period, all on their way."""
    rng = np.random.default_rng(period)
    for _ in range(400):
        orbit, count = rng.normal(size=(period, NUMBERS)), int(rng.integers(60, 200))
        radius, size = 1 - 10 ** rng.uniform(-4, -1.5), 10 ** rng.uniform(-2, 1)  # far enough to be on its way
        per_period = radius * np.exp(1j * rng.choice([0.0, rng.uniform(0.1, 3)]))
        modes = rng.normal(size=(period, NUMBERS)) + 1j * rng.normal(size=(period, NUMBERS))
        n = np.arange(count)
        points = orbit[n % period] + size * (per_period ** (n // period)[:, None] * modes[n % period]).real
        found, scale = looked_at(points), np.abs(points).max(axis=0)
        left = np.abs((points - orbit[n % period]) / np.maximum(scale, 1e-3 * scale.max()))[-period:].max()
        if left < 1e-4:
            continue
        assert (found["period"], found["approached_period"]) == (0, period)
        assert abs(found["approached_factor"] ** period - radius) < 1e-6
        assert abs(found["approached_distance"] / left - 1) < 1e-3


def by_two_modes(rng, period: int, size: float):
    """Section points on the way to an orbit of that period by two pairs of multipliers, of which neither has died out,
    from so far; how far it is still; and the moduli of the two."""
    orbit, count = rng.normal(size=(period, NUMBERS)), int(rng.integers(80, 200))
    radii, angles = 1 - 10 ** rng.uniform(-4, -2, 2), rng.uniform([0.2, 1.6], [1.4, 3.0])
    n, points = np.arange(count), orbit[np.arange(count) % period]
    for multiplier, part in zip(radii * np.exp(1j * angles), 10 ** rng.uniform(-1, 0, 2), strict=True):
        modes = rng.normal(size=(period, NUMBERS)) + 1j * rng.normal(size=(period, NUMBERS))
        points = points + size * part * (multiplier ** (n // period)[:, None] * modes[n % period]).real
    scale = np.abs(points).max(axis=0)
    left = np.abs((points - orbit[n % period]) / np.maximum(scale, 1e-3 * scale.max()))[-period:].max()
    return points, left, radii


@pytest.mark.parametrize("period", [1, 2, 3])
def test_two_modes_at_once(period):
    """300 orbits of each period, all on their way."""
    rng, seen = np.random.default_rng(period), 0
    for _ in range(300):
        points, left, radii = by_two_modes(rng, period, 1.0)
        if left < 1e-3:
            continue
        seen += 1
        found = looked_at(points)
        assert (found["period"], found["approached_period"]) == (0, period)
        assert abs(found["approached_factor"] ** period - radii.max()) < 1e-5
        assert abs(found["approached_distance"] / left - 1) < 1e-2
    assert seen > 280


@pytest.mark.parametrize("period", [1, 2, 3, 6])
def test_an_orbit_that_two_modes_have_nearly_left_has_arrived(period):
    rng = np.random.default_rng(period)
    for _ in range(300):
        found = looked_at(by_two_modes(rng, period, 10 ** rng.uniform(-9, -8))[0])
        assert (found["period"], found["approached_period"]) == (period, 0)


def test_chaos_and_tori_are_not_on_their_way():
    """1000 orbits of the Hénon map, and 1000 that turn by two frequencies."""
    rng, wrong = np.random.default_rng(1), 0
    for _ in range(1000):
        x, points = rng.uniform(-0.1, 0.1, (NUMBERS // 2, 2)), []
        for _ in range(int(rng.integers(40, 200)) + 100):
            x = np.stack([1 - 1.4 * x[:, 0] ** 2 + x[:, 1], 0.3 * x[:, 0]], axis=1)
            points.append(x.ravel())
        found = looked_at(np.array(points[100:]))
        wrong += found["period"] > 0 or found["approached_period"] > 0
        angles = np.arange(int(rng.integers(40, 200)))[:, None] * rng.uniform(0.1, 3, 2)
        circle = np.concatenate([np.cos(angles), np.sin(angles + 0.3 * np.sin(angles[:, ::-1]))], axis=1)
        found = looked_at(circle)
        wrong += found["period"] > 0 or found["approached_period"] > 0
    assert wrong <= 10  # half a per cent


def test_a_drift_is_no_approach():
    """A free mass that moves on by as much in each period: |z| is 1 but for rounding."""
    rng = np.random.default_rng(2)
    for _ in range(200):
        n = np.arange(int(rng.integers(40, 200)))[:, None]
        points = rng.normal(size=NUMBERS) + 10 ** rng.uniform(-3, 3) * n * rng.normal(size=NUMBERS)
        assert looked_at(points)["approached_period"] == 0


@pytest.mark.slow  # a kernel of its own is compiled
def test_a_spiral_by_a_quarter_has_no_longer_period():
    """Multiplier 0.054 + 0.976 i: after four points it is nearer to where it was than after one."""
    system = vs.Oscillator(
        M=[[2, 0], [0, 1]], K=[[3, -1], [-1, 1]], C=[[0.1, 0], [0, 0.1]], force=[1, 0], contact_normal=[-1, 1], b=0.8,
        omega=0.62, k_stop=40, c_stop=2, release="force", tau=0,
    )  # fmt: skip
    for transient in range(400, 800, 10):
        assert vs.sweep(system, {"omega": [0.62]}, transient=transient, record=60, observe=["section"]).period in (0, 1)
