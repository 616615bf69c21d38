"""Criticality of Neimark-Sacker points."""

import numpy as np
import pytest
from scipy.linalg import expm
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches import torus


def product(a, b):
    """Of two power series in two numbers, to third order."""
    out = np.zeros((4, 4), complex)
    for j in range(4):
        for k in range(4 - j):
            out[j:, k:] += a[j, k] * b[: 4 - j, : 4 - k]
    return out


class NormalForm:
    """z -> e^{i theta} z (1 + a |z|^2) and a contraction, seen in other coordinates: y = S (x + quadratic terms)."""

    n = 4

    def __init__(self, theta, a, seed):
        rng = np.random.default_rng(seed)
        self.theta, self.a = theta, a
        self.S, self.terms = rng.normal(size=(4, 4)) + 3 * np.eye(4), rng.normal(size=(4, 4, 4))

    def squares(self, x):
        return sum(np.multiply.outer(self.terms[:, j, k], product(x[j], x[k])) for j in range(4) for k in range(4))

    def straight(self, y):
        aim = np.tensordot(np.linalg.inv(self.S), y, 1)
        x = aim
        for _ in range(3):
            x = aim - self.squares(x)
        return x

    def __call__(self, y):
        """Of power series (4, 4, 4)."""
        x = self.straight(y)
        size = product(x[0], x[0]) + product(x[1], x[1])  # |z|^2 where x is real
        turned = []
        for part, other, sign in ((x[0], x[1], -1), (x[1], x[0], 1)):
            factors = [np.exp(1j * self.theta) * weight for weight in (1, self.a)]
            real, imag = (
                factors[0].real * part + factors[1].real * product(size, part),
                factors[0].imag * other + factors[1].imag * product(size, other),
            )
            turned.append(real + sign * imag)
        x = np.array([*turned, 0.3 * x[2], -0.5 * x[3]])
        return np.tensordot(self.S, x + self.squares(x), 1)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("a", [0.7, -0.4 + 2j, 0.05 - 1j])
def test_coefficient_of_a_normal_form_in_other_coordinates(a, seed):
    """With |q| = 1 in y the coefficient is Re a times the square of |z| along q."""
    form = NormalForm(1.1, a, seed)
    found = torus.coefficient(form, 1.1).sum().real
    q = form.S @ np.array([1, -1j, 0, 0])  # of eigenvalue e^{i theta}, z = 2 times its coordinate
    expected = np.real(a) * (2 / np.linalg.norm(q)) ** 2
    assert found == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("itinerary", ["R", "LR"])
def test_series_of_the_map_agree_with_differences_of_simulation(itinerary):
    """Third order in a displacement: what is left falls like its fourth power."""
    orbit = vs.periodic_orbit(PAPER.replace(b=3.5, tau=0.4), itinerary=itinerary)
    s = orbit._solution
    f, P = torus.Map(s), s.P
    direction = np.array([0.3, -0.2, 0.5, 0.4])  # of x1, x2, v1, v2
    series = np.zeros((4, 4, 4), complex)
    series[:, 1, 0] = direction
    expected = f(series)[:, :, 0].real
    begin = s.times[0] - 0.02  # before the first impact, of all displaced motions too
    short = expm(torus.flow(s.family.linear).B * 0.02)[:4, :4]
    order = [0, 2, 1, 3]

    def image(size):
        there = orbit.sample([begin])[0] + np.linalg.solve(short, size * direction)[order]
        run = vs.simulate(orbit.system, there, 1, begin)
        return short @ (s.sigma * run.sample([begin + P]) - orbit.sample([begin]))[0][order]

    left = [
        np.abs(image(size) - expected @ size ** np.arange(4)).max() / np.abs(expected[:, 3]).max()
        for size in (1e-2, 5e-3)
    ]
    assert left[0] < 1e-6 and left[0] / left[1] == pytest.approx(16, rel=0.1)


def test_criticality_where_the_impact_is_slow():
    """Rounding of its time once hid the sign: speed 5e-2 of omega times the clearance."""
    system = vs.System(
        mu_m=7.217826111600302, mu_k=0.4128955381592853, zeta=0.022, f2=0, omega=0.44440953779592013,
        R=0.7404608367095735, b=0.028635072114428204, stops="left",
    )  # fmt: skip
    orbit = vs.periodic_orbit(system, itinerary="L")
    branch = vs.continue_orbit(orbit, "zeta", (0.0208, 0.025))
    point = next(s for s in branch.special if s.type == "neimark_sacker")
    assert point.parameters["zeta"] == pytest.approx(0.021001901082175742, rel=1e-12) and point.criticality == "super"


def test_circle_beyond_the_point_attracts(one_sided_branch):
    """Supercritical: beyond it, orbits that start nearer and farther come to one distance, like its square root."""
    special = one_sided_branch.special[1]
    assert special.type == "neimark_sacker" and special.criticality == "super"
    distances = []
    for beyond in (5e-4, 2e-3):
        orbit = vs.periodic_orbit(PAPER.replace(b=special.parameters["b"] + beyond), itinerary="R")
        assert not orbit.stable
        reached = []
        for size in (0.05, 0.8):
            start = orbit.state + np.array([0, size, 0.3 * size, 0.2 * size])
            section = vs.simulate(orbit.system, start, 40_000).section
            reached.append(np.abs(section[-500:] - orbit.state).max())
        assert reached[0] == pytest.approx(reached[1], rel=0.02)
        distances.append(reached[0])
    assert distances[1] / distances[0] == pytest.approx(2, rel=0.1)
