"""Points of codimension two in many digits (tests/reference/conditions.py)."""

import pytest
from support.branches import branch_of
from support.codimension_two import error_of

import vibro_sweep as vs

pytestmark = pytest.mark.slow

NAMES, BOX = ("b", "omega"), ((0.3, 9), (0.5, 0.8))


def first(found, kind):
    return next(special for special in found if special.type == kind)


def check(special):
    assert special.error < 1e-12 and error_of(special) < max(special.error, 1e-13), special.type


@pytest.fixture(scope="module")
def pitchforks(symmetric_branch):
    return vs.bifurcation_curve(first(symmetric_branch.special, "pitchfork"), NAMES, BOX).special


def test_degenerate_flip_and_the_cusp_of_the_folds_that_begin_there(pitchforks):
    special = first(pitchforks, "degenerate_flip")
    check(special)
    folds = vs.bifurcation_curve(vs.switch(special)[1], NAMES, BOX)
    check(first(folds.special, "cusp"))


def test_graze_on_the_neimark_sacker_curve_that_begins_at_a_flip(pitchforks):
    starts = vs.switch(first(pitchforks, "flip_neimark_sacker"))
    longer = next(start for start in starts if not start.orbit.symmetric)
    check(first(vs.bifurcation_curve(longer, NAMES, BOX).special, "neimark_sacker_graze"))


def test_degenerate_neimark_sacker(one_sided_branch):
    curve = vs.bifurcation_curve(first(one_sided_branch.special, "neimark_sacker"), NAMES, BOX)
    check(first(curve.special, "degenerate_neimark_sacker"))


def test_flip_and_resonance_on_a_graze_curve(one_sided_branch):
    curve = vs.bifurcation_curve(one_sided_branch.begins, NAMES, BOX)
    check(first(curve.special, "flip_graze"))
    for special in curve.special:
        if special.type == "resonant_graze":
            check(special)


def test_fold_and_double_graze_of_a_window():
    bounds, found = ((6, 7.5), (0.61, 0.65)), {}
    for special in branch_of(6.6, 13).special:
        if special.type in ("fold", "graze"):
            curve = vs.bifurcation_curve(special, NAMES, bounds)
            found |= {one.type: one for one in curve.special if one.type in ("fold_graze", "double_graze")}
    assert set(found) == {"fold_graze", "double_graze"}
    for special in found.values():
        check(special)


def test_pitchfork_and_graze_at_once_from_both_curves():
    system = vs.System(mu_m=1.5, mu_k=2.65, zeta=0.08, f2=0, omega=1.58, R=0.45, b=1.0)
    star = vs.grazing(system).b
    orbit = vs.periodic_orbit(system.replace(b=0.5 * star), itinerary="LR")
    branch = vs.continue_orbit(orbit, "b", (0.1 * star, 1.05 * star))
    found = []
    for special in branch.special:
        if special.type in ("pitchfork", "graze"):
            curve = vs.bifurcation_curve(special, NAMES, ((0.05 * star, 3 * star), (0.95, 2.3)))
            found += [one for one in curve.special if one.type == "pitchfork_graze"]
    assert {one.curve for one in found} == {"pitchfork", "graze"}
    for special in found:
        assert special.parameters == pytest.approx(found[0].parameters, abs=1e-12)
        check(special)
