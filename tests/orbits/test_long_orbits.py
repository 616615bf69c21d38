"""Orbits with many impacts are found, followed and differentiated as short ones are."""

from dataclasses import replace

import numpy as np
import pytest
from support import slow_cases
from support.oscillators import CHAIN, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_orbits import orbit_at
from vibro_sweep.analysis.continuation.first_point import followed_from
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.windows.job import Job, window_of
from vibro_sweep.engine.continuation.workspace import TEST
from vibro_sweep.engine.impulses.flow import rate_slopes, rates
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.tables.bifurcations import TYPES

DAMPER = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.27, zeta=0.116, F=0.99, omega=0.65, R=0.9, b=1.3)


@pytest.mark.parametrize(
    ("system", "name"),
    [
        *((PAPER, name) for name in ("R", "b", "omega", "mu_m")),
        *slow_cases(*((CHAIN, name) for name in ("R", "b", "omega", "c"))),
    ],
)
def test_slopes_of_a_long_orbit_are_those_of_the_short_one(system, name):
    short = vs.periodic_orbit(system, itinerary="LR")._solution
    solution, times = short.whole().repeated(80), 80 if short.sigma == 1 else 160
    slope, K = solution.family.derivative(name), short.K
    found, one = Linearised(solution, slope).slopes(), Linearised(short, slope).slopes()
    later = -short.P * slope.omega / solution.family.linear.omega  # dP/dp
    shifts = np.repeat(np.arange(times), K)
    expected = np.tile(one[:K], times) + later * shifts, np.tile(one[K:], times) * float(short.sigma) ** shifts
    assert found == pytest.approx(np.concatenate(expected), rel=1e-6, abs=1e-8 * np.abs(found).max())


@pytest.mark.parametrize("system", [PAPER, CHAIN, DAMPER])
def test_slopes_of_the_rates_are_those_of_differences(system):
    """Of all numbers that move the flights; the damper's contact coordinates are not those of the masses."""
    family = family_of(system)
    names = [name for name, value in family.numbers.items() if isinstance(value, float) and name not in ("R", "b")]
    for name in names:
        value = family.numbers[name]
        step = 1e-4 * max(abs(value), 0.1)
        one, two = ([rates(family.replace(**{name: value + k * h}).linear) for k in (1, -1)] for h in (step, 2 * step))
        expected = (8 * (one[0] - one[1]) - (two[0] - two[1])) / (12 * step)
        found = rate_slopes(family.linear, family.derivative(name))
        assert found == pytest.approx(expected, abs=1e-10 * max(np.abs(expected).max(), 1.0)), name
    assert len(names) > 3


def test_the_critical_direction_of_a_long_orbit():
    """A pitchfork of the paper's oscillator, written out: J(1) of 81 half orbits is singular as J(-1) of one is."""
    orbit = vs.periodic_orbit(PAPER.replace(b=3.892819435563419), itinerary="LR")
    short, solution = orbit._solution, orbit._solution.whole().repeated(61)
    one, found = Linearised(short).critical_direction(-1), Linearised(solution).critical_direction(1)
    signs = (-1.0) ** np.arange(122)
    expected = np.concatenate([one[0] * signs, -short.sigma * one[1] * np.ones(122)])
    assert abs(found @ expected) == pytest.approx(np.linalg.norm(found) * np.linalg.norm(expected), rel=1e-8)


def test_long_orbit_is_followed_like_the_short_one():
    """61 periods of the one-sided orbit written out: each of them is what the short orbit is."""
    short = vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R")
    long = short._solution.whole().repeated(61)
    start = followed_from(long, "b", 1.0)
    point = start.curve.step(start, 0.01)
    found = vs.periodic_orbit(PAPER.replace(b=point.value), itinerary="R")
    assert point.solution.jumps == pytest.approx(-1.8 * found.impacts["v1"][0], rel=1e-12)
    assert np.sign(point.tests[TEST.minus]) == np.sign(start.tests[TEST.minus])


@pytest.mark.parametrize("system", [PAPER, *slow_cases(CHAIN)])
def test_newton_finds_a_long_orbit(system):
    long = vs.periodic_orbit(system, itinerary="LR")._solution.whole().repeated(35)
    rng = np.random.default_rng(0)
    near = replace(long, u=long.u * (1 + 1e-6 * rng.normal(size=len(long.u))))
    found = near.corrected()
    assert found.change < 1e-11 and np.abs(found.u - long.u).max() < 1e-11 and found.real
    far = replace(long, u=long.u * (1 + 0.3 * rng.normal(size=len(long.u)))).corrected()
    if far is not None:
        q, states = far.family.linear, far.states
        assert np.abs(states[:, 0] - q.contact.stop(far.sides)).max() < 1e-9
        one_plus_R = 1 + q.contact.restitution(far.sides)
        assert np.abs(far.jumps + one_plus_R * states[:, q.masses]).max() < 1e-9


# from random sweeps of chains of three: system, its swept number, period, bounds, a state of the recorded orbit
LONG = {
    "R, 131 impacts": (
        dict(m=[1.7276, 0.8218, 1.5047], k=[1.8371, 0.3211, 0.3475, 0.6318], c=[0.21198, 0.03705, 0.0401, 0.07291],
             stop_at=2, stops="right", force=[1.344, 0.404, -0.262], omega=1.841, R=0.47798657718120807, b=0.05378),
        "R", 131, (0.0, 1.0), [0.178625296, -0.0579101815, 0.0438598766, -0.20547138, -0.10164796, 0.132249013],
    ),
    "R, 121 impacts": (
        dict(m=[0.4523, 1.7795, 0.4199], k=[1.2338, 0.8002, 1.1728, 0.9952], c=[0.02913, 0.01889, 0.02769, 0.0235],
             stop_at=1, stops="both", force=[1.303, 1.947, 0.282], omega=0.9541, R=0.2948993288590604, b=0.82182),
        "R", 41, (0.0, 1.0), [0.608929966, 0.137846139, 3.8751717, 0.147350898, 2.35514408, 0.0822432731],
    ),
    "b, 189 impacts": (
        dict(m=[2.9864, 1.2041, 2.3856], k=[0.3268, 2.8437, 0.4974, 2.1373], c=[0.00652, 0.05675, 0.00993, 0.04266],
             stop_at=3, stops="both", force=[0.251, -1.031, -0.49], omega=0.7291, R=0.8, b=0.2093810134228188),
        "b", 98, (0.01239975, 0.446391),
        [-0.634863674, 0.0508487612, -0.274988504, 0.00420478308, 0.125366312, -0.124083108],
    ),
    "omega, 311 impacts": (
        dict(m=[2.3455, 1.5973, 1.0771], k=[1.1261, 0.3628, 2.0928, 1.425], c=[0.05434, 0.0175, 0.10099, 0.06876],
             stop_at=2, stops="both", force=[0.252, 0.549, 1.056], omega=0.7157600000000001, R=0.8, b=2.0248),
        "omega", 139, (0.313145, 1.52099), [-1.4671242, -1.5309865, -1.38154746, -2.23157547, -1.07039699, -0.55767385],
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("case", LONG)
def test_windows_of_long_orbits(case):
    """At their ends an impact vanishes or appears, or a multiplier is on the unit circle."""
    numbers, name, period, bounds, state = LONG[case]
    job = Job(vs.Oscillator.named("chain", **numbers), np.array(state), period, name, bounds)
    arrays = window_of(job)
    assert len(arrays["impact_side"]) == int(case.split()[1]) and not arrays["branch_symmetric"]
    assert np.all(arrays["special_error"] < 2e-11)
    for point, kind, value in zip((0, -1), arrays["special_type"], arrays["special_value"], strict=True):
        system = job.system.replace(**{name: float(value)})
        orbit = orbit_at(arrays, point, system)
        solution = orbit._solution
        if TYPES[int(kind)].name == "graze":
            slowest = solution.pushes.min() / np.abs(solution.jumps).max()
            assert min(abs(orbit.stop_distance) / solution.size_of_gap, abs(slowest)) < 1e-8
        elif TYPES[int(kind)].name != "boundary":
            assert np.abs(np.abs(orbit.multipliers) - 1).min() < 1e-4


@pytest.mark.slow
def test_newton_finds_an_orbit_of_many_impacts_beside_a_fold():
    """5e-14 from it, 711 impacts with a free mass, where rounding is large; beyond the fold is none."""
    ball = dict(mass_ratio=0.1742756546125067, zeta=0.04364419723740718, F=0.9339197298888937, tau=1.278286292243059)
    ball |= dict(omega=1.973006977361091, R=0.9134945151458826, b=0.32)
    system = vs.Oscillator.named("ball_in_cavity", **ball)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="LRR", periods=1), "b", (0.3, 0.36))
    (fold,) = [special for special in branch.special if special.type == "fold"]
    there, end = fold.orbit._solution, fold.parameters["b"]
    critical = Linearised(there).critical_direction(1)
    critical /= np.linalg.norm(critical)

    def beside(distance, amplitude):
        guess = replace(there, family=family_of(system.replace(b=end + distance)), u=there.u + amplitude * critical)
        return guess.corrected()

    side = 1 if beside(1e-6, 1e-3) is not None else -1
    near, far = (beside(side * distance, 1e-3) for distance in (1e-8, 4e-8))
    if (far.u - near.u) @ critical < 0:
        critical = -critical
    one = beside(side * 5e-14, (near.u - there.u) @ critical * 5e-6**0.5)
    shifts = np.repeat(np.arange(237) * one.P, one.K)
    u = np.concatenate([np.tile(one.times, 237) + shifts, np.tile(one.jumps, 237)])
    many = replace(one, half_periods=237 * one.half_periods, sides=one.sides * 237, u=u)
    found = many.corrected()
    assert found.change < 1e-7 and np.abs(found.u - many.u).max() < 1e-6
    assert replace(many, family=family_of(system.replace(b=end - side * 1e-9))).corrected() is None
