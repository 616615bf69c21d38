"""`continue_orbit`, `switch`, `born_at_grazing`: branches, their bifurcations, and where they end."""

import itertools
import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.shooting import Shooting
from support.oscillators import BALL, CAVITY, CHAIN, LONG_CHAIN, ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis import way
from vibro_sweep.analysis.lcp import complementary, representatives
from vibro_sweep.analysis.sticking import shrinking
from vibro_sweep.model.linear import family_of

B_STAR = 6.7057167409730219272  # |e_1.(K - omega^2 M + i omega C)^-1 P| in 40 digits


def types(branch):
    return [(special.type, special.parameters[branch.parameter]) for special in branch.special]


def same_points(branch, expected, tolerance=1e-12):
    found = types(branch)
    assert [kind for kind, _ in found] == [kind for kind, _ in expected]
    assert [value for _, value in found] == pytest.approx([value for _, value in expected], abs=tolerance)


@pytest.fixture(scope="module")
def symmetric():
    return vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (0.3, 6.8))


@pytest.fixture(scope="module")
def one_sided():
    return vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (0.3, 6.8))


def recorded(b, n, seed=1):
    """A state on an attractor of period n > 1 at this clearance."""
    rng, system = np.random.default_rng(seed), PAPER.replace(b=b)
    for _ in range(60):
        start = [rng.uniform(-b, b), *(rng.normal(size=3) * (3, 3, 1))]
        section = vs.simulate(system, start, 3000).section
        if np.abs(section[-1] - section[-1 - n]).max() < 1e-7 and np.abs(section[-1] - section[-2]).max() > 1e-3:
            return system, section[-1]
    raise AssertionError("no such attractor was met")


def branch_of(b, n, bounds=(6.3, 6.9)):
    system, state = recorded(b, n)
    return vs.continue_orbit(vs.periodic_orbit(system, state=state, periods=n), "b", bounds)


def test_symmetric_orbit_of_the_paper(symmetric):
    same_points(symmetric, [("graze", 0.652974448339183), ("pitchfork", 3.892819435563412), ("graze", B_STAR)])
    begins, pitchfork, ends = symmetric.special
    assert begins is symmetric.begins and ends is symmetric.ends and not symmetric.closed
    assert (begins.impact, begins.kind, begins.direction) == (None, "nonsmooth fold", 1)
    assert (ends.impact, ends.kind, ends.direction) == (0, "persistence", 1)
    assert pitchfork.multipliers[0] == pytest.approx(-1, abs=1e-12) and pitchfork.criticality == "sub"
    assert all(special.orbit.ok and special.error < 1e-13 for special in symmetric.special)


def test_one_sided_orbit_of_the_paper(one_sided):
    expected = [("graze", 3.221903876767776), ("neimark_sacker", 4.347417989446589), ("graze", B_STAR)]
    same_points(one_sided, expected)
    graze, torus, _ = one_sided.special
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
    """orbits.md: a period-15 fold, and the fold of a period-19 orbit with five impacts on one side."""
    assert ("fold", pytest.approx(6.7130205450254, abs=1e-12)) in types(branch_of(6.7125, 15))
    branch = branch_of(6.7575, 19)
    assert ("fold", pytest.approx(6.757836047561766, abs=1e-12)) in types(branch)
    assert len(branch.begins.orbit.impacts) == 5


def test_free_motion_ends_at_the_double_graze():
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=6.8), itinerary=""), "b", (6.3, 6.9))
    same_points(branch, [("graze", B_STAR), ("limit", 6.9)])
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
    assert abs(branch.ends.orbit.margin) < 2e-14


@pytest.mark.parametrize(("n", "R", "flip"), [(1, 0.8, 1.07083646824791), (2, 0.5, 2.37087721026694)])
def test_bouncing_ball_from_its_fold_to_its_flip(n, R, flip):
    fold = n * math.pi * (1 - R) / (1 + R)
    phase, speed = math.acos(1 / 1.05), n * 2 * math.pi / (1 + R)
    orbit = vs.periodic_orbit(BALL.replace(A=1.05 * fold, R=R), guess=[(phase, -1, -speed)], periods=n)
    found = types(vs.continue_orbit(orbit, "A", (0.01, 4)))
    assert ("fold", pytest.approx(fold, abs=1e-13)) in found
    assert ("flip", pytest.approx(flip, abs=1e-13)) in found


def test_one_mass_oscillator_of_the_literature():
    """arXiv 2510.16218, values of physics.md; the impact speed at the flip and the fold, and zero at the graze."""
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
def test_special_points_do_not_depend_on_the_step(symmetric, one_sided, factor, monkeypatch):
    for name in ("LONGEST_STEP", "FIRST_STEP", "STRAIGHT"):
        monkeypatch.setattr(way, name, factor * getattr(way, name))
    again = vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (0.3, 6.8))
    same_points(again, types(symmetric), 5e-14)
    again = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (0.3, 6.8))
    same_points(again, types(one_sided), 5e-14)


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


def test_multipliers_of_the_points_obey_their_sum_rule(symmetric):
    points = symmetric.points.isel(point=slice(1, -1))
    product = np.prod(points.multiplier_re.values + 1j * points.multiplier_im.values, axis=1)
    assert product == pytest.approx(PAPER.R**4 * math.exp(PAPER.divergence * PAPER.period), rel=1e-9)
    assert np.all(np.diff(points.b) > 0) and np.all(np.abs(np.diff(points.impact_t, axis=0)) < 1)
    assert float(points.margin.min()) > 0 and float(points.min_impact_speed.min()) > 0


def test_branch_in_two_ways_is_one_branch(symmetric):
    for b in (0.8, 5.5):
        orbit = vs.periodic_orbit(PAPER.replace(b=b), itinerary="LR")
        same_points(vs.continue_orbit(orbit, "b", (0.3, 6.8)), types(symmetric), 5e-14)


def test_asymmetric_branch_is_born_at_the_pitchfork(symmetric):
    pitchfork = symmetric.special[1]
    pair = vs.switch(pitchfork)
    assert len(pair) == 2 and not any(orbit.symmetric for orbit in pair)
    assert pair[0].state == pytest.approx(-vs.simulate(pair[1].system, pair[1].state, 1).sample(
        [PAPER.period / 2])[0], abs=1e-6)  # fmt: skip
    branch = vs.continue_orbit(pair[0], "b", (0.3, 6.8))
    assert types(branch)[-1] == ("pitchfork", pytest.approx(3.892819435563412, abs=1e-12))
    assert branch.ends.orbit.symmetric and branch.ends.criticality == "sub"
    # its other end is where the one-sided orbit gains an impact
    assert types(branch)[0] == ("graze", pytest.approx(3.221903876767776, abs=1e-12))
    assert branch.begins.impact is not None
    (other,) = vs.switch(branch.begins)
    assert other.itinerary in "RL"


def test_doubled_branch_is_born_at_the_flip():
    orbit = vs.periodic_orbit(ONE_MASS.replace(F=0.37), itinerary="R", periods=2)
    flip = next(special for special in vs.continue_orbit(orbit, "F", (0.3, 0.6)).special if special.type == "flip")
    (doubled,) = vs.switch(flip)
    assert doubled.period == 4 and doubled.itinerary == "RR" and doubled.stable
    branch = vs.continue_orbit(doubled, "F", (0.3, 0.6))
    assert [special.type for special in branch.special] == ["graze", "flip", "flip"]
    assert branch.ends.parameters["F"] == pytest.approx(flip.parameters["F"], abs=1e-14)
    assert branch.ends.criticality == flip.criticality == "super" and branch.ends.orbit.period == 2


def test_graze_hands_over_to_the_orbit_with_one_impact_more(symmetric):
    (after,) = vs.switch(symmetric.begins)
    assert after.itinerary == "LLRR" and after.symmetric
    branch = vs.continue_orbit(after, "b", (0.3, 6.8))
    ends = [special for special in branch.special if special.type == "graze"]
    touching = min(ends, key=lambda special: abs(special.parameters["b"] - 0.652974448339183))
    assert touching.parameters["b"] == pytest.approx(0.652974448339183, abs=1e-12)
    assert touching.impact is not None and touching.kind == "nonsmooth fold"


@pytest.mark.parametrize("family", [CHAIN, CAVITY])
def test_other_oscillators(family):
    """Three masses with unequal restitution and any damping; a free ball. Ends are where the orbit touches a stop."""
    orbit = vs.periodic_orbit(family, itinerary="LR")
    branch = vs.continue_orbit(orbit, "b", (0.05, 3))
    assert branch.begins.type == "graze" and branch.begins.orbit.margin == pytest.approx(0, abs=1e-13)
    for special in branch.special:
        assert special.orbit.ok and special.error < 1e-12
        if special.type in ("pitchfork", "flip"):
            assert np.abs(special.multipliers + 1).min() < 1e-11
        if special.type == "fold":
            assert np.abs(special.multipliers - 1).min() < 1e-11


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


def test_bad_input_is_refused():
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    with pytest.raises(ValueError, match="stops"):
        vs.continue_orbit(orbit, "stops", (0, 1))
    with pytest.raises(ValueError, match="mu_m, mu_k"):
        vs.continue_orbit(orbit, "beta", (0, 1))
    with pytest.raises(ValueError, match="bounds"):
        vs.continue_orbit(orbit, "b", (3, 4))
    with pytest.raises(ValueError, match="not_real"):
        vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=6.0), itinerary=""), "b", (1, 7))
    branch = vs.continue_orbit(orbit, "b", (1.9, 2.1))
    assert [special.type for special in branch.special] == ["limit", "limit"]
    with pytest.raises(ValueError, match="limit"):
        vs.switch(branch.ends)


def test_orbits_born_at_the_double_graze_of_the_paper():
    """orbits.md: only R, L and RL are born, all below b*."""
    born = vs.born_at_grazing(PAPER, periods=6)
    assert [(item.period, item.itinerary, item.born) for item in born] == [(1, "R", "below"), (1, "LR", "below")]


@pytest.mark.parametrize("omega", [0.56, 0.53, 0.44])
def test_orbits_born_at_a_graze_have_the_speeds_that_they_say(omega):
    system = PAPER.replace(omega=omega)
    b = vs.grazing(system).b
    born = vs.born_at_grazing(system, periods=4)
    assert len(born) >= 3 and all(item.orbit.ok for item in born)
    for item in born:
        distance = item.orbit.system.b - b
        assert (distance > 0) == (item.born == "above")
        speeds = np.abs(item.orbit.impacts["v1"]) / abs(distance)
        assert speeds == pytest.approx(item.speed_per_distance, rel=0.05)
    assert len({(item.period, item.itinerary, tuple(np.round(item.speed_per_distance, 6))) for item in born}) == len(
        born
    )


def test_complementarity_problem_against_all_sign_patterns():
    rng = np.random.default_rng(0)
    for _ in range(20):
        count = 6
        row = rng.normal(size=count)
        M = np.array([[row[(i - j) % count] for j in range(count)] for i in range(count)])
        sets = np.array(list(itertools.product([False, True], repeat=count))[1:])
        found = {(tuple(hit), side) for hit, _, side in complementary(M, sets)}
        expected = set()
        for hit in sets:
            d = np.zeros(count)
            for side in (-1, 1):
                d[hit] = np.linalg.solve(M[np.ix_(hit, hit)], -side * np.ones(hit.sum()))
                w = side + M @ d
                if np.all(d[hit] > 0) and np.all(w[~hit] > 0):
                    expected.add((tuple(hit), side))
        assert found == expected


def test_representatives_are_the_necklaces():
    def least(mask, shift):
        return min(tuple(np.roll(mask, k)) for k in range(0, len(mask), shift))

    for count, shift in ((6, 2), (8, 2), (5, 1)):
        everything = [np.array(m) for m in itertools.product([0, 1], repeat=count)]
        prime = {
            least(m, shift) for m in everything if all(np.any(np.roll(m, k) != m) for k in range(shift, count, shift))
        }
        found = [least(m.astype(int), shift) for m in representatives(count, shift, mirrors=False)]
        assert len(found) == len(set(found)) and set(found) == prime
        mirrored = {least(m.astype(int), 1) for m in representatives(count, shift, mirrors=True)}
        assert mirrored == {least(np.array(m), 1) for m in prime}


def exact(special, name):
    """The parameter of a special point in 40 digits, by shooting."""
    solution, value = special.orbit._solution, special.parameters[name]
    numbers = {key: number for key, number in family_of(special.orbit.system).numbers.items() if key != "stops"}
    shooting = Shooting(numbers, solution.sigma, solution.halves, solution.sides)
    x1, x2, v1, v2 = solution.states[0][:4]
    u = shooting.unknowns(solution.times, (x1, v1, x2, v2))
    if special.type == "fold":
        return shooting.where_multiplier(1, u, name, value)
    if special.type in ("flip", "pitchfork"):
        return shooting.where_multiplier(-1, u, name, value)
    if special.type == "neimark_sacker":
        return shooting.where_torus(u, name, value)
    if special.impact is None:
        _, time, side = solution.nearest
        return shooting.where_touching(time, side, u, name, value)
    return shooting.where_vanishing(int(np.argmin(solution.pushes)), u, name, value)


@pytest.mark.parametrize("R", [0.2, 0.8, 0.95])
def test_chatter_at_its_onset_shrinks_by_its_own_factor(R):
    """A mass that bounces under the acceleration s - s_inf: the factor of orbits.md makes its flights similar."""
    phi = shrinking(R)
    # velocity after an impact at s = -1 (s_inf = 0) such that the flight lasts 1 - phi; then the next one is similar
    d = 1 - phi
    v = d / 2 - d**2 / 6  # v d + integral of the acceleration s twice = 0
    arrival = v - d + d**2 / 2
    assert -R * arrival == pytest.approx(phi**2 * v, rel=1e-12)


@pytest.mark.slow
def test_sticking_onset_of_the_symmetric_orbit():
    """orbits.md: 0.064639143358."""
    system = PAPER.replace(b=0.08)
    orbit = vs.periodic_orbit(system, state=vs.simulate(system, (0, 0, 0, 0), 500).section[-1])
    branch = vs.continue_orbit(orbit, "b", (0.05, 0.2))
    onset = vs.sticking_onset(branch.begins)
    assert onset.type == "sticking" and onset.orbit.status == "sticking"
    assert onset.parameters["b"] == pytest.approx(0.064639143358, abs=1e-12)
    assert (
        abs(onset.parameters["b"] - 0.064639143358) < onset.error + 5e-13 and onset.error < 2e-12
    )  # some of it is rounding
    assert vs.sticking_onset(branch.ends) is None


@pytest.mark.slow
@pytest.mark.parametrize("name", ["b", "omega", "zeta", "mu_m"])
def test_special_points_in_40_digits(name, symmetric, one_sided):
    bounds = {"b": (0.3, 6.8), "omega": (0.4, 1), "zeta": (0.001, 0.2), "mu_m": (1, 20)}[name]
    branches = [vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=3.0), itinerary="LR"), name, bounds)]
    if name == "b":
        branches += [symmetric, one_sided, branch_of(6.6, 13)]
        branches += [vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=1.0), itinerary="LLRR"), "b", (0.1, 6))]
    checked = 0
    for branch in branches:
        for special in branch.special:
            if special.type != "limit":
                with mp.workdps(40):
                    difference = abs(mpf(special.parameters[name]) - exact(special, name))
                assert difference < max(special.error, 1e-15) and difference < 1e-13
                checked += 1
    assert checked >= 2


@pytest.mark.slow
def test_random_oscillators_agree_with_simulation():
    """Attractors of random systems, followed both ways: at points in between the engine repeats the orbit."""
    compared = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        system = vs.System(
            mu_m=10 ** rng.uniform(-0.5, 1), mu_k=10 ** rng.uniform(-0.5, 1), zeta=10 ** rng.uniform(-2, -0.5),
            f2=rng.choice([0, rng.uniform(0, 1)]), omega=rng.uniform(0.3, 2), R=rng.uniform(0.3, 1.0), b=1,
            stops=str(rng.choice(["both", "right", "left"])),
        )  # fmt: skip
        graze = vs.grazing(system).b
        system = system.replace(b=graze * rng.uniform(0.1, 1.05))
        section = vs.simulate(system, [0, 0, rng.normal() * system.b, 0], 1500).section
        periods = [n for n in range(1, 20) if np.abs(section[-1] - section[-1 - n]).max() < 1e-9]
        if not periods:
            continue
        orbit = vs.periodic_orbit(system, state=section[-1], periods=periods[0])
        if orbit.status == "sticking":
            continue
        assert orbit.ok and orbit.period == periods[0], seed
        name = rng.choice(["b", "omega", "zeta", "R"])
        value = getattr(system, name)
        bounds = (
            (0.1 * graze, 1.1 * graze)
            if name == "b"
            else (0.7 * value, min(1.3 * value, 1) if name == "R" else 1.3 * value)
        )
        branch = vs.continue_orbit(orbit, str(name), bounds)
        assert all(special.type != "failed" and special.orbit.ok for special in branch.special), seed
        points = branch.points.isel(point=slice(1, -1))
        for i in np.linspace(0, points.sizes["point"] - 1, 8).astype(int):
            point = points.isel(point=i)
            largest = float(np.hypot(point.multiplier_re, point.multiplier_im).max())
            if largest > 1e3:
                continue
            here = system.replace(**{str(name): float(point[name])})
            state = np.array([float(point[x]) for x in ("x1", "v1", "x2", "v2")])
            low, high = -here.b if here.stops != "right" else -np.inf, here.b if here.stops != "left" else np.inf
            state[0] = np.clip(state[0], low, high)
            simulated = vs.simulate(here, state, orbit.period)
            tolerance = 1e-9 * max(1, largest) / min(float(point.min_impact_speed), 1)
            assert np.abs(simulated.section[-1] - state).max() < tolerance * max(1, np.abs(state).max()), (seed, i)
            assert len(simulated.impacts) == points.sizes["impact"] or np.any(point.impact_t % here.period < 1e-6)
            compared += 1
    assert compared > 100
