"""`periodic_orbit`: orbits with impacts by Newton's method, their multipliers and certificate."""

import math
from collections import Counter

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.machine import machine_of
from support import slow_cases
from support.oscillators import BALL, CAVITY, CHAIN, ONE_MASS, PAPER

import vibro_sweep as vs


def agrees_with_simulation(orbit, tolerance):
    simulated = vs.simulate(orbit.system, orbit.state, orbit.period)
    assert np.abs(simulated.section[-1] - orbit.state).max() < tolerance
    length = orbit.period * orbit.system.period
    mine = np.sort(orbit.impacts["t"] % length)
    assert simulated.impacts["t"] == pytest.approx(mine, abs=tolerance)
    times = np.linspace(0, length, 300)
    assert np.abs(orbit.sample(times) - simulated.sample(times)).max() < tolerance


@pytest.fixture(scope="module")
def thirteen():
    """The period-13 attractor at b = 6.6 as a sweep records it."""
    system = PAPER.replace(b=6.6)
    return system, vs.simulate(system, (0, 0, 0, 0), 3000).section[-1]


def test_orbit_from_an_itinerary_is_symmetric_and_is_what_the_engine_simulates():
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    assert orbit.ok and orbit.symmetric and orbit.stable and orbit.half == 1
    assert orbit.impacts["side"].tolist() == [-1, 1]
    assert orbit.impacts["t"][1] - orbit.impacts["t"][0] == pytest.approx(PAPER.period / 2, abs=1e-13)
    assert orbit.residual < 1e-14
    agrees_with_simulation(orbit, 1e-12)


def test_orbit_from_a_recorded_state(thirteen):
    system, state = thirteen
    orbit = vs.periodic_orbit(system, state=state, periods=13)
    assert (orbit.status, orbit.period, orbit.symmetric, orbit.stable) == ("ok", 13, False, True)
    assert orbit.itinerary in ("RRRR", "LLLL")
    assert 0 <= orbit.impacts["t"][0] < system.period
    agrees_with_simulation(orbit, 1e-11)


def test_an_orbit_that_several_periods_lead_away_from():
    """The state is near an unstable orbit: the impacts of its first period tell it, those of the fourth do not."""
    system = PAPER.replace(b=0.5)
    state = [0.3962101635644616, -0.45026096898370377, 0.18543986559557998, 0.00594555747505903]
    assert len(vs.simulate(system, state, 1).impacts) == 4 and len(vs.simulate(system, state, 4).impacts) != 16
    orbit = vs.periodic_orbit(system, state=state, periods=1)
    assert orbit.ok and not orbit.stable and len(orbit.impacts) == 4
    agrees_with_simulation(orbit, 1e-9)


@pytest.mark.parametrize("late", [0.0, 1e-12, -1e-12])
def test_impact_at_the_section(late):
    """The state at t = 0 is the one before an impact there, which comes again at the end of the period."""
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    first = orbit.impacts["t"][1]
    shifted = PAPER.replace(tau=PAPER.phase + PAPER.omega * (first + late))
    again = vs.periodic_orbit(shifted, itinerary="LR")
    turn = 2 * math.pi * again.impacts["t"][1] / PAPER.period
    assert again.ok and abs(math.sin(turn / 2)) < 1e-11
    found = vs.periodic_orbit(shifted, state=orbit.sample([first + late])[0].clip(-PAPER.b, PAPER.b))
    assert found.ok and found.itinerary == "LR"
    assert found.impacts["v1"] == pytest.approx(orbit.impacts["v1"], abs=1e-11)


def test_least_period_is_found(thirteen):
    system, state = thirteen
    once, twice = (vs.periodic_orbit(system, state=state, periods=n) for n in (13, 26))
    assert twice.period == 13
    assert twice.impacts["t"] == pytest.approx(once.impacts["t"], abs=1e-11)


def test_canonical_itinerary_does_not_depend_on_where_the_orbit_is_met(thirteen):
    system, state = thirteen
    later = vs.simulate(system, state, 5).section[-1]
    a, b = (vs.periodic_orbit(system, state=x, periods=13) for x in (state, later))
    assert a.itinerary == b.itinerary
    assert a.impacts["t"] == pytest.approx(b.impacts["t"], abs=1e-10)


def test_multipliers_over_ten_decades_against_40_digits():
    """b = 6.705, evidence.md: -9869, 0.7852 +- 0.4149i, -3.7e-5 of the half map."""
    system = PAPER.replace(b=6.705)
    orbit = vs.periodic_orbit(system, itinerary="LR")
    with mp.workdps(40):
        first, machine = orbit.impacts[0], machine_of(system.linear)
        closed = ClosedOrbit(machine, impacts_of(machine, first["side"][None]), 0.5, -1, first["t"] - 1)
        mu = closed.multipliers(*closed.solve(orbit.sample([first["t"] - 1])[0], [first["t"]]))
        expected = sorted((complex(m) for m in mu), key=lambda m: (-round(abs(m), 12), -m.imag))
    assert orbit.half_multipliers == pytest.approx(np.array(expected), rel=1e-10)
    assert not orbit.stable


@pytest.mark.parametrize("R", [1.0, 0.8, 0.3, 0.01, 1e-5])
def test_product_of_the_multipliers_is_known(R):
    """det S = R^2 and the divergence, evidence.md."""
    system = PAPER.replace(b=4.0, R=R)
    orbit = vs.periodic_orbit(system, itinerary="LR")
    assert orbit.ok
    expected = R**4 * math.exp(system.divergence * system.period)
    assert np.prod(orbit.multipliers) == pytest.approx(expected, rel=1e-11)


@pytest.mark.slow
def test_impact_without_restitution():
    """R = 0: one dimension is lost at every impact that leaves the stop at once."""
    orbit = vs.periodic_orbit(PAPER.replace(b=5.0, R=0.0), itinerary="LR")
    assert orbit.ok
    assert np.abs(orbit.half_multipliers[-1]) < 1e-15
    agrees_with_simulation(orbit, 1e-12)


@pytest.mark.parametrize("zeta", [0.0, 1e-6, "critical", 2.0])
def test_any_damping(zeta):
    system = PAPER.replace(tau=0.0, b=1.0)
    if zeta == "critical":
        zeta = 1 / math.sqrt(system.modes.omega_squared[1])
    system = system.replace(zeta=zeta)
    grazing = vs.grazing(system).b
    system = system.replace(b=0.8 * grazing)
    if zeta == 2.0:
        orbit = vs.periodic_orbit(system, state=vs.simulate(system, (0, 0, 0, 0), 100).section[-1])
        assert orbit.itinerary == "LLLRRR"
    else:
        orbit = vs.periodic_orbit(system, itinerary="LR")
    assert orbit.ok and orbit.symmetric
    simulated = vs.simulate(orbit.system, orbit.state, 1)
    assert np.abs(simulated.section[-1] - orbit.state).max() < 1e-11 * max(1, abs(orbit.multipliers[0]))


@pytest.mark.parametrize(("n", "R"), [(1, 0.8), (2, 0.5)])
def test_bouncing_ball_in_closed_form(n, R):
    """evidence.md: impact speed G n T/(1 + R), phase cos(phi) = n pi (1 - R)/((1 + R) Gamma)."""
    least = n * math.pi * (1 - R) / (1 + R)
    ball = BALL.replace(A=1.05 * least, R=R)
    speed, phase = n * 2 * math.pi / (1 + R), math.acos(1 / 1.05)
    orbit = vs.periodic_orbit(ball, guess=[(phase + 0.01, -1, -0.99 * speed)], periods=n)
    assert orbit.ok and orbit.period == n
    assert orbit.impacts["v1"] == pytest.approx(-speed, rel=1e-13)
    assert orbit.impacts["t"] == pytest.approx(phase, rel=1e-12)
    assert np.prod(orbit.multipliers) == pytest.approx(R**2, rel=1e-12)
    assert vs.periodic_orbit(ball, itinerary="L", periods=n).ok


@pytest.mark.parametrize("family", [CAVITY, ONE_MASS.replace(F=0.5), *slow_cases(CHAIN)])
def test_motion_obeys_the_equation_of_motion(family):
    """M x'' + C x' + K x = force along flights, by differences of `sample`; the impact law; periodicity."""
    q = family.linear
    orbit = vs.periodic_orbit(family, itinerary="LR" if np.isfinite(q.contact.low) else "R")
    assert orbit.ok
    times = np.linspace(0.05, 2 * math.pi / q.omega * orbit.period, 40)
    h = 1e-4
    near = np.abs(np.subtract.outer(times, orbit.impacts["t"])) % (orbit.period * 2 * math.pi / q.omega)
    times = times[(near > 2 * h).all(axis=1)]
    before, now, after = (orbit.sample(times + d) for d in (-h, 0, h))
    x, v = now[:, ::2], now[:, 1::2]
    assert (after - before)[:, ::2] / (2 * h) == pytest.approx(v, abs=1e-6)
    phase = q.omega * times[:, None] + q.tau
    force = q.constant + q.sine * np.sin(phase) + q.cosine * np.cos(phase)
    acceleration = (after - before)[:, 1::2] / (2 * h)
    assert acceleration @ q.M + v @ q.C + x @ q.K == pytest.approx(force, abs=1e-6)
    for impact in orbit.impacts:
        t = impact["t"]
        jump = orbit.sample([t + 1e-9])[0, 1::2] - orbit.sample([t])[0, 1::2]
        assert q.contact.normal @ jump == pytest.approx(
            -(1 + q.contact.restitution(impact["side"])) * impact["v1"], abs=1e-7
        )
        assert np.linalg.matrix_rank(np.array([q.M @ jump, q.contact.normal]), tol=1e-6) == 1
    length = orbit.period * 2 * math.pi / q.omega
    assert orbit.sample(times + length) == pytest.approx(orbit.sample(times), abs=1e-12)


def test_margin_is_the_least_distance_of_a_turning_point(thirteen):
    system, state = thirteen
    orbit = vs.periodic_orbit(system, state=state, periods=13)
    times = np.linspace(0, 13 * system.period, 200_001)
    states = orbit.sample(times)
    gap, rate = states[:, 0], states[:, 1]
    away = np.abs(np.subtract.outer(times, orbit.impacts["t"] % (13 * system.period))).min(axis=1) > 1e-3
    turns = np.flatnonzero((rate[:-1] * rate[1:] < 0) & away[:-1] & away[1:])
    least = min(system.b - abs(gap[i]) for i in turns)
    assert orbit.stop_distance == pytest.approx(least, abs=1e-6) and orbit.stop_distance <= least + 1e-15


def test_margin_of_the_free_motion_is_the_distance_from_the_graze():
    orbit = vs.periodic_orbit(PAPER.replace(b=6.8), itinerary="")
    assert orbit.ok and orbit.symmetric and orbit.itinerary == "" and len(orbit.impacts) == 0
    assert orbit.stop_distance == pytest.approx(6.8 - vs.grazing(PAPER).b, abs=1e-13)
    assert np.abs(orbit.multipliers) == pytest.approx(np.exp(-np.repeat(PAPER.eta, 2) * PAPER.period), rel=1e-12)
    virtual = vs.periodic_orbit(PAPER.replace(b=6.7), itinerary="")
    assert virtual.status == "inadmissible" and virtual.stop_distance < 0


def test_orbit_close_to_the_graze_where_shooting_has_a_square_root():
    """The one-mass oscillator of arXiv 2510.16218 down to impact speeds of 1e-8 and less."""
    grazing = 0.34542288575020583
    for distance in (1e-6, 1e-9, 1e-12):
        family = ONE_MASS.replace(F=grazing + distance)
        orbit = vs.periodic_orbit(family, guess=[(0.116, 1, distance)], periods=2)
        assert orbit.ok and orbit.residual < 1e-13
    assert 0 < orbit.impacts["v1"][0] < 1e-8


def test_thousand_guesses_give_the_orbit_or_an_honest_failure():
    orbit = vs.periodic_orbit(PAPER.replace(b=3.0), itinerary="LR")
    rng, statuses = np.random.default_rng(1), Counter()
    for factors in 1 + rng.uniform(-0.3, 0.3, (1000, 2)):
        (t, v), side = orbit.impacts[["t", "v1"]][0].tolist() * factors, orbit.impacts["side"][0]
        guess = [(t, side, v), (t + orbit.system.period / 2, -side, -v)]
        found = vs.periodic_orbit(orbit.system, guess=guess)
        statuses[found.status] += 1
        if found.ok:
            assert found.impacts["v1"] == pytest.approx(orbit.impacts["v1"], abs=1e-12)
            assert found.state == pytest.approx(orbit.state, abs=1e-11)
    assert statuses["ok"] > 900
    assert set(statuses) <= {"ok", "not_converged", "inadmissible"}


def test_the_reference_finds_the_same_orbit():
    orbit = vs.periodic_orbit(PAPER, itinerary="R")
    orbit = orbit if orbit.ok else vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R")
    with mp.workdps(30):
        machine = machine_of(orbit.system.linear)
        closed = ClosedOrbit(machine, impacts_of(machine, orbit.impacts["side"]), 1)
        state, times = closed.solve(orbit.state, orbit.impacts["t"])
        for mine, exact in zip((*orbit.state, *orbit.impacts["t"]), (*state, *times), strict=True):
            assert abs(mpf(float(mine)) - exact) < 2e-14


@pytest.mark.parametrize("itinerary", ["LR", "LRR"])
def test_a_free_mass_that_the_contact_does_not_see(itinerary):
    """It may be anywhere: Newton's method leaves its place alone, and finds the impacts of the other mass."""
    numbers = dict(force=[0.5, 0.2], contact_normal=[1.0, 0.0], omega=0.7, R=0.8, b=0.3)
    both = vs.periodic_orbit(vs.Oscillator(np.eye(2), np.zeros((2, 2)), **numbers), itinerary=itinerary)
    one = vs.periodic_orbit(
        vs.Oscillator([[1.0]], [[0.0]], **numbers | dict(force=[0.5], contact_normal=[1.0])), itinerary=itinerary
    )
    rng = np.random.default_rng(0)
    near = [(t, side, v) for t, side, v in both.impacts[["t", "side", "v1"]].tolist()]
    near = [(t * (1 + 1e-6 * rng.normal()), side, v * (1 + 1e-6 * rng.normal())) for t, side, v in near]
    beside = vs.periodic_orbit(both.system, guess=near)
    assert both.ok and beside.ok
    for name in ("t", "v1"):
        assert np.abs(beside.impacts[name] - both.impacts[name]).max() < 1e-13
    for name in ("t", "side"):
        assert both.impacts[name] == pytest.approx(one.impacts[name], abs=1e-12)


def test_newton_finds_what_is_at_a_fold_to_rounding():
    """Rounding throws its steps about by 1e-6 there: one of them leads to the orbit."""
    system = vs.Oscillator.named(
        "one_mass", base=False, stops="left", k=1.0, zeta=0.017127041585976777, F=0.37588718692642553,
        constant=-0.10162752952927796, omega=0.9908938690340032, R=0.9003566901152249, b=0.6241569974260474,
        offset=-0.10162752952927796, tau=4.767350176503159,
    )  # fmt: skip
    rows, rng = np.array([[6.33082, -1, -0.60963], [12.673045, -1, -0.60664]]), np.random.default_rng(0)
    found = [
        vs.periodic_orbit(system, guess=rows * (1 + 1e-7 * rng.normal(size=(2, 1)) * [1, 0, 1]), periods=2)
        for _ in range(40)
    ]
    found = [orbit for orbit in found if orbit.ok]
    assert len(found) >= 35 and max(orbit.residual for orbit in found) < 1e-7
    assert all(abs(orbit.multipliers[0] - 1) < 1e-3 for orbit in found)
