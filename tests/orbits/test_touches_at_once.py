"""The free motion touches both stops at once: the orbits that begin there, and those that matrices say do."""

from itertools import product

import numpy as np
import pytest
from scipy.linalg import expm
from support import sample, slow_cases

import vibro_sweep as vs

CASES = [  # omega, zeta, dampers of the right and the left stop
    (0.75, 0.05, 43.0, 27.0),
    (0.8, 0.05, 8.0, 5.0),
    (0.7, 0.1, 20.0, 10.0),
    (0.45, 0.05, 8.0, 5.0),
    (0.45, 0.05, 8.0, 7.0),
    (1.5, 0.05, 8.0, 5.0),
    (2.5, 0.05, 1.0, 0.7),
]


def half_map(omega, zeta):
    """Of x'' + 2 zeta x' + x = 0 from one turning point of the free motion to the next."""
    return expm(np.array([[0, 1], [-1, -2 * zeta]]) * np.pi / omega)


def corner(damper):
    return np.array([[1, 0], [-damper, 1]])


RIGID = None  # in place of a damper


def itineraries(omega, zeta, right, left):
    """Of orbits that exist where the free motion has a smaller, a larger amplitude than the gap.

    Unknown are the deviations from the free motion at its turning points, y at the right stop and z at the left, and
    the impulses of the stops: z = H (y - J_R), y = H (z + J_L), with turning points `larger` behind the stops.
    """
    H, both = half_map(omega, zeta), {-1: set(), 1: set()}
    for larger, hits_right, hits_left in product((-1, 1), (False, True), (False, True)):
        rows, values = np.zeros((6, 6)), np.zeros(6)  # of y, z, J_R, J_L
        rows[:2, :2], rows[:2, 2:4], rows[:2, 5] = np.eye(2), -H, -H[:, 1]
        rows[2:4, 2:4], rows[2:4, :2], rows[2:4, 4] = np.eye(2), -H, H[:, 1]
        for row, damper, hits, place, sign in ((4, right, hits_right, 0, 1), (5, left, hits_left, 2, -1)):
            if hits and damper is RIGID:  # sign y + larger = 0
                rows[row, place], values[row] = sign, -larger
            else:  # J = damper (sign y + larger)
                damper = damper if hits else 0
                rows[row, row], rows[row, place], values[row] = 1, -damper * sign, damper * larger
        found = np.linalg.solve(rows, values)
        pressed = [
            found[row] > 0 if hits and damper is RIGID else (sign * found[place] + larger > 0) == hits
            for row, damper, hits, place, sign in ((4, right, hits_right, 0, 1), (5, left, hits_left, 2, -1))
        ]
        if all(pressed):
            both[larger].add("L" * hits_left + "R" * hits_right)
    return both


@pytest.mark.parametrize("omega, zeta, right, left", sample(2, CASES))
def test_contacts_that_end_by_force(omega, zeta, right, left):
    amplitude = 1 / np.hypot(1 - omega**2, 2 * zeta * omega)
    inside, sign = (0.97, 1) if omega < 1 else (1.03, -1)  # where the amplitude is smaller; its growth with omega
    system = vs.Oscillator.named(
        "one_mass", k=1, zeta=zeta, F=1, omega=omega * inside, b=amplitude, tau=0.3, release="force",
        k_stop=300, c_stop=right, k_stop_left=200, c_stop_left=left,
    )  # fmt: skip
    expected = itineraries(omega, zeta, right, left)
    bounds = 0.9 * omega, 1.1 * omega
    free = vs.continue_orbit(vs.periodic_orbit(system, itinerary=""), "omega", bounds)
    (graze,) = [one for one in free.special if one.type == "graze"]
    assert graze.parameters["omega"] == pytest.approx(omega, abs=1e-13) and graze.stop == -1
    kind = "persistence" if expected[1] and expected[-1] else "nonsmooth fold"
    assert graze.kind == kind
    begun = vs.switch(graze)
    found = {(sign * int(np.sign(one.system.omega - omega)), one.itinerary) for one in begun}
    assert found == {(side, name) for side, names in expected.items() for name in names if name}
    for orbit in begun:
        branch = vs.continue_orbit(orbit, "omega", bounds)
        ends = [one for one in branch.special if one.type == "graze" and abs(one.parameters["omega"] - omega) < 1e-12]
        assert ends and ends[0].kind == kind
        if orbit.itinerary == "LR":
            H = half_map(omega, zeta)
            values = np.linalg.eigvals(H @ corner(left) @ H @ corner(right))
            assert np.sort(np.abs(ends[0].multipliers)) == pytest.approx(np.sort(np.abs(values)), rel=1e-9)


@pytest.mark.parametrize(
    "stops, right, left",
    sample(
        4,
        [
            ({"R": 0.7, "R_left": 0.5}, RIGID, RIGID),
            ({"R": 0.3, "R_left": 0.9}, RIGID, RIGID),
            ({"k_stop": 30, "R_left": 0.7}, 0, RIGID),
            ({"k_stop": 30, "preload": 0.1, "k_stop_left": 20, "preload_left": 0}, RIGID, 0),
            ({"k_stop": 30, "preload": 0.1, "k_stop_left": 20}, RIGID, RIGID),
            ({"k_stop": 300, "c_stop": 8, "R_left": 0.7, "release": "force"}, 8, RIGID),
        ],
    ),
    ids=str,
)
@pytest.mark.parametrize("omega", [0.45, *slow_cases(0.8, 2.5)])
def test_impacts_and_preload_beside_other_stops(omega, stops, right, left):
    amplitude = 1 / np.hypot(1 - omega**2, 0.1 * omega)
    inside, sign = (0.97, 1) if omega < 1 else (1.03, -1)
    system = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=1, omega=omega * inside, b=amplitude, tau=0.3, **stops)
    expected = itineraries(omega, 0.05, right, left)
    free = vs.continue_orbit(vs.periodic_orbit(system, itinerary=""), "omega", (0.9 * omega, 1.1 * omega))
    (graze,) = [one for one in free.special if one.type == "graze"]
    assert graze.kind == ("persistence" if expected[1] and expected[-1] else "nonsmooth fold")
    begun = {(sign * int(np.sign(one.system.omega - omega)), one.itinerary) for one in vs.switch(graze)}
    assert begun == {(side, name) for side, names in expected.items() for name in names if name}


def test_an_impact_that_is_forgotten_begins_on_the_other_side_and_from_all_starts():
    """A long contact damps to 1e-31 what is left of an impact: the sign of the linear answer was rounding."""
    system = vs.Oscillator.named(
        "one_mass", k=1.1382099671765398, zeta=0.0, F=0.4657714744778907, omega=0.44761943522526637, R=1.0,
        k_stop_left=3985.6239394137633, c_stop_left=47.853618720326274, b=0.10760910011476069, tau=0.6102898288417304,
    )  # fmt: skip
    for zeta in (0.01, 0.1, 0.17, 0.181):
        there = system.replace(zeta=zeta)
        orbit = vs.periodic_orbit(there, state=vs.simulate(there, (0, 0), 300).section[-1])
        graze = vs.continue_orbit(orbit, "zeta", (0.0, 0.25)).ends
        assert (graze.type, graze.kind, graze.direction) == ("graze", "persistence", -1)
        (beyond,) = vs.switch(graze)
        assert beyond.itinerary == "LLLRRRRR" and beyond.system.zeta > graze.parameters["zeta"]
        flown = vs.simulate(beyond.system, beyond.state, 1)
        assert np.abs(flown.section[-1] - beyond.state).max() < 1e-12 and len(flown.impacts) == 5


def test_a_window_that_begins_at_a_graze_of_both_stops_has_its_orbit_there():
    """Steps fail so near to it that the last point, corrected, differs in its last digits from what was recorded."""
    system = vs.Oscillator.named(
        "one_mass", k=1, F=0.7431435673133039, omega=1, zeta=0.08296261710310168, tau=0, b=0.8319339808708435,
        k_stop=12.343990807677045, c_stop=4.070820177882852, k_stop_left=37.031972423031135, c_stop_left=0,
    )  # fmt: skip
    swept = vs.sweep(system, {"omega": np.linspace(0.5, 2, 31)}, observe=["section"], transient=400, record=60)
    begins = vs.windows(swept)[0].lower
    assert begins.type == "graze" and begins.orbit.status == "ok" and np.isfinite(begins.orbit.state).all()
    free = vs.periodic_orbit(system.replace(omega=begins.parameters["omega"]), itinerary="")
    assert begins.orbit.sample([0.0, 1.0]) == pytest.approx(free.sample([0.0, 1.0]), abs=1e-9)
