"""Pairs of multipliers near the unit circle: slow ones, and two that pass one another."""

from types import SimpleNamespace

import numpy as np
import pytest
from support.branches import same_points, types
from support.drawn_branches import Case
from support.same_branch import follow

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_events import reflected, torus_test
from vibro_sweep.analysis.branches.crossings import nearest_pair
from vibro_sweep.engine.impulses import pairs


class Stand:
    """A point with multipliers only."""

    def __init__(self, multipliers):
        self.solution, self.torus = self, np.nan
        self.multipliers = multipliers
        i, j = np.triu_indices(len(multipliers), 1)
        self.products = multipliers[i] * multipliers[j]


def test_a_weakly_damped_pair_crosses_the_circle_between_two_points_near_it():
    """Its factor of the torus test is left out where it is zero to rounding only, as that of another one is."""
    lossless, slow = np.exp(1.1j), np.exp(2.7j)
    here, there = (Stand(np.array([lossless, lossless.conj(), *(size * np.array([slow, slow.conj()])), 0.5, 0.3]))
                   for size in (1 - 2e-8, 1 + 3e-8))  # fmt: skip
    test = torus_test(here, there)
    assert test(here) * test(there) < 0


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.1, 0.5, 1, 2])
def test_a_start_on_a_torus_of_a_weakly_damped_chain(factor):
    """The neighbour at which the run begins, and the point behind it, are within 1e-6 of the circle."""
    chain = vs.Oscillator.named(
        "chain", stop_at=4, omega=1.93, R=0.93, b=0.15, tau=1.05, m=[2] * 6, k=[1, 1, 2, 2, 1, 1, 1],
        c=[0.001, 0.002, 0.003, 0.003, 0.002, 0.001, 0.002], force=[0, -2, 1, 0, -1, -2],
    )  # fmt: skip
    case = Case(vs.periodic_orbit(chain, itinerary="LR"), "b", (0.139, 2.087))
    branch = follow(case)
    last = [special for special in branch.special if special.type == "neimark_sacker"][-1]
    assert last.parameters["b"] == pytest.approx(1.04052196, abs=1e-8)
    same_points(follow(case._replace(orbit=last.orbit), factor), types(branch), 1e-10)


def passing(length: float):
    """Multipliers at three points `length` apart, in the middle of which one pair passes another nearer to the circle;
    and those half way between the second and the third."""
    found, coupling = [], 0.012 * np.exp(1.53j)
    for s in length * np.array([-1.5, -0.5, 0.5, 0.0]):
        mu = np.linalg.eigvals([[0.999 * np.exp(1.53j), coupling], [coupling, 0.967 * np.exp(1j * (1.53 - 12 * s))]])
        found.append(np.array([[value.real, part * value.imag] for value in mu for part in (1, -1)]))
    return found


def test_a_pair_that_another_one_pushes_over_the_circle_while_it_passes():
    """Both are inside before and behind; the one that is passed goes where it was heading."""
    before, here, there, middle = passing(0.012)
    inside = [np.all(np.hypot(*mu.T) < 1) for mu in (before, here, there, middle)]
    assert inside == [True, True, True, False]
    assert pairs.coarse(before, here, there, 1.0, 1.0)
    assert not any(pairs.coarse(*passing(length)[:3], 1.0, 1.0) for length in (0.0015, 0.0005))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("sign", [1, -1])
def test_an_infinite_multiplier_is_the_limit_of_large_ones(sign):
    """As beside the graze of a rigid stop, where another one is 0: their product is not a number."""
    others = [0.5 + 0.8j, 0.5 - 0.8j, 0.0]
    infinite, large = (np.array([sign * size, *others], complex) for size in (np.inf, 1e150))
    tests = [reflected(SimpleNamespace(solution=SimpleNamespace(multipliers=mu))) for mu in (infinite, large)]
    assert tests[0] == pytest.approx(tests[1], rel=1e-12) and tests[0] * sign > 0
    assert {*nearest_pair(infinite)} == {*others[:2]}
    assert np.isnan(nearest_pair(infinite[[0, 3]])).all()
