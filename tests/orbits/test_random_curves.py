"""Bifurcation curves of random systems: tests/support/random_curves.py."""

import numpy as np
import pytest
from support.random_branches import attractors, random_system
from support.random_curves import key, special_at, study
from support.searching import searched

import vibro_sweep as vs


@pytest.mark.slow
def test_curves_of_random_systems():
    counted, wrong = searched(study, range(8))
    assert wrong == [] and counted["curves"] >= 4 and counted["points"] >= 2 * counted["curves"]


@pytest.mark.slow
def test_a_closed_curve():
    """Of folds in (b, R): it comes back, wherever it is begun."""
    rng = np.random.default_rng(52)
    system = random_system(rng)
    ((state, periods),) = attractors(system, rng, most=1, tries=4)
    orbit = vs.periodic_orbit(system, state=state, periods=periods)
    branch = vs.continue_orbit(orbit, "b", (0.3 * system.b, 2 * system.b))
    fold = next(special for special in branch.special if special.type == "fold")
    b = fold.parameters["b"]
    bounds = ((0.1 * b, 10 * b), (0.05, 1.0))
    curve = vs.bifurcation_curve(fold, ("b", "R"), bounds)
    assert curve.closed and curve.begins is curve.ends and curve.ends.type == "closed"
    points = np.column_stack([curve.points.b, curve.points.R])
    steps = np.linalg.norm(np.diff(points / np.ptp(points, axis=0), axis=0), axis=1)
    assert np.linalg.norm((points[-1] - points[0]) / np.ptp(points, axis=0)) < 2 * steps.max()
    other = vs.bifurcation_curve(special_at(curve, 40, fold.orbit), ("b", "R"), bounds)
    assert other.closed
    keys = [sorted(key(one) for one in found.special if one.type != "closed") for found in (curve, other)]
    assert [kind for kind, *_ in keys[0]] == [kind for kind, *_ in keys[1]]
