"""Bifurcation curves of a mass at a wall and of a bouncing ball: closed forms and published values."""

import math

import numpy as np
import pytest
from support.curves import first, types

import vibro_sweep as vs


def ball(n=1, F=0.9, R=0.8):
    system = vs.Oscillator.named(
        "one_mass", k=0, zeta=0, constant=-1, base=True, F=F, omega=1, R=R, b=0, stops="left", tau=0.0
    )
    return vs.continue_orbit(vs.periodic_orbit(system, itinerary="L", periods=n), "F", (0.2, 4))


@pytest.mark.slow
def test_bouncing_ball():
    """Fold and flip in (Gamma, R): physics of P. J. Holmes, J. Sound Vib. 84 (1982) 173; a free mode, N = 1."""
    branch = ball()
    for kind in ("fold", "flip"):
        curve = vs.bifurcation_curve(first(branch, kind), ("F", "R"), ((0.05, 4), (0.2, 0.95)))
        R = curve.points.R.values
        least = math.pi * (1 - R) / (1 + R)
        expected = least if kind == "fold" else np.hypot(least, 2 * (1 + R**2) / (1 + R) ** 2)
        np.testing.assert_allclose(curve.points.F.values, expected, rtol=1e-13)
        assert curve.type == kind and not curve.points.virtual.any() and np.ptp(R) == pytest.approx(0.75)
        assert curve.begins.parameters["F"] < curve.ends.parameters["F"] and types(curve) == ["boundary", "boundary"]


@pytest.mark.slow
def test_a_box_is_left_by_the_side_that_is_met_first():
    """Near a corner one step passes two sides of the bounds, and the fold above ends on the nearer of them."""
    fold, corner = first(ball(), "fold"), math.pi * 0.7 / 1.3  # F of the fold at R = 0.3
    for highest in (corner * (1 + 1e-4), corner * (1 - 1e-4)):
        curve = vs.bifurcation_curve(fold, ("F", "R"), ((0.05, highest), (0.3, 0.95)))
        end = max(curve.special, key=lambda one: one.parameters["F"]).parameters
        F, R = (corner, 0.3) if highest > corner else (highest, (math.pi - highest) / (math.pi + highest))
        assert types(curve) == ["boundary", "boundary"] and end == pytest.approx({"F": F, "R": R}, rel=1e-13)
        assert curve.points.F.values.max() == end["F"] and curve.points.R.values.min() == end["R"]


def wall(omega, F):
    return vs.Oscillator.named("one_mass", zeta=0.02, F=F, omega=omega, R=0.9, b=1, stops="right")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "begin", "ranges", "omega", "F"),
    [
        ("flip", (0.9, 0.25), ((0.01, 0.5), (0.81, 1.0)), 0.81, 0.347533397),
        ("fold", (0.79, 0.37), ((0.01, 0.5), (0.78, 0.799)), 0.799, 0.362836202),
    ],
)
def test_one_impact_in_two_periods(kind, begin, ranges, omega, F):
    """arXiv 2510.16218, worked out anew in 30 digits: reached from far away."""
    branch = vs.continue_orbit(vs.periodic_orbit(wall(*begin), itinerary="R", periods=2), "F", (0.01, 0.5))
    curve = vs.bifurcation_curve(first(branch, kind), ("F", "omega"), ranges)
    (end,) = [one for one in curve.special if one.parameters["omega"] == omega]
    assert end.type == "boundary" and end.parameters["F"] == pytest.approx(F, abs=6e-10)


@pytest.mark.slow
def test_fold_and_flip_begin_at_the_resonant_graze():
    """arXiv 2510.16218: from (0.36, 0.8) the fold goes down to omega = 0.788, the flip up to 0.9998; both are tangent
    to the graze curve there, with a distance that grows like the square."""
    bounds = ((0.01, 0.5), (0.78, 1.05))
    branch = vs.continue_orbit(vs.periodic_orbit(wall(0.81, 0.4), itinerary="R", periods=2), "F", (0.01, 0.6))
    flip = vs.bifurcation_curve(first(branch, "flip"), ("F", "omega"), bounds)
    graze = vs.bifurcation_curve(branch.begins, ("F", "omega"), bounds)
    branch = vs.continue_orbit(vs.periodic_orbit(wall(0.799, 0.364), itinerary="R", periods=2), "F", (0.01, 0.6))
    fold = vs.bifurcation_curve(first(branch, "fold"), ("F", "omega"), bounds)
    places = {}
    for curve in (flip, fold, graze):
        for special in curve.special:
            if special.type == "resonant_graze":
                places.setdefault(curve.type, []).append(special.parameters["omega"])
    (begin,) = places["fold"]
    rate = math.sqrt(1 - 0.02**2)  # of the free decay: gamma = 0 at zero delay where it swings a whole number of times
    assert begin == pytest.approx(4 / 5 * rate, abs=1e-12)
    assert sorted(places["flip"]) == pytest.approx([begin, rate], abs=1e-12)
    assert sorted(places["graze"]) == pytest.approx(sorted(places["flip"]), abs=1e-12)
    assert [special.parameters["omega"] for special in fold.special if special.type == "fold_graze"] == pytest.approx(
        [0.7881222563629103], abs=1e-12
    )
    special = next(one for one in fold.special if one.type == "resonant_graze")
    near_box = ((special.parameters["F"] - 0.004, special.parameters["F"] + 0.004), (begin - 0.002, begin + 0.002))
    starts = [start for start in vs.switch(special) if start.type in ("fold", "flip")]
    assert len(starts) == 2
    for curve in (vs.bifurcation_curve(start, ("F", "omega"), near_box) for start in starts):
        real = curve.points.isel(point=~curve.points.virtual.values)
        omega, F = real.omega.values, real.F.values
        near = np.abs(omega - begin) > 1e-5
        response = np.hypot(1 - omega**2, 0.04 * omega)  # the free motion touches the stop at this F
        distance = np.abs(F - response)[near]
        power = np.polyfit(np.log(np.abs(omega - begin)[near]), np.log(distance), 1)[0]
        assert near.sum() >= 4 and power == pytest.approx(2, abs=0.05)


@pytest.mark.slow
def test_without_losses_no_multiplier_becomes_double():
    """mu and 1/mu are both -1 all along a curve of flips."""
    system = vs.Oscillator.named("one_mass", k=1, zeta=0, F=0.5, omega=0.8, b=0.3, stops="left", tau=0.0, R=1)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="L"), "b", (-1, 7))
    flip = next(one for one in branch.special if one.type == "flip")
    curve = vs.bifurcation_curve(flip, ("b", "omega"), ((-1, 7), (0.4, 1)))
    assert not {one.type for one in curve.special} & {"resonance_1_2", "degenerate_flip"} and len(curve.special) < 10
