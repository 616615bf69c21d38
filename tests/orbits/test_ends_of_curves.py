"""Ends of bifurcation curves: the same whatever the step, at the sides of the box, and on stretches without motion."""

import numpy as np
import pytest
from golden import curves, records
from support.random_branches import attractors, random_oscillator

import vibro_sweep as vs

NAMES, BOX = ("b", "omega"), ((0.3, 9), (0.5, 0.8))


def first(found, kind):
    return next(special for special in found if special.type == kind)


def places(curve):
    return sorted((special.type, *special.parameters.values()) for special in curve.special)


def same(one, other):
    return [kind for kind, *_ in one] == [kind for kind, *_ in other] and all(
        a[1:] == pytest.approx(b[1:], abs=1e-10) for a, b in zip(one, other, strict=True)
    )


def same_whatever_the_step(special, names, bounds):
    """Its points of codimension two."""
    expected = places(vs.bifurcation_curve(special, names, bounds))
    for factor in (0.5, 2):
        assert same(places(vs.bifurcation_curve(special, names, bounds, step=factor)), expected), factor
    return [kind for kind, *_ in expected]


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


@pytest.mark.slow
def test_an_impact_that_vanishes_on_a_virtual_stretch_is_left_out():
    """With steps of twice the length another one vanishes in the same step, behind which the orbit is real."""
    record = records.read("curves")["paper, one side, neimark_sacker 1, resonance_1_4 3, fold 2"]
    special = curves.start_of_curve(record)
    curve = vs.bifurcation_curve(special, tuple(record["names"]), record["box"], step=2)
    assert [one.type for one in curve.special] == ["boundary", "resonant_graze", "resonance_1_4"]
