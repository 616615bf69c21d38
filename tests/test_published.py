"""Models with names against published numbers and closed forms, by way of their periodic orbits.

x'' + 0.04 x' + x = F cos(omega t), x <= 1, R = 0.9: arXiv 2510.16218, worked out anew in 30 digits.
"""

import math

import numpy as np
import pytest

import vibro_sweep as vs


def wall(omega, F):
    return vs.Oscillator.named("one_mass", zeta=0.02, F=F, omega=omega, R=0.9, b=1, stops="right")


def specials(branch, kind):
    return [one for one in branch.special if one.type == kind]


@pytest.mark.parametrize(
    ("omega", "begin", "kind", "F", "speed"),
    [(0.81, 0.4, "flip", 0.347533397, 0.0653039433), (0.799, 0.364, "fold", 0.362836202, 0.1240873449)],
)
def test_one_impact_in_two_periods(omega, begin, kind, F, speed):
    orbit = vs.periodic_orbit(wall(omega, begin), itinerary="R", periods=2)
    branch = vs.continue_orbit(orbit, "F", (0.3, 0.5))
    (found,) = [one for one in specials(branch, kind) if abs(one.parameters["F"] - F) < 1e-3]
    assert found.parameters["F"] == pytest.approx(F, abs=6e-10)
    assert found.orbit.impacts["v1"] == pytest.approx(speed, abs=6e-11)


def test_bouncing_ball():
    """It begins at Gamma = n pi (1 - R)/(1 + R); its speed does not change on the way to the flip."""
    ball = vs.Oscillator.named(
        "one_mass", k=0, zeta=0, constant=-1, base=True, F=0.9, omega=1, R=0.8, b=0, stops="left", tau=0.0
    )
    orbit = vs.periodic_orbit(ball, itinerary="L", periods=1)
    assert orbit.impacts["v1"][0] == pytest.approx(-2 * math.pi / 1.8, rel=1e-13)
    assert math.cos(orbit.impacts["t"][0]) == pytest.approx(math.pi / 9 / 0.9, rel=1e-12)
    branch = vs.continue_orbit(orbit, "F", (0.3, 1.3))
    (fold,), (flip,) = specials(branch, "fold"), specials(branch, "flip")
    assert fold.parameters["F"] == pytest.approx(math.pi / 9, rel=1e-13)
    assert flip.parameters["F"] == pytest.approx(1.07083646824791, rel=1e-13)


@pytest.mark.parametrize(("R", "amplitude"), [(0.7, 1.0), (0.5, 0.6)])
def test_a_free_ball_in_a_shaken_cavity(R, amplitude):
    """Two impacts a period, each the mirror image of the other: between them x = -A sin(omega t) + c t + d.

    From the speeds and places at both impacts: sin(phi) + kappa cos(phi) = -b/A, kappa = pi (1 + R)/(2 (1 - R)), and
    v = -2 A omega cos(phi)/(1 - R), with phi the phase of the impact on the right.
    """
    omega, b = 1.3, 1.0
    ball = vs.Oscillator.named("one_mass", k=0, zeta=0, base=True, F=amplitude, omega=omega, R=R, b=b, tau=0.0)
    kappa = math.pi * (1 + R) / (2 * (1 - R))
    turn = math.asin(-b / amplitude / math.hypot(1, kappa))
    phases = [angle - math.atan(kappa) for angle in (turn, math.pi - turn)]
    phases = [phase % (2 * math.pi) for phase in phases if math.cos(phase) < 0]
    orbit = vs.periodic_orbit(ball, itinerary="LR", periods=1)
    assert orbit.ok and orbit.symmetric
    (hit,) = orbit.impacts[orbit.impacts["side"] > 0]
    phase = min(phases, key=lambda one: abs(math.remainder(one - omega * hit["t"], 2 * math.pi)))
    assert abs(math.remainder(phase - omega * hit["t"], 2 * math.pi)) < 1e-12
    assert hit["v1"] == pytest.approx(-2 * amplitude * omega * math.cos(phase) / (1 - R), rel=1e-12)


def test_a_ball_in_the_cavity_of_a_heavy_host():
    """A ball of next to no weight does not move its host: its cavity is shaken as the host moves without it."""
    mass_ratio, zeta, omega, R = 1e-9, 0.05, 0.8, 0.7
    both = vs.Oscillator.named(
        "ball_in_cavity", mass_ratio=mass_ratio, zeta=zeta, F=0.5, omega=omega, R=R, b=1.0, tau=0.0
    )
    response = 0.5 / complex(1 - omega**2, 2 * zeta * omega)
    shaken = vs.Oscillator.named(
        "one_mass", k=0, zeta=0, base=True, F=abs(response), omega=omega, R=R, b=1.0, tau=float(np.angle(response))
    )
    ours = vs.periodic_orbit(both, itinerary="LR", periods=1)
    assert ours.ok
    guess = [(hit["t"], hit["side"], hit["v1"]) for hit in ours.impacts]
    alone = vs.periodic_orbit(shaken, itinerary="LR", periods=1, guess=guess)
    np.testing.assert_allclose(ours.impacts["t"], alone.impacts["t"], rtol=0, atol=1e-6)
    np.testing.assert_allclose(ours.impacts["v1"], alone.impacts["v1"], rtol=1e-6)
