"""Results do not depend on the unit of length (tests/support/units.py)."""

import pytest
from support import slow_cases
from support.oscillators import PAPER
from support.searching import new_report, searched
from support.units import EXPONENTS, Pair, orbit_in, study

import vibro_sweep as vs

NAMES, BOX = ("b", "omega"), ((0.3, 9), (0.5, 0.8))


@pytest.fixture(scope="module")
def pitchforks():
    """Orbits of the paper's oscillator at a pitchfork, as of an oscillator whose force is a length too; and curves."""
    q = PAPER.replace(b=5.0).linear
    numbers = dict(
        M=q.M, K=q.K, C=q.C, contact_normal=q.contact.normal, force=q.sine, omega=q.omega, R=q.contact.R_high, tau=q.tau
    )
    orbit = vs.periodic_orbit(vs.Oscillator(**numbers, b=5.0), itinerary="LR")
    return [orbit_in(orbit, k) for k in (0, *EXPONENTS)]


@pytest.mark.parametrize("k", slow_cases(-40, 40))
def test_what_begins_at_points_of_codimension_two(k, pitchforks):
    report, orbits = new_report(), (pitchforks[0], pitchforks[1 + EXPONENTS.index(k)])
    pair = Pair(report, "paper", k, True)
    found = pair.branch(orbits, "b", (0.3, 9.0))
    pair.curve(next(points for points in found if points[0].type == "pitchfork"), NAMES, BOX)
    assert report.wrong == []
    assert {"from degenerate_flip", "from flip_neimark_sacker"} <= set(report.counted)


def test_what_begins_where_a_pitchfork_meets_a_graze():
    """The asymmetric orbits graze with one half; of the distance of the other, which touches too, rounding is left."""
    system = vs.System(mu_m=1.5, mu_k=2.65, zeta=0.08, f2=0, omega=1.58, R=0.45, b=1.0)
    star, q = vs.grazing(system).b, system.linear
    numbers = dict(
        M=q.M, K=q.K, C=q.C, contact_normal=q.contact.normal, force=q.sine, omega=q.omega, R=q.contact.R_high, tau=q.tau
    )
    orbit = vs.periodic_orbit(vs.Oscillator(**numbers, b=0.5 * star), itinerary="LR")
    report = new_report()
    pair = Pair(report, "pitchfork and graze", 40, True)
    found = pair.branch([orbit_in(orbit, k) for k in (0, 40)], "b", (0.1 * star, 1.05 * star))
    points = next(points for points in found if points[0].type == "pitchfork")
    pair.curve(points, NAMES, ((0.05 * star, 3 * star), (0.95, 2.3)))
    assert report.wrong == [] and "from pitchfork_graze" in report.counted


@pytest.mark.slow
def test_random_oscillators():
    """Without a scale of its own for lengths, `switch` lost an orbit, or found others, in each of the first three.

    The fourth missed a flip, since polynomials in omega kept three digits of the forces.
    """
    counted, wrong = searched(study, [3, 5, 9, 178, *range(11, 21)])
    assert wrong == [] and counted["switch"] > 14
