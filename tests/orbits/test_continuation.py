"""`continue_orbit`: branches, their bifurcations, and where they end."""

import math

import numpy as np
import pytest
from support import slow_cases
from support.branches import branch_of, same_points, types
from support.oscillators import BALL, CAVITY, CHAIN, LONG_CHAIN, ONE_MASS, PAPER
from support.random_branches import random_oscillator, random_system

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_start import start_of_run

B_STAR = 6.7057167409730219272  # |e_1.(K - omega^2 M + i omega C)^-1 P| in 40 digits


def test_symmetric_orbit_of_the_paper(symmetric_branch):
    same_points(symmetric_branch, [("graze", 0.652974448339183), ("pitchfork", 3.892819435563412), ("graze", B_STAR)])
    begins, pitchfork, ends = symmetric_branch.special
    assert begins is symmetric_branch.begins and ends is symmetric_branch.ends and not symmetric_branch.closed
    assert (begins.impact, begins.kind, begins.direction) == (None, "nonsmooth fold", 1)
    assert (ends.impact, ends.kind, ends.direction) == (0, "persistence", 1)
    assert pitchfork.multipliers[0] == pytest.approx(-1, abs=1e-12) and pitchfork.criticality == "sub"
    assert all(special.orbit.ok and special.error < 1e-13 for special in symmetric_branch.special)


def test_one_sided_orbit_of_the_paper(one_sided_branch):
    expected = [("graze", 3.221903876767776), ("neimark_sacker", 4.347417989446589), ("graze", B_STAR)]
    same_points(one_sided_branch, expected)
    graze, torus, _ = one_sided_branch.special
    assert (graze.stop, graze.impact) == (-1, None)
    assert abs(torus.multipliers[0]) == pytest.approx(1, abs=1e-12) and abs(torus.multipliers[0].imag) > 0.5


def test_window_of_the_period_13_pair():
    branch = branch_of(6.6, 13)
    expected = [("graze", 6.594680526617001), ("fold", 6.610672536301659), ("graze", 6.610633594672752)]
    same_points(branch, expected)
    points = branch.points
    stable = points.b.where(points.unstable == 0, drop=True)
    assert float(stable.min()) == pytest.approx(6.594680526617, abs=1e-9)
    assert float(stable.max()) <= 6.610672536302


def test_folds_that_end_hysteresis():
    """reference_values.md: a period-15 fold, and the fold of a period-19 orbit with five impacts on one side."""
    assert ("fold", pytest.approx(6.7130205450254, abs=1e-12)) in types(branch_of(6.7125, 15))
    branch = branch_of(6.7575, 19)
    assert ("fold", pytest.approx(6.757836047561766, abs=1e-12)) in types(branch)
    assert len(branch.begins.orbit.impacts) == 5


def test_free_motion_ends_at_the_double_graze():
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=6.8), itinerary=""), "b", (6.3, 6.9))
    same_points(branch, [("graze", B_STAR), ("boundary", 6.9)])
    assert branch.ends.parameters["b"] == 6.9
    born = vs.switch(branch.begins)
    assert sorted(orbit.itinerary for orbit in born) == ["L", "LR", "R"]
    assert all(orbit.system.b < B_STAR for orbit in born)


@pytest.mark.parametrize("stops", ["both", "right", "left"])
def test_graze_of_the_free_motion_in_another_number(stops):
    """b*(omega) = 6.8 in 40 digits. With `tau: grazing` the motion turns just where the period begins."""
    orbit = vs.periodic_orbit(PAPER.replace(b=6.8, stops=stops), itinerary="")
    branch = vs.continue_orbit(orbit, "omega", (0.5, 0.8))
    assert branch.ends.parameters["omega"] == pytest.approx(0.63076170757239941673, abs=2e-15)
    assert abs(branch.ends.orbit.stop_distance) < 2e-14


@pytest.mark.parametrize(("n", "R", "flip"), [(1, 0.8, 1.07083646824791), (2, 0.5, 2.37087721026694)])
def test_bouncing_ball_from_its_fold_to_its_flip(n, R, flip):
    fold = n * math.pi * (1 - R) / (1 + R)
    phase, speed = math.acos(1 / 1.05), n * 2 * math.pi / (1 + R)
    orbit = vs.periodic_orbit(BALL.replace(A=1.05 * fold, R=R), guess=[(phase, -1, -speed)], periods=n)
    found = types(vs.continue_orbit(orbit, "A", (0.01, 4)))
    assert ("fold", pytest.approx(fold, abs=1e-13)) in found
    assert ("flip", pytest.approx(flip, abs=1e-13)) in found


def test_one_mass_oscillator_of_the_literature():
    """arXiv 2510.16218 (reference_values.md); the impact speed at the flip and the fold, and zero at the graze."""
    for omega, kind, F, speed in (
        (0.81, "flip", 0.347533397, 0.0653039433),
        (0.799, "fold", 0.362836202, 0.1240873449),
    ):
        orbit = vs.periodic_orbit(ONE_MASS.replace(F=0.37, omega=omega), itinerary="R", periods=2)
        branch = vs.continue_orbit(orbit, "F", (0.3, 0.6))
        special = next(special for special in branch.special if special.type == kind)
        assert special.parameters["F"] == pytest.approx(F, abs=1e-9)
        assert special.orbit.impacts["v1"] == pytest.approx(speed, abs=1e-9)
        assert abs(branch.begins.orbit.impacts["v1"][0]) < 1e-13 and branch.begins.impact == 0


@pytest.mark.parametrize("factor", [0.4, 2.5])
def test_special_points_do_not_depend_on_the_step(symmetric_branch, one_sided_branch, factor):
    again = vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (0.3, 6.8), step=factor)
    same_points(again, types(symmetric_branch), 5e-14)
    again = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (0.3, 6.8), step=factor)
    same_points(again, types(one_sided_branch), 5e-14)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.5, 1, 2, 7])
def test_bifurcations_in_one_step_do_not_hide_each_other(factor):
    """Three masses: a flip and a Neimark-Sacker point lie within 6e-4 of R_left, two others within 7e-3."""
    system = random_oscillator(np.random.default_rng(2))
    orbit, bounds = vs.periodic_orbit(system, itinerary="LRR"), (0.56, 0.99)
    branch = vs.continue_orbit(orbit, "R_left", bounds, step=factor)
    expected = [0.69546726882168, 0.69605952370370, 0.81987655017267, 0.82658501099370]
    assert [s.type for s in branch.special[1:-1]] == ["flip", "neimark_sacker", "neimark_sacker", "flip"]
    assert [s.parameters["R_left"] for s in branch.special[1:-1]] == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("factor", [2, *slow_cases(1, 4)])
def test_bifurcation_in_the_step_to_a_graze(factor):
    """A Neimark-Sacker point 4e-4 beside the graze, where multipliers have a pole."""
    system = random_system(np.random.default_rng(41))
    orbit, bounds = vs.periodic_orbit(system, itinerary="L"), (0.7, 0.9)
    branch = vs.continue_orbit(orbit, "omega", bounds, step=factor)
    expected = [("graze", 0.86249263869125), ("neimark_sacker", 0.86291307010265), ("flip", 0.86981802910054)]
    assert types(branch)[:3] == [(kind, pytest.approx(value, abs=1e-13)) for kind, value in expected]


@pytest.mark.parametrize("name", ["omega", "zeta", "R", "mu_m", "f2"])
def test_branch_in_any_number_is_a_branch_of_orbits(name):
    """Points in between, found again from a state by Newton's method at fixed parameters, and by simulation."""
    orbit = vs.periodic_orbit(PAPER.replace(b=3.0), itinerary="LR")
    value = getattr(orbit.system, name)
    bounds = (0.0, 0.05) if name == "f2" else (0.98 * value, 1.02 * value)
    points = vs.continue_orbit(orbit, name, bounds).points
    for i in np.linspace(1, points.sizes["point"] - 2, 4).astype(int):
        point = points.isel(point=i)
        system = orbit.system.replace(**{name: float(point[name])})
        state = np.array([float(point[x]) for x in ("x1", "v1", "x2", "v2")])
        state[0] = np.clip(state[0], -system.b, system.b)
        simulated = vs.simulate(system, state, 1)
        assert np.abs(simulated.section[-1] - state).max() < 1e-11
        assert np.sort(simulated.impacts["v1"]) == pytest.approx(np.sort(point.impact_v), abs=1e-11)


def test_multipliers_of_the_points_obey_their_sum_rule(symmetric_branch):
    points = symmetric_branch.points.isel(point=slice(1, -1))
    product = np.prod(points.multiplier_re.values + 1j * points.multiplier_im.values, axis=1)
    assert product == pytest.approx(PAPER.R**4 * math.exp(PAPER.divergence * PAPER.period), rel=1e-9)
    assert np.all(np.diff(points.b) > 0) and np.all(np.abs(np.diff(points.impact_t, axis=0)) < 1)
    assert float(points.stop_distance.min()) > 0 and float(points.min_impact_speed.min()) > 0


def test_shorter_steps_give_more_points(one_sided_branch):
    orbit = vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R")
    finer = vs.continue_orbit(orbit, "b", (0.3, 6.8), step=0.25)
    assert finer.points.sizes["point"] > 2 * one_sided_branch.points.sizes["point"]


@pytest.mark.parametrize("k", [1, 12, -2])
def test_the_orbit_at_a_point_is_that_of_newtons_method(symmetric_branch, k):
    """And its state, its impacts and its oscillator are those of the point."""
    point, orbit = symmetric_branch.points.isel(point=k), symmetric_branch.orbit(k)
    assert orbit.ok and orbit.symmetric and orbit.itinerary == "LR" and orbit.system.b == float(point.b)
    state = [float(point[name]) for name in ("x1", "v1", "x2", "v2")]
    assert orbit.state == pytest.approx(state, rel=1e-9)  # the point is recorded as steps have left it
    again = vs.periodic_orbit(orbit.system, itinerary="LR")
    assert np.sort(orbit.impacts["v1"]) == pytest.approx(np.sort(again.impacts["v1"]), rel=1e-9)


def test_a_point_that_a_branch_has_not(symmetric_branch):
    count = symmetric_branch.points.sizes["point"]
    with pytest.raises(ValueError, match=f"point: {count} is not allowed; it must be a whole number >= -{count}"):
        symmetric_branch.orbit(count)


@pytest.mark.parametrize(("name", "bounds"), [("omega", (0.75, 0.9)), ("damping", (0.0, 0.2))])
def test_the_unit_of_length_does_not_matter(name, bounds):
    """With force and clearance as many times as large every number of the branch is the same, but for rounding."""

    def branch(scale):
        system = ONE_MASS.replace(F=0.37 * scale, b=scale, omega=0.799)
        return vs.continue_orbit(vs.periodic_orbit(system, itinerary="R", periods=2), name, bounds)

    expected = branch(1.0)
    for scale in (2.0**-40, 2.0**40):  # of which no product is rounded
        found = branch(scale)
        assert found.points.sizes == expected.points.sizes
        assert [one.type for one in found.special] == [one.type for one in expected.special]
        for one, other in zip(found.special, expected.special, strict=True):
            assert one.parameters[name] == pytest.approx(other.parameters[name], abs=max(one.error, 1e-300), rel=0)


def test_branch_in_two_ways_is_one_branch(symmetric_branch):
    for b in (0.8, 5.5):
        orbit = vs.periodic_orbit(PAPER.replace(b=b), itinerary="LR")
        same_points(vs.continue_orbit(orbit, "b", (0.3, 6.8)), types(symmetric_branch), 5e-14)


@pytest.mark.parametrize("family", [CAVITY, pytest.param(CHAIN, marks=pytest.mark.slow)])  # N = 3: more kernels
def test_other_oscillators(family):
    """Three masses with unequal restitution and any damping; a free ball. Ends are where the orbit touches a stop."""
    orbit = vs.periodic_orbit(family, itinerary="LR")
    branch = vs.continue_orbit(orbit, "b", (0.05, 3))
    assert branch.begins.type == "graze" and branch.begins.orbit.stop_distance == pytest.approx(0, abs=1e-13)
    for special in branch.special:
        assert special.orbit.ok and special.error < 1e-12
        if special.type in ("pitchfork", "flip"):
            assert np.abs(special.multipliers + 1).min() < 1e-11
        if special.type == "fold":
            assert np.abs(special.multipliers - 1).min() < 1e-11


@pytest.mark.slow
def test_eight_masses():
    """From the free motion through its graze to the orbit that is born there; the product of 16 multipliers."""
    branch = vs.continue_orbit(vs.periodic_orbit(LONG_CHAIN, itinerary=""), "b", (0.01, 60))
    graze = branch.begins
    assert graze.type == "graze" and graze.kind == "nonsmooth fold"
    symmetric = [orbit for orbit in vs.switch(graze) if orbit.symmetric]
    assert [orbit.itinerary for orbit in symmetric] == ["LR"] and symmetric[0].system.numbers[
        "b"
    ] > branch.begins.parameters["b"]
    born = [item for item in vs.born_at_grazing(LONG_CHAIN, 1) if item.itinerary == "LR"]
    assert born[0].born == "above" and born[0].orbit.ok
    q = LONG_CHAIN.linear
    divergence = -np.trace(np.linalg.solve(q.M, q.C)) * 2 * math.pi / q.omega
    assert np.prod(symmetric[0].multipliers) == pytest.approx(0.7**4 * math.exp(divergence), rel=1e-8)
    again = vs.continue_orbit(symmetric[0], "b", (0.01, 60))
    ends = [special.parameters["b"] for special in (again.begins, again.ends) if special.impact is not None]
    assert ends == [pytest.approx(graze.parameters["b"], abs=1e-13)]


def test_no_other_branch_begins_at_a_bound():
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    branch = vs.continue_orbit(orbit, "b", (1.9, 2.1))
    assert [special.type for special in branch.special] == ["boundary", "boundary"]
    with pytest.raises(ValueError, match="boundary"):
        vs.switch(branch.ends)


def test_steps_to_masses_that_are_not_positive(recwarn):
    """A step along a branch may try one; it is made shorter, and nothing is said of square roots."""
    system = vs.System(mu_m=1, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=9)
    first = start_of_run(vs.periodic_orbit(system, itinerary="")._solution, "mu_m", 1.0, 41.0).backwards()
    assert first.ahead(0.05) is None  # 1 - 0.05 * 40 is negative
    assert first.ahead(0.01).value == pytest.approx(0.6)
    assert not recwarn.list
