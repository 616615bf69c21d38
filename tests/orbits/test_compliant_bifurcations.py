"""Windows and curves with compliant stops; special points and points of codimension two in 45 digits.

With `-m slow` all of BRANCHES and CURVES. What was found: tests/data/compliant_bifurcations.log.
"""

import numpy as np
import pytest
from support import compliant_branches, compliant_curves, slow_cases
from support.compliant_bifurcations import BRANCHES, branch_of, one_mass
from support.in_digits import errors_of
from support.searching import searched

import vibro_sweep as vs

ENDS = ("boundary", "closed")


def compare(special):
    """The distance from 45 digits: 1e-12 at most, or what the point says of itself."""
    off = errors_of(special)
    assert np.all(np.abs(off) < max(1e-12, special.error)), (special, off)


@pytest.mark.parametrize("name", slow_cases(*BRANCHES))
def test_special_points_of_branches_in_45_digits(name):
    branch, compared = branch_of(name), 0
    assert not compliant_branches.unexplained(branch)
    for special in branch.special:
        if special.type not in ENDS:
            compare(special)
            compared += 1
    assert compared >= 2


@pytest.mark.slow
def test_folds_run_beside_grazes():
    """Without a preload the branch of short contacts turns at a fold just beside the graze; both can be followed."""
    branch = branch_of("one mass")
    fold, graze = branch.special[-2:]
    assert fold.type == "fold" and graze.type == "graze"
    beyond = []
    for one in (fold, graze):
        points = vs.bifurcation_curve(one, ("omega", "F"), ((1.1, 1.4), (0.3, 0.8))).points
        omega, F = points.omega.values, points.F.values
        assert len(omega) > 20
        beyond.append(F - np.hypot(1 - omega**2, 2 * 0.05 * omega))  # of where the free motion has the size 1
    assert np.abs(beyond[1]).max() < 1e-12
    assert np.all(beyond[0] > 1e-6) and np.all(beyond[0] < 1e-3)


TWICE = dict(k=2.66, zeta=0.036, F=0.49, omega=0.715, k_stop=54.5, c_stop=2.38, b=0.058, offset=0, tau=0.545)
OVER_AN_END = dict(
    k=0.354, zeta=0.041, F=0.284, omega=1.598, k_stop=4.51, c_stop=1.2, b=0.0276, offset=0, tau=3.5685, stops="left"
)


@pytest.mark.slow
def test_a_contact_of_no_length_on_a_curve_of_flips_is_no_error():
    """Without damping this curve runs along the free motion; where the contact vanishes its equations are 0/0."""
    system = one_mass(zeta=0, b=0.3, stops="left")
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="L"), "b", (0.2, 7))
    flips = [one for one in branch.special if one.type == "flip"]
    curves = [vs.bifurcation_curve(flip, ("b", "omega"), ((0.2, 7), (0.4, 1))) for flip in flips]
    assert [one.parameters["b"] for one in flips] == pytest.approx([0.8095353984, 1.3879367035])
    assert all(len(curve.points.b) > 100 for curve in curves)
    found = {one.type for curve in curves for one in curve.special}
    assert not found & {"resonance_1_2", "degenerate_flip"}  # -1 is double everywhere: its cubic term does not tell


@pytest.mark.slow
@pytest.mark.parametrize("numbers, bounds", [
    (TWICE, (-0.0276, 0.017)),
    (TWICE | dict(preload=0.01), (-0.0276, 0.017)),
    (OVER_AN_END, (-0.01, 0.01)),
])  # fmt: skip
def test_two_contacts_become_one(numbers, bounds, tmp_path):
    """At one place for both branches, that of the orbits with two contacts and that with one, in 45 digits."""
    system = one_mass(**numbers)
    simulated = vs.simulate(system, (0, 0), 600).section[-1]
    branch = vs.continue_orbit(vs.periodic_orbit(system, simulated, periods=2), "offset", bounds)
    (special,) = [one for one in branch.special if one.type == "split"]
    compare(special)
    assert special.error < 1e-12
    contacts = np.sort(special.orbit.contacts, order="t_touch")
    begins = np.append(contacts["t_touch"][1:], contacts["t_touch"][0] + special.orbit.period * system.period)
    assert (begins - contacts["t_release"]).min() == pytest.approx(0, abs=1e-14)
    read = vs.load(branch.save(tmp_path / "branch.h5"))
    (again,) = [one for one in read.special if one.type == "split"]
    assert again.multipliers == pytest.approx(special.multipliers, abs=1e-12)
    from_there = [one.type for one in vs.continue_orbit(special.orbit, "offset", bounds).special]
    assert [one.type for one in branch.special] in (from_there, from_there[::-1])
    (one,) = vs.switch(special)
    assert one.ok and len(one.contacts) == len(contacts) - 1
    far = vs.continue_orbit(one, "offset", bounds)
    met = [end for end in far.special if end.type == "split"]
    assert min(abs(end.parameters["offset"] - special.parameters["offset"]) for end in met) < 1e-12
    back = next(end for end in met if abs(end.parameters["offset"] - special.parameters["offset"]) < 1e-12)
    (two,) = vs.switch(back)
    assert two.ok and len(two.contacts) == len(contacts)
    for end in met:
        compare(end)


@pytest.mark.parametrize("numbers", [1, *slow_cases(4)])
def test_a_curve_does_not_come_back_where_preload_and_contact_vanish(numbers):
    """A flip or a fold beside the graze of a soft stop, in the preload: the curve rises from preload = 0 and comes down
    to 0 where the contact has no length. It was followed back from there, or ended as failed."""
    branch = vs.continue_orbit(vs.periodic_orbit(one_mass(c_stop=0.3, preload=0.0), itinerary="R"), "omega", (0.3, 3))
    near = branch.special[numbers]
    assert near.type == ("flip" if numbers == 1 else "fold")
    curve = vs.bifurcation_curve(near, ("omega", "preload"), ((0.3, 3), (0, 1)))
    between = [one.type for one in curve.special if one.type != "boundary"]
    assert between == ["degenerate_flip" if numbers == 1 else "cusp"]
    assert [one.parameters["preload"] for one in curve.special if one.type == "boundary"] == [0, 0]


@pytest.mark.parametrize("numbers", [(20, 1, 0.05), (20, 1, 0.1), (29, 0, 0.05), (100, 1, 0.05)])
def test_an_infinite_multiplier_at_the_graze_of_a_preloaded_stop(numbers):
    """Of the first of these its inverse is zero to the last bit, of the others to rounding."""
    k, c, p = numbers
    stop = dict(k_stop=k, c_stop=c, preload=p, b=1, stops="right", tau=0)
    system = vs.Oscillator.named("one_mass", zeta=0.02, F=0.5, omega=0.8, **stop)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "omega", (0.6, 3))
    assert [one.type for one in branch.special] == ["graze", "flip", "fold", "graze"]
    for graze in (branch.begins, branch.ends):
        first, second = abs(graze.multipliers)
        assert first > 1e12 and second < 1e-12 and np.isfinite(graze.error)


@pytest.mark.slow
def test_a_curve_ends_where_two_contacts_become_one():
    """A flip of an orbit of four periods with sixteen contacts; the place in 45 digits."""
    case = compliant_branches.drawn_case(207)
    flips = [one for one in compliant_branches.follow(case).special if one.type == "flip"]
    flip = min(flips, key=lambda one: one.parameters["b"])
    curve = vs.bifurcation_curve(flip, ("b", "omega"), (case.bounds, (1.1, 1.2)))
    ends = [one for one in curve.special if one.type == "split"]
    assert ends and not any(one.type == "failed" for one in curve.special)
    for one in ends:
        compare(one)
        assert np.abs(one.multipliers + 1).min() < 1e-9


@pytest.mark.slow
def test_windows_of_one_elastic_stop():
    """Every window has a label at both ends, and the motion there is stable inside and gone or unstable beyond."""
    system = one_mass(zeta=0.01, base=True, F=0.9 / 1.26, tau=np.pi / 2)
    data = vs.sweep(system, {"omega": np.linspace(0.74, 1.1, 19)}, transient=600, record=60)
    windows = vs.windows(data)
    assert {(one.period, one.itinerary) for one in windows} >= {(1, "R"), (2, "R"), (3, "RR")}
    for one in windows:
        for end, inwards in ((one.lower, 1), (one.upper, -1)):
            if end.type == "boundary":
                continue
            assert end.type in ("graze", "fold", "flip") and end.error < 1e-12
            value = end.parameters["omega"] + inwards * 1e-6
            inside = vs.simulate(system.replace(omega=value), end.orbit.state, 4000 * one.period)
            last = inside.section[-1], inside.section[-1 - one.period]
            assert np.abs(last[0] - last[1]).max() < 1e-3


@pytest.mark.parametrize("seeds", [[1], *slow_cases([*range(4), 45], [*range(1000, 1004), 1034, 1151, 1865])])
def test_random_branches_from_several_starts(seeds):
    counted, wrong = searched(compliant_branches.study, seeds)
    assert wrong == [] and counted["branches"] > 0.6 * len(seeds)


@pytest.mark.parametrize("seeds", slow_cases(range(7), [1003, 1035]))
def test_random_curves_with_steps_of_other_lengths(seeds):
    counted, wrong = searched(compliant_curves.study, seeds)
    assert wrong == [] and counted["curves"] > 0.4 * len(seeds)
