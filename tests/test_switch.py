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


def test_impact_that_vanishes_where_the_orbit_starts_a_forcing_period_later():
    """`impacts` begin within [0, T): those of an orbit of period 2 T may be the solution's, shifted by T.

    The constant force moves all by 0.5; other tests of one mass have one, too, and so the same kernels.
    """
    system = vs.Oscillator.named(
        "one_mass", k=1, zeta=0.02, F=0.4, constant=0.5, omega=0.81, R=0.9, b=0.3, tau=0.3, stops="right"
    )  # fmt: skip
    orbit = vs.periodic_orbit(system, state=(0.247, 0.414), periods=2)
    end = vs.continue_orbit(orbit, "b", (0.299, 0.4)).ends
    assert orbit.itinerary == "RRRRRRR" and end.type == "graze"
    assert abs(end.orbit.impacts["v1"][end.impact]) < 1e-12
    (without,) = vs.switch(end)
    assert without.itinerary == "RRRRRR" and without.period == 2
    after = vs.simulate(without.system, without.state, 2).section[-1]
    assert after == pytest.approx(without.state, abs=1e-9)


def test_branch_ends_at_its_birth_where_the_contact_is_a_free_mode():
    """A first step as long as the amplitude of the born orbit ended just at the birth, and passed it."""
    system = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.82, zeta=0.05, F=1, omega=0.9, R=0.84, b=1, tau=0)
    guess = [(hit["t"], hit["side"], hit["v1"]) for hit in vs.simulate(system, (0, 0, 0, 0), 1500).impacts[-4:]]
    guess = [(t - guess[0][0] // system.period * system.period, side, v) for t, side, v in guess]
    parent = vs.continue_orbit(vs.periodic_orbit(system, guess=guess), "omega", (0.85, 0.95))
    (pitchfork,) = (special for special in parent.special if special.type == "pitchfork")
    value = pitchfork.parameters["omega"]
    for orbit in vs.switch(pitchfork):
        branch = vs.continue_orbit(orbit, "omega", (value - 0.01, value + 0.01))
        births = [end for end in (branch.begins, branch.ends) if end.type == "pitchfork"]
        assert [end.parameters["omega"] for end in births] == [pytest.approx(value, abs=1e-12)]
        assert "fold" not in [special.type for special in branch.special]


def test_stop_of_a_graze_is_that_of_the_impact_that_vanishes():
    """Of a symmetric orbit, of the one in the first half of `impacts`; the other one touches the other stop."""
    system = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.43, zeta=0.05, F=1, omega=0.72, R=0.876, b=1, tau=0)
    state = vs.simulate(system, (0, 0, 0, 0), 1500).section[-1]
    branch = vs.continue_orbit(vs.periodic_orbit(system, state=state), "omega", (0.5, 1))
    for end in (branch.begins, branch.ends):
        assert end.type == "graze" and end.orbit.itinerary == "LLLRRR" and end.impact < end.orbit.half == 3
        assert end.stop == end.orbit.impacts["side"][end.impact] == -1
        assert abs(end.orbit.impacts["v1"][end.impact]) < 1e-12


def test_restart_from_the_end_of_what_is_allowed():
    """f2 = 0 is the least: rounding must not lead below it."""
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "f2", (0, 0.5))
    again = vs.continue_orbit(branch.begins.orbit, "f2", (0, 0.5))
    assert [special.parameters for special in again.special] == [{"f2": 0.0}, {"f2": 0.5}]
