"""`switch`: the branches that are born at a pitchfork, at a flip, and at a graze."""

import pytest
from support.branches import types
from support.oscillators import ONE_MASS, PAPER

import vibro_sweep as vs


def test_asymmetric_branch_is_born_at_the_pitchfork(symmetric_branch):
    pitchfork = symmetric_branch.special[1]
    pair = vs.switch(pitchfork)
    assert len(pair) == 2 and not any(orbit.symmetric for orbit in pair)
    assert pair[0].state == pytest.approx(-vs.simulate(pair[1].system, pair[1].state, 1).sample(
        [PAPER.period / 2])[0], abs=1e-6)  # fmt: skip
    branch = vs.continue_orbit(pair[0], "b", (0.3, 6.8))
    assert types(branch)[-1] == ("pitchfork", pytest.approx(3.892819435563412, abs=1e-12))
    assert branch.ends.orbit.symmetric and branch.ends.criticality == "sub"
    # its other end is where the one-sided orbit gains an impact
    assert types(branch)[0] == ("graze", pytest.approx(3.221903876767776, abs=1e-12))
    assert branch.begins.impact is not None
    (other,) = vs.switch(branch.begins)
    assert other.itinerary in "RL"


def test_doubled_branch_is_born_at_the_flip():
    orbit = vs.periodic_orbit(ONE_MASS.replace(F=0.37), itinerary="R", periods=2)
    flip = next(special for special in vs.continue_orbit(orbit, "F", (0.3, 0.6)).special if special.type == "flip")
    (doubled,) = vs.switch(flip)
    assert doubled.period == 4 and doubled.itinerary == "RR" and doubled.stable
    branch = vs.continue_orbit(doubled, "F", (0.3, 0.6))
    assert [special.type for special in branch.special] == ["graze", "flip", "flip"]
    assert branch.ends.parameters["F"] == pytest.approx(flip.parameters["F"], abs=1e-14)
    assert branch.ends.criticality == flip.criticality == "super" and branch.ends.orbit.period == 2


def test_graze_hands_over_to_the_orbit_with_one_impact_more(symmetric_branch):
    (after,) = vs.switch(symmetric_branch.begins)
    assert after.itinerary == "LLRR" and after.symmetric
    branch = vs.continue_orbit(after, "b", (0.3, 6.8))
    ends = [special for special in branch.special if special.type == "graze"]
    touching = min(ends, key=lambda special: abs(special.parameters["b"] - 0.652974448339183))
    assert touching.parameters["b"] == pytest.approx(0.652974448339183, abs=1e-12)
    assert touching.impact is not None and touching.kind == "nonsmooth fold"
