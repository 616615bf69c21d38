"""Which points of a plane a curve passes between, and which special points lie on a curve that is known already."""

import numpy as np
import pytest
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.curves.curve_search import Curves, compute_curve, seed_at
from vibro_sweep.analysis.windows.edges import Plane, edges_of, passing
from vibro_sweep.types import SpecialPoint

NAMES, BOX = ("b", "omega"), ((2.5, 6), (0.58, 0.68))


def pitchfork(omega) -> SpecialPoint:
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4, omega=omega), itinerary="LR"), "b", (2.5, 6))
    return next(special for special in branch.special if special.type == "pitchfork")


@pytest.mark.slow
def test_a_curve_is_known_from_another_of_its_points():
    curves, first = Curves(NAMES, BOX, ("pitchfork",)), pitchfork(0.63)
    known = curves.run([seed_at(first, NAMES)], 0, lambda _, tasks: [compute_curve(task) for task in tasks])
    for omega in (0.612, 0.64):
        assert curves.lies_on(known, seed_at(pitchfork(omega), NAMES))
    moved = first.orbit.system.replace(b=first.parameters["b"] + 1e-5)
    near = SpecialPoint("pitchfork", {"b": moved.b}, vs.periodic_orbit(moved, itinerary="LR"), first.multipliers)
    assert not curves.lies_on(known, seed_at(near, NAMES))


def test_edges_between_which_a_line_passes():
    """A straight line over a plane of 5 x 4 points, counted by hand: period 1 below it, 3 above it; 2 at one point."""
    x, y = np.arange(5.0), np.arange(4.0)
    period = np.where(y > 0.5 * x[:, None] + 0.6, 3, 1)
    plane = Plane((x, y), period)
    line = np.column_stack([[-1.0, 2.1, 6.0], [0.1, 1.65, 3.6]])
    arrays = {"branch_type": 0, "branch_period": 3, "value": line, "unstable": np.array([0, 0, 0])}
    edges = edges_of(plane)
    assert len(edges.axis) == len(passing(plane, edges, arrays)) == 7
    assert len(passing(plane, edges, arrays | {"branch_period": 2})) == 0  # the orbits of other regions
    assert len(passing(plane, edges, arrays | {"unstable": np.array([1, 1, 1])})) == 0  # that bound no attractor
    period[0, 3] = 2
    edges = edges_of(plane)
    found = passing(plane, edges, arrays)
    assert len(edges.axis) == 9 and sorted(map(sorted, edges.periods[found].tolist())) == 7 * [[1, 3]]
