"""Bifurcation curves where unequal stops unfold what the symmetric oscillator does at one point."""

import numpy as np
import pytest
from support.curves import first, types
from support.oscillators import PAPER

import vibro_sweep as vs


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
