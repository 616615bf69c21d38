"""`switch`: what it says of grazes, where nothing begins, and long orbits; other points are rows of switches.yaml."""

import numpy as np
import pytest
from support.branches import types
from support.oscillators import PAPER

import vibro_sweep as vs


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


def test_a_free_ball_may_rest_anywhere():
    """Where it strikes no more it may rest or drift between the walls: no orbit is left, and all ways say the same."""
    numbers = dict(mass_ratio=0.30708370157577386, zeta=0.12333976067052502, F=0.23384453537076677)
    system = vs.Oscillator.named(
        "ball_in_cavity", **numbers, omega=0.6568743481690207, R=0.705, b=0.42003497841912407,
    )  # fmt: skip
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="LR"), "b", (0.336, 0.504))
    assert branch.begins.type == "graze"
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
