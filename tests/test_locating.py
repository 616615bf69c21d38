"""Where ends and bifurcations of a branch lie: the ways to find them against each other."""

import numpy as np
import pytest
from support.oscillators import BALL, CAVITY, ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches import locating
from vibro_sweep.analysis.branches.special import inserted
from vibro_sweep.analysis.branches.walk import Walk
from vibro_sweep.model.linear import Family, family_of

ORBITS = [
    (PAPER.replace(b=3.0), "LR", "b", (0.3, 6.8)),
    (PAPER.replace(b=4.0), "R", "b", (3.0, 6.8)),
    (PAPER.replace(b=1.0), "LLRR", "R", (0.7, 0.9)),
    (PAPER.replace(b=4.0), "R", "offset", (-0.2, 0.2)),
    (ONE_MASS.replace(F=0.37), "R", "b", (0.5, 1.5)),
    (CAVITY, "LR", "b", (0.3, 0.8)),
    (BALL.replace(A=0.5), "L", "R", (0.2, 0.9)),
]
IDS = [f"{itinerary}-{name}-{i}" for i, (_, itinerary, name, _) in enumerate(ORBITS)]


def orbit_of(system, itinerary):
    periods = 2 if isinstance(system, Family) and system.build is ONE_MASS.build else 1
    orbit = vs.periodic_orbit(system, itinerary=itinerary, periods=periods)
    assert orbit.ok
    return orbit


@pytest.mark.parametrize(("system", "itinerary", "name", "bounds"), ORBITS, ids=IDS)
def test_ends_found_at_once_are_those_of_a_search_along_the_branch(system, itinerary, name, bounds, monkeypatch):
    orbit = orbit_of(system, itinerary)
    at_once = vs.continue_orbit(orbit, name, bounds)
    used = []
    for way in ("_at_value", "_at_touch"):
        monkeypatch.setattr(locating, way, lambda *args: used.append(args))
    searched = vs.continue_orbit(orbit, name, bounds)
    assert used and [special.type for special in at_once.special] == [special.type for special in searched.special]
    for one, other in zip(at_once.special, searched.special, strict=True):
        apart = abs(one.parameters[name] - other.parameters[name])
        assert apart <= max(one.error + other.error, 1e-14) < 1e-12, (one, other)
        assert (one.stop, one.kind, one.impact, one.direction) == (
            other.stop,
            other.kind,
            other.impact,
            other.direction,
        )


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


def test_an_impact_without_speed_lies_between_its_neighbours_whatever_turn_phases_are_counted_from():
    """The phase of the force is continuous along a branch, and so may be a turn off what the oscillator says."""
    start = orbit_of(PAPER.replace(b=4.0), "R")._solution
    walk = Walk(start, "omega", 0.1)
    walk._taus[0] = (walk._taus[0][0], walk._taus[0][1] + 2 * np.pi)
    point = walk.first(1.0)
    touching, index = inserted(point.solution)
    phases = walk.with_touch(point.guess, touching, index).phases
    assert np.all(np.diff(phases) > 0) and phases[-1] - phases[0] < np.pi * start.halves
