"""Towards the onset of sticking: branches of more and more impacts, and the special point at which they accumulate."""

import itertools
import math

import numpy as np
import pytest
from support.oscillators import PAPER

import vibro_sweep as vs

pytestmark = pytest.mark.slow

ONSET = 0.0646391433583  # of the symmetric orbit (evidence.md; in more digits from 60 impacts written out)


def attractor(b):
    system = PAPER.replace(b=b)
    return vs.periodic_orbit(system, state=vs.simulate(system, (0, 0, 0, 0), 400).section[-1])


def test_the_onset_is_a_special_point_of_the_branches_that_lead_to_it():
    branch = vs.continue_orbit(attractor(0.0666), "b", (0.06, 0.067))
    assert [s.type for s in branch.special] == ["sticking", "graze", "pitchfork", "fold", "graze"]
    onset, graze = branch.special[:2]
    assert branch.begins is graze and graze.impact is None and onset.stop == graze.stop
    assert abs(onset.parameters["b"] - ONSET) < onset.error + 1e-12 and onset.error < 1e-11
    assert onset.orbit.status == "sticking" and float(branch.points.b.min()) == graze.parameters["b"]
    with pytest.raises(ValueError, match="sticking"):
        vs.switch(onset)
    out_of_range = vs.continue_orbit(attractor(0.0666), "b", (0.0655, 0.067))
    assert "sticking" not in [s.type for s in out_of_range.special]


def test_branches_are_followed_to_the_onset_and_end_there():
    """With bounds this wide the first branch is within 1e-4 of the range."""
    found = vs.follow_branches(attractor(0.0666), "b", (0.06, 15.0), follow=("graze",), depth=2)
    assert [(item.generation, len(item.branch.begins.orbit.impacts)) for item in found[:2]] == [(0, 38), (1, 36)]
    assert found[1].special is found[0].branch.ends and [item.parent for item in found].count(0) == 1


@pytest.mark.parametrize(
    ("distance", "impacts"), [(1.02e-7, 126), (4.8e-8, 132), (2.2e-8, 138), (4e-9, 154), (2.3e-10, 180)]
)
def test_orbits_of_many_impacts_down_to_the_onset(distance, impacts):
    """The engine's simulation sums chatter up impact by impact; the product of the multipliers is known exactly."""
    orbit = attractor(ONSET + distance)
    assert orbit.ok and orbit.symmetric and len(orbit.impacts) == impacts and orbit.residual < 1e-7
    simulated = vs.simulate(orbit.system, orbit.state, 1)
    assert np.abs(simulated.section[-1] - orbit.state).max() < 1e-10
    speeds = np.sort(np.abs(simulated.impacts["v1"]))
    assert len(speeds) == impacts and speeds[-impacts // 2 :] == pytest.approx(
        np.sort(np.abs(orbit.impacts["v1"]))[-impacts // 2 :], rel=1e-7
    )
    expected = impacts * math.log(PAPER.R) * 2 + orbit.system.divergence * orbit.system.period
    assert 2 * math.log(abs(np.prod(orbit.half_multipliers))) == pytest.approx(expected, rel=1e-9)
    branch = vs.continue_orbit(orbit, "b", (0.06, 0.07))
    first = branch.special[0]
    assert first.type == "sticking" and abs(first.parameters["b"] - ONSET) < first.error + 1e-12 < 1e-10
    if branch.begins.type == "graze":  # which has an error of its own
        assert branch.begins.parameters["b"] > ONSET - branch.begins.error
    assert float(branch.points.b.min()) > ONSET - 1e-7


def test_branch_after_branch_until_the_onset_is_near():
    found = vs.follow_branches(attractor(0.065), "b", (0.03, 0.067), follow=("graze",), depth=60)
    towards = [item.branch for item in found if item.branch.special[-1].type == "sticking"]
    impacts = [len(branch.begins.orbit.impacts) for branch in towards]
    assert impacts == list(range(impacts[0], impacts[-1] + 2, 2)) and len(towards) > 15
    grazes = [branch.ends.parameters["b"] - ONSET for branch in towards]
    assert all(a > b > 0 for a, b in itertools.pairwise(grazes))
    ratios = np.array(grazes[1:]) / np.array(grazes[:-1])
    assert ratios[-1] == pytest.approx(PAPER.R, abs=2e-3)  # they accumulate like R^K
    assert grazes[-1] < 1e-4 * 0.037 < grazes[-2]
