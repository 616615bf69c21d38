"""Special points of branches in 40 digits, and onsets of sticking."""

import pytest
from mpmath import mp, mpf
from support.branches import branch_of, exact
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.sticking import shrinking


@pytest.mark.parametrize("R", [0.2, 0.8, 0.95])
def test_chatter_at_its_onset_shrinks_by_its_own_factor(R):
    """A mass that bounces under the acceleration s - s_inf: the factor of orbits.md makes its flights similar."""
    phi = shrinking(R)
    # velocity after an impact at s = -1 (s_inf = 0) such that the flight lasts 1 - phi; then the next one is similar
    d = 1 - phi
    v = d / 2 - d**2 / 6  # v d + integral of the acceleration s twice = 0
    arrival = v - d + d**2 / 2
    assert -R * arrival == pytest.approx(phi**2 * v, rel=1e-12)


@pytest.mark.slow
def test_sticking_onset_of_the_symmetric_orbit():
    """orbits.md: 0.064639143358."""
    system = PAPER.replace(b=0.08)
    orbit = vs.periodic_orbit(system, state=vs.simulate(system, (0, 0, 0, 0), 500).section[-1])
    branch = vs.continue_orbit(orbit, "b", (0.05, 0.2))
    onset = vs.sticking_onset(branch.begins)
    assert onset.type == "sticking" and onset.orbit.status == "sticking"
    assert onset.parameters["b"] == pytest.approx(0.064639143358, abs=1e-12)
    assert (
        abs(onset.parameters["b"] - 0.064639143358) < onset.error + 5e-13 and onset.error < 2e-12
    )  # some of it is rounding
    assert vs.sticking_onset(branch.ends) is None


@pytest.mark.slow
@pytest.mark.parametrize("name", ["b", "omega", "zeta", "mu_m"])
def test_special_points_in_40_digits(name, symmetric_branch, one_sided_branch):
    bounds = {"b": (0.3, 6.8), "omega": (0.4, 1), "zeta": (0.001, 0.2), "mu_m": (1, 20)}[name]
    branches = [vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=3.0), itinerary="LR"), name, bounds)]
    if name == "b":
        branches += [symmetric_branch, one_sided_branch, branch_of(6.6, 13)]
        branches += [vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=1.0), itinerary="LLRR"), "b", (0.1, 6))]
    checked = 0
    for branch in branches:
        for special in branch.special:
            if special.type != "limit":
                with mp.workdps(40):
                    difference = abs(mpf(special.parameters[name]) - exact(special, name))
                assert difference < max(special.error, 1e-15) and difference < 1e-13
                checked += 1
    assert checked >= 2
