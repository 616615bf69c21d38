"""Curves of an orbit of 68 impacts: few points are needed for those of codimension two, and few operations for each."""

import numpy as np
import pytest
from support.drawn_branches import drawn_oscillator
from support.random_switching import attractor

import vibro_sweep as vs
from vibro_sweep.analysis.continuation import secant
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve

SEED = [1, 840]

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def graze():
    rng = np.random.default_rng(SEED)
    system = drawn_oscillator(str(rng.choice(["one_mass", "two_mass", "ball_in_cavity"])), rng)
    state, periods = attractor(system, rng, tries=1)
    orbit = vs.periodic_orbit(system, state=state, periods=periods)
    assert orbit.ok and orbit._solution.K == 68
    return vs.continue_orbit(orbit, "b", (0.9 * system.b, 1.1 * system.b)).begins


def test_searches_end_where_rounding_of_the_tests_begins(graze, monkeypatch):
    b, omega = graze.parameters["b"], graze.orbit.system.omega
    bounds, counts, found = ((0.9 * b, 1.1 * b), (0.95 * omega, 1.05 * omega)), [], []
    correct = SolutionCurve.correct

    def counted(curve, guess, row, exact=True):
        counts[-1] += exact
        return correct(curve, guess, row, exact)

    monkeypatch.setattr(SolutionCurve, "correct", counted)
    for coarse in (secant.COARSE, 1.0):
        monkeypatch.setattr(secant, "COARSE", coarse)
        counts.append(0)
        found.append(vs.bifurcation_curve(graze, ("b", "omega"), bounds).special)
    assert len(found[0]) > 8 and counts[0] < 0.7 * counts[1]  # 0.55 to 0.6, as kernels round
    assert [one.type for one in found[0]] == [other.type for other in found[1]]
    for one, other in zip(*found, strict=True):
        for name, value in one.parameters.items():
            assert abs(value - other.parameters[name]) <= one.error + other.error
