"""Periodic orbits with compliant stops, their multipliers and branches.

Those of two masses are slow: their kernels serve no other fast test.
"""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from reference.closed_orbit import ClosedOrbit, contacts_of
from reference.machine import machine_of
from support import sample, slow_cases
from support.compliant_bifurcations import PAPER, one_mass, paper

import vibro_sweep as vs
from vibro_sweep.analysis.periodic import resting_orbit
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of


def in_thirty_digits(orbit):
    """State at t = 0, times of touch and release, and multipliers of the orbit, and what the reference has of them.

    By force contacts end where the stop would pull at its place.
    """
    length, contacts = orbit.period * orbit.system.period, np.sort(orbit.contacts, order="t_touch")
    t = contacts["t_touch"] % length
    order = np.argsort(t)
    times = np.column_stack([t, t + contacts["t_release"] - contacts["t_touch"]])[order].ravel()
    q = orbit.system.linear
    pulled = bool(np.all(q.contact.c_high * contacts["v_release"] + q.contact.p_high < 0))
    machine = machine_of(q)
    exact = ClosedOrbit(machine, contacts_of(machine, contacts["side"][order], pulled), orbit.period)
    state, known = exact.solve(orbit.state, times)
    multipliers = np.array([complex(one) for one in exact.multipliers(state, known)])
    found = [orbit.state, times, np.sort_complex(orbit.multipliers)]
    return found, [np.array(state, float), np.array(known, float), np.sort_complex(multipliers)]


@pytest.mark.parametrize(
    "system, itinerary",
    [
        (one_mass(), "R"),
        (one_mass(c_stop=0.5, preload=0.05, release="force"), "R"),
        *slow_cases(
            (paper(4, 1e4), "R"),
            (paper(2, 1e2, preload=0.5), "LR"),
            (one_mass(omega=0.75, preload=0.05), "R"),
            (paper(2, 1e6), "LR"),
            (paper(5, 1e3, z=0.5), "R"),
            (vs.System(**PAPER, b=4, k_stop=1e4, c_stop=3, k_stop_left=50, preload_left=0.1), "LR"),
            (one_mass(c_stop=2, release="force"), "R"),
            (one_mass(c_stop=0.5, preload=0.5, release="force"), "R"),
            (paper(2, 1e4, z=0.2, release="force"), "LR"),
            (paper(4, 1e4, release="force"), "R"),
            (paper(2, 1e6, z=0.8, release="force"), "LR"),
        ),
    ],
)
def test_orbits_and_multipliers_in_thirty_digits(system, itinerary):
    orbit = vs.periodic_orbit(system, itinerary=itinerary)
    assert orbit.ok and orbit.itinerary == itinerary and len(orbit.impacts) == 0
    found, known = in_thirty_digits(orbit)
    for here, there in zip(found, known, strict=True):
        assert np.abs(here - there).max() < 1e-12 * max(1.0, np.abs(there).max())


@pytest.mark.slow
def test_the_orbit_is_the_one_that_is_simulated():
    system = paper(4, 1e4)
    simulated = vs.simulate(system, (0, 0, 0, 0), 1500)
    orbit, last = vs.periodic_orbit(system, simulated.section[-1]), simulated.contacts[-1]
    assert orbit.ok and orbit.stable and orbit.state == pytest.approx(simulated.section[-1], abs=1e-11)
    (contact,) = orbit.contacts
    for name in ("v_touch", "v_release", "max_penetration", "max_force"):
        assert contact[name] == pytest.approx(last[name], rel=1e-9)
    times = np.linspace(0, system.period, 200)  # sections of flights and of contacts
    again = vs.simulate(system, orbit.state, 1)
    assert orbit.sample(times) == pytest.approx(again.sample(times), abs=1e-11)
    guess = [(contact["t_touch"], 1, contact["v_touch"])]
    assert vs.periodic_orbit(system, guess=guess).state == pytest.approx(orbit.state, abs=1e-12)
    assert len(vs.periodic_orbit(system, itinerary="LR").contacts) == 2


@pytest.mark.slow
def test_a_branch_in_the_stiffness_reaches_the_rigid_orbit():
    soft = vs.System(**PAPER, b=4, k_stop=1e3)
    rigid = vs.periodic_orbit(vs.System(**PAPER, b=4, R=1), itinerary="R")
    branch = vs.continue_orbit(vs.periodic_orbit(soft, itinerary="R"), "k_stop", (1e3, 1e9))
    assert branch.ok and branch.ends.type == "boundary"
    end = branch.ends.orbit
    assert end.state == pytest.approx(rigid.state, abs=1e-3)
    assert np.abs(np.sort_complex(end.multipliers) - np.sort_complex(rigid.multipliers)).max() < 1e-3


@pytest.mark.parametrize("name", ["c_stop", "preload"])
def test_numbers_of_a_stop_that_are_left_out_can_be_followed(name):
    """They are 0, and numbers like any other."""
    given, left_out = (
        vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), name, (0, 0.5))
        for system in (one_mass(**{name: 0.0}), one_mass())
    )
    assert [one.type for one in left_out.special] == ["boundary", "boundary"]
    assert left_out.ends.orbit.system == one_mass(**{name: 0.5})
    for one, other in zip(left_out.special, given.special, strict=True):
        np.testing.assert_array_equal(one.multipliers, other.multipliers)


@pytest.mark.slow
def test_special_points_of_a_branch_are_where_the_multipliers_of_the_reference_are():
    orbit = vs.periodic_orbit(one_mass(), itinerary="R")
    branch = vs.continue_orbit(orbit, "omega", (0.3, 3))
    assert [one.type for one in branch.special] == ["graze", "flip", "flip", "fold", "fold", "graze"]
    assert all(one.kind == "persistence" for one in branch.special if one.type == "graze")
    for one in branch.special[1:3]:
        multipliers = in_thirty_digits(one.orbit)[1][2]
        assert np.abs(multipliers + 1).min() < 1e-10
    # det G(1) has no factor s: at neither graze a fold is found, and both folds turn
    values = branch.points.omega.values
    turns = np.flatnonzero(np.diff(np.sign(np.diff(values))))
    assert len(turns) == 2
    folds = [one for one in branch.special if one.type == "fold"]
    assert [values[i + 1] for i in turns] == pytest.approx([one.parameters["omega"] for one in folds], abs=1e-6)


@pytest.mark.slow
def test_a_pair_on_the_circle_and_a_graze_of_the_free_motion():
    branch = vs.continue_orbit(vs.periodic_orbit(paper(4, 1e4), itinerary="R"), "b", (1, 7))
    (first, *middle, last), b_star = branch.special, paper(4, 1e4).parameters()["b"]
    assert first.type == last.type == "graze" and {one.type for one in middle} == {"neimark_sacker"} and b_star == 4
    torus = in_thirty_digits(middle[0].orbit)[1][2]
    assert np.abs(np.abs(torus) - 1).min() < 1e-9
    free = vs.periodic_orbit(paper(8, 1e4), itinerary="")
    x1 = free.sample(np.linspace(0, free.system.period, 4001))[:, 0]
    assert last.parameters["b"] == pytest.approx(x1.max(), abs=1e-5)
    # just before its contact would vanish, where the free motion grazes, the orbit passes the other stop
    beyond = (last.parameters["b"] + vs.grazing(free.system).b_right) / 2
    solution = last.orbit._solution
    orbit = orbit_of(paper(beyond, 1e4), replace(solution, family=solution.family.replace(b=beyond)).corrected())
    times = np.linspace(0, orbit.system.period, 4001)
    near = times[np.argmin(orbit.sample(times)[:, 0])] + np.linspace(-0.01, 0.01, 4001)
    assert last.stop == -1 and orbit.status == "inadmissible" and orbit.sample(near)[:, 0].min() < -beyond - 1e-9
    assert vs.switch(last)[0].itinerary == vs.switch(first)[0].itinerary == "LR"


@pytest.mark.slow
def test_branches_go_on_over_grazes_flips_and_pitchforks():
    found = vs.follow_branches(vs.periodic_orbit(paper(4, 1e4), itinerary="LR"), "b", (1, 8), depth=2)
    assert all(one.branch.ok for one in found)
    assert {"", "R", "LR"} <= {one.branch.begins.orbit.itinerary for one in found}


@pytest.mark.slow
def test_a_branch_that_a_flip_begins():
    doubled = vs.follow_branches(vs.periodic_orbit(one_mass(), itinerary="R"), "omega", (0.3, 3))
    assert any(one.special is not None and one.special.type == "flip" for one in doubled)


@pytest.mark.slow
def test_a_preload_makes_a_graze_as_of_rigid_stops():
    """With a preload the speed is proportional to the distance from the graze, without it to its square root."""
    for preload, power in ((0.0, 0.5), (1.0, 1.0)):
        system = paper(4, 1e4, preload=preload, stops="right")
        branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3, 7))
        graze = next(one for one in (branch.begins, branch.ends) if one.impact is not None)
        b, lengths = graze.parameters["b"], []
        s = graze.orbit._solution
        assert abs(s.ends - s.times).min() < 1e-12
        points = branch.points
        away = np.abs(points.b.values - b)
        near = np.argsort(np.where(away > 1e-9, away, np.inf))[:2]
        lengths = points.min_impact_speed.values[near]
        slope = np.diff(np.log(lengths)) / np.diff(np.log(np.abs(points.b.values[near] - b)))
        assert slope[0] == pytest.approx(power, abs=0.2)


@pytest.mark.slow
def test_a_mixed_machine_has_contacts_and_impacts():
    system = vs.System(**PAPER, b=2, k_stop=1e3, c_stop=4, R_left=0.7)
    orbit = vs.periodic_orbit(system, itinerary="LR")
    assert orbit.ok and orbit.contacts["side"].tolist() == [1] and orbit.impacts["side"].tolist() == [-1]
    branch = vs.continue_orbit(orbit, "R_left", (0.2, 0.95))
    assert branch.ok
    for end in (branch.begins, branch.ends):
        state = end.orbit.state
        simulated = vs.simulate(end.orbit.system, state, 1).section[-1]
        assert simulated == pytest.approx(state, abs=1e-10)


@pytest.mark.slow
def test_a_ball_that_flies_freely_at_its_graze():
    """There both multipliers of the free flight are 1, and pitchforks within rounding of the graze were found."""
    ball = vs.Oscillator.named(
        "ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.05, omega=1, b=0.8, tau=0, k_stop=4, c_stop=0.1
    )
    branch = vs.continue_orbit(vs.periodic_orbit(ball, itinerary="LR"), "b", (0.2, 3))
    found = [one.type for one in branch.special]
    assert found == ["boundary", "pitchfork", "neimark_sacker", "fold", "fold", "neimark_sacker", "graze"]
    assert branch.ends.parameters["b"] == pytest.approx(2.5, abs=1e-13)  # the box has the amplitude F/(2 zeta)


def test_files_hold_them(tmp_path):
    orbit = vs.periodic_orbit(one_mass(), itinerary="R")
    data = orbit.to_xarray()
    assert data.contact_t_touch.dims == ("contact",) and data.contact_max_force.values == orbit.contacts["max_force"]
    assert orbit.to_dataframe().v_release.tolist() == orbit.contacts["v_release"].tolist()
    again = vs.load(orbit.save(tmp_path / "orbit.json"))
    assert again.ok and again.state == pytest.approx(orbit.state, abs=1e-14)
    branch = vs.continue_orbit(orbit, "omega", (0.7, 0.9))
    read = vs.load(branch.save(tmp_path / "branch.h5"))
    assert [one.type for one in read.special] == [one.type for one in branch.special]
    assert read.special[0].orbit.state == pytest.approx(branch.special[0].orbit.state, abs=1e-9)
    assert branch.plot() is not None and orbit.plot() is not None


SHORT = [
    dict(k_stop=2),
    dict(k_stop=29),
    dict(k_stop=29, c_stop=0.4),
    dict(k_stop=29, c_stop=0.4, release="force"),
    dict(k_stop=1e4),
]


@pytest.mark.parametrize("depth, law", sample(6, product([0.1, 0.02, 1e-3, 1e-5], SHORT)))
def test_orbits_with_short_contacts_are_found(law, depth):
    """Next to the graze of the free motion, where those with rigid stops lead nowhere: the one that its branch has."""
    system = vs.Oscillator.named("one_mass", zeta=0.05, F=0.5, omega=0.9, b=0.6, stops="right", tau=0, **law)
    b = float(vs.grazing(system).b_right) - depth
    orbit = vs.periodic_orbit(system.replace(b=b), itinerary="R")
    assert orbit.ok
    known = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (0.5, b)).ends
    assert known.type == "boundary"
    np.testing.assert_allclose(orbit.contacts["t_touch"], known.orbit.contacts["t_touch"], rtol=0, atol=1e-11)
    np.testing.assert_allclose(orbit.multipliers, known.multipliers, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("c_stop", "status"), [(2e4, "ok"), (1e5, "too_stiff")])
def test_stops_with_a_strong_damper(c_stop, status):
    """Contacts of which a forcing period is 4e5 cells were found, and could not be shown; longer ones are not found."""
    orbit = vs.periodic_orbit(one_mass(k_stop=29, c_stop=c_stop), itinerary="R")
    assert orbit.status == status
    if orbit.ok:
        (contact,), P = orbit.contacts, orbit.period * orbit.system.period
        times = np.array([contact["t_touch"], contact["t_release"]])
        run = vs.simulate(orbit.system, orbit.state, 2 * orbit.period)
        np.testing.assert_allclose(orbit.sample([P])[0], run.section[-1], rtol=0, atol=1e-9)
        known = np.array([[one["t_touch"], one["t_release"]] for one in run.contacts])
        assert np.abs(known - times - P * np.round((known[:, :1] - times[0]) / P)).max() < 1e-9


@pytest.mark.slow
def test_orbits_that_attract_are_found_by_their_contacts():
    """Random oscillators, at clearances from just below the graze to a third of it."""
    rng, found, missed = np.random.default_rng(7), 0, []
    while found + len(missed) < 60:
        k, z = 10 ** rng.uniform(0.3, 4), rng.choice([0.0, 0.05, 0.3])
        system = vs.Oscillator.named(
            "one_mass", zeta=0.05, F=0.5, omega=rng.uniform(0.4, 2), tau=rng.uniform(0, 6), b=1.0, k_stop=k,
            c_stop=2 * z * np.sqrt(k), release=str(rng.choice(["displacement", "force"])), stops="right",
        )  # fmt: skip
        b = float(vs.grazing(system).b_right) * rng.choice([0.999, 0.99, 0.95, 0.9, 0.7, 0.5, 0.3])
        system = system.replace(b=b)
        orbit = vs.periodic_orbit(system, state=vs.simulate(system, [0, 0], 600).section[-1], periods=1)
        if orbit.ok and orbit.stable and orbit.itinerary == "R":
            again = vs.periodic_orbit(system, itinerary="R")
            found += again.ok
            missed += [] if again.ok else [system]
    assert not missed


@pytest.mark.parametrize("stops", [dict(k_stop=29), *slow_cases(dict(R=0.8))], ids=["elastic", "rigid"])
@pytest.mark.parametrize("unsettled", [1e-8, -1e-8, 1e-4, -1e-4])
@pytest.mark.parametrize("share", [-0.01, 1e-9])
def test_an_orbit_that_has_nearly_settled(stops, unsettled, share):
    """Its first contact comes again a little before a period is over, or after it, and was counted twice, or not."""
    system = one_mass(**({"k_stop": None} | stops))
    orbit = vs.periodic_orbit(system, itinerary="R")
    first = (orbit.contacts["t_touch"] if "k_stop" in stops else orbit.impacts["t"])[0]
    begin = first + share * system.period
    state = orbit.sample([begin])[0] + unsettled * np.array([0.0, 1.0])
    later = system.replace(tau=system.tau + system.omega * begin)
    again = vs.periodic_orbit(later, state=state, periods=1)
    assert again.ok and again.itinerary == "R"
    np.testing.assert_allclose(np.sort(again.multipliers), np.sort(orbit.multipliers), rtol=0, atol=1e-9)


def test_a_guess_without_a_motion_is_no_traceback(monkeypatch):
    """Its states follow from a system of equations that may be singular."""
    system = one_mass(release="force")
    state = vs.periodic_orbit(system, itinerary="R").state

    def singular(*_):
        raise np.linalg.LinAlgError("Singular matrix")

    monkeypatch.setattr(resting_orbit.np.linalg, "solve", singular)
    assert vs.periodic_orbit(system, state=state).status == "not_converged"
