"""`born_at_grazing`: orbits born where the free motion grazes, and the complementarity problem behind them."""

import itertools

import numpy as np
import pytest
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.periodic.lcp import complementary, representatives


def test_orbits_born_at_the_double_graze_of_the_paper():
    """evidence.md: only R, L and RL are born, all below b*."""
    born = vs.born_at_grazing(PAPER, periods=6)
    assert [(item.period, item.itinerary, item.born) for item in born] == [(1, "R", "below"), (1, "LR", "below")]


@pytest.mark.parametrize("omega", [0.56, 0.53, 0.44])
def test_orbits_born_at_a_graze_have_the_speeds_that_they_say(omega):
    system = PAPER.replace(omega=omega)
    b = vs.grazing(system).b
    born = vs.born_at_grazing(system, periods=4)
    assert len(born) >= 3 and all(item.orbit.ok for item in born)
    for item in born:
        distance = item.orbit.system.b - b
        assert (distance > 0) == (item.born == "above")
        speeds = np.abs(item.orbit.impacts["v1"]) / abs(distance)
        assert speeds == pytest.approx(item.speed_per_distance, rel=0.05)
    assert len({(item.period, item.itinerary, tuple(np.round(item.speed_per_distance, 6))) for item in born}) == len(
        born
    )


@pytest.mark.parametrize("constant", [-2.0, -3.0])
def test_clearance_at_the_graze_may_have_any_sign(constant):
    """One stop: a constant force moves the graze, and nothing else."""
    oscillator = vs.Oscillator.named(
        "one_mass", k=1, zeta=0.1, F=1, omega=0.8, R=0.8, b=1, tau=0, constant=constant, stops="right"
    )
    born = vs.born_at_grazing(oscillator, periods=3)
    b = vs.grazing(oscillator).b_right
    assert (b > 0) == (constant == -2.0)
    assert [(item.period, item.itinerary, item.born) for item in born] == [
        (1, "R", "below"), (2, "R", "below"), (3, "R", "above"), (3, "RR", "below"),
    ]  # fmt: skip
    assert all(item.orbit.ok and (item.orbit.system.b > b) == (item.born == "above") for item in born)


def test_complementarity_problem_against_all_sign_patterns():
    rng = np.random.default_rng(0)
    for _ in range(20):
        count = 6
        row = rng.normal(size=count)
        M = np.array([[row[(i - j) % count] for j in range(count)] for i in range(count)])
        sets = np.array(list(itertools.product([False, True], repeat=count))[1:])
        found = {(tuple(hit), side) for hit, _, side in complementary(M, sets)}
        expected = set()
        for hit in sets:
            d = np.zeros(count)
            for side in (-1, 1):
                d[hit] = np.linalg.solve(M[np.ix_(hit, hit)], -side * np.ones(hit.sum()))
                w = side + M @ d
                if np.all(d[hit] > 0) and np.all(w[~hit] > 0):
                    expected.add((tuple(hit), side))
        assert found == expected


def test_representatives_are_the_necklaces():
    def least(mask, shift):
        return min(tuple(np.roll(mask, k)) for k in range(0, len(mask), shift))

    for count, shift in ((6, 2), (8, 2), (5, 1)):
        everything = [np.array(m) for m in itertools.product([0, 1], repeat=count)]
        prime = {
            least(m, shift) for m in everything if all(np.any(np.roll(m, k) != m) for k in range(shift, count, shift))
        }
        found = [least(m.astype(int), shift) for m in representatives(count, shift, mirrors=False)]
        assert len(found) == len(set(found)) and set(found) == prime
        mirrored = {least(m.astype(int), 1) for m in representatives(count, shift, mirrors=True)}
        assert mirrored == {least(np.array(m), 1) for m in prime}


@pytest.mark.parametrize("omega", [0.53, 0.44])
def test_branches_lead_back_to_the_graze_where_all_their_impacts_vanish_together(omega):
    """Born below, they go on as the free motion above; born above, they exist beside it."""
    system = PAPER.replace(omega=omega)
    b = vs.grazing(system).b
    for item in vs.born_at_grazing(system, periods=2):
        branch = vs.continue_orbit(item.orbit, "b", (0.99 * b, 1.01 * b))
        (end,) = (s for s in branch.special if abs(s.parameters["b"] - b) < 1e-9)
        assert end.type == "graze" and abs(end.parameters["b"] - b) < 1e-14
        assert end.kind == ("persistence" if item.born == "below" else "nonsmooth fold")
        assert (end.impact, end.direction) == (0, 1)
        (free,) = vs.switch(end)
        assert free.itinerary == "" and free.system.b > b
