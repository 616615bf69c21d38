"""Stops that differ, or are compliant: where branches end, what begins at special points, and wide bounds."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from support import compliant_curves, sample
from support.compliant_branches import drawn_case
from support.drawn_branches import Case
from support.same_branch import follow

import vibro_sweep as vs

NAMES = ("b", "omega")


def one_mass(**numbers) -> vs.Oscillator:
    known = {"k": 1, "zeta": 0.05, "F": 1.0, "omega": 0.9, "b": 1, "tau": 0.0}
    return vs.Oscillator.named("one_mass", **(known | numbers))


def one_stop() -> vs.Oscillator:
    return one_mass(F=0.5, omega=0.8, stops="right", k_stop=29)


@pytest.fixture(scope="module")
def soft_branch():
    return vs.continue_orbit(vs.periodic_orbit(one_stop(), itinerary="R"), "omega", (0.3, 3))


def test_windows_of_stops_that_differ_end_where_the_free_motion_grazes():
    system = one_mass(k_stop=50, k_stop_left=51)
    b = vs.grazing(system).b
    found = vs.windows(vs.sweep(system, {"b": b * np.linspace(0.7, 1.3, 25)}, transient=300, record=32))
    ends = [(one.itinerary, one.lower.type, one.upper.type) for one in found]
    assert ends == [("LR", "boundary", "graze"), ("", "graze", "boundary")]


@pytest.mark.parametrize(
    "flips, other, bounds, count",
    sample(1, [([0, 1], "b", (0.1, 2), 4), ([1], "k_stop", (5, 2000), 1)]),
)
def test_curves_of_doubled_orbits_with_contacts_begin_at_a_degenerate_flip(soft_branch, flips, other, bounds, count):
    """A flip, and the fold that begins there: its orbits of two periods have a multiplier 1, and it leads back."""
    along, known = ("omega", other), [one for one in soft_branch.special if one.type == "flip"]
    box, found = ((0.3, 3), bounds), []
    for flip in (known[i] for i in flips):
        for point in vs.bifurcation_curve(flip, along, box).special:
            if point.type == "degenerate_flip":
                found.append((point, {one.type: one for one in vs.switch(point)}))
    assert len(found) == count
    for point, begun in found:
        assert set(begun) == {"flip", "fold"}
        fold = begun["fold"]
        assert fold.orbit.period == 2 and np.abs(fold.multipliers - 1).min() < 1e-9
        ends = [one.parameters for one in vs.bifurcation_curve(fold, along, box).special if one.type == point.type]
        assert any(one == pytest.approx(point.parameters, rel=1e-8) for one in ends)


BOTH = {"k_stop": 30.0, "k_stop_left": 30.0, "c_stop": 1.0, "c_stop_left": 1.0, "preload": 0.1, "preload_left": 0.1}


@pytest.mark.parametrize("name", sample(2, BOTH))
def test_a_symmetric_orbit_does_not_stay_so_along_a_number_of_one_stop(name):
    """Its branch said ok of halves of orbits that are not there."""
    orbit = vs.periodic_orbit(one_mass(b=0.8, tau=0.3, **BOTH), itinerary="LR")
    assert orbit.symmetric
    branch = vs.continue_orbit(orbit, name, (0.5 * BOTH[name], 2 * BOTH[name]))
    points = branch.points.isel(point=[0, -1])
    for value, x, v in zip(points[name].values, points.x1.values, points.v1.values, strict=True):
        flown = vs.simulate(orbit.system.replace(**{name: value}), (x, v), 1).section[-1]
        assert np.abs(flown - (x, v)).max() < 1e-12


def test_a_curve_of_grazes_that_leaves_its_bounds_at_no_preload_has_no_point_there():
    """Its tests are zero there, beyond the bound by rounding: it ended in an error of the preload."""
    system = one_mass(F=0.5, omega=0.8, stops="right", k_stop=29, preload=0.05)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (0.1, 2))
    graze = next(one for one in branch.special if one.type == "graze")
    for most in (0.1, 0.2, 0.5, 1):
        curve = vs.bifurcation_curve(graze, ("b", "preload"), ((0.1, 3), (0, most)))
        assert curve.points.preload.values.min() == 0.0
        assert all(one.type == "boundary" for one in curve.special if abs(one.parameters["preload"]) < 1e-9)


@pytest.mark.slow
def test_a_resonant_graze_whose_test_is_nearly_flat_is_one_point_with_its_error():
    """Multipliers of 1e-10: rounding changed the sign of the test at up to six places, with errors of 5e-11."""
    numbers = {"k": 1, "zeta": 0.08655, "F": 1.41046, "omega": 0.49928, "b": 0.16023, "tau": -1.61125}
    law = {"k_stop": 68.79466, "c_stop": 10.1741, "preload": 0.18724}
    orbit = vs.periodic_orbit(vs.Oscillator.named("one_mass", stops="right", **numbers, **law), itinerary="RR")
    graze = next(one for one in vs.continue_orbit(orbit, "preload", (0, 0.57)).special if one.type == "graze")
    found = []
    for bounds in (((0.12, 0.4), (30, 200)), ((0.1, 0.5), (20, 300))):
        curve = vs.bifurcation_curve(graze, ("preload", "k_stop"), bounds, virtual=False)
        found.append([one for one in points(curve, "resonant_graze") if 0.13 < one.parameters["preload"] < 0.39])
    assert len(found[0]) == len(found[1]) > 4
    for one in found[0]:
        near = min(found[1], key=lambda other: abs(one.parameters["k_stop"] - other.parameters["k_stop"]))
        assert abs(one.parameters["k_stop"] - near.parameters["k_stop"]) <= one.error + near.error < 0.2


def test_a_curve_of_grazes_ends_where_its_touch_comes_to_the_contact_before():
    """There the mass leaves the stop without speed and acceleration. It is integrated from there, once around."""
    numbers = {"k": 1.0, "zeta": 0.064, "F": 1.471, "constant": 0.114, "omega": 1.852, "b": 0.28, "tau": 0.864}
    system = vs.Oscillator.named("one_mass", stops="left", k_stop=39.83, c_stop=5.68, **numbers)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="L"), "omega", (0.92, 3.3))
    graze = next(one for one in branch.special if one.type == "graze")
    ends = []
    for factor in (0.5, 1.0, 2.0):
        curve = vs.bifurcation_curve(graze, ("omega", "k_stop"), ((0.92, 3.3), (6.6, 240)), step=factor)
        (end,) = points(curve, "split")
        before, touch = end.orbit.contacts
        assert touch["t_touch"] == touch["t_release"] == pytest.approx(before["t_release"], abs=1e-12)
        ends.append((end.parameters["omega"], end.parameters["k_stop"], end.error))
    for one in ends:
        assert one[:2] == pytest.approx(ends[0][:2], abs=one[2] + ends[0][2]) and one[2] < 1e-9

    def left(unknown):
        omega, k_stop = unknown
        phase = math.asin((-0.28 - 0.114) / 1.471)  # of the force: no acceleration at the stop, and then away from it

        def pull(t, y, k, c):
            return y[1], 1.471 * math.sin(omega * t + phase) + 0.114 - (0.128 + c) * y[1] - y[0] - k * (y[0] + 0.28)

        def back(t, y, *_):
            return y[0] + 0.28 if t > 0.1 else 1.0

        back.terminal, period = True, 2 * math.pi / omega
        exact = {"rtol": 1e-12, "atol": 1e-13, "method": "DOP853"}
        flight = solve_ivp(pull, (0, period), [-0.28, 0.0], args=(0.0, 0.0), events=back, **exact)
        contact = solve_ivp(pull, (flight.t[-1], period), flight.y[:, -1], args=(k_stop, 5.68), **exact)
        return contact.y[0, -1] + 0.28, contact.y[1, -1]

    assert ends[0][:2] == pytest.approx(fsolve(left, [1.01, 21.0], xtol=1e-12), rel=1e-8)


def test_a_curve_keeps_within_its_bounds_where_a_preload_vanishes(soft_branch, tmp_path):
    fold = next(one for one in soft_branch.special if one.type == "fold")
    curve = vs.bifurcation_curve(fold, ("omega", "preload"), ((0.3, 3), (-1, 1)))
    assert curve.points.preload.values.min() == 0.0
    curve.save(tmp_path / "curve.h5")
    assert vs.load(tmp_path / "curve.h5").points.equals(curve.points)


@pytest.mark.parametrize("bounds", sample(1, [[20, 3e8], [1, 1e9]]))
def test_a_branch_goes_from_soft_to_rigid_within_wide_bounds(bounds):
    branch = vs.continue_orbit(vs.periodic_orbit(one_stop(), itinerary="R"), "k_stop", bounds)
    assert branch.status == "ok"
    assert [one.parameters["k_stop"] for one in (branch.begins, branch.ends)] == list(bounds)


def test_bounds_so_wide_that_steps_are_rounding_are_refused(soft_branch):
    orbit = vs.periodic_orbit(one_stop().replace(preload=0.1), itinerary="R")
    with pytest.raises(
        ValueError, match=r"bounds: \[0.0, 1e\+20\] is not allowed; .* as wide as preload is large, 0.1"
    ):
        vs.continue_orbit(orbit, "preload", (0, 1e20))
    flip = next(one for one in soft_branch.special if one.type == "flip")
    with pytest.raises(ValueError, match=r"bounds.b: .* as wide as b is large"):
        vs.bifurcation_curve(flip, ("omega", "b"), ((0.3, 3), (-1e18, 1e18)))


def test_bounds_that_reach_to_a_stop_without_stiffness_say_how_the_branch_ends():
    branch = vs.continue_orbit(vs.periodic_orbit(one_stop(), itinerary="R"), "k_stop", (0, 100))
    assert branch.ends.type == "boundary" and branch.begins.parameters["k_stop"] < 1e-4


@pytest.mark.parametrize("itinerary", ["R", "LLRR"])
def test_orbits_that_are_not_there_have_a_status_where_one_stop_is_rigid(itinerary):
    orbit = vs.periodic_orbit(one_mass(omega=0.9, b=0.35, k_stop=50, R_left=0.6), itinerary=itinerary)
    assert orbit.status in ("inadmissible", "not_converged")


@pytest.mark.slow
@pytest.mark.parametrize("seed, expected", [(1083, "resonant_graze"), (136, "fold_graze")])
def test_a_curve_of_folds_meets_that_of_grazes_at_one_point(seed, expected):
    """Whatever the length of the steps; of the first seed also where the curve of grazes has it."""
    case = drawn_case(seed)
    branch = follow(case)
    graze = next(one for one in branch.special if one.type == "graze" and one.impact is not None)
    folds = [one for one in branch.special if one.type == "fold"]
    fold = min(folds, key=lambda one: abs(one.parameters["b"] - graze.parameters["b"]))
    values = fold.parameters["b"], case.orbit.system.numbers["omega"]
    bounds = [(value - by * abs(value), value + by * abs(value)) for value, by in zip(values, (0.1, 0.05), strict=True)]
    known = np.array(
        [list(one.parameters.values()) for one in points(vs.bifurcation_curve(graze, NAMES, bounds), expected)]
    )
    first = None
    for factor in (0.5, 1.0, 2.0):
        curve = vs.bifurcation_curve(fold, NAMES, bounds, step=factor)
        (found,) = [one for one in points(curve, expected) if one.impact is not None]
        value = np.array(list(found.parameters.values()))
        first = value if first is None else first
        assert found.error < 1e-11
        assert np.abs(value - first).max() < 1e-11
        if seed == 1083:
            assert np.abs(known - value).max(axis=1).min() < 1e-11


@pytest.mark.slow
def test_where_a_contact_vanishes_on_a_curve_the_others_keep_their_speeds():
    """Seed 1028, far from the start of the curve: they had those of other units, and `switch` raised LinAlgError."""
    flip = next(one for one in follow(drawn_case(1028)).special if one.type == "flip")
    values = flip.parameters["b"], flip.orbit.system.omega
    (point,) = points(vs.bifurcation_curve(flip, NAMES, [(0.7 * value, 1.3 * value) for value in values]), "flip_graze")
    contacts = np.sort(point.orbit.contacts, order="t_touch")
    flown = vs.simulate(point.orbit.system, point.orbit.state, point.orbit.period).contacts
    lengths = contacts["t_release"] - contacts["t_touch"]
    kept = contacts[lengths > 1e-7]  # the simulation may miss the one without length
    assert len(kept) == len(contacts) - 1
    for one in kept:
        assert np.abs(flown["v_touch"] - one["v_touch"]).min() < 1e-9
    assert {one.type for one in vs.switch(point)} == {"flip", "graze"}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1028, 1056, 1193, 1212, 1241, 1307])
def test_points_beside_the_graze_of_a_contact_do_not_depend_on_steps(seed):
    """Its length divides the tests there: rounding made resonances and cusps, each step others."""
    found, wrong = compliant_curves.study(seed, 2, compliant_curves.FAR)
    assert found["curves"] == 2 and not wrong


def points(curve, expected: str):
    return [one for one in curve.special if one.type == expected]


@pytest.mark.slow
def test_a_branch_ends_as_split_with_steps_of_every_length():
    """One that leads at once to what is no motion ended as `failed` at the same place."""
    system = vs.System(
        mu_m=0.5795038292920104, mu_k=1.8132932901918726, zeta=0.11150691424431475, f2=0.7890304343508028,
        omega=1.7299099654394774, b=0.20416521446326663, tau="grazing", offset=0.035661460411879224, R=None,
        R_left=1.0, k_stop=232.41253118292923, c_stop=9.698818225540375,
    )  # fmt: skip
    orbit = vs.periodic_orbit(system, itinerary="LRR")
    for factor in (1.0, 2.0):
        end = follow(Case(orbit, "c_stop", (0.0, 50.0)), factor).ends
        assert end.type == "split" and end.parameters["c_stop"] == pytest.approx(15.4549764978, rel=1e-10)
