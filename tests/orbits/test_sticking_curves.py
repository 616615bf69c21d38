"""Curves of sticking onsets: 30 digits (tests/reference/chatter.py), simulation, closed relations."""

import math

import numpy as np
import pytest
from mpmath import mp
from reference.chatter import Chatter
from reference.machine import machine_of
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.curves.bifurcation_curve import first_of
from vibro_sweep.analysis.curves.curve_start import start_at
from vibro_sweep.analysis.periodic.steady_gap import steady_gap
from vibro_sweep.engine.impulses.flow import contact_coordinates

pytestmark = pytest.mark.slow


def wall(**numbers):
    numbers = {"zeta": 0.05, "F": 1.0, "omega": 0.4, "R": 0.7, "b": 0.53, "stops": "right", "tau": 0.0} | numbers
    return vs.Oscillator.named("one_mass", **numbers)


def onset(system, state, periods, bounds):
    orbit = vs.periodic_orbit(system, state=vs.simulate(system, state, periods).section[-1])
    return next(one for one in vs.continue_orbit(orbit, "b", bounds).special if one.type == "sticking")


@pytest.fixture(scope="module")
def symmetric_onset():
    return onset(PAPER.replace(b=0.0666), (0, 0, 0, 0), 400, (0.06, 0.067))


@pytest.fixture(scope="module")
def one_mass_onset():
    return onset(wall(), (0, 0), 200, (0.5, 0.54))


def numbers_at(special):
    """Of the orbit: in the coordinates of the masses at the end of the chatter, and times before it."""
    s, state = special._chatter.solution, special._chatter.state
    q, N = s.family.linear, len(state) // 2
    masses = s.sigma * contact_coordinates(q).to_masses(state).reshape(N, 2).T.ravel()
    return s, q, masses, s.times[0] + s.P


def error_at(special) -> float:
    """Of b, against 34 digits, in parts of the free motion's amplitude: what rounding of the gap is a part of."""
    s, q, state, end = numbers_at(special)

    def machine_at(b):
        return machine_of(q.with_contact(high=b, low=-b))

    with mp.workdps(34):
        chatter = Chatter(machine_at, s.sigma, s.half_periods, s.sides[1:])
        exact = chatter.where_sticking(state, end, s.times[1:], q.contact.high)
    return abs(float(exact) - q.contact.high) / max(q.contact.high, abs(steady_gap(q).swing))


def test_stated_errors(symmetric_onset, one_mass_onset):
    for special in (symmetric_onset, one_mass_onset):
        _, q, _, _ = numbers_at(special)
        true = error_at(special) * max(q.contact.high, abs(steady_gap(q).swing))
        assert true < special.error < 2e-13


def test_the_nearer_of_two_onsets():
    """The orbit gains impacts at both ends of its branch; from either end Newton's method may find both onsets."""
    system = vs.System(
        mu_m=8.45913255205294, mu_k=2.4638554530011407, zeta=0.07377473049461114, f2=0.6073477420034428,
        omega=0.36217888304179824, R=0.7279326390251835, b=0.17628650016260886, stops="left",
    )  # fmt: skip
    orbit = vs.periodic_orbit(system, state=vs.simulate(system, np.full(4, 1e-3), 400).section[-1])
    special = vs.continue_orbit(orbit, "omega", (0.25, 0.5)).special
    assert [one.type for one in special] == ["sticking", "graze", "graze", "sticking"]


@pytest.mark.parametrize(
    ("names", "bounds"),
    [(("b", "omega"), ((0.01, 0.3), (0.4, 0.63))), (("b", "R"), ((0.03, 0.3), (0.3, 0.95)))],
)
def test_symmetric_orbit_of_the_paper(names, bounds, symmetric_onset):
    curve = vs.bifurcation_curve(symmetric_onset, names, bounds)
    assert curve.type == "sticking" and [one.type for one in curve.special] == ["boundary", "boundary"]
    assert not curve.points.virtual.any() and np.isnan(curve.points.multiplier_re).all()
    assert max(error_at(end) for end in (curve.begins, curve.ends)) < 1e-13
    if names[1] == "omega":  # the bounds ends at the paper's omega, where 60 impacts written out give the onset
        assert curve.begins.parameters["b"] == pytest.approx(0.0646391433585, rel=1e-12)
        assert curve.begins.parameters["omega"] == 0.63


@pytest.mark.parametrize("names", [("b", "omega"), ("b", "R")])
def test_one_mass(names, one_mass_onset):
    curve = vs.bifurcation_curve(one_mass_onset, names, ((0.05, 0.99), (0.2, 0.9)))
    assert [one.type for one in curve.special] == ["boundary", "boundary"]
    assert max(error_at(end) for end in (curve.begins, curve.ends)) < 1e-13


def test_the_tangent_is_that_of_the_points(symmetric_onset):
    """By differences of neighbouring points: the derivatives of the chatter's series have fewer orders than it."""
    names = ("mu_m", "omega")
    curve, place = first_of(SolutionCurve(start_at(symmetric_onset, names), names, ((9, 11), (0.6, 0.65))))
    h = 1e-3  # nearer, rounding of slow impacts is seen
    beside = [curve.step(place, sign * h) for sign in (-2, -1, 1, 2)]
    far, near = curve.difference(beside[0], beside[3]), curve.difference(beside[1], beside[2])
    slope = (8 * near - far) / (12 * h)
    np.testing.assert_allclose(slope, place.direction, rtol=0, atol=3e-8)


def test_simulated_orbits_rest_on_one_side_of_the_curve(one_mass_onset):
    for omega in ((0.2, 0.9), (0.3, 0.5), (0.35, 0.41)):
        curve = vs.bifurcation_curve(one_mass_onset, ("b", "omega"), ((0.1, 0.98), omega))
        for end in (curve.begins, curve.ends):
            _, q, (x, v), time = numbers_at(end)
            rests = []
            for side in (-1e-7, 1e-7):
                system = wall(b=q.contact.high * (1 + side), omega=q.omega)
                run = vs.simulate(system, (x * (1 - 1e-6), -abs(v)), 300, start_time=time)
                rests.append(int(np.sum(run.sticking["t_on"] > 250 * 2 * math.pi / q.omega + time)))
            assert rests == [50, 0], end.parameters


def test_where_the_orbit_touches_the_other_stop(one_mass_onset):
    """The right stop stays where it is; the left one comes nearer and is touched at the orbit's lowest point."""
    right = one_mass_onset.parameters["b"]
    special = onset(wall(b=5.0, offset=0.53 - 5.0, stops="both"), (0, 0), 200, (4.99, 5.01))
    assert special.parameters["b"] == pytest.approx(right + 5 - 0.53, abs=1e-12)
    bounds = ((0.1, 6.0), (-5.0, 1.0))
    curve = vs.bifurcation_curve(special, ("b", "offset"), bounds)
    np.testing.assert_allclose(curve.points.b + curve.points.offset, right, atol=1e-12)
    (graze,) = (one for one in curve.special if one.type == "sticking_graze")
    _, _, state, end = numbers_at(one_mass_onset)
    flight = vs.simulate(wall(b=right + 1e-9), state, 1, start_time=end)
    times = np.linspace(end, end + 2 * math.pi / 0.4, 20_001)
    lowest = flight.sample(times)[:, 0].min()
    assert graze.parameters["offset"] - graze.parameters["b"] == pytest.approx(lowest, abs=1e-6)
    assert curve.points.virtual.any()
    starts = vs.switch(graze)
    assert [start.type for start in starts] == ["sticking", "sticking"]
    without = vs.bifurcation_curve(starts[1], ("b", "offset"), bounds)
    (again,) = (one for one in without.special if one.type == "sticking_graze")
    assert again.parameters == pytest.approx(graze.parameters, abs=1e-12)
    struck = vs.bifurcation_curve(starts[0], ("b", "offset"), bounds)
    real = struck.points.isel(point=~struck.points.virtual.values)
    assert real.sizes["point"] > 3 and (np.abs(real.impact_v[:, real.impact_side[0].values < 0]) > 0).all()


def test_refusals(symmetric_onset):
    with pytest.raises(ValueError, match="where the symmetry is broken, both chatter sequences"):
        vs.bifurcation_curve(symmetric_onset, ("b", "offset"), ((0.01, 1), (-1, 1)))
