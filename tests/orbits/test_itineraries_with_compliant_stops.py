"""Orbits with compliant stops are found by the contacts that they have."""

import pytest
from support import slow_cases
from support.compliant_branches import drawn_case

import vibro_sweep as vs

OTHER_MASSES = slow_cases(98, 108, 1036)  # four, and two: each number of masses compiles kernels of its own
MISSED_BY_SEEDS = (45, *OTHER_MASSES)  # rigid stops that become softer lead to other orbits, or to none
LONGEST = 4  # contacts


def again(orbit):
    return vs.periodic_orbit(orbit.system, itinerary=orbit.itinerary, periods=orbit.period)


@pytest.mark.parametrize("seed", MISSED_BY_SEEDS)
def test_soft_stops_with_long_contacts(seed):
    orbit = drawn_case(seed).orbit
    found = again(orbit)
    assert found.ok and found.period == orbit.period and found.itinerary in 2 * orbit.itinerary


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [range(40), range(1000, 1060)], ids=["displacement", "force"])
def test_what_attracts_a_drawn_oscillator_is_found(seeds):
    cases = [case for case in map(drawn_case, seeds) if case is not None and len(case.orbit.itinerary) <= LONGEST]
    missed = [case.orbit for case in cases if not again(case.orbit).ok]
    assert not missed and len(cases) > 0.6 * len(seeds)
