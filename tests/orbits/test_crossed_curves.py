"""Where the orbit of a curve of grazes becomes the free motion, whose own grazes solve the same equations."""

import pytest
from support import slow_cases
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.model.linear import amplitudes


@pytest.fixture(scope="module")
def graze():
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (3.0, 4.1))
    return next(special for special in branch.special if special.type == "graze")


@pytest.mark.parametrize("factor", [1.0, 0.7848, *slow_cases((0.5,), (1.2965,), (1.7,), (2.0,), (2.3,))])
def test_the_point_where_the_orbit_becomes_the_free_motion(graze, factor):
    """The other impact vanishes there, and the free motion touches both stops. It does not depend on the steps."""
    curve = vs.bifurcation_curve(graze, ("b", "omega"), ((2.45, 9.0), (0.5, 0.8)), step=factor)
    found = [special for special in curve.special if special.type not in ("boundary", "resonant_graze", "flip_graze")]
    assert [special.type for special in found] == ["double_graze"]
    b, omega = (found[0].parameters[name] for name in ("b", "omega"))
    assert omega == pytest.approx(0.540141118989, abs=1e-11)
    q = PAPER.replace(b=b, omega=omega).linear
    assert abs(abs(q.normal @ amplitudes(q)) - b) < 1e-12
    assert 0 < found[0].error < 1e-10
