"""`follow_branches`: every branch once, from the paper's symmetric orbit and from the free motion."""

import numpy as np
import pytest
from support.branches import types
from support.oscillators import ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches import branch_search
from vibro_sweep.analysis.branches.branch_arrays import arrays_of, special_point
from vibro_sweep.analysis.branches.branch_switching import mirrored
from vibro_sweep.analysis.branches.recognising import passes
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of

BOUNDS = (0.3, 6.8)


@pytest.fixture(scope="module")
def tree():
    return vs.follow_branches(vs.periodic_orbit(PAPER, itinerary="LR"), "b", BOUNDS, depth=2)


def word(item):
    return item.branch.begins.orbit.itinerary


def test_generations_from_the_symmetric_orbit(tree):
    """The pitchfork leads to the pair of LR orbits, b* to the one-sided and the free one, the left graze to LLRR."""
    assert [item.generation for item in tree] == sorted(item.generation for item in tree)
    assert tree[0].parent is None and tree[0].special is None
    first = [item for item in tree if item.generation == 1]
    assert [item.special.type for item in first] == ["graze", "pitchfork", "graze"]
    assert [item.branch._start.whole().K for item in first] == [4, 2, 0]
    assert all(tree[item.parent].generation == item.generation - 1 for item in tree[1:])
    second = [item.branch for item in tree if item.generation == 2]
    one_sided = [branch for branch in second if branch._start.K == 1 and branch._start.sigma == 1]
    assert len(one_sided) == 1  # its mirror image is the same, and it is met from b* and from the pair's graze
    assert ("neimark_sacker", pytest.approx(4.347417989446589, abs=1e-12)) in types(one_sided[0])


def test_no_branch_comes_twice(tree):
    for i, item in enumerate(tree):
        for other in tree[i + 1 :]:
            a, b = item.branch, other.branch
            same = types(a) == [(kind, pytest.approx(value, abs=1e-9)) for kind, value in types(b)]
            assert not (same and a._start.K == b._start.K), types(a)


def test_orbits_are_recognised_on_their_branch(tree):
    def on(item, orbit):
        arrays = arrays_of(item.branch, item.branch.special[0].orbit.system.b)
        return passes(arrays, "b", orbit.system, orbit._solution)

    points = tree[2].branch.points
    i = points.sizes["point"] // 2
    point = points.isel(point=i)
    b = float(point.b) * (1 + 1e-5)
    guess = list(zip(point.impact_t.values, point.impact_side.values, point.impact_v.values, strict=True))
    orbit = vs.periodic_orbit(PAPER.replace(b=b), guess=guess)
    assert orbit.ok and on(tree[2], orbit) and not on(tree[0], orbit)
    image = orbit_of(orbit.system, mirrored(orbit._solution))
    assert on(tree[2], image)
    other = vs.periodic_orbit(PAPER.replace(b=b), itinerary="LR")
    assert other.ok and other.symmetric and not on(tree[2], other) and on(tree[0], other)


def test_period_doubling_cascade():
    orbit = vs.periodic_orbit(ONE_MASS.replace(F=0.37), itinerary="R", periods=2)
    tree = vs.follow_branches(orbit, "F", (0.3, 0.6), follow=["flip"], depth=2)
    periods = [item.branch.begins.orbit.period for item in tree]
    assert periods[0] == 2 and {item.branch._start.half_periods // 2 for item in tree} >= {2, 4, 8}
    assert all(item.special.type == "flip" for item in tree[1:])


def test_what_is_refused():
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    with pytest.raises(ValueError, match="fold"):
        vs.follow_branches(orbit, "b", BOUNDS, follow=["fold"])
    with pytest.raises(ValueError, match="depth"):
        vs.follow_branches(orbit, "b", BOUNDS, depth=-1)
    assert len(vs.follow_branches(orbit, "b", BOUNDS, depth=0)) == 1


def test_one_branch_that_fails_loses_no_other(monkeypatch):
    """A seed whose orbit has no real neighbour within the bounds; here the first that is born at the pitchfork, whose
    mirror image is then followed."""
    orbit, count = vs.periodic_orbit(PAPER, itinerary="LR"), 0
    whole = vs.follow_branches(orbit, "b", BOUNDS)

    def second_fails(*args):
        nonlocal count
        count += 1
        if count == 2:
            raise ValueError("orbit: it is a special point")
        return vs.continue_orbit(*args)

    monkeypatch.setattr(branch_search, "continue_orbit", second_fails)
    found = vs.follow_branches(orbit, "b", BOUNDS)
    assert [item.branch.status for item in found] == ["ok", "ok", "failed", "ok", "ok"]
    assert [types(item.branch) for item in (*found[:2], found[4])] == [types(whole[i].branch) for i in (0, 1, 3)]
    assert types(found[3].branch) == [(kind, pytest.approx(value, abs=1e-12)) for kind, value in types(whole[2].branch)]
    assert types(found[2].branch) == [("failed", found[2].branch.begins.orbit.system.b)]
    arrays = arrays_of(found[2].branch, found[2].branch.begins.orbit.system.b)
    assert (
        arrays["branch_status"] == 1
        and len(arrays["value"]) == 1
        and arrays["branch_ends"] == arrays["branch_begins"] == 0
    )
    again = special_point(arrays, 0, "b", PAPER)
    np.testing.assert_allclose(again.orbit.state, found[2].branch.begins.orbit.state, rtol=1e-12)


def test_progress_is_told():
    told = []
    vs.follow_branches(vs.periodic_orbit(PAPER, itinerary="LR"), "b", BOUNDS, progress=lambda *at: told.append(at))
    branches, points, values = zip(*told, strict=True)
    assert max(branches) >= 3 and min(points) > 0 and np.all(np.isfinite(values))
