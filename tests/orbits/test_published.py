"""Models with names against published numbers and closed forms, by way of their periodic orbits."""

import math

import numpy as np
import pytest
from mpmath import mp, mpc, mpf

import vibro_sweep as vs


def wall(omega, F):
    return vs.Oscillator.named("one_mass", zeta=0.02, F=F, omega=omega, R=0.9, b=1, stops="right")


def specials(branch, kind):
    return [one for one in branch.special if one.type == kind]


ETA, R = 0.02, 0.9


def flight(omega):
    """E over two periods, and a and c: from one impact at speed v to the next the flight is linear about the steady
    motion s, (1 - E)(1 - s, -s') = E (0, -R v) - (0, v). So s = 1 - a v and s' = c v at the impact.
    """
    eta, u = mpf(ETA), 4 * mp.pi / mpf(omega)
    root = mp.sqrt(1 - eta**2)
    cos, sin = mp.cos(root * u), mp.sin(root * u) / root
    E = mp.exp(-eta * u) * mp.matrix([[cos + eta * sin, sin], [-sin, cos - eta * sin]])
    a, minus_c = mp.lu_solve(mp.eye(2) - E, E * mp.matrix([0, -mpf(R)]) - mp.matrix([0, 1]))
    return E, a, -minus_c


def force_of_speed(omega, v):
    """F of the orbit with this speed: F |g| is the amplitude of s."""
    with mp.workdps(30):
        (_, a, c), omega, v = flight(omega), mpf(omega), mpf(v)
        return float(mp.hypot(1 - a * v, c * v / omega) * abs(mpc(1 - omega**2, 2 * mpf(ETA) * omega)))


def special(omega, kind):
    """F and the speed at the fold or the flip of the orbits with one impact in two periods, in 30 digits.

    x'' + 0.04 x' + x = F cos(omega t), x <= 1, R = 0.9 (arXiv 2510.16218). F is least at the fold. At the flip
    1 + tr + det of the monodromy matrix E S is zero, which is linear in the speed.
    """
    with mp.workdps(30):
        (E, a, c), w, back = flight(omega), mpf(omega), mpf(R)
        if kind == "fold":
            v = a / (a**2 + (c / w) ** 2)
        else:
            steepness = (back * (E[0, 0] + E[1, 1]) - 1 - back**2 * mp.det(E)) / E[0, 1]
            # steepness v = (1 + R)(f - 1), with the force f = (1 - omega^2) s + 2 eta s'
            v = (1 + back) * -(w**2) / (steepness + (1 + back) * ((1 - w**2) * a - 2 * mpf(ETA) * c))
        return force_of_speed(omega, v), float(v)


@pytest.mark.parametrize(
    ("omega", "begin", "kind", "published"),
    [(0.81, 0.4, "flip", (0.347533397, 0.0653039433)), (0.799, 0.364, "fold", (0.362836202, 0.1240873449))],
)
def test_one_impact_in_two_periods(omega, begin, kind, published):
    """F of the published tables to 5e-7; of the closed form to 1e-12, with the speed."""
    F, speed = special(omega, kind)
    assert (F, speed) == pytest.approx(published, abs=6e-10)
    orbit = vs.periodic_orbit(wall(omega, begin), itinerary="R", periods=2)
    branch = vs.continue_orbit(orbit, "F", (0.3, 0.5))
    (found,) = [one for one in specials(branch, kind) if abs(one.parameters["F"] - F) < 1e-3]
    assert found.parameters["F"] == pytest.approx(F, abs=1e-12)
    assert found.orbit.impacts["v1"] == pytest.approx(speed, abs=1e-12)


@pytest.mark.parametrize(("omega", "begin"), [(0.81, 0.4), (0.799, 0.364)])
def test_orbits_of_the_published_tables(omega, begin):
    """Along the branch, unstable orbits among them: F of each speed."""
    orbit = vs.periodic_orbit(wall(omega, begin), itinerary="R", periods=2)
    points = vs.continue_orbit(orbit, "F", (0.3, 0.5)).points
    assert points.sizes["point"] > 20
    speeds, forces = points.impact_v.values[:, 0], points.F.values
    sums = [force_of_speed(omega, speed) for speed in speeds]
    np.testing.assert_allclose(forces, sums, rtol=0, atol=1e-12)


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


@pytest.mark.parametrize(("omega", "R", "n"), [(2.8, 0.8, 1), (2.6, 0.7, 1), (1.8, 0.8, 1), (4.3, 0.8, 2)])
def test_one_impact_without_damping(omega, R, n):
    """x'' + x = cos(omega t), x < sigma: the end of the ellipse of speeds over sigma, and the speed where the period
    doubles, by the closed forms of docs/papers/other_papers.md."""
    P, gamma = 2 * math.pi * n / omega, 1 / (1 - omega**2)
    c, r = math.sin(P) * (1 + R) / (1 - math.cos(P)), (1 - R) / omega
    d = 4 * R * math.cos(P) - 2 * (1 + R**2) + (omega**2 - 1) * c**2 * (1 - math.cos(P))
    steep = ((1 + R) * omega * math.sin(P)) ** 2 * (omega**2 * (c**2 + r**2) - 2 * d / (1 - math.cos(P)))
    doubling = abs(2 * (1 + R) * math.sin(P) * omega**2 * gamma) / math.sqrt(d**2 + steep)
    system = vs.Oscillator.named("one_mass", zeta=0, F=1, omega=omega, R=R, b=0.0, stops="right", tau=math.pi / 2)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R", periods=n), "b", (-5, 5))
    (fold,) = specials(branch, "fold")
    assert abs(fold.parameters["b"]) == pytest.approx(abs(gamma) * math.hypot(1, c / r), rel=1e-12)
    for flip in specials(branch, "flip"):
        assert flip.orbit.impacts["v1"][0] == pytest.approx(doubling, rel=1e-11)
    assert len(specials(branch, "flip")) == (omega != 1.8)


def test_amplitudes_of_a_textbook():
    """docs/papers/other_papers.md: 60 Hz, R = 0.5; the second doubling at 0.0115 cm."""
    ball = vs.Oscillator.named(
        "one_mass", k=0, zeta=0, constant=-1, base=True, F=1.2, omega=1, R=0.5, b=0, tau=0, stops="left"
    )
    (first,) = specials(vs.continue_orbit(vs.periodic_orbit(ball, itinerary="L"), "F", (1.0, 2.2)), "flip")
    _, second = specials(vs.continue_orbit(vs.switch(first)[0], "F", (1.0, 2.2)), "flip")
    centimetres = 981 / (2 * math.pi * 60) ** 2
    assert first.parameters["F"] == pytest.approx(math.hypot(math.pi / 3, 2.5 / 2.25), rel=1e-13)
    assert round(second.parameters["F"] * centimetres, 4) == 0.0115


def test_an_orbit_of_recipes_for_continuation():
    """docs/papers/other_papers.md: k = 1, c = 0.1, A = 1, w = 1, d = 1, e = 0.8."""
    system = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=1, omega=1, R=0.8, b=1, stops="right", tau=math.pi / 2)
    orbit = vs.periodic_orbit(system, itinerary="R")
    (hit,) = orbit.impacts
    assert round(hit["t"], 3) == 0.076 and round(-0.8 * hit["v1"], 2) == -1.36
    (graze,) = specials(vs.continue_orbit(orbit, "F", (0.01, 1.0001)), "graze")
    assert graze.parameters["F"] == pytest.approx(0.1, rel=1e-12)
