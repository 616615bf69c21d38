"""Periodic orbits with rests after impacts without restitution: one event each, with the time at which it ends."""

import numpy as np
import pytest
from mpmath import mp
from reference.closed_orbit import ClosedOrbit
from support import slow_cases
from support.in_digits import closed_of, of_orbit
from support.oscillators import PAPER

import vibro_sweep as vs

pytestmark = pytest.mark.slow  # orbits with rests compile a kernel of branches of their own

DEAD = PAPER.replace(R=0.0)


def settled(b, periods=1):
    """The orbit that the motion from rest comes to, and a state of it."""
    system = DEAD.replace(b=b)
    state = vs.simulate(system, (0, 0, 0, 0), 400).section[-1]
    return vs.periodic_orbit(system, state=state, periods=periods), state


@pytest.fixture(scope="module")
def resting():
    return settled(0.5)


@pytest.fixture(scope="module")
def branch(resting):
    return vs.continue_orbit(resting[0], "b", (0.3, 3))


@pytest.mark.parametrize("b", [0.05, 0.5, 1.2])
def test_orbit_is_what_the_engine_simulates(b):
    orbit, state = settled(b)
    assert orbit.ok and orbit.symmetric and orbit.stable and orbit.itinerary == "LR" and orbit.residual < 1e-14
    simulated = vs.simulate(orbit.system, state, 3)
    times = np.linspace(0, 2 * orbit.system.period, 500)
    assert np.abs(orbit.sample(times) - simulated.sample(times)).max() < 1e-12
    length = orbit.system.period
    for t_on, t_off, side in orbit.sticking:
        there = simulated.sticking[(simulated.sticking["side"] == side) & (simulated.sticking["t_on"] > 0)][0]
        assert (t_on - there["t_on"]) / length == pytest.approx(round((t_on - there["t_on"]) / length), abs=1e-12)
        assert t_off - t_on == pytest.approx(there["t_off"] - there["t_on"], abs=1e-12)


def test_mirror_image_of_a_symmetric_orbit_is_the_orbit(resting):
    orbit, _ = resting
    image = vs.periodic_orbit(orbit.system, state=-orbit.state)
    assert image.ok and len(image.sticking) == 2 and image.stable
    assert np.abs(image.state - orbit.state).max() < 1e-13


def test_multipliers_are_those_of_the_simulated_map(resting):
    """Two are lost by the rest in which the period begins; the others by differences in x2 and v2."""
    orbit, state = resting
    assert abs(state[0]) == orbit.system.b and state[1] == 0
    h = 1e-4
    columns = []
    for axis in np.eye(4)[2:]:
        ends = [vs.simulate(orbit.system, state + sign * h * axis, 1).section[-1] for sign in (1, -1)]
        columns.append((ends[0] - ends[1])[2:] / (2 * h))
    expected = np.linalg.eigvals(np.array(columns).T)
    assert orbit.multipliers[:2] == pytest.approx(expected[np.argsort(-expected.imag)], abs=1e-8)
    assert np.all(orbit.multipliers[2:] == 0)


@pytest.mark.parametrize("b", [0.5, *slow_cases(0.05, 1.6)])  # the last with a flight between two impacts on one stop
def test_orbits_of_branches_are_those_of_matrix_exponentials(b):
    orbit, compared = settled(b)[0], 0
    assert len(of_orbit(orbit).events) == (2 if b > 1.5 else 1)
    for name in ("b", "omega", "zeta", "mu_m", "mu_k", "f2"):
        value = getattr(orbit.system, name)
        branch = vs.continue_orbit(orbit, name, (0.98 * value, 1.02 * value) if value else (0.0, 0.02))
        for one in (orbit, branch.orbit(0), branch.orbit(branch.points.sizes["point"] // 2), branch.orbit(-1)):
            compared += is_exact(one)
    assert compared == 24


def is_exact(orbit) -> bool:
    d = closed_of(of_orbit(orbit))
    with mp.workdps(50):
        exact = ClosedOrbit(d.machine, *d.of)
        state, times = exact.solve(*d.guess)
        assert d.guess[0] == pytest.approx(np.array(state, float), abs=1e-13)
        assert d.guess[1] == pytest.approx(np.array(times, float), abs=1e-13)
        expected = np.array([complex(mu) for mu in exact.multipliers(state, times)])
    expected = expected[np.lexsort((-expected.imag, -np.abs(expected).round(12)))]
    assert orbit.half_multipliers == pytest.approx(expected, abs=1e-12)
    return True


@pytest.mark.parametrize("b", [0.05, 0.5, 1.2])
def test_acceleration_into_the_stop_is_that_of_sampled_states(b):
    """Its least value where the rest begins, or where it turns."""
    orbit = settled(b)[0]
    q, (begin, end, side) = orbit.system.linear, orbit.sticking[0]
    t = np.linspace(begin + 1e-9, end, 4001)
    states, angle = orbit.sample(t), q.omega * t + q.tau
    force = q.constant + np.outer(np.sin(angle), q.sine) + np.outer(np.cos(angle), q.cosine)
    a = side * (force - states[:, ::2] @ q.K - states[:, 1::2] @ q.C) @ np.linalg.inv(q.M) @ q.contact.normal
    turns = np.flatnonzero((a[1:-1] < a[:-2]) & (a[1:-1] < a[2:])) + 1
    assert np.append(a[turns], a[0]).min() > 0
    assert abs(a[-1]) < 1e-12


def test_branch_ends_where_the_rest_does_not_begin_at_once(branch):
    """There the acceleration into the stop vanishes just after the impact; beyond, a short flight precedes the rest."""
    end = branch.ends
    assert end.type == "sticking" and end.error < 1e-12
    for beside, impacts in ((-1e-7, 2), (1e-7, 4)):
        system = DEAD.replace(b=end.parameters["b"] + beside)
        after = vs.simulate(system, vs.simulate(system, (0, 0, 0, 0), 400).section[-1], 2)
        assert len(after.impacts) == 2 * impacts
        orbit, _ = settled(end.parameters["b"] + 1e4 * beside)
        assert orbit.ok and len(orbit.impacts) == impacts and len(orbit.sticking) == 2
        assert abs(orbit.multipliers[0] - end.orbit.multipliers[0]) < 0.01


def test_points_of_the_branch(branch):
    points = branch.points
    for i in np.linspace(1, points.sizes["point"] - 2, 6).astype(int):
        point = points.isel(point=i)
        state = np.array([float(point[x]) for x in ("x1", "v1", "x2", "v2")])
        system = DEAD.replace(b=float(point.b))
        state[0] = np.clip(state[0], -system.b, system.b)
        assert np.abs(vs.simulate(system, state, 1).section[-1] - state).max() < 1e-11
        orbit = vs.periodic_orbit(system, state=vs.simulate(system, state, 20).section[-1])
        assert point.multiplier_re.values == pytest.approx(orbit.multipliers.real, abs=1e-11)


def test_orbit_survives_its_file(resting, tmp_path):
    orbit, _ = resting
    again = vs.load(orbit.save(tmp_path / "orbit.json"))
    assert again.ok and again.sticking.tobytes() == orbit.sticking.tobytes()
    assert again.impacts.tobytes() == orbit.impacts.tobytes()


@pytest.mark.parametrize("b", [0.05, 0.5, 1.2])
def test_orbit_with_rests_from_its_itinerary_and_from_a_guess(b):
    orbit, _ = settled(b)
    near = [(i["t"] + 0.02, i["side"], 1.1 * i["v1"]) for i in orbit.impacts]
    for found in (vs.periodic_orbit(orbit.system, itinerary="LR"), vs.periodic_orbit(orbit.system, guess=near)):
        assert found.ok and len(found.sticking) == 2 and found.symmetric
        assert np.abs(found.state - orbit.state).max() < 1e-12


def test_short_flight_before_the_rest(branch):
    """Two impacts on each stop; the mass rests after the second one only."""
    orbit, _ = settled(branch.ends.parameters["b"] + 0.01)
    assert orbit.itinerary == "LLRR" and len(orbit.sticking) == 2
    near = [(i["t"] + 1e-3, i["side"], i["v1"]) for i in orbit.impacts]
    found = vs.periodic_orbit(orbit.system, guess=near)
    assert found.ok and np.abs(found.state - orbit.state).max() < 1e-12


def test_ball_that_rests_in_its_cavity():
    cavity = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.1, zeta=0.05, F=1.0, omega=0.7, R=0.0, b=0.2)
    section = vs.simulate(cavity, np.zeros(4), 500).section
    found = vs.periodic_orbit(cavity, itinerary="LR")
    assert found.ok and len(found.sticking) == 2 and np.abs(found.state - section[-1]).max() < 1e-9


def test_a_rest_after_one_impact_is_not_followed_to_other_restitutions(resting):
    with pytest.raises(ValueError, match=r"parameter: 'R' is not allowed; .* at R = 0"):
        vs.continue_orbit(resting[0], "R", (0.0, 0.5))


def test_rest_after_chatter_stays_refused():
    system = PAPER.replace(b=0.03)
    state = vs.simulate(system, (0, 0, 0, 0), 200).section[-1]
    assert vs.periodic_orbit(system, state=state).status == "sticking"
