"""Curves of orbits with two or four times the period, where `switch` says that they begin."""

import numpy as np
import pytest
from support import conditions
from support.curves import chosen
from support.in_digits import of_orbit, of_point
from support.oscillators import PAPER
from support.random_curves import simulate_beside
from support.searching import new_report

import vibro_sweep as vs

NAMES, BOX = ("b", "omega"), ((0.3, 9), (0.5, 0.8))


def points(special, kind, names=NAMES, bounds=BOX):
    curve = vs.bifurcation_curve(special, names, bounds)
    return [one for one in curve.special if one.type == kind]


def first(found, kind):
    return next(special for special in found if special.type == kind)


def longer(special, kind="neimark_sacker"):
    K = size(special.orbit)
    return [start for start in vs.switch(special) if start.type == kind and size(start.orbit) > K]


def size(orbit) -> int:
    """Impacts, of half the period where it is symmetric."""
    return len(of_orbit(orbit).events)


def nearest_pair(mu, axis=-1):
    """Of each row the multiplier above the real axis that is nearest to the unit circle."""
    where = np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf), axis=axis)
    return np.take_along_axis(mu, np.expand_dims(where, axis), axis).squeeze(axis)


def pair_of(orbit):
    """The complex multiplier, by saltation matrices."""
    found, *_ = conditions.at_point(orbit)
    assert found.off[0] < 1e-9
    return nearest_pair(np.linalg.eigvals(found.matrix[0]))


def check(special, start, names=NAMES, bounds=BOX):
    """The curve ends at the point, and a pair passes the unit circle where simulated orbits cross it."""
    curve = vs.bifurcation_curve(start, names, bounds, virtual=False)
    (end,) = (one for one in (curve.begins, curve.ends) if one.type == special.type)
    assert end.parameters == pytest.approx(special.parameters, abs=1e-11)
    multipliers = curve.points.multiplier_re.values + 1j * curve.points.multiplier_im.values
    theta = np.angle(nearest_pair(multipliers))
    away = np.flatnonzero(~curve.points.virtual.values & (theta > 0.3 * theta.max()))  # at its end mu is double
    for k in away[(len(away) * np.array([0.2, 0.5, 0.8])).astype(int)]:
        motion, sizes = of_point(curve, k, start.orbit), []
        system, state = motion.system, motion.sample([0.0])[0]
        for part in (-1e-6, 0.0, 1e-6):
            other = system.replace(**{names[0]: getattr(system, names[0]) * (1 + part)})
            mu = pair_of(vs.periodic_orbit(other, state=state, periods=start.orbit.period))
            if not part:
                assert abs(mu) == pytest.approx(1, abs=1e-9)
                assert np.cos(np.angle(mu)) == pytest.approx(np.cos(theta[k]), abs=1e-9)
            else:
                sizes.append(abs(mu) - 1)
        assert sizes[0] * sizes[1] < 0


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["resonance_1_2", "fold_flip"])
def test_doubled_orbits(kind, symmetric_branch, one_sided_branch):
    """In one of two cases; in the other two multipliers leave 1 along the real axis."""
    branch, of_type, expected = {
        "resonance_1_2": (one_sided_branch, "neimark_sacker", [1]),
        "fold_flip": (symmetric_branch, "pitchfork", [0, 1]),
    }[kind]
    found = points(first(branch.special, of_type), kind)
    starts = [longer(special) for special in found]
    assert sorted(map(len, starts)) == expected
    for special, here in zip(found, starts, strict=True):
        for start in here:
            check(special, start)


@pytest.mark.slow
def test_no_curve_begins_at_a_resonance_1_2_of_the_other_case(symmetric_branch):
    (special,) = points(first(symmetric_branch.special, "pitchfork"), "resonance_1_2")
    assert longer(special) == []


@pytest.mark.slow
def test_orbits_of_four_times_the_period():
    """Where |A| > 1 and the determinant of the normal form is positive: both folds and one Neimark-Sacker curve."""
    names, bounds = ("mu_m", "mu_k"), ((5.5, 10.5), (3.5, 5.2))
    orbit = vs.periodic_orbit(PAPER.replace(b=4.0, R=0.6), itinerary="R")
    branch = vs.continue_orbit(orbit, "b", (3, 6))
    (special,) = points(first(branch.special, "neimark_sacker"), "resonance_1_4", names, bounds)
    assert len(longer(special, "fold")) == 2
    (start,) = longer(special)
    check(special, start, names, ((5.9715, 5.98), (3.754, 3.77)))


@pytest.fixture(scope="module")
def asymmetric_graze():
    """The branch of the symmetric orbit of a system whose pitchfork curve meets its graze curve, and a bounds."""
    system = vs.System(mu_m=1.5, mu_k=2.65, zeta=0.08, f2=0, omega=1.58, R=0.45, b=1.0)
    star = vs.grazing(system).b
    orbit = vs.periodic_orbit(system.replace(b=0.5 * star), itinerary="LR")
    branch = vs.continue_orbit(orbit, "b", (0.1 * star, 1.05 * star))
    return branch, ((0.05 * star, 3 * star), (0.95, 2.3))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["flip_graze", "pitchfork_graze"])
def test_grazes_of_the_orbits_that_are_born(kind, one_sided_branch, asymmetric_graze):
    """Of one half of them: they begin where the flip (pitchfork) meets the graze, and simulated orbits are there."""
    branch, bounds = (one_sided_branch, BOX) if kind == "flip_graze" else asymmetric_graze
    special = first(vs.bifurcation_curve(first(branch.special, "graze"), NAMES, bounds).special, kind)
    smooth = next(start for start in vs.switch(special) if start.type == kind.removesuffix("_graze"))
    (again,) = points(
        smooth, kind, bounds=bounds
    )  # from the other curve the motion has no impact there, it touches the stop
    assert again.touches and not special.touches
    for one in (special, again):
        (start,) = (start for start in vs.switch(one) if start.type == "graze" and size(start.orbit) == 3)
        curve = vs.bifurcation_curve(start, NAMES, bounds, virtual=False)
        (end,) = (end for end in (curve.begins, curve.ends) if end.type == kind)
        assert end.parameters == pytest.approx(special.parameters, abs=1e-11)
        report = new_report()
        for k in chosen(curve, 9)[1:-1]:
            t, P = curve.points.impact_t[k].values, of_point(curve, k, start.orbit).P
            assert np.abs((t + P / 2 - t[:, None] + P / 4) % P - P / 4).min() > 1e-4  # no orbit taken twice
            simulate_beside(report, curve, k, kind, start.orbit)
        assert report.counted["points"] >= 6 and report.wrong == []
        assert len({(one.type, *one.parameters.values()) for one in curve.special}) == len(curve.special)
