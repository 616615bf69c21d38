"""Periodic orbits at the edge: many impacts, no damping, long periods, vanishing impact speeds."""

import math

import numpy as np
import pytest
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.machine import machine_of
from scipy.linalg import expm
from scipy.optimize import brentq
from support.in_digits import errors_of
from support.oscillators import ONE_MASS, PAPER

import vibro_sweep as vs


def of_state(system, periods=1, settle=2000):
    state = vs.simulate(system, (0, 0, 0, 0), settle).section[-1]
    return vs.periodic_orbit(system, state=state, periods=periods)


@pytest.mark.parametrize(("b", "impacts"), [(0.0647, 68), (0.06464, 106)])
def test_many_impacts_near_the_onset_of_sticking(b, impacts):
    """The onset is b = 0.064639143358."""
    orbit = of_state(PAPER.replace(b=b), settle=400)
    assert orbit.ok and orbit.symmetric and len(orbit.impacts) == impacts and orbit.residual < 1e-8
    simulated = vs.simulate(orbit.system, orbit.state, 1)
    rounding = 1e-17 / np.abs(orbit.impacts["v1"]).min()  # of the gap, over the slowest impact
    assert np.abs(simulated.section[-1] - orbit.state).max() < 1e-11 + rounding
    assert np.sort(simulated.impacts["v1"]) == pytest.approx(np.sort(orbit.impacts["v1"]), abs=1e-10)
    expected = impacts * 2 * math.log(PAPER.R) + orbit.system.divergence * orbit.system.period
    product = np.prod(orbit.half_multipliers)
    assert 2 * math.log(abs(product)) == pytest.approx(expected, rel=1e-9)
    branch = vs.continue_orbit(orbit, "b", (0.06, 0.07))
    assert branch.begins.type == branch.ends.type == "graze" and "fold" in [s.type for s in branch.special]


@pytest.mark.slow
def test_period_29_from_its_graze_to_its_fold():
    """evidence.md, b = 6.69: symmetric, four impacts on each stop."""
    orbit = of_state(PAPER.replace(b=6.69), 29, settle=6000)
    assert (orbit.status, orbit.itinerary, orbit.symmetric, orbit.half) == ("ok", "LLLLRRRR", True, 4)
    branch = vs.continue_orbit(orbit, "b", (6.5, 6.75))
    assert [special.type for special in branch.special] == ["graze", "fold", "graze"]
    for special in branch.special:
        assert np.abs(errors_of(special)).max() < 1e-13


def test_without_damping():
    system = PAPER.replace(zeta=0.0, tau=0.0, b=3.0)
    orbit = vs.periodic_orbit(system, itinerary="LR")
    assert np.prod(orbit.multipliers) == pytest.approx(PAPER.R**4, rel=1e-12)
    branch = vs.continue_orbit(orbit, "b", (0.3, 6.5))
    assert [special.type for special in branch.special] == ["graze", "pitchfork", "boundary"]
    for special in branch.special[:2]:
        assert np.abs(errors_of(special)).max() < 1e-13
    into_damping = vs.continue_orbit(orbit, "zeta", (0.0, 0.1))
    assert into_damping.begins.type == "boundary" and into_damping.begins.parameters["zeta"] == 0.0


@pytest.mark.slow
def test_without_damping_and_without_losses():
    """R = 1, zeta = 0: the map keeps volume, and no Neimark-Sacker point is reported."""
    system = PAPER.replace(zeta=0.0, tau=0.0, b=3.0, R=1.0)
    orbit = vs.periodic_orbit(system, itinerary="LR")
    assert orbit.ok and np.prod(orbit.multipliers) == pytest.approx(1, rel=1e-11)
    branch = vs.continue_orbit(orbit, "b", (0.5, 6.5))
    assert "neimark_sacker" not in [special.type for special in branch.special]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_multipliers_of_random_attractors_in_40_digits(seed):
    """Each to 1e-9 relative, whatever its size."""
    from support.random_branches import attractors, random_system

    rng = np.random.default_rng(seed + 500)
    system = random_system(rng)
    for state, n in attractors(system, rng, most=2, tries=4):
        orbit = vs.periodic_orbit(system, state=state, periods=n)
        if not orbit.ok or not len(orbit.impacts):
            continue
        length = orbit.period * system.period
        hits = np.sort(orbit.impacts, order="t")
        hits["t"] %= length
        hits, machine = np.sort(hits, order="t"), machine_of(system.linear)
        closed = ClosedOrbit(machine, impacts_of(machine, hits["side"]), orbit.period)
        expected = np.array([complex(mu) for mu in closed.multipliers(*closed.solve(orbit.state, hits["t"]))])
        for value in orbit.multipliers:
            nearest = expected[np.argmin(np.abs(expected - value))]
            others = np.abs(expected - nearest)[np.abs(expected - nearest) > 0]
            condition = max(1.0, np.abs(nearest) / others.min())
            speed = np.abs(orbit.impacts["v1"]).min() / (system.omega * system.b)
            assert abs(value - nearest) < abs(nearest) * max(1e-9, 100 * condition**2 * 2e-16 / speed**2)


class OneMass:
    """x'' + 0.04 x' + x = F cos(omega t), x <= 1, over two forcing periods, by shooting with the state."""

    def __init__(self, F):
        self.A = np.array([[0, 1, 0, 0], [-1, -0.04, F, 0], [0, 0, 0, -0.81], [0, 0, 0.81, 0.0]])
        self.P = 2 * 2 * math.pi / 0.81
        self.grid = np.linspace(0, self.P, 4001)
        self.step = expm(self.A * self.grid[1])

    def __call__(self, state):
        z, t = np.array([*state, 1.0, 0.0]), 0.0
        for end in self.grid[1:]:
            after = expm(self.A * (end - t)) @ z if t != end - self.grid[1] else self.step @ z
            if after[0] > 1 >= z[0]:
                hit = brentq(lambda u, z=z: (expm(self.A * u) @ z)[0] - 1, 0, end - t, xtol=1e-16)
                z = expm(self.A * hit) @ z
                z[1] *= -0.9
                z = expm(self.A * (end - t - hit)) @ z
            else:
                z = after
            t = end
        return z[:2]


def shoot(period_map, state, steps=12):
    """Newton's method with differences: (state, last change)."""
    h, change = 1e-9, np.inf
    for _ in range(steps):
        image = period_map(state)
        J = np.array([(period_map(state + h * axis) - image) / h for axis in np.eye(2)]).T
        step = np.linalg.solve(J - np.eye(2), image - state)
        state, change = state - step, np.abs(step).max()
        if change < 1e-9:
            break
    return state, change


def test_where_shooting_fails():
    """arXiv 2510.16218: towards the graze the state's equations become singular, those of the impulses do not."""
    graze = 0.34542288575020583
    speeds = []
    for distance, shooting_works in ((0.02, True), (1e-9, False)):
        family = ONE_MASS.replace(F=graze + distance)
        orbit = vs.periodic_orbit(family, itinerary="R", periods=2) if distance > 1e-6 else vs.periodic_orbit(
            family, guess=[(0.116, 1, distance)], periods=2
        )  # fmt: skip
        assert orbit.ok and orbit.residual < 1e-13
        speeds.append(float(orbit.impacts["v1"][0]))
        found, change = shoot(OneMass(graze + distance), orbit.state + np.array([1e-5, -1e-5]))
        # from this guess near the graze it comes to the motion that misses the stop, or to none
        assert (change < 1e-9 and np.abs(found - orbit.state).max() < 1e-9) == shooting_works
    assert speeds[1] < 1e-7 < speeds[0]
