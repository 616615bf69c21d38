"""Ends of bifurcation curves: the same whatever the step, also in corners of wide boxes; none closed that is not."""

import numpy as np
import pytest
from golden import curves, records
from support.oscillators import PAPER
from support.random_branches import attractors, random_oscillator

import vibro_sweep as vs
from vibro_sweep.analysis.continuation.oscillators import BEYOND, Oscillators, Units
from vibro_sweep.model.linear import family_of

NAMES, BOX = ("b", "omega"), ((0.3, 9), (0.5, 0.8))
MASSES, WIDE = ("mu_m", "mu_k"), ((4, 25), (2, 12))


def first(found, kind):
    return next(special for special in found if special.type == kind)


def places(curve):
    return sorted((special.type, *special.parameters.values()) for special in curve.special)


def same(one, other):
    return [kind for kind, *_ in one] == [kind for kind, *_ in other] and all(
        a[1:] == pytest.approx(b[1:], abs=1e-10) for a, b in zip(one, other, strict=True)
    )


@pytest.mark.slow
def test_longer_steps_pass_no_strong_resonance(symmetric_branch, one_sided_branch):
    """Where a step led behind the end, farther than it had begun before it, the end was not looked for."""
    for branch, kind in ((symmetric_branch, "pitchfork"), (one_sided_branch, "neimark_sacker")):
        start = first(branch.special, kind)
        if kind == "pitchfork":
            curve = vs.bifurcation_curve(start, NAMES, BOX)
            start = first(vs.switch(first(curve.special, "flip_neimark_sacker")), "neimark_sacker")
        expected = places(vs.bifurcation_curve(start, NAMES, BOX))
        assert "failed" not in [kind for kind, *_ in expected]
        for factor in (0.5, 2, 4):
            assert same(places(vs.bifurcation_curve(start, NAMES, BOX, step=factor)), expected), factor


def same_whatever_the_step(special, names, bounds):
    """Its points of codimension two."""
    expected = places(vs.bifurcation_curve(special, names, bounds))
    for factor in (0.5, 2):
        assert same(places(vs.bifurcation_curve(special, names, bounds, step=factor)), expected), factor
    return [kind for kind, *_ in expected]


@pytest.mark.slow
def test_an_orbit_that_is_born_next_to_the_side_of_the_box():
    """The step from the graze of a doubled orbit to its birth also leaves the bounds."""
    system = vs.System(
        mu_m=7.246127476057355, mu_k=2.287345399823902, zeta=0.01518081597191766, f2=0, omega=1.5505364507815478,
        R=0.5496994433217061, b=0.603379592936371, offset=-0.2335030344355092, R_left=0.8465644910234273,
    )  # fmt: skip
    state = (-0.04835425, -0.54930262, 0.15744071, 0.03340232)
    orbit = vs.periodic_orbit(system, state=vs.simulate(system, state, 500).section[-1], periods=10)
    graze = first(vs.continue_orbit(orbit, "b", (0.3, 0.9)).special, "graze")
    reach, b, offset = 0.1 * graze.parameters["b"], graze.parameters["b"], system.offset
    bounds = ((b - reach, b + reach), (offset - reach, offset + reach))
    assert same_whatever_the_step(graze, ("b", "offset"), bounds).count("flip_graze") == 2


@pytest.mark.slow
@pytest.mark.parametrize(("masses", "seed", "name"), [(3, 26, "offset"), (8, 1, "omega")])
def test_nothing_is_invented_where_another_impact_vanishes(masses, seed, name):
    """Multipliers have a pole there, and what tells Neimark-Sacker points changes its sign."""
    rng = np.random.default_rng([seed, ord("N") + ord(str(masses))])
    system = random_oscillator(rng, masses)
    ((state, periods),) = attractors(system, rng, most=1, tries=6)
    orbit, b = vs.periodic_orbit(system, state=state, periods=periods), system.b
    branch = vs.continue_orbit(orbit, "b", (0.5 * b, 1.5 * b))
    value = system.offset if name == "offset" else system.linear.omega
    found = []
    for special in branch.special:
        if special.type == "graze":
            at = special.parameters["b"]
            reach = 0.1 * at if name == "offset" else 0.05 * value
            bounds = ((0.9 * at, 1.1 * at), (value - reach, value + reach))
            found += same_whatever_the_step(special, ("b", name), bounds)
    assert "double_graze" in found and "neimark_sacker_graze" not in found


@pytest.mark.slow
def test_curves_in_a_corner_of_a_wide_box(symmetric_branch):
    """Slopes of polynomials that do not reach so far were taken there; the resonances were not found."""
    pitchforks = vs.bifurcation_curve(first(symmetric_branch.special, "pitchfork"), MASSES, WIDE)
    special, ends = first(pitchforks.special, "resonance_1_2"), set()
    starts = [start for start in vs.switch(special) if start.type == "neimark_sacker"]
    assert len(starts) == 2  # of the symmetric orbit, and of the orbits without the symmetry
    for start in starts:
        curve = vs.bifurcation_curve(start, MASSES, WIDE)
        begin = next(end for end in (curve.begins, curve.ends) if end.type == "resonance_1_2")
        assert begin.parameters == pytest.approx(special.parameters, abs=1e-11)
        ends |= {curve.begins.type, curve.ends.type}
    assert ends == {"resonance_1_2", "resonance_1_1", "boundary"}


@pytest.mark.slow
def test_a_curve_that_passes_near_its_first_point_is_not_closed():
    """Both folds of a resonance 1:4 with |A| = 1.0086 are one curve, from there and back."""
    bounds = ((6.2, 6.8), (3.9, 4.2))
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (3, 6))
    curve = vs.bifurcation_curve(first(branch.special, "neimark_sacker"), MASSES, WIDE)
    special = first(curve.special, "resonance_1_4")
    for start in vs.switch(special):
        if start.type == "fold":
            for limits in (bounds, WIDE):
                fold = vs.bifurcation_curve(start, MASSES, limits)
                assert not fold.closed and fold.begins.type == fold.ends.type == "resonance_1_4"


@pytest.mark.slow
def test_a_curve_that_leaves_the_box_within_a_step_ends_there(symmetric_branch):
    """b has a maximum on the pitchfork curve; the points of the wide bounds tell where, by interpolation."""
    pitchfork = first(symmetric_branch.special, "pitchfork")
    points = vs.bifurcation_curve(pitchfork, NAMES, BOX).points
    k = int(points.b.values.argmax())
    b, omega = (points[name].values[k - 3 : k + 4] for name in NAMES)
    fitted = np.polynomial.Polynomial.fit(omega, b, 6)
    (at,) = (x.real for x in fitted.deriv().roots() if abs(x.imag) < 1e-9 and omega[2] < x.real < omega[4])
    top = fitted(at)
    assert top > b.max()
    for below in (1e-3, 0.5 * (top - b.max()), 1e-6, 1e-8):
        curve = vs.bifurcation_curve(pitchfork, NAMES, ((0.3, top - below), BOX[1]))
        assert curve.ends.type == "boundary" and curve.ends.parameters["b"] == top - below
        assert curve.ends.parameters["omega"] < at and curve.points.b.max() == top - below
    curve = vs.bifurcation_curve(pitchfork, NAMES, ((0.3, top + 1e-8), BOX[1]))
    assert curve.points.b.max() < top + 1e-8 and curve.ends.parameters["b"] < 1


def test_polynomials_stop_before_a_frequency_of_zero():
    """There is no forcing period; a curve in wide bounds ended with an error where they were fitted anew."""
    (plane,) = Oscillators(family_of(PAPER), NAMES, 2, Units(1.0, 1.0)).around((3.0, 0.55), (30.0, 1.0))
    assert 0 < BEYOND * plane["reach"][1] < 0.55


@pytest.mark.slow
def test_an_impact_that_vanishes_on_a_virtual_stretch_is_left_out():
    """With steps of twice the length another one vanishes in the same step, behind which the orbit is real."""
    record = records.read("curves")["paper, one side, neimark_sacker 1, resonance_1_4 3, fold 2"]
    special = curves.start_of_curve(record)
    curve = vs.bifurcation_curve(special, tuple(record["names"]), record["box"], step=2)
    assert [one.type for one in curve.special] == ["boundary", "resonant_graze", "resonance_1_4"]
