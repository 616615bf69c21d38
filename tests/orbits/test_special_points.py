"""Special points of branches in 40 digits, and onsets of sticking."""

import pytest
from reference.chatter import part_lost
from support.branches import branch_of
from support.in_digits import errors_of
from support.oscillators import PAPER

import vibro_sweep as vs


@pytest.mark.parametrize("R", [0.2, 0.8, 0.95])
def test_chatter_at_its_onset_shrinks_by_its_own_factor(R):
    """A mass that bounces under the acceleration s - s_inf: the factor of evidence.md makes its flights
    similar, and is that of `reference.chatter`, to which curves of onsets are held."""
    phi = 1 - part_lost(R)
    # velocity after an impact at s = -1 (s_inf = 0) such that the flight lasts 1 - phi; then the next one is similar
    d = 1 - phi
    v = d / 2 - d**2 / 6  # v d + integral of the acceleration s twice = 0
    arrival = v - d + d**2 / 2
    assert -R * arrival == pytest.approx(phi**2 * v, rel=1e-12)


@pytest.mark.slow
def test_sticking_onset_of_the_symmetric_orbit():
    """evidence.md: 0.064639143358."""
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
def test_an_onset_of_sticking_does_not_depend_on_where_zero_is():
    """Stops and constant forces that are moved alike move all orbits, and the onset with them, in `offset`."""
    k = [2.981022369341434, 2.908640819453773, 1.750534718776756, 2.9704604606931895]
    guess = [
        (0.0950831, -1, -0.3545543), (0.2573115, -1, -0.1678099), (0.4073339, -1, -0.0624831),
        (4.9260188, -1, -1.1587489), (5.6046551, -1, -1.2729894), (5.9350102, -1, -0.701252),
    ]  # fmt: skip
    found = []
    for moved in (1.0, 0.0, -0.0026):
        system = vs.Oscillator.named(
            "chain", stop_at=1, stops="left", m=[0.616827116235112, 1.2785609169674024, 0.5605734340523443], k=k,
            c=[0.06578693338135376, 0.021279988096570432, 0.12029900039974009, 0.05645182145258775],
            force=[0.6901473785015929, 1.362659767137964, 1.7310028096790901], omega=1.0370637849252582,
            constant=[-0.13663899855 + (k[0] + k[1]) * moved, -0.29222875887 - k[1] * moved, -0.00195785365],
            R=0.5625570576856003, b=0.7563173173357928, offset=-0.09236368466789292 + moved, tau=5.0572430589817685,
        )  # fmt: skip
        orbit = vs.periodic_orbit(system, guess=guess, periods=1)
        branch = vs.continue_orbit(orbit, "offset", (moved - 0.32, moved + 0.13))
        (onset,) = (special for special in branch.special if special.type == "sticking")
        found.append((onset.parameters["offset"] - moved, onset.error))
    assert found[1][0] == pytest.approx(0.0026184, abs=1e-7)
    for value, error in found:
        assert abs(value - found[0][0]) < error + found[0][1] < 1e-9


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
            if special.type != "boundary":
                (off,) = errors_of(special)
                assert abs(off) < max(special.error, 1e-15) and abs(off) < 1e-13
                checked += 1
    assert checked >= 2
