"""Derivatives of the equations of curves: tangents beside differences of points, and quadratic convergence."""

from itertools import pairwise

import numpy as np
import pytest
from golden import curves, records
from support import slow_cases

from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.curves.bifurcation_curve import first_of
from vibro_sweep.analysis.curves.curve_start import start_at
from vibro_sweep.engine.continuation import stepper

NAMES = (  # of each kind, of one to eight masses, in numbers that move the flight and that do not
    "paper, symmetric, pitchfork 1",
    *slow_cases(
        "closed curve of folds",
        "paper, symmetric, in mu_k, pitchfork 3",
        "paper, one side, in b, neimark_sacker 1",
        "drawn 15.0, two_mass, graze 2",
        "drawn 15.0, two_mass, fold 1",
        "drawn 1.1, one_mass, flip 0",
        "drawn 92.0, ball_in_cavity, fold 4",
        "drawn 18.0, chain, neimark_sacker 1",
        "drawn 18.2, chain, flip 1",
        "drawn 13.1, chain, pitchfork 4",
        "chain of 7, LR, pitchfork 2",
        "chain of 8, LLRR, neimark_sacker 2",
        "drawn 69.1, linear, fold 1",
    ),
)
H = 1e-3
ROUNDED = 1e-12  # Newton's change where what is left of it is rounding


@pytest.fixture(params=NAMES, scope="module")
def curve(request):
    """A curve of the golden record and its first point."""
    record = records.read("curves")[request.param]
    names = tuple(record["names"])
    solution_curve, place = first_of(
        SolutionCurve(start_at(curves.start_of_curve(record), names), names, record["box"])
    )
    return solution_curve, solution_curve.step(place, 10 * H)


def test_tangents_are_those_of_the_points(curve):
    solution_curve, place = curve
    beside = [solution_curve.step(place, sign * H) for sign in (-2, -1, 1, 2)]
    far, near = solution_curve.difference(beside[0], beside[3]), solution_curve.difference(beside[1], beside[2])
    np.testing.assert_allclose((8 * near - far) / (12 * H), place.direction, rtol=0, atol=3e-8)


def test_newtons_method_converges_quadratically(curve):
    """From a guess that satisfies no equation: states before impacts are off, too."""
    solution_curve, place = curve
    guess, row = solution_curve.copied(place), place.direction
    guess.x[:] += 1e-4 * np.random.default_rng(1).normal(size=guess.x.shape)
    changes = []
    while not changes or changes[-1] > ROUNDED:
        assert solution_curve.take_numbers(guess) and len(changes) < 5
        changes.append(solution_curve.run_task(stepper.CORRECT, guess, row))
    constant = max(changes[1] / changes[0] ** 2, 1.0)
    assert changes[0] > 1e-6 and all(b < 30 * constant * a * a + ROUNDED for a, b in pairwise(changes))
