"""Newton's method from random guesses, near and far: the orbit, another orbit, or an honest failure."""

import numpy as np
import pytest
from support import slow_cases
from support.drawn_oscillators import drawn
from support.oscillators import PAPER

import vibro_sweep as vs


def attractor(system, state=None):
    start = np.zeros(2 * system.linear.masses) if state is None else state
    section = vs.simulate(system, start, 2000).section
    periods = next(n for n in range(1, 30) if np.abs(section[-1] - section[-1 - n]).max() < 1e-9)
    return vs.periodic_orbit(system, state=section[-1], periods=periods)


ORBITS = {
    "1 a half": lambda: vs.periodic_orbit(PAPER.replace(b=3.0), itinerary="LR"),
    "4": lambda: vs.periodic_orbit(PAPER.replace(b=0.6), itinerary="LLRR"),
    "10": lambda: attractor(PAPER.replace(b=0.17)),
    "three masses": lambda: attractor(*drawn(4, 3)),
}


@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("1 a half", 100),
        *slow_cases(("4", 100), ("10", 1000), ("three masses", 300)),
    ],
)
def test_what_is_called_an_orbit_is_what_the_engine_simulates(name, count):
    """Times are off by up to a tenth of the shortest flight, speeds by as much of themselves."""
    orbit = ORBITS[name]()
    assert orbit.ok
    system, impacts, n = orbit.system, orbit.impacts, orbit.period
    flight = np.diff(np.append(impacts["t"], impacts["t"][0] + n * system.period)).min()
    rng = np.random.default_rng(1)
    counted = {"ok": 0, "same": 0}
    for _ in range(count):
        off = 10 ** rng.uniform(-6, -1)
        t = impacts["t"] + off * flight * rng.uniform(-1, 1, len(impacts))
        v = impacts["v1"] * (1 + off * rng.uniform(-1, 1, len(impacts)))
        found = vs.periodic_orbit(system, guess=list(zip(t, impacts["side"], v, strict=True)), periods=n)
        counted[found.status] = counted.get(found.status, 0) + 1
        assert found.status in ("ok", "not_converged", "inadmissible")
        if found.ok:
            simulated = vs.simulate(system, found.state, found.period)
            growth = max(1.0, np.abs(found.multipliers[0]))
            assert np.abs(simulated.section[-1] - found.state).max() < 1e-11 * growth
            assert len(simulated.impacts) == len(found.impacts)
            counted["same"] += np.abs(found.state - orbit.state).max() < 1e-9
    assert counted["same"] > 0.7 * count, counted
