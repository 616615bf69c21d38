"""Special points and multipliers of random oscillators in many digits: N = 1 and 3, any damping, unequal stops.

All points of the first fourteen oscillators in b, omega, R, R_left and offset were computed once: 114 points (37 flips,
37 grazes, 21 Neimark-Sacker points, 19 folds), the largest error 1.6e-14. A fixed sample of them is tested.
"""

import numpy as np
import pytest
from mpmath import mp
from reference.closed_orbit import ClosedOrbit
from support.in_digits import closed_of, errors_of, of_orbit
from support.random_branches import attractors, bounds_of, random_oscillator

import vibro_sweep as vs

pytestmark = pytest.mark.slow


def attractor(seed):
    """The first periodic orbit with impacts that a random oscillator comes to."""
    rng = np.random.default_rng(seed)
    system = random_oscillator(rng)
    ((state, n),) = attractors(system, rng, most=1, tries=3)
    orbit = vs.periodic_orbit(system, state=state, periods=n)
    assert orbit.ok and len(orbit.impacts)
    return orbit


@pytest.mark.parametrize(
    ("seed", "name", "types"),
    [
        (11, "b", "graze fold graze"),
        (6, "omega", "graze flip flip"),
        (0, "b", "neimark_sacker flip graze"),
        (0, "omega", "graze flip neimark_sacker neimark_sacker neimark_sacker flip"),
        (10, "omega", "flip fold graze"),
        (4, "b", "graze neimark_sacker graze"),
        (11, "R_left", "graze flip"),
        (10, "offset", "neimark_sacker"),
    ],
)
def test_special_points_in_30_digits(seed, name, types):
    orbit = attractor(seed)
    branch = vs.continue_orbit(orbit, name, bounds_of(orbit.system, name))
    special = [s for s in branch.special if s.type != "boundary"]
    assert [s.type for s in special] == types.split()
    for s in special:
        (off,) = errors_of(s)
        assert abs(off) < min(s.error, 1e-13)


@pytest.mark.parametrize("seed", [11, 0, 1, 2, 4, 6, 10, 13])
def test_multipliers_in_60_digits(seed):
    """Of the attractor, each to 1e-9 of itself."""
    orbit = attractor(seed)
    with mp.workdps(60):
        d = closed_of(of_orbit(orbit))
        closed = ClosedOrbit(d.machine, *d.of, digits=60)
        expected = np.array([complex(mu) for mu in closed.multipliers(*closed.solve(*d.guess))])
    expected = expected[np.lexsort((-expected.imag, -np.abs(expected)))]
    found = orbit.half_multipliers if orbit.symmetric else orbit.multipliers
    assert np.all(np.abs(found - expected) < 1e-9 * np.abs(expected))
