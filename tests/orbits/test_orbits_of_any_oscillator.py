"""Periodic orbits of other oscillators than the paper's, against the engine's simulation."""

import numpy as np
import pytest

import vibro_sweep as vs

M = np.diag([1.0, 2.0, 1.5])
K = np.array([[2, -1, 0], [-1, 2.5, -1], [0, -1, 1.2]])
C = np.array([[0.2, -0.1, 0], [-0.1, 0.15, 0], [0, 0, 0.1]])
named = vs.Oscillator.named
# Of one mass all have a constant force, here and in other tests: others are computed by kernels of their own.
THREE = vs.Oscillator(
    M, K, C, force=[1, 0, 0.5], contact_normal=[1, -1, 0], omega=0.8, b=0.6, offset=0.05, R=0.7, R_left=0.5
)
ONE = named("one_mass", zeta=0.05, F=1.0, constant=0.1, omega=0.7, R=0.8, b=1.0, offset=0.1, stops="right")
CAVITY = named("ball_in_cavity", mass_ratio=0.1, zeta=0.05, F=1.0, omega=1.0, R=0.6, b=1.0, tau=0.0)
LINKS = {"m": [1, 1, 2, 1], "k": [1, 2, 1, 1, 0.5], "c": [0.1] * 5, "force": [0, 0, 0, 1], "stop_at": 3}
FOUR = named("chain", **LINKS, omega=0.9, R=0.7, b=0.4)
DEAD = named("one_mass", zeta=0.05, F=1.0, constant=0.1, omega=0.4, R=0.0, b=0.3, offset=0.1, stops="both")
CASES = {
    "three masses, unequal stops": (THREE, "LLRR"),
    "three masses with a larger gap": (THREE.replace(b=0.7), "LLR"),
    "three masses with a symmetric orbit": (THREE.replace(b=0.8), "LR"),
    "one mass": (ONE, "RR"),
    "ball in a cavity": (CAVITY, "LLLLRRRR"),
    "chain of four": (FOUR, "LLRR"),
    "rests without restitution": (DEAD, "LR"),
}


def settled(system):
    """A state on the attractor from rest, and its period."""
    section = vs.simulate(system, np.zeros(2 * system.masses), 3000).section
    period = next(n for n in range(1, 10) if np.abs(section[-1] - section[-1 - n]).max() < 1e-10)
    return section[-1], period


@pytest.mark.slow  # each number of masses compiles kernels of its own
@pytest.mark.parametrize("name", CASES)
def test_orbit_against_simulation(name):
    system, itinerary = CASES[name]
    state, period = settled(system)
    orbit = vs.periodic_orbit(system, state=state, periods=period)
    assert (orbit.status, orbit.itinerary, orbit.stable) == ("ok", itinerary, True)
    assert np.abs(orbit.state - state).max() < 1e-9
    simulated = vs.simulate(system, orbit.state, period)
    times = np.linspace(0, period * system.period, 200)
    assert np.abs(simulated.sample(times) - orbit.sample(times)).max() < 1e-10
    assert orbit.impacts.dtype == simulated.impacts.dtype


@pytest.mark.slow
def test_orbit_of_an_oscillator_survives_its_file(tmp_path):
    system = CASES["one mass"][0]
    orbit = vs.periodic_orbit(system, state=settled(system)[0])
    again = vs.load(orbit.save(tmp_path / "orbit.json"))
    assert again.ok and again.system == system and again.impacts.tobytes() == orbit.impacts.tobytes()
