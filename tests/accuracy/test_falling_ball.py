"""A ball that drops on a floor without a force, against its closed form.

With the acceleration g, from the height h: the n-th impact is at t_n = t_1 (1 + 2 (R - R^n)/(1 - R)) with the speed
R^(n-1) sqrt(2 g h), t_1 = sqrt(2 h/g). Between the impacts n and n + 1 the ball is R^(2n) h high at most, and from
t_1 (1 + R)/(1 - R) on it lies. The frequency of the force, which is zero, means nothing.
"""

import math

import numpy as np
import pytest

import vibro_sweep as vs

pytestmark = pytest.mark.slow  # motions of one mass between rigid stops compile kernels of their own
FADED = 1e-7  # of the first speed, below which impacts are summed up
CASES = range(40)


def floor_below(g, **numbers):
    """One mass above a stop at x = 0."""
    given = dict(k=0.0, zeta=0.0, constant=-g, F=0.0, b=0.0, stops="left", tau=0.0)
    return vs.Oscillator.named("one_mass", **(given | numbers))


class Drop:
    """A ball drawn at random, and where it is."""

    def __init__(self, seed: int):
        rng = np.random.default_rng([75, seed])
        self.h, self.g = 10 ** rng.uniform(-3, 3, 2)
        self.R = float(rng.choice([rng.uniform(0.1, 0.9), rng.uniform(0.9, 0.99), 1 - 10 ** rng.uniform(-3, -2)]))
        self.first, self.speed = math.sqrt(2 * self.h / self.g), math.sqrt(2 * self.g * self.h)
        self.rest = self.first * (1 + self.R) / (1 - self.R)
        self.omega = 2 * math.pi / (self.rest * 10 ** rng.uniform(-2, 2))  # up to a hundred periods, or one
        self.periods = math.ceil(1.2 * self.rest * self.omega / (2 * math.pi))

    def hit(self, n):
        """The time of the n-th impact."""
        return self.first * (1 + 2 * (self.R - self.R**n) / (1 - self.R))


@pytest.mark.parametrize("seed", CASES)
def test_heights_impacts_and_rest(seed):
    drop = Drop(seed)
    orbit = vs.simulate(floor_below(drop.g, R=drop.R, omega=drop.omega), [drop.h, 0.0], drop.periods)
    assert orbit.status == "ok"
    n = np.arange(1, min(len(orbit.impacts), 200))
    tops = (drop.hit(n) + drop.hit(n + 1)) / 2
    np.testing.assert_allclose(orbit.sample(tops)[:, 0], drop.R ** (2 * n) * drop.h, rtol=0, atol=1e-9 * drop.h)
    speeds = drop.speed * drop.R ** np.arange(len(orbit.impacts))
    np.testing.assert_allclose(orbit.impacts["v1"], -speeds, rtol=1e-9)
    assert abs(speeds[-1] * drop.R / (FADED * drop.speed) - 1) < 2 * (1 - drop.R)  # those listed, whatever omega is
    assert orbit.sticking["t_on"] == pytest.approx([drop.rest], rel=1e-11)


@pytest.mark.parametrize("seed", CASES)
def test_energy(seed):
    """What impacts take is m g h, the smallest speed is none, and rms x follows from the sum over all flights."""
    drop = Drop(seed)
    data = vs.sweep(
        floor_below(drop.g, omega=drop.omega, R=drop.R), {"R": [drop.R]}, transient=0, record=drop.periods,
        start={"x1": drop.h, "v1": 0.0}, observe=["energy", "impacts"], progress=None,
    ).isel(R=0)  # fmt: skip
    assert int(data.status) == 0 and float(data.min_impact_speed) == 0.0
    time = drop.periods * 2 * math.pi / drop.omega
    assert float(data.impact_power) * time == pytest.approx(drop.g * drop.h, rel=1e-12)
    flights = 8 / 15 * drop.h**2 * drop.first * (1 + 2 * drop.R**5 / (1 - drop.R**5))
    assert float(data.rms_x1) == pytest.approx(math.sqrt(flights / time), rel=1e-9)


@pytest.mark.parametrize(
    ("numbers", "start", "floor"),
    [
        (dict(stops="right", constant=1.0), -1.0, 0.0),
        (dict(b=2.0), -1.0, -2.0),
        (dict(b=5.0, offset=5.0, stops="both"), 1.0, 0.0),
        (dict(F=1e-12), 1.0, 0.0),
    ],
    ids=["right stop", "floor at -2", "in a box", "tiny force"],
)
@pytest.mark.parametrize("omega", [1e-3, 0.05, 1.0, 10.0])
def test_the_same_ball_in_other_places(numbers, start, floor, omega):
    orbit = vs.simulate(floor_below(1.0, **({"R": 0.8, "omega": omega} | numbers)), [start, 0.0], math.ceil(3 * omega))
    top = math.sqrt(2) * 1.8
    assert abs(orbit.sample([top])[0, 0] - floor) == pytest.approx(0.64, abs=1e-9)


def test_the_gap_of_two_free_masses():
    free = dict(M=np.eye(2), K=np.zeros((2, 2)), force=[0.0, 0], b=0.0, R=0.8, stops="left", omega=0.01, tau=0.0)
    pair = vs.Oscillator(**free, constant=[-0.5, 0.5], contact_normal=[1, -1])
    state = vs.simulate(pair, [1.0, 0, 0, 0], 1).sample([math.sqrt(2) * 1.8])[0]
    assert state[0] - state[2] == pytest.approx(0.64, abs=1e-9)


def test_too_many_impacts_have_a_status():
    """At R = 0.9999 a sequence has 160 000 impacts until they have faded."""
    assert vs.simulate(floor_below(1.0, R=0.9999, omega=1e-5), [1.0, 0.0], 1).status == "too_many_impacts_in_a_period"
