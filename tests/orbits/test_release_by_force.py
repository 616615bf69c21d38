"""Periodic orbits, branches, curves and windows with `release: force`: corners, stops that have not relaxed."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.closed_orbit import DIGITS, ClosedOrbit
from reference.machine import machine_of
from support import sample
from support.in_digits import errors_of

import vibro_sweep as vs


def one_mass(**numbers):
    given = dict(k=1, zeta=0.05, F=0.5, omega=0.8, k_stop=29, b=1, stops="right", tau=0.0, release="force")
    return vs.Oscillator.named("one_mass", **(given | numbers))


def branch_of(name, bounds, **numbers):
    return vs.continue_orbit(vs.periodic_orbit(one_mass(**numbers), itinerary="R"), name, bounds)


@pytest.mark.slow
@pytest.mark.parametrize("preload", [0.0, 0.03])
def test_special_points_in_45_digits(preload):
    branch = branch_of("omega", (0.3, 3), c_stop=0.5, preload=preload)
    types = [one.type for one in branch.special]
    assert types[0] == types[-1] == "graze" and {"flip", "fold"} <= set(types)
    for special in branch.special:
        assert np.abs(errors_of(special, pulled=preload > 0)).max() < 1e-12


def touching_in_digits(special):
    """Multipliers with the least contact at a graze of the free motion: of (1 - c e_v e_g) M, since v' = -c gap."""
    q = special.orbit.system.linear
    with mp.workdps(DIGITS):
        M = ClosedOrbit(machine_of(q), [], 1).closure([0, 0], [])
        jump = mp.eye(2)
        jump[1, 0] = -mpf(float(q.contact.c_high)) / mpf(float(q.M[0, 0]))
        return np.sort_complex(np.array(mp.eig(jump * M, left=False, right=False), complex))


def grazes_at(branch, omega):
    """The graze nearest to this frequency."""
    found = [one for one in branch.special if one.type == "graze"]
    return min(found, key=lambda one: abs(one.parameters["omega"] - omega))


@pytest.mark.parametrize("c_stop, kinds", sample(1, [
    (0.5, ("persistence", "persistence")), (2.0, ("persistence", "nonsmooth fold")),
]))  # fmt: skip
def test_grazes_are_corners(c_stop, kinds):
    """The multipliers jump; where det(M - 1) changes its sign the orbits with the contact lie beside those without."""
    branch = branch_of("omega", (0.3, 3), c_stop=c_stop)
    values = branch.points.omega.values
    for graze, kind, next_to in zip((branch.begins, branch.ends), kinds, (values[1], values[-2]), strict=True):
        exact, omega = touching_in_digits(graze), graze.parameters["omega"]
        assert np.abs(np.sort_complex(graze.multipliers) - exact).max() < 1e-12
        (without,) = vs.switch(graze)
        assert np.abs(np.sort_complex(without.multipliers) - exact).max() > 0.1
        folds = np.prod(1 - exact).real * np.prod(1 - without.multipliers).real < 0
        same_side = (next_to - omega) * (without.system.numbers["omega"] - omega) > 0
        assert (graze.kind == "nonsmooth fold") == (kind == "nonsmooth fold") == folds == same_side
        free = vs.continue_orbit(without, "omega", (0.3, 3))
        assert grazes_at(free, omega).kind == kind  # seen from the other side


def test_a_branch_in_the_preload_passes_from_one_end_of_contacts_to_the_other():
    """From c |delta'| = preload on the mass leaves at the stop, and both releases are one."""
    branch = branch_of("preload", (0, 2), c_stop=0.5, preload=0.0)
    assert branch.ok and [one.type for one in branch.special] == ["boundary", "boundary"]
    (contact,) = branch.ends.orbit.contacts
    assert 0.5 * contact["v_release"] < 2
    guess = [(contact["t_touch"], 1, contact["v_touch"])]
    other = vs.periodic_orbit(one_mass(c_stop=0.5, preload=2, release="displacement"), guess=guess)
    assert branch.ends.orbit.state == pytest.approx(other.state, abs=1e-12)
    assert branch.ends.multipliers == pytest.approx(other.multipliers, abs=1e-12)


def test_without_a_damper_both_releases_are_one():
    branch = branch_of("c_stop", (0, 1), c_stop=0.5)
    assert branch.ok and branch.begins.parameters["c_stop"] == 0
    other = vs.periodic_orbit(one_mass(c_stop=0, release="displacement"), itinerary="R")
    assert branch.begins.multipliers == pytest.approx(other.multipliers, abs=1e-12)
    assert vs.periodic_orbit(one_mass(), itinerary="R").state == pytest.approx(other.state, abs=1e-12)


@pytest.mark.slow
def test_stops_that_have_not_relaxed_are_refused():
    """Where e^{-k D/c} (1 + k/(c omega)) is not below rounding at the next touch, a time D after the release."""
    orbit = vs.periodic_orbit(one_mass(c_stop=10), itinerary="R")
    assert orbit.status == "unrelaxed"
    branch = branch_of("c_stop", (1, 12), c_stop=2.0)
    end = branch.ends
    assert end.type == "unrelaxed"
    c, (contact,) = end.parameters["c_stop"], end.orbit.contacts
    away = end.orbit.system.period - (contact["t_release"] - contact["t_touch"])
    assert np.exp(-29 / c * away) * (1 + 29 / c / 0.8) == pytest.approx(2**-53, rel=1e-6)
    # a preload brings the stop back to its place in a finite time, exactly
    preloaded = vs.periodic_orbit(one_mass(c_stop=5.8, preload=0.3), itinerary="R")
    assert vs.periodic_orbit(one_mass(c_stop=5.8), itinerary="R").status == "unrelaxed" and preloaded.ok
    again = vs.simulate(preloaded.system, preloaded.state, 20)
    assert preloaded.stable and again.section[-1] == pytest.approx(preloaded.state, abs=1e-10)


def test_a_curve_of_grazes_says_where_a_corner_begins_with_a_flip():
    graze = branch_of("omega", (0.3, 3), c_stop=2.0).begins
    curve = vs.bifurcation_curve(graze, ("c_stop", "omega"), ((0.1, 3), (0.3, 3)))
    (point,) = [one for one in curve.special if one.type == "resonant_graze"]
    c, mu = point.parameters["c_stop"], None
    system = graze.orbit.system.replace(c_stop=c)
    with mp.workdps(DIGITS):
        M = ClosedOrbit(machine_of(system.replace(**point.parameters).linear), [], 1).closure([0, 0], [])
        jump = mp.eye(2)
        jump[1, 0] = -mpf(c)
        mu = mp.eig(jump * M, left=False, right=False)
    assert min(abs(one + 1) for one in mu) < 1e-12


@pytest.mark.parametrize("preload", [0.0, 0.05, 0.25, 0.6])
def test_two_contacts_come_back_whatever_the_preload(preload):
    """The damper pulls with 0.51 at the release: up to there contacts end by force, beyond it at the stop."""
    numbers = dict(k=0.67, zeta=0.056, F=1.54, omega=1.88, k_stop=198, c_stop=0.527, b=0.475, tau=0.97)
    system = vs.Oscillator.named("one_mass", **numbers, preload=preload, stops="both", release="force")
    for moved in (system, system.replace(offset=1e-3)):
        orbit = vs.periodic_orbit(moved, itinerary="LR")
        assert orbit.ok and vs.simulate(moved, orbit.state, 1).section[-1] == pytest.approx(orbit.state, abs=1e-13)


def test_a_curve_ends_where_a_stop_does_not_relax_any_more():
    flip = [one for one in branch_of("omega", (0.3, 3), c_stop=0.5).special if one.type == "flip"][1]
    curve = vs.bifurcation_curve(flip, ("omega", "c_stop"), ((0.3, 3), (0.1, 9)))
    (end,) = [one for one in curve.special if one.type == "unrelaxed"]
    c, omega = end.parameters["c_stop"], end.parameters["omega"]
    (contact,) = end.orbit.contacts
    away = end.orbit.system.period - (contact["t_release"] - contact["t_touch"])
    assert np.exp(-29 / c * away) * (1 + 29 / c / omega) == pytest.approx(2**-53, rel=1e-6)


@pytest.mark.slow
def test_windows_of_a_rubber_stop():
    """Every window has a label at both ends; the motion is stable inside and gone, or unstable, beyond."""
    system = one_mass(zeta=0.02, c_stop=1.0, F=0.4)
    data = vs.sweep(system, {"omega": np.linspace(0.7, 1.4, 15)}, transient=300, record=40)
    windows = vs.windows(data)
    assert (1, "R") in {(one.period, one.itinerary) for one in windows}
    for one in windows:
        for end, inwards in ((one.lower, 1), (one.upper, -1)):
            if end.type == "boundary":
                continue
            assert end.type in ("graze", "fold", "flip") and end.error < 1e-12
            value = end.parameters["omega"] + inwards * 1e-6
            inside = vs.simulate(system.replace(omega=value), end.orbit.state, 2000 * one.period)
            last = inside.section[-1], inside.section[-1 - one.period]
            assert np.abs(last[0] - last[1]).max() < 1e-3


def test_an_orbit_whose_mass_meets_its_stop_again_before_it_is_out_is_none():
    """The stop relaxes faster than the mass moves on. The branch went on as ok, and windows with it, up to 56.84."""
    system = vs.Oscillator.named(
        "one_mass", k=1.0, zeta=0.21946461644074794, F=1.4480217615475175, omega=1.624381452744489,
        R=0.5119483099802649, k_stop_left=391.3381999367444, c_stop_left=50.0, preload_left=0.18166495017546266,
        b=0.7118563659162448, tau=1.3880336099211246, release="force",
    )  # fmt: skip
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="LR"), "c_stop_left", (45.0, 70.0))
    end = branch.ends
    assert end.type == "unrelaxed" and end.error < 1e-10
    last = end.parameters["c_stop_left"]
    for beyond, contacts in ((-1e-6, 1), (1e-6, 2)):
        there = system.replace(c_stop_left=last + beyond)
        flown = vs.simulate(there, end.orbit.state, 1)
        assert len(flown.contacts) == contacts
        assert vs.periodic_orbit(there, itinerary="LR").status == ("ok" if contacts == 1 else "unrelaxed")
