"""Criticality of Neimark-Sacker points."""

import numpy as np
import pytest
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches import torus


class NormalForm:
    """z -> e^{i theta} z (1 + a |z|^2) and a contraction, seen in other coordinates: y = S (x + quadratic terms)."""

    n = 4

    def __init__(self, theta, a, seed):
        rng = np.random.default_rng(seed)
        self.theta, self.a = theta, a
        self.S, self.terms = rng.normal(size=(4, 4)) + 3 * np.eye(4), rng.normal(size=(4, 4, 4))

    def bent(self, x):
        return self.S @ (x + np.einsum("ijk,j,k", self.terms, x, x))

    def straight(self, y):
        aim = np.linalg.solve(self.S, y)
        x = aim.copy()
        for _ in range(60):
            x = aim - np.einsum("ijk,j,k", self.terms, x, x)
        return x

    def __call__(self, y):
        x = self.straight(y)
        z = complex(x[0], x[1])
        z = np.exp(1j * self.theta) * z * (1 + self.a * abs(z) ** 2)
        return self.bent(np.array([z.real, z.imag, 0.3 * x[2], -0.5 * x[3]]))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("a", [0.7, -0.4 + 2j, 0.05 - 1j])
def test_coefficient_of_a_normal_form_in_other_coordinates(a, seed):
    """With |q| = 1 in y the coefficient is Re a times the square of |z| along q."""
    form = NormalForm(1.1, a, seed)
    found = torus._coefficient(form, 1.1, np.ones(4), 1e-3)
    q = form.S @ np.array([1, -1j, 0, 0])  # of eigenvalue e^{i theta}, z = 2 times its coordinate
    expected = np.real(a) * (2 / np.linalg.norm(q)) ** 2
    assert found == pytest.approx(expected, rel=1e-3)


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
