"""Orbits that can strike no more: the certificate and the jump, against matrix exponentials."""

import functools

import numpy as np
import pytest
from mpmath import mp
from numpy.random import default_rng
from scipy.linalg import expm
from support import slow_cases

import vibro_sweep as vs
from vibro_sweep.engine.motion import coast
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.simd.jit import exported

SYSTEMS, PARTS = 40, 64


@exported
def clear(q, o):
    return coast.is_clear(q, o)


@exported
def fly(q, nodes, o, periods):
    coast.fly_periods(q, nodes[q.cells].E, o, periods)


def draw(rng) -> vs.System:
    """A random system whose stops stand a little outside of what its steady motion reaches."""
    numbers = {
        "mu_m": 10 ** rng.uniform(-1, 1),
        "mu_k": 10 ** rng.uniform(-1, 1),
        "zeta": rng.choice([0, 10 ** rng.uniform(-3, 0)]),
        "f2": rng.uniform(),
        "omega": 10 ** rng.uniform(-0.5, 0.5),
        "R": 0.5,
    }
    steady = vs.grazing(vs.System(**numbers, b=1.0)).b
    return vs.System(**numbers, b=steady * (1 + 10 ** rng.uniform(-3, 0)), tau=rng.uniform(0, 6))


def matrices(system) -> tuple[np.ndarray, np.ndarray]:
    """A of dz/dt = A z for z = (x1, v1, x2, v2, sin, cos), and the state of the steady motion at t = 0."""
    p = system.parameters()
    K = np.array([[1, -1], [-1, 1 + p["mu_k"]]])
    M, force = np.diag([1, p["mu_m"]]), np.array([1 - p["f2"], p["f2"]])
    A = np.zeros((6, 6))
    A[0, 1] = A[2, 3] = 1
    A[1:4:2, 0:4:2], A[1:4:2, 1:4:2] = -np.linalg.solve(M, K), -2 * p["zeta"] * np.linalg.solve(M, K)
    A[1:4:2, 4] = np.linalg.solve(M, force)
    A[4, 5], A[5, 4] = p["omega"], -p["omega"]
    x = np.linalg.solve(K - p["omega"] ** 2 * M + 2j * p["zeta"] * p["omega"] * K, -1j * force)
    x = x * np.exp(1j * p["tau"])
    v = 1j * p["omega"] * x
    return A, np.array([x[0].real, v[0].real, x[1].real, v[1].real])


def expm_exactly(A, t) -> np.ndarray:
    """e^{A t}, each entry to all digits of a float."""
    with mp.workdps(40):
        return np.array(mp.expm(mp.matrix(A.tolist()) * mp.mpf(t)).tolist(), float)


def cases(orbits=20):
    """Systems, each with an engine whose orbit has started at a random distance from the steady motion."""
    rng = default_rng(7)
    for _ in range(SYSTEMS):
        system = draw(rng)
        A, steady = matrices(system)
        engine = Engine(system)
        for _ in range(orbits):
            state = steady + rng.normal(size=4) * system.b * 10 ** rng.uniform(-4, 0)
            if abs(state[0]) < system.b:
                engine.put(state)
                yield system, A, steady, engine, state


@functools.cache
def within_a_period(system) -> tuple[np.ndarray, np.ndarray]:
    """Rows (PARTS, 6): x1 at equal times of a period from z at its beginning. And the matrix (6, 6) over the period."""
    step, powers = expm(matrices(system)[0] * system.period / PARTS), [np.eye(6)]
    while len(powers) <= PARTS:
        powers.append(step @ powers[-1])
    return np.array(powers)[:-1, 0], powers[-1]


def test_no_orbit_that_is_called_clear_ever_reaches_a_stop():
    tried = called = 0
    for system, _, _, engine, state in cases():
        tried += 1
        if not clear(engine.flight.oscillator[0], engine.orbit[0]):
            continue
        called += 1
        z = np.array([*state, np.sin(system.phase), np.cos(system.phase)])
        gaps, period = within_a_period(system)
        for _ in range(200):
            assert np.abs(gaps @ z).max() < system.b
            z = period @ z
    assert tried > 500 and called > 200, (tried, called)


def test_near_the_steady_motion_all_orbits_are_clear():
    rng = default_rng(8)
    for _ in range(SYSTEMS):
        system = draw(rng)
        engine = Engine(system)
        engine.put(matrices(system)[1])
        assert clear(engine.flight.oscillator[0], engine.orbit[0])


def test_below_grazing_no_orbit_is_clear():
    rng = default_rng(9)
    for _ in range(SYSTEMS):
        system = draw(rng)
        system = system.replace(b=vs.grazing(system).b * (1 - 1e-8))
        _, steady = matrices(system)
        engine = Engine(system)
        engine.put(steady * 0.5)
        assert not clear(engine.flight.oscillator[0], engine.orbit[0])


@pytest.mark.parametrize("periods", [1, *slow_cases(2, 7, 1000)])
def test_the_state_after_many_periods(periods):
    for system, A, steady, engine, state in cases(orbits=1):
        fly(engine.flight.oscillator[0], engine.flight.nodes, engine.orbit[0], periods)
        flown = expm_exactly(A[:4, :4], system.period * periods)
        exact = steady + flown @ (state - steady)
        turns = np.abs(A).max() * system.period * periods  # at least what the fastest mode turns by
        size = (np.abs(state - steady).max() + np.abs(steady).max()) * np.abs(A).max()  # also of speeds
        assert np.abs(engine.orbit["X"][0, :4] - exact).max() < 2.0**-51 * (10 + turns) * size
