"""The compiled equations of periodic orbits: Green function, Jacobian, flights, multipliers."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from support.oscillators import BALL, CAVITY, CHAIN, ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.periodic.impulse_equations import Equations, contacts_of, flow, multipliers_of
from vibro_sweep.engine.impulses.green import MOST_CELLS, ResonanceError, TooStiffError, space, train
from vibro_sweep.model.linear import family_of, forcing_period

PAPER_FAMILY = family_of(PAPER)
DAMPED = {
    "underdamped": PAPER_FAMILY,
    "critical": PAPER_FAMILY.replace(zeta=1 / math.sqrt(PAPER.modes.omega_squared[1])),
    "overdamped": PAPER_FAMILY.replace(zeta=3.0),
    "not proportional": CHAIN,
    "one mass": ONE_MASS,
}


def gamma_of(table, s):
    k = min(int(s / table.width), len(table.coefficients) - 1)
    return np.polynomial.polynomial.polyval(s - k * table.width, table.coefficients[k])


@pytest.mark.parametrize("name", DAMPED)
@pytest.mark.parametrize(("sigma", "halves"), [(1, 2), (-1, 1), (-1, 3), (1, 8)])
def test_green_function_is_the_sum_over_all_earlier_impulses(name, sigma, halves):
    q = DAMPED[name].linear
    s, table = space(q), train(q, sigma, halves)
    P = halves * forcing_period(q) / 2
    one = expm(s.A * P)
    for share in (0.0, 0.1, 0.5, 0.93, 1.0):
        z = expm(s.A * share * P) @ s.e_v
        total = 0.0
        for m in range(4000):
            total += sigma**m * (s.e_g @ z)
            z = one @ z
            if np.abs(z).max() < 1e-18:
                break
        assert gamma_of(table, share * P) == pytest.approx(total, rel=1e-11, abs=1e-13)


@pytest.mark.parametrize("family", [BALL, CAVITY], ids=["ball", "cavity"])
def test_green_function_of_a_free_mode_answers_impulses_less_their_mean(family):
    """Jump 1 of the velocity, period P, gamma(0) = 0, and the equation of motion with the force -1/P."""
    q = family.linear
    s, table = space(q), train(q, 1, 2)
    P = table.P
    d = table.width
    assert gamma_of(table, 0.0) == pytest.approx(0, abs=1e-14)
    assert gamma_of(table, P) == pytest.approx(0, abs=1e-13)
    start, end = table.coefficients[0], table.coefficients[-1]
    slope_at_end = sum(n * end[n] * d ** (n - 1) for n in range(1, len(end)))
    assert start[1] - slope_at_end == pytest.approx(1, abs=1e-12)
    if len(q.along) == 1:
        u = np.linspace(0, P, 7)
        # orbits.md: s/2 - s^2/(2P), less a constant
        assert [gamma_of(table, x) for x in u] == pytest.approx(u / 2 - u**2 / (2 * P), abs=1e-13)
    assert s.e_g @ s.A @ s.e_v == pytest.approx(1)


CASES = [
    (family, name)
    for family in (PAPER_FAMILY, PAPER_FAMILY.replace(tau=0.3), BALL, CAVITY, CHAIN, ONE_MASS)
    for name, value in family.numbers.items()
    if isinstance(value, float)
]


@pytest.mark.parametrize(("family", "name"), CASES, ids=[f"{f.build.__name__}-{n}" for f, n in CASES])
def test_derivatives_are_those_of_differences(family, name):
    q = family.linear
    right, left = np.isfinite(q.high), np.isfinite(q.low)
    sides = [1 if right else -1, -1 if left else 1, 1 if right else -1]
    for sigma, halves in ((1, 2), (-1, 3)) if q.symmetric else ((1, 2),):
        e = Equations(q, sigma, halves, family.derivative(name))
        u = np.array([0.3, 1.1, 2.9, -2.0, 1.5, -1.0])
        u = np.append(u, 0.1) if e.free else u
        _, J, Fp, _ = e.evaluate(sides, u)
        h = 1e-6
        for j, axis in enumerate(np.eye(len(u))):
            slope = (e.evaluate(sides, u + h * axis)[0] - e.evaluate(sides, u - h * axis)[0]) / (2 * h)
            assert slope == pytest.approx(J[:, j], abs=2e-8)
        value = family.numbers[name]
        up, down = (Equations(family.replace(**{name: value + d}).linear, sigma, halves) for d in (h, -h))
        slope = (up.evaluate(sides, u)[0] - down.evaluate(sides, u)[0]) / (2 * h)
        assert slope == pytest.approx(Fp, abs=1e-8 * max(1, np.abs(Fp).max()))


@pytest.mark.parametrize(
    ("family", "itinerary", "periods"), [(PAPER_FAMILY, "LR", 1), (CHAIN, "L", 1), (CHAIN.replace(b=0.2), "LR", 1)]
)
def test_determinant_of_the_linearised_equations(family, itinerary, periods):
    """det J(mu) = prod v_i prod (mu - mu_j)/(mu - sigma e^{l_j P}) at mu = 1, -1, with mu_j of a plain product."""
    orbit = vs.periodic_orbit(family, itinerary=itinerary, periods=periods)
    s, solution = space(family.linear), orbit._solution.whole()
    e, u, motion = solution.equations, solution.u, solution.motion
    _, J, _, _ = e.evaluate(solution.sides, u)
    n, N = len(s.e_g), len(s.e_g) // 2
    velocity = np.concatenate([np.zeros(N), s.e_g[:N]])
    product = np.eye(n)
    for k, side in enumerate(solution.sides):
        gain = 1 + family.linear.restitution([side])[0]
        v, a = motion[k, 0], motion[k, 1]
        S = np.eye(n) - gain * np.outer(s.e_v, velocity)
        S += np.outer(gain * a * s.e_v - gain * v * (s.A @ s.e_v), s.e_g) / v
        following = u[k + 1] if k + 1 < solution.K else u[0] + e.P
        product = expm(s.A * (following - u[k])) @ S @ product
    mu, free = np.linalg.eigvals(product), np.exp(np.linalg.eigvals(s.A) * e.P)
    assert np.sort_complex(mu) == pytest.approx(np.sort_complex(orbit.multipliers), abs=1e-10)
    for point, matrix in ((1, J), (-1, e.linearised(-1, solution.sides, u, motion))):
        expected = np.prod(motion[:, 0]) * np.prod(point - mu) / np.prod(point - free)
        assert np.linalg.det(matrix) == pytest.approx(expected.real, rel=1e-8)


def test_undamped_mode_that_repeats_itself_is_named():
    family = PAPER_FAMILY.replace(zeta=0.0, tau=0.0)
    omega = math.sqrt(PAPER.modes.omega_squared[0])
    with pytest.raises(ResonanceError):
        train(family.replace(omega=omega).linear, 1, 2)
    assert np.isfinite(train(family.linear, 1, 2).coefficients).all()


def test_rates_too_far_apart_are_named():
    with pytest.raises(TooStiffError, match=str(MOST_CELLS)):
        train(PAPER_FAMILY.replace(mu_m=1e-12, tau=0.0).linear, 1, 2)


def test_kernels_are_not_given_arrays_that_are_too_short():
    """The mean gap of a free mode was left out: a kernel wrote beyond its arrays, and the interpreter died."""
    numbers = dict(mass_ratio=0.2747929395913874, zeta=0.11595848024966961, F=0.9895081779106233)
    damper = vs.Oscillator.named("ball_in_cavity", **numbers, omega=0.6493760554424832, R=0.7, b=1.0)
    orbit = vs.periodic_orbit(damper, itinerary="LR")
    whole = orbit._solution.whole()
    short = replace(whole, u=whole.u[: 2 * whole.K])
    with pytest.raises(AssertionError, match="unknowns"):
        short.equations.evaluate(short.sides, short.u)


def test_impacts_out_of_order_have_no_multipliers():
    """Their flights are longer than the period, in which there is room for the factors."""
    orbit = vs.periodic_orbit(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.3), itinerary="LR")
    s = orbit._solution.whole()
    moved = s.u.copy()
    moved[0] += 100 * s.P
    q = s.family.linear
    given = flow(q), s.sigma, s.P, contacts_of(q, None, s.sides)
    assert np.isnan(multipliers_of(*given, moved, s.motion)).all()
    assert np.isfinite(multipliers_of(*given, s.u, s.motion)).all()
