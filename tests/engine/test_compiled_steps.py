"""Compiled steps along a branch: points, tests and certificate, beside orbits and multipliers found by themselves."""

import numpy as np
import pytest
from scipy.linalg import expm
from support.oscillators import BALL, CAVITY, CHAIN, LONG_CHAIN, ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_run import FIRST_STEP
from vibro_sweep.analysis.branches.compiled_stepper import CompiledStepper
from vibro_sweep.analysis.continuation.first_point import guess_of, start_of_branch
from vibro_sweep.analysis.continuation.solution_curve import branch_through
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.certificate import may_turn
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.continuation.workspace import TEST
from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.types import Family, PeriodicOrbit


def stepper_of(solution, name, bounds, forwards=1.0):
    first = start_of_branch(branch_through(solution, name, bounds[1] - bounds[0], bounds))
    return first, CompiledStepper(first if forwards > 0 else first.backwards(), 0, FIRST_STEP)


CASES = [
    (PAPER.replace(b=3.0), "LR", "b", (1.0, 3.5)),
    (PAPER.replace(b=3.0), "LR", "omega", (0.55, 0.7)),
    (PAPER.replace(b=3.0, zeta=0.01), "LR", "zeta", (0.005, 0.05)),
    (PAPER.replace(b=4.0), "R", "mu_m", (8.0, 12.0)),
    (PAPER.replace(b=1.0), "LLRR", "R", (0.7, 0.9)),
    (ONE_MASS.replace(F=0.37), "R", "omega", (0.7, 0.9)),
    (ONE_MASS.replace(F=0.37), "R", "F", (0.35, 0.5)),
    (CAVITY, "LR", "b", (0.3, 0.8)),
    (CAVITY, "LR", "ratio", (0.1, 0.3)),
    (BALL.replace(A=0.5), "L", "G", (0.8, 1.2)),
    pytest.param(CHAIN, "LR", "c", (0.05, 0.3), marks=pytest.mark.slow),  # three masses compile kernels of their own
    pytest.param(CHAIN, "LR", "k", (0.5, 1.0), marks=pytest.mark.slow),
    pytest.param(LONG_CHAIN, "born", "b", (0.01, 60.0), marks=pytest.mark.slow),
    pytest.param(LONG_CHAIN, "born", "omega", (0.45, 0.55), marks=pytest.mark.slow),
]


def orbit_of(system, itinerary):
    if itinerary == "born":
        born = next(item.orbit for item in vs.born_at_grazing(system, 1) if item.itinerary == "LR")
        points = vs.continue_orbit(born, "b", (0.01, 60)).points
        middle = (points.b.min() + points.b.max()) / 2
        point = points.isel(point=int(abs(points.b - middle).argmin("point")))
        guess = zip(point.impact_t.values, point.impact_side.values, point.impact_v.values, strict=True)
        return vs.periodic_orbit(system.replace(b=float(point.b)), guess=list(guess))
    periods = 2 if isinstance(system, Family) and system.build is ONE_MASS.build else 1
    orbit = vs.periodic_orbit(system, itinerary=itinerary, periods=periods)
    assert orbit.ok
    return orbit


@pytest.mark.parametrize(("system", "itinerary", "name", "bounds"), CASES)
def test_points_are_orbits(system, itinerary, name, bounds):
    orbit = orbit_of(system, itinerary)
    first, stepper = stepper_of(orbit._solution, name, bounds)
    _, rows = stepper.run(1)
    assert len(rows.p) >= 2 and rows.p[-1] != rows.p[0]
    for i in np.linspace(0, len(rows.p) - 1, 5).astype(int):
        family = first.solution.family.replace(**{name: rows.p[i]})
        s = orbit._solution
        u = np.concatenate([rows.t[i], rows.D[i]])
        start = Solution(family, s.sigma, s.half_periods, s.sides, u)
        exact, u = start.corrected(), start.u
        size = exact.size_of_gap
        back, slowest = np.linalg.inv(Linearised(exact).closure(1)), np.abs(exact.motion[:, 0]).min()
        size_of_u = np.repeat([1 / slowest, family.linear.omega], s.K)
        error = 3e-13 * size * size_of_u * (1 + np.linalg.norm(back, 2))  # what so much in the equations does
        assert np.all(np.abs(exact.u - u) < error + 1e-13 * np.abs(u))
        slack = float(error.max() + 1e-12 * size)
        assert np.abs(exact.motion[:, :2] - rows.motion[i]).max() < 3 * slack
        assert rows.stop_distance[i] == pytest.approx(exact.stop_distance, abs=slack)
        found = PeriodicOrbit(orbit.system, "ok", exact, (0, 0))
        assert rows.state[i] == pytest.approx(found.state, abs=slack)


@pytest.mark.parametrize(("system", "itinerary", "name", "bounds"), CASES)
def test_tests_have_the_signs_of_the_precise_ones(system, itinerary, name, bounds):
    """Of det G(-1) up to a factor of one sign, of the torus test, of the tangent; and the count of multipliers."""
    orbit = orbit_of(system, itinerary)
    first, stepper = stepper_of(orbit._solution, name, bounds)
    precise, found = [first], [stepper.a.tests.copy()]
    for _ in range(4):
        stepper.run(1)
        precise.append(stepper.point(stepper.a))
        found.append(stepper.a.tests.copy())
        precise.append(stepper.point(stepper.b))
        found.append(stepper.b.tests.copy())
        stepper.accept(precise[-2], precise[-1])
    pairs = [(x.solution.multipliers, n) for x, n in zip(precise, found, strict=True) if x]
    assert len({np.sign(np.prod(1 + mu).real * n[TEST.minus]) for mu, n in pairs}) == 1
    for x, n in zip(precise, found, strict=True):
        if x is not None:
            if len(x.solution.multipliers) > 2:  # else it cannot vanish
                assert n[TEST.pair] == pytest.approx(
                    x.solution.torus, rel=1e-6, abs=1e-9 * np.abs(x.solution.multipliers).max()
                )
            assert n[TEST.rate] == pytest.approx(x.rate, rel=1e-6, abs=1e-9)
            mu = x.solution.multipliers
            out, real = np.abs(mu) > 1, mu.imag == 0
            assert n[TEST.above] == np.count_nonzero(out & real & (mu.real > 0))
            assert n[TEST.below] == np.count_nonzero(out & real & (mu.real < 0))
            assert 2 * n[TEST.pairs] == np.count_nonzero(out & ~real)
            assert n[TEST.on_circle] == 0
            r, (i, j) = np.prod(np.hypot(1, abs(mu))), np.triu_indices(len(mu), 1)
            crossing = np.prod(1 - mu[i] * mu[j]).real / r ** (len(mu) - 1) if len(mu) > 2 else 1.0
            assert n[TEST.reflected] == pytest.approx(np.prod(1 + mu).real / r, rel=1e-6, abs=1e-9)
            assert n[TEST.crossing] == pytest.approx(crossing, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("count", [4, 30])
def test_orbit_written_out_several_times_has_the_same_branch(count):
    short = vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R")
    _, one = stepper_of(short._solution, "b", (3.5, 4.2))
    _, many = stepper_of(short._solution.whole().repeated(count), "b", (3.5, 4.2))
    for stepper in (one, many):
        stepper.run(1)
    for stepper in (one, many):
        point = stepper.point(stepper.a)
        same = vs.periodic_orbit(PAPER.replace(b=point.value), itinerary="R")._solution
        assert np.abs(point.solution.jumps - same.jumps).max() < 1e-11
        assert np.abs(point.solution.states[:, :4] - same.states[0, :4]).max() < 1e-11


@exported
def asked(planes, states, turns, low, high, nearest, answers):
    for i in range(len(states)):
        answers[i] = may_turn(planes[0], states[i], turns[i], low[i], high[i], nearest[i])


@pytest.mark.parametrize(
    ("system", "itinerary", "name"),
    [(PAPER.replace(b=3.0), "LR", "b"), (ONE_MASS.replace(F=0.37), "R", "F"), (CAVITY, "LR", "b")],
)
def test_cells_left_out_have_no_turning_point_of_interest(system, itinerary, name):
    """Against 400 samples of each cell, by matrix exponentials: 4000 random flights, both bounds have work to do."""
    rng, count, samples = np.random.default_rng(5), 4000, 400
    curve = branch_through(orbit_of(system, itinerary)._solution, name, 0.1)
    curve.move_to(guess_of(curve))
    plane = curve.planes[0]
    A, width, omega, swing = plane["A"], float(plane["width"]), float(plane["numbers"][OMEGA]), plane["Z"][0]
    n = len(A)
    B = np.vstack([A, np.zeros(n + 1)])
    states = rng.normal(size=(count, n)) * 10.0 ** rng.uniform(-2, 2, (count, 1))
    turned = np.exp(1j * rng.uniform(0, 2 * np.pi, count))
    times, full = np.linspace(0, width, samples), np.column_stack([states, np.ones(count)])
    gap, slope = np.einsum("sij,pj->ips", [expm(B * s)[[0, n // 2]] for s in times], full)
    steady = swing * turned[:, None] * np.exp(1j * omega * times)
    gap, slope = gap + steady.real, slope + (1j * omega * steady).real
    high, low = rng.uniform(0.1, 100, count), -rng.uniform(0.1, 100, count)
    nearest = np.where(rng.random(count) < 0.5, np.inf, rng.uniform(0, 50, count))
    answers = np.zeros(count, bool)
    asked(curve.planes, states, turned, low, high, nearest, answers)
    turns = np.any(slope[:, 1:] * slope[:, :-1] < 0, axis=1)
    distance = np.minimum(high - gap.max(axis=1), gap.min(axis=1) - low)
    assert not np.any(~answers & turns & (distance < nearest))
    assert np.count_nonzero(~answers & turns) > 50  # left out for their distance
    assert np.count_nonzero(~answers & np.isinf(nearest)) > 1000  # left out for their slope
    assert np.count_nonzero(answers & ~turns & np.isinf(nearest)) < 0.1 * count  # few are looked at in vain
