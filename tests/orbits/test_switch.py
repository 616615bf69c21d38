"""`switch`: the branches that are born at a pitchfork, at a flip, and at a graze."""

import numpy as np
import pytest
from support.branches import types
from support.oscillators import ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches import births, branch_start
from vibro_sweep.analysis.branches.births import is_steady
from vibro_sweep.analysis.continuation import first_point
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of


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


@pytest.mark.slow
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


@pytest.mark.slow
def test_an_orbit_that_loses_an_impact_may_be_symmetric():
    """LLLLRRR without the impact that vanishes is LLLRRR, to rounding: its half map has a pitchfork, its map none."""
    system = PAPER.replace(b=0.5)
    found = vs.follow_branches(vs.periodic_orbit(system, itinerary="LLRR"), "b", (0.05, 0.72), depth=4)
    ends = [end for item in found for end in (item.branch.begins, item.branch.ends)]
    ends = [end for end in ends if end.type == "graze" and end.impact is not None]
    graze = next(end for end in ends if abs(end.parameters["b"] - 0.1773928791) < 1e-9 and not end.orbit.symmetric)
    assert graze.orbit.itinerary == "LLLLRRR"
    (orbit,) = vs.switch(graze)
    assert orbit.itinerary == "LLLRRR" and orbit.symmetric
    assert np.abs(orbit.sample([0.0]) + orbit.sample([system.period / 2])).max() < 1e-13
    alike = [types(item.branch) for item in found if len(item.branch.begins.orbit.impacts) == 6]
    grazes = [{round(value, 9) for kind, value in one if kind == "graze"} for one in alike]
    assert len(grazes) > 1 and len(grazes) == len(set(map(frozenset, grazes)))  # no branch twice


FLAT = vs.System(
    mu_m=8.379769014161136, mu_k=3.8163220400771807, zeta=0.028200222924778515, f2=0.9337335869439435,
    omega=1.2384170377684125, R=0.639, b=0.08630475621966693, tau=0.25528644319765714, offset=-0.0027889332142134425,
)  # fmt: skip


@pytest.fixture(scope="module")
def flat_flip():
    """A flip from which the doubled orbits leave with hardly any change of f2."""
    state = vs.simulate(FLAT, np.zeros(4), 600).section[-1]
    orbit = vs.periodic_orbit(FLAT, state=state, periods=19)
    branch = vs.continue_orbit(orbit, "f2", (0.8870469075967463, 0.9804202662911407))
    return [special for special in branch.special if special.type == "flip"][-1]


def test_an_orbit_that_is_born_can_be_followed(flat_flip):
    """At the usual amplitude it has a multiplier of 0.9999994, and Newton's method comes no nearer than 1e-10."""
    (orbit,) = vs.switch(flat_flip)
    assert orbit.ok and orbit.period == 38 and is_steady(orbit._solution, "f2")
    value = flat_flip.parameters["f2"]
    branch = vs.continue_orbit(orbit, "f2", (value - 1e-3, value + 1e-3))
    assert branch.ok and ("flip", pytest.approx(value, abs=1e-12)) in types(branch)


def test_a_branch_that_cannot_be_started_says_so(flat_flip, monkeypatch):
    """It is started a little farther off; where nothing is found there either, its orbit is all that is left of it."""
    value = flat_flip.parameters["f2"]
    bounds = (value - 1e-3, value + 1e-3)
    with monkeypatch.context() as patch:
        patch.setattr(births, "is_steady", lambda *_: True)  # at the usual amplitude
        near = births.born(flat_flip.orbit._solution, "f2", 1)
    orbit = orbit_of(FLAT.replace(f2=near.family.numbers["f2"]), near)
    assert orbit.ok and vs.continue_orbit(orbit, "f2", bounds).ok
    monkeypatch.setattr(branch_start, "FARTHER", ())
    monkeypatch.setattr(first_point, "STILL", -1.0)  # as where Newton's method does not stand still
    branch = vs.continue_orbit(orbit, "f2", bounds)
    assert branch.status == "failed" and not branch.ok
    assert branch.points.sizes["point"] == 1 and float(branch.points.f2[0]) == orbit.system.f2
    assert types(branch) == [("failed", orbit.system.f2)] and branch.begins is branch.ends
    np.testing.assert_array_equal([float(branch.points[name][0]) for name in ("x1", "v1", "x2", "v2")], orbit.state)


def test_a_free_ball_may_rest_anywhere():
    """Where it strikes no more it may rest or drift between the walls: no orbit is left, and all ways say the same."""
    numbers = dict(mass_ratio=0.30708370157577386, zeta=0.12333976067052502, F=0.23384453537076677)
    system = vs.Oscillator.named(
        "ball_in_cavity", **numbers, omega=0.6568743481690207, R=0.705, b=0.42003497841912407,
    )  # fmt: skip
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="LR"), "b", (0.336, 0.504))
    assert branch.begins.type == "graze" and vs.switch(branch.begins) == []
    beside = system.replace(b=branch.begins.parameters["b"] * 1.01)
    assert vs.periodic_orbit(beside, itinerary="").status == "resonance"
    host = vs.simulate(beside.replace(b=50.0), np.zeros(4), 500).section[-1]  # the ball rests in the middle
    for shift in (0.0, 1e-3):  # both are motions without impacts
        start = host + np.array([0, 0, shift, 0])
        run = vs.simulate(beside, start, 5)
        assert len(run.impacts) == 0 and np.abs(run.section[-1] - start).max() < 1e-9
        assert vs.periodic_orbit(beside, state=start).status == "resonance"


@pytest.mark.parametrize("omega", [0.76805, 0.7681])
def test_a_long_orbit_that_is_born_comes_back(omega):
    """Rounding moves the frequency at which it has its amplitude by 1e-10, and with it the force after 24 periods."""
    numbers = dict(mass_ratio=0.07542000228012215, zeta=0.2717872599192225, F=0.5012098506435191, R=0.45652296622105776)
    system = vs.Oscillator.named("ball_in_cavity", **numbers, omega=omega, b=0.8783750788351449, tau=0.3)
    state = [-0.44385227161259655, 0.5989384049199556, -1.2991489272132684, -0.6559561129938539]
    branch = vs.continue_orbit(vs.periodic_orbit(system, state=state, periods=12), "omega", (0.7679, 0.7681))
    flip = next(special for special in branch.special if special.type == "flip")
    (orbit,) = vs.switch(flip)
    assert orbit.period == 24 and len(orbit.impacts) == 68
    assert np.abs(vs.simulate(orbit.system, orbit.state, 24).section[-1] - orbit.state).max() < 2e-10
