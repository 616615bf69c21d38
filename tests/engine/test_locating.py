"""Where ends and bifurcations of a branch lie."""

import pytest
from support import sample
from support.oscillators import BALL, CAVITY, ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.continuation.first_point import first_place
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import KINDS
from vibro_sweep.analysis.curves.curve_start import start_at
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.types import Family

ORBITS = [
    (PAPER.replace(b=3.0), "LR", "b", (0.3, 6.8)),
    (PAPER.replace(b=4.0), "R", "b", (3.0, 6.8)),
    (PAPER.replace(b=1.0), "LLRR", "b", (0.3, 3.0)),
    (PAPER.replace(b=4.0), "R", "offset", (-3.0, 3.0)),
    (ONE_MASS.replace(F=0.37), "R", "b", (0.5, 1.5)),
    (CAVITY, "LR", "b", (0.1, 4.0)),
    (BALL.replace(A=0.5), "L", "R", (0.2, 0.9)),
]
IDS = [f"{itinerary}-{name}-{i}" for i, (_, itinerary, name, _) in enumerate(ORBITS)]


def orbit_of(system, itinerary):
    periods = 2 if isinstance(system, Family) and system.build is ONE_MASS.build else 1
    orbit = vs.periodic_orbit(system, itinerary=itinerary, periods=periods)
    assert orbit.ok
    return orbit


@pytest.mark.parametrize(("system", "itinerary", "name", "bounds"), sample(3, ORBITS), ids=IDS)
def test_special_points_are_where_their_equations_hold(system, itinerary, name, bounds):
    """Where a test vanishes along the branch, beside Newton's method for the orbit and the parameter at once, with the
    equation of the bifurcation."""
    found = [one for one in vs.continue_orbit(orbit_of(system, itinerary), name, bounds).special if one.type in KINDS]
    assert found
    for special in found:
        place = first_place(SolutionCurve(start_at(special, (name,)), (name,), [bounds]))
        assert abs(place.p[0] - special.parameters[name]) <= 2 * max(special.error, 1e-14) < 1e-12, special  # of both


def test_stops_that_do_not_move_in_proportion():
    """b = 3 c^2: the branch in c has the ends of the branch in b, at the square roots."""
    paper = family_of(PAPER)

    def build(*, c):
        return paper.build(**(paper.numbers | {"b": 3 * c**2}))

    squared = Family(build, {"c": 1.0})
    orbit = vs.periodic_orbit(squared, itinerary="LR", periods=1)
    found = vs.continue_orbit(orbit, "c", (0.4, 1.5)).special
    expected = vs.continue_orbit(orbit_of(PAPER.replace(b=3.0), "LR"), "b", (0.48, 6.75)).special
    assert [one.type for one in found] == [one.type for one in expected] == ["graze", "pitchfork", "graze"]
    for one, other in zip(found, expected, strict=True):
        assert 3 * one.parameters["c"] ** 2 == pytest.approx(other.parameters["b"], abs=1e-12)
