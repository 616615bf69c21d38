"""Branches of random oscillators: stable pieces against simulation; the same special points from wherever a branch is
followed, each held against monodromy matrices that do not come from the engine."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.machine import machine_of
from support import branch_search, conditions, random_branches, slow_cases
from support.drawn_branches import MODELS, Case
from support.oscillators import PAPER
from support.same_branch import differences, follow, listed
from support.searching import searched

import vibro_sweep as vs


@pytest.mark.parametrize(
    "study, seeds",
    slow_cases(
        (random_branches.study_of_systems, range(1)),
        (random_branches.study_of_systems, range(6)),
        (random_branches.study_of_oscillators, range(4)),
    ),
)
def test_stable_pieces_agree_with_simulation(study, seeds):
    """Three branches of each; points and ends are compared to 1e-9, and none may disagree."""
    counted, wrong = searched(study, seeds)
    assert wrong == [] and counted["compared"] > 15 * len(seeds)


@pytest.mark.parametrize(
    ("seeds", "models", "least"),
    [
        pytest.param([7, 14], ("two_mass",), 2, id="two"),
        pytest.param(
            [143], MODELS, 2, marks=pytest.mark.slow, id="from a fold, where Newton's method leads to another branch"
        ),
        pytest.param(range(10), MODELS, 7, marks=pytest.mark.slow, id="ten"),
    ],
)
def test_the_same_points_from_all_starts_and_steps(seeds, models, least):
    """Lists of special points, the condition of each, and all changes of stability between points."""
    counted, wrong = searched(partial(branch_search.study, models=models), seeds)
    assert wrong == [] and counted["branches"] >= least


@pytest.fixture(scope="module")
def known():
    """The paper's symmetric branch, with a pitchfork, and the one-sided one, with a Neimark-Sacker point."""
    cases = [
        Case(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (0.3, 6.8)),
        Case(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (0.3, 6.8)),
    ]
    return [(case, follow(case)) for case in cases]


def test_the_monodromy_matrix_is_that_of_many_digits(known):
    """Of the reference against the other one, which has 40 digits and the paper's equation only."""
    for case, branch in known:
        pieces = conditions.Pieces(branch, case)
        assert np.max(pieces.off) < 1e-13
        for special in branch.special:
            if special.type == "graze":  # division by a speed of zero
                continue
            orbit = special.orbit
            machine, hits = machine_of(orbit.system.linear), np.sort(orbit.impacts, order="t")
            closed = ClosedOrbit(machine, impacts_of(machine, hits["side"]), orbit.period)
            exact = np.array([complex(mu) for mu in closed.multipliers(orbit.state, hits["t"])])
            found = np.linalg.eigvals(conditions.at_point(orbit)[0].matrix[0])
            found = found**2 if orbit.symmetric else found
            assert np.abs(np.sort_complex(found) - np.sort_complex(exact)).max() < 1e-11


def test_a_point_that_is_left_out_or_wrong_is_seen(known):
    """Each check by itself: the list, the changes of stability, the condition, the orbit."""
    for case, branch in known:
        (bifurcation,) = (special for special in branch.special if special.type in ("pitchfork", "neimark_sacker"))
        assert not conditions.unexplained(conditions.Pieces(branch, case))
        shorter = replace(branch, special=[special for special in branch.special if special is not bifurcation])
        ((kind, _),) = conditions.unexplained(conditions.Pieces(shorter, case))
        assert kind == "change of stability"
        size = case.bounds[1] - case.bounds[0]
        assert not differences(listed(branch), listed(branch)[::-1], size)
        assert differences(listed(branch), listed(shorter), size)
        assert conditions.distance(bifurcation)[0] < 1e-10
        assert conditions.distance(replace(bifurcation, orbit=case.orbit))[0] > conditions.MEETS
        for special in (branch.begins, branch.ends):
            assert conditions.distance(special)[0] < 1e-10
            assert conditions.distance(replace(special, orbit=case.orbit))[0] > conditions.MEETS
        assert not conditions.not_reduced(case.orbit, "b") and not conditions.passing(conditions.Pieces(branch, case))


def test_steps_are_as_long_as_asked_for(known):
    """Where nothing happens: a name that is bound elsewhere would change nothing."""
    case, branch = known[0]
    counts = [len(follow(case, factor).points[case.name]) for factor in (0.5, 1.0, 2.0)]
    assert counts[1] == len(branch.points[case.name])
    assert counts[0] > 1.4 * counts[1] and counts[1] > 1.2 * counts[2]
