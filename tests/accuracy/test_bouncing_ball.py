"""The bouncing ball against its closed forms (physics of one mass), and a preloaded mass at rest."""

import math

import numpy as np
import pytest
from support.drawn_oscillators import one_mass

import vibro_sweep as vs

pytestmark = pytest.mark.slow  # motions of one mass between rigid stops compile a kernel of their own


@pytest.mark.parametrize(("R", "n", "gamma"), [(0.8, 1, 1.05), (0.8, 1, 0.5), (0.5, 2, 2.3)])
def test_bouncing_ball(R, n, gamma):
    """One impact every n periods of the table: speed n T G/(1 + R) at cos(phi) = n pi (1 - R)/((1 + R) gamma)."""
    speed, phi = n * 2 * math.pi / (1 + R), math.acos(n * math.pi * (1 - R) / ((1 + R) * gamma))
    ball = one_mass(force=[gamma], constant=[-1.0], omega=1.0, tau=phi, b=0.0, R=R, stops="left")
    hits = vs.simulate(ball, [0.0, -speed], 10 * n).impacts
    assert len(hits) >= 10
    np.testing.assert_allclose(hits["v1"], -speed, rtol=1e-13)
    np.testing.assert_allclose(np.diff(hits["t"]), n * 2 * math.pi, rtol=1e-13)


@pytest.mark.parametrize(("R", "n", "flip"), [(0.8, 1, 1.07083646824791), (0.5, 2, 2.37087721026694)])
def test_flip_of_the_bouncing_ball(R, n, flip):
    """Within 1e-9 of the flip lambda_1 changes its sign. The orbit begins a time 1 after an impact."""
    signs = []
    for gamma in (flip - 1e-9, flip + 1e-9):
        speed, phi = n * 2 * math.pi / (1 + R), math.acos(n * math.pi * (1 - R) / ((1 + R) * gamma))
        later = phi + 1
        x = R * speed - 0.5 + gamma * (math.sin(phi) + math.cos(phi) - math.sin(later))
        v = R * speed - 1 + gamma * (math.cos(phi) - math.cos(later))
        ball = one_mass(force=[gamma], constant=[-1.0], omega=1.0, tau=later, b=0.0, R=R, stops="left")
        signs.append(np.sign(vs.lyapunov(ball, [x, v], transient=0, record=20)[0]))
    assert signs == [-1, 1]


def test_preload():
    """At rest on a stop, until the force has grown to what holds it there."""
    preload, force = 0.5, 1.3
    system = one_mass(
        K=[[1.0]], C=[[0.1]], force=[force], constant=[-preload], omega=0.9, tau=0.0, b=0.0, R=0.5, stops="left"
    )
    first = vs.simulate(system, [0.0, 0.0], 1).sticking[0]
    assert first["t_on"] == 0 and first["side"] == -1
    assert abs(first["t_off"] - math.asin(preload / force) / 0.9) < 1e-13
