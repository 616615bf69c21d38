"""Branches and curves where unequal stops unfold what the symmetric oscillator does at one point."""

import numpy as np
import pytest
from support import slow_cases
from support.curves import first, types
from support.drawn_branches import Case
from support.oscillators import PAPER
from support.same_branch import follow

import vibro_sweep as vs

OF_PAPER = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0.0, "omega": 0.63, "tau": 0.0}
# stops, the pitchfork of the orbit that hits both, and special points of the branches into which an offset unfolds it,
# below its place
UNFOLDED = {
    "rigid": ({"R": 0.8}, 3.8928194355634025, ["boundary", "fold", "graze"], ["graze"]),
    "compliant": (
        {"R": None, "k_stop": 100.0}, 3.7417481866132416, ["boundary", "fold", "fold", "graze"], ["graze", "fold"],
    ),
}  # fmt: skip


@pytest.mark.slow
def test_double_graze_unfolds_where_the_stops_are_unequal():
    """In (b, offset) four graze curves cross at b*: of orbits that hit one stop, where they touch it, b = b* +- offset,
    and of the orbit that hits both, where it loses one impact."""
    bounds, star = ((3, 9), (-1, 1)), vs.grazing(PAPER).b
    orbit = vs.periodic_orbit(PAPER.replace(offset=0.05, b=4.0), itinerary="R")
    curve = vs.bifurcation_curve(vs.continue_orbit(orbit, "b", (0.3, 6.9)).ends, ("b", "offset"), bounds)
    (double,) = (special for special in curve.special if special.type == "double_graze")
    assert double.parameters == {"b": pytest.approx(star, abs=1e-12), "offset": pytest.approx(0, abs=1e-12)}
    starts = vs.switch(double)
    assert sorted((start.type, start.orbit.itinerary, start.stop) for start in starts) == [
        ("graze", "L", -1), ("graze", "LR", -1), ("graze", "LR", 1), ("graze", "R", 1),
    ]  # fmt: skip
    both = []
    for start in starts:
        other = vs.bifurcation_curve(start, ("b", "offset"), bounds)
        assert types(other).count("double_graze") == 1
        if start.orbit.itinerary != "LR":
            np.testing.assert_allclose(other.points.b, star - start.stop * other.points.offset, rtol=1e-13)
        else:
            both.append([special.parameters for special in other.special if special.type == "neimark_sacker_graze"])
    (one,), (mirror,) = both
    assert one["b"] == pytest.approx(mirror["b"], abs=1e-12)
    assert one["offset"] == pytest.approx(-mirror["offset"], abs=1e-12)


@pytest.mark.slow
def test_pitchfork_is_a_cusp_of_folds_where_the_symmetry_is_broken(symmetric_branch):
    pitchfork = first(symmetric_branch, "pitchfork")
    curve = vs.bifurcation_curve(pitchfork, ("b", "offset"), ((3, 5), (-0.2, 0.2)))
    points = curve.points
    assert curve.type == "fold" and types(curve) == ["boundary", "cusp", "boundary"]
    cusp = curve.special[1].parameters
    assert cusp == {"b": pytest.approx(pitchfork.parameters["b"], abs=1e-12), "offset": pytest.approx(0, abs=1e-12)}
    b, offset = points.b.values, points.offset.values
    near = (np.abs(offset) > 1e-6) & (np.abs(offset) < 1e-2)  # |b - b_0| like offset^(2/3)
    power = np.polyfit(np.log(np.abs(offset[near])), np.log(np.abs(b[near] - pitchfork.parameters["b"])), 1)[0]
    assert near.sum() > 6 and power == pytest.approx(2 / 3, abs=0.03)


@pytest.mark.parametrize("stops", ["rigid", *slow_cases("compliant")])
@pytest.mark.parametrize("factor", [0.25, *slow_cases(1.0, 2.0)])
def test_branches_stay_apart_where_a_pitchfork_is_unfolded(stops, factor):
    """However small the offset: one branch turns at a fold, at |b - b_0| like offset^(2/3), and comes to the other one
    as close as offset^(1/3)."""
    stops, pitchfork, turning, smooth = UNFOLDED[stops]
    offsets, folds = 10.0 ** np.arange(-7, -2), []
    for offset in offsets:
        system = vs.Oscillator.named("two_mass", b=3.0, offset=offset, **OF_PAPER, **stops)
        one, other = (
            follow(Case(vs.periodic_orbit(system.replace(b=b), itinerary="LR"), "b", (1.0, 7.0)), factor).special
            for b in (3.0, 5.0)
        )
        assert [special.type for special in one] == turning
        assert [special.type for special in other if special.parameters["b"] < pitchfork] == smooth
        folds.append(one[1].parameters["b"])
    power = np.polyfit(np.log(offsets), np.log(pitchfork - np.array(folds)), 1)[0]
    assert power == pytest.approx(2 / 3, abs=0.01)
