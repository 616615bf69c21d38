"""Bifurcation curves in two parameters: closed forms, published values, where curves of longer orbits begin."""

import numpy as np
import pytest
from support.curves import exact_resonance, first, types
from support.in_digits import of_orbit
from support.oscillators import PAPER

import vibro_sweep as vs

BOXES = {("b", "omega"): ((0.3, 9), (0.5, 0.8)), ("b", "R"): ((0.3, 9), (0.3, 0.99))}


@pytest.mark.slow
def test_free_motion_touches_the_stops_as_theorem_1_says(symmetric_branch):
    curve = vs.bifurcation_curve(symmetric_branch.ends, ("b", "omega"), BOXES["b", "omega"])
    omega = curve.points.omega.values
    expected = [vs.grazing(PAPER.replace(omega=float(value))).b for value in omega]
    np.testing.assert_allclose(curve.points.b.values, expected, rtol=1e-13)
    found = [special for special in curve.special if special.type == "resonant_graze"]
    assert [special.parameters["omega"] for special in found] == pytest.approx(
        [0.5401411189888746, 0.6534837093382131], abs=1e-12
    )


def test_impacts_that_vanish_together_are_one_graze():
    """An orbit is born where the free motion grazes: its three impacts in four periods have no speed all along."""
    numbers = dict(mu_m=1.7716559184958023, mu_k=1.811457549080368, zeta=0.014733856601569005, f2=0.31665143637016824)
    system = vs.System(**numbers, omega=1.2710535099504932, R=0.38741610692212525, b=0.2914798891569992, stops="left")
    state = [0.16554426549913004, 0.11735437838761553, 0.5648765098892732, 0.12123907138947979]
    branch = vs.continue_orbit(vs.periodic_orbit(system, state=state, periods=4), "b", (0.2, 0.4))
    graze = first(branch, "graze")
    assert graze.orbit.itinerary == "LLL" and not graze.orbit.impacts["v1"].round(12).any()
    bounds = ((0.28, 0.32), (0.0103, 0.0206))
    curve = vs.bifurcation_curve(graze, ("b", "zeta"), bounds)
    assert types(curve) == ["boundary", "boundary"] and curve.points.sizes["impact"] == 1
    free = vs.continue_orbit(vs.periodic_orbit(system.replace(b=0.35), itinerary=""), "b", (0.2, 0.4))
    other = vs.bifurcation_curve(first(free, "graze"), ("b", "zeta"), bounds)
    for one, same in zip(curve.special, other.special, strict=True):
        assert one.parameters == pytest.approx(same.parameters, abs=1e-13)


def test_refusals(symmetric_branch):
    pitchfork, limit = symmetric_branch.special[1], first(
        vs.continue_orbit(symmetric_branch.special[1].orbit, "b", (3, 4)), "boundary"
    )  # fmt: skip
    bounds = BOXES["b", "omega"]
    with pytest.raises(ValueError, match=r"special\.type: 'boundary' is not allowed; it must be one of fold, flip"):
        vs.bifurcation_curve(limit, ("b", "omega"), bounds)
    with pytest.raises(ValueError, match=r"parameters: \('b', 'b'\) is not allowed; it must be two of mu_m"):
        vs.bifurcation_curve(pitchfork, ("b", "b"), bounds)
    with pytest.raises(ValueError, match=r"bounds\.b: \[5.0, 9.0\] is not allowed; it must be \(lo, hi\), lo < hi"):
        vs.bifurcation_curve(pitchfork, ("b", "omega"), ((5, 9), (0.5, 0.8)))
    for wrong in (None, (1, 9), ((1, 9),), ((1, 2, 3), (4, 5))):
        with pytest.raises(
            ValueError, match=r"bounds: .* is not allowed; it must be \(\(lo, hi\), \(lo, hi\)\) of b and"
        ):
            vs.bifurcation_curve(pitchfork, ("b", "omega"), wrong)
    with pytest.raises(ValueError, match="parameters: None is not allowed"):
        vs.bifurcation_curve(pitchfork, None, bounds)
    with pytest.raises(TypeError, match="special"):
        vs.bifurcation_curve(pitchfork.orbit, ("b", "omega"), bounds)


@pytest.mark.slow
def test_resonances_of_the_free_motion_in_40_digits(symmetric_branch, one_sided_branch):
    """evidence.md: gamma = 0 at zero delay; for one impact in T or T/2, followed from impact to graze."""
    published = {
        1: (0.3283, 0.4333, 0.5489, 0.5881, 0.6499, 0.8263, 1.0803, 1.8636),
        -1: (0.3615, 0.4564, 0.6535, 0.8060, 1.0785),
    }
    for branch, sigma in ((one_sided_branch, 1), (symmetric_branch, -1)):
        curve = vs.bifurcation_curve(branch.ends, ("b", "omega"), ((0.001, 60), (0.3, 2.0)))
        resonances = [one for one in curve.special if one.type == "resonant_graze"]
        assert len(resonances) == len(curve.special) - 2
        omegas = {1: [], -1: []}
        for one in resonances:
            omega = one.parameters["omega"]
            errors = {mu: abs(exact_resonance(sigma, sigma * mu, omega) - omega) for mu in (1, -1)}
            mu = min(errors, key=errors.get)
            assert errors[mu] < 1e-12
            assert one.parameters["b"] == pytest.approx(vs.grazing(PAPER.replace(omega=omega)).b, rel=1e-12)
            omegas[mu].append(omega)
        assert sorted(omegas[1]) == pytest.approx(published[sigma], abs=6e-5)
        if sigma == -1:  # pitchfork of RL
            assert min(abs(omega - 0.931808938984019) for omega in omegas[-1]) < 1e-13


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["degenerate_flip", "flip_neimark_sacker", "resonance_1_4"])
def test_curves_of_longer_orbits_end_where_switch_says_that_they_begin(kind, symmetric_branch, one_sided_branch):
    branch, of_type = (
        (one_sided_branch, "neimark_sacker") if kind == "resonance_1_4" else (symmetric_branch, "pitchfork")
    )
    names = ("b", "omega")
    curve = vs.bifurcation_curve(first(branch, of_type), names, BOXES[names])
    found = 0
    for special in curve.special:
        if special.type != kind:
            continue
        size = len(special.orbit.impacts) * (4 if kind == "resonance_1_4" else 1)
        half = len(of_orbit(special.orbit).events)
        starts = [start for start in vs.switch(special) if len(of_orbit(start.orbit).events) > half]
        assert all(start.orbit.ok and len(start.orbit.impacts) == size for start in starts)
        assert len(starts) == (2 if kind == "resonance_1_4" else 1)
        ends = []
        for start in starts:
            near = [(0.9 * value, 1.1 * value) for value in special.parameters.values()]
            other = vs.bifurcation_curve(start, names, near)
            (end,) = (one for one in (other.begins, other.ends) if one.type == kind)
            assert end.parameters == pytest.approx(special.parameters, abs=1e-11)
            ends.append((other.begins if end is other.ends else other.ends).parameters)
            found += 1
        assert len(ends) == 1 or ends[0] != pytest.approx(ends[1], rel=1e-3)  # two curves, not one twice
    assert found == {"degenerate_flip": 2, "flip_neimark_sacker": 1, "resonance_1_4": 2}[kind]


@pytest.mark.slow
def test_the_fold_of_asymmetric_orbits_begins_where_the_pitchfork_turns_from_super_to_sub(
    symmetric_branch, one_sided_branch
):
    """Its curve, found over a resonant graze of other orbits, ends at the zero of the normal form's coefficient."""
    bounds = BOXES["b", "omega"]
    pitchfork = vs.bifurcation_curve(first(symmetric_branch, "pitchfork"), ("b", "omega"), bounds)
    graze = vs.bifurcation_curve(one_sided_branch.begins, ("b", "omega"), bounds)
    starts = [start for one in graze.special if one.type == "resonant_graze" for start in vs.switch(one)]
    fold = vs.bifurcation_curve(next(start for start in starts if start.type == "fold"), ("b", "omega"), bounds)
    end = next(end for end in (fold.begins, fold.ends) if end.type != "boundary")
    assert end.type == "degenerate_flip" and end.orbit.symmetric
    nearest = min(
        (one for one in pitchfork.special if one.type == "degenerate_flip"),
        key=lambda one: abs(one.parameters["b"] - end.parameters["b"]),
    )
    assert end.parameters == pytest.approx(nearest.parameters, abs=1e-12)
    assert "cusp" in types(fold)


@pytest.mark.slow
def test_picture(symmetric_branch):
    pitchfork = first(symmetric_branch, "pitchfork")
    curves = [vs.bifurcation_curve(pitchfork, names, BOXES[names]) for names in BOXES]
    fig = curves[0].plot()
    (panel,) = fig.axes
    assert {text.get_text() for text in panel.texts} >= {"RG", "GPD", "LPPD"}
    first_two, names = np.split([text.get_text() for text in fig.legends[0].get_texts()], [2])
    assert list(first_two) == ["pitchfork", "virtual"]
    assert {name.split()[0] for name in names} >= {"RG", "GPD", "LPPD"}
    with pytest.raises(ValueError, match=r"others: .* is not allowed; it must be curves in"):
        curves[0].plot(curves[1])
