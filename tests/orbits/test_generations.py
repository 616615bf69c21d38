"""`follow_branches`: every branch once, from the paper's symmetric orbit and from the free motion."""

import numpy as np
import pytest
from support.branch_rows import middle
from support.branches import types
from support.oscillators import ONE_MASS, PAPER

import vibro_sweep as vs

BOUNDS = (0.3, 6.8)


@pytest.fixture(scope="module")
def tree():
    return vs.follow_branches(vs.periodic_orbit(PAPER, itinerary="LR"), "b", BOUNDS, depth=2)


def test_generations_from_the_symmetric_orbit(tree):
    """The pitchfork leads to the pair of LR orbits, b* to the one-sided and the free one, the left graze to LLRR."""
    assert [item.generation for item in tree] == sorted(item.generation for item in tree)
    assert tree[0].parent is None and tree[0].special is None
    first = [item for item in tree if item.generation == 1]
    assert [item.special.type for item in first] == ["graze", "pitchfork", "graze"]
    assert [len(middle(item.branch).impacts) for item in first] == [4, 2, 0]
    assert all(tree[item.parent].generation == item.generation - 1 for item in tree[1:])
    second = [item.branch for item in tree if item.generation == 2]
    one_sided = [branch for branch in second if len(middle(branch).impacts) == 1]
    assert len(one_sided) == 1  # its mirror image is the same, and it is met from b* and from the pair's graze
    assert ("neimark_sacker", pytest.approx(4.347417989446589, abs=1e-12)) in types(one_sided[0])


def test_no_branch_comes_twice(tree):
    for i, item in enumerate(tree):
        for other in tree[i + 1 :]:
            a, b = item.branch, other.branch
            same = types(a) == [(kind, pytest.approx(value, abs=1e-9)) for kind, value in types(b)]
            assert not (same and len(middle(a).impacts) == len(middle(b).impacts)), types(a)


def test_period_doubling_cascade():
    orbit = vs.periodic_orbit(ONE_MASS.replace(F=0.37), itinerary="R", periods=2)
    tree = vs.follow_branches(orbit, "F", (0.3, 0.6), follow=["flip"], depth=2)
    periods = [item.branch.begins.orbit.period for item in tree]
    assert periods[0] == 2 and {middle(item.branch).period for item in tree} >= {2, 4, 8}
    assert all(item.special.type == "flip" for item in tree[1:])


def test_what_is_refused():
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    with pytest.raises(ValueError, match="fold"):
        vs.follow_branches(orbit, "b", BOUNDS, follow=["fold"])
    with pytest.raises(ValueError, match="depth"):
        vs.follow_branches(orbit, "b", BOUNDS, depth=-1)
    assert len(vs.follow_branches(orbit, "b", BOUNDS, depth=0)) == 1


def test_progress_is_told():
    told = []
    vs.follow_branches(vs.periodic_orbit(PAPER, itinerary="LR"), "b", BOUNDS, progress=lambda *at: told.append(at))
    branches, points, values = zip(*told, strict=True)
    assert max(branches) >= 3 and min(points) > 0 and np.all(np.isfinite(values))
