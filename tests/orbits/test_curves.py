"""Bifurcation curves in two parameters: closed forms, 30 digits, published values, differences."""

import math

import numpy as np
import pytest
from support.branches import branch_of
from support.curves import chosen, error_at, exact_codimension_two, exact_resonance, first, solution_at, types
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.criticality import criticality
from vibro_sweep.analysis.continuation.starting_orbit import KINDS, Start
from vibro_sweep.analysis.curves import born
from vibro_sweep.analysis.curves.curve_points import others_outside
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.engine.continuation.conditions import TORUS

BOXES = {("b", "omega"): ((0.3, 9), (0.5, 0.8)), ("b", "R"): ((0.3, 9), (0.3, 0.99))}


def test_a_critical_pair_that_rounding_parts_counts_as_no_other():
    """At the end of a Neimark-Sacker curve: both are near 1 or -1, one of them a little outside."""
    pair = np.array([1.65, 1 + 4e-8, 1 - 4e-8, 0.08], complex)
    assert others_outside(np.array([pair, -pair]), TORUS, np.array([0.0, np.pi])).tolist() == [1, 1]


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
@pytest.mark.parametrize("names", BOXES)
@pytest.mark.parametrize("kind", ["pitchfork", "neimark_sacker"])
def test_curves_in_30_digits(names, kind, symmetric_branch, one_sided_branch):
    branch = symmetric_branch if kind == "pitchfork" else one_sided_branch
    curve = vs.bifurcation_curve(first(branch, kind), names, BOXES[names])
    for k in chosen(curve, 20):
        assert error_at(curve, k) < 1e-12, k


@pytest.mark.slow
def test_margin_where_cells_are_passed_over(symmetric_branch):
    """What is farther from the stops than at the point before is not looked at; that of a single orbit is."""
    fold = first(branch_of(6.6, 13), "fold")
    for special, bounds in (
        (first(symmetric_branch, "pitchfork"), BOXES["b", "omega"]),
        (fold, ((6, 7.5), (0.61, 0.65))),
    ):
        curve = vs.bifurcation_curve(special, ("b", "omega"), bounds)
        margins = curve.points.stop_distance.values  # inf: there is no turning point
        for k in range(0, len(margins), 5):
            assert margins[k] == pytest.approx(solution_at(curve, k).stop_distance, rel=1e-8, abs=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize(("b", "periods"), [(6.6, 13), (6.7125, 15)])
def test_windows_in_30_digits(b, periods):
    branch = branch_of(b, periods)
    for special in branch.special:
        if special.type in ("fold", "graze"):
            curve = vs.bifurcation_curve(special, ("b", "omega"), ((6, 7.5), (0.61, 0.65)))
            for k in chosen(curve, 4):
                assert error_at(curve, k) < 1e-12, (special.type, k)


@pytest.mark.slow
def test_criticality_changes_at_the_degenerate_points(symmetric_branch, one_sided_branch):
    """By the coefficient at neighbouring orbits."""
    for branch, kind, most in ((symmetric_branch, "pitchfork", 2), (one_sided_branch, "neimark_sacker", 3)):
        special = first(branch, kind)
        curve = vs.bifurcation_curve(special, ("b", "omega"), BOXES["b", "omega"])
        degenerate = [one for one in curve.special if one.type.startswith("degenerate")]
        assert len(degenerate) == most
        for one in degenerate:
            b, omega = one.parameters["b"], one.parameters["omega"]
            points = curve.points
            k = int(np.argmin(np.hypot(points.b.values - b, points.omega.values - omega)))
            found = [criticality_at(curve, j) for j in (k - 1, k + 1)]
            assert sorted(found) == ["sub", "super"], one.parameters


def criticality_at(curve, k):
    return criticality(solution_at(curve, k), KINDS[curve.type], "b")


REGULAR = ("fold_flip", "resonance_1_1", "resonance_1_2", "resonance_1_3", "resonance_1_4", "fold_neimark_sacker")


@pytest.mark.slow
def test_codimension_two_in_40_digits(symmetric_branch, one_sided_branch):
    found = set()
    for special in (first(symmetric_branch, "pitchfork"), first(one_sided_branch, "neimark_sacker")):
        curve = vs.bifurcation_curve(special, ("b", "omega"), BOXES["b", "omega"])
        for one in curve.special:
            if one.type in (*REGULAR, "flip_neimark_sacker"):
                assert max(exact_codimension_two(one).values()) < max(one.error, 1e-13) < 1e-12, one.type
                found.add(one.type)
    assert found == {*REGULAR, "flip_neimark_sacker"}


@pytest.mark.slow
def test_resonances_of_the_free_motion_in_40_digits(symmetric_branch, one_sided_branch):
    """reference_values.md: gamma = 0 at zero delay; for one impact in T or T/2, followed from impact to graze."""
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
def test_every_way_into_the_net_of_curves_gives_the_same_points(symmetric_branch):
    """From each point of codimension two on a curve, its curves are followed anew."""
    bounds = BOXES["b", "omega"]
    curve = vs.bifurcation_curve(first(symmetric_branch, "pitchfork"), ("b", "omega"), bounds)
    expected = places(curve)
    folds, followed = [], 0
    for special in curve.special[1:-1]:
        for start in vs.switch(special):
            if start.type in ("pitchfork", "fold") and start.orbit.symmetric:
                other = vs.bifurcation_curve(start, ("b", "omega"), bounds)
                if start.type == "pitchfork":
                    assert places(other) == [(kind, pytest.approx(where, abs=1e-12)) for kind, where in expected]
                    followed += 1
                else:
                    folds.append(places(other))
    assert followed == len(curve.special) - 2 and len(folds) == 2
    assert folds[0] == [(kind, pytest.approx(where, abs=1e-12)) for kind, where in folds[1]]


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
        half = special.orbit._solution.K
        starts = [start for start in vs.switch(special) if start.orbit._solution.K > half]
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
def test_normal_form_of_the_resonance_1_4_says_where_the_folds_are(one_sided_branch):
    """At the amplitude 0.005, which is that of the third order and no more."""
    curve = vs.bifurcation_curve(first(one_sided_branch, "neimark_sacker"), ("b", "omega"), BOXES["b", "omega"])
    special = first(curve, "resonance_1_4")
    values = np.array(list(special.parameters.values()))
    parent = Start("neimark_sacker", special.orbit._solution, theta=math.pi / 2)
    for sign in (1, -1):
        entry = born.entry(special, "fold", parent, 4, 0.005, sign)
        found = np.array(list(born.entered(special, entry).parameters.values()))
        assert np.abs(found - values - entry.moved).max() < 0.01 * np.abs(entry.moved).max()


def places(curve):
    found = [(special.type, list(special.parameters.values())) for special in curve.special]
    return found if found[0][1] < found[-1][1] else found[::-1]


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
@pytest.mark.parametrize("names", [("b", "omega"), ("omega", "mu_m"), ("b", "R")])
def test_states_of_points_are_those_of_the_orbits(names, symmetric_branch, one_sided_branch):
    specials = [first(symmetric_branch, "pitchfork"), one_sided_branch.ends, first(one_sided_branch, "neimark_sacker")]
    for special in specials:
        here = special.parameters | {"omega": 0.63, "mu_m": 10.0, "R": 0.8}
        bounds = tuple((here[name] - 0.05 * abs(here[name]), here[name] + 0.05 * abs(here[name])) for name in names)
        curve = vs.bifurcation_curve(special, names, bounds)
        states = np.stack([curve.points[name].values for name in ("x1", "v1", "x2", "v2")], axis=-1)
        assert len(states) > 8
        for k in range(0, len(states), 3):
            orbit = orbit_of(None, solution_at(curve, k))
            assert states[k] == pytest.approx(orbit.state, abs=1e-11 * np.abs(orbit.state).max()), (special.type, k)


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
