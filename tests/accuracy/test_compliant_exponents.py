"""Exponents with compliant stops: of periodic orbits against eighty digits, and their sum against its exact value.

`python tests/accuracy/test_compliant_exponents.py FIRST LAST` compares the oscillators FIRST ... LAST - 1, and
`relaxing FIRST LAST` such that are touched while they relax; `sums FIRST LAST` computes such planes, a line for each;
tests/data/compliant_exponents.log is what they printed.
"""

import sys

import numpy as np
import pytest
from support import compliant_exponents, compliant_sums, slow_cases
from support.compliant_sums import MOST

import vibro_sweep as vs

ORBITS, RELAXING, PLANES = 200, 300, 200
WITHIN = 5  # times the stated error
LESS = 10  # times: the share of contact, a sum of many, is known to less


def hold(reports):
    for one in reports:
        assert np.all(one.errors <= WITHIN * one.stated), one
        assert np.all(one.multiplier_errors <= WITHIN * one.multipliers_stated), one


def test_exponents_of_an_orbit_against_eighty_digits():
    report = compliant_exponents.compared(0)
    assert report.period
    hold([report])


@pytest.mark.parametrize("masses, z, k, part", [
    (1, 2, 100, 0.04),
    *slow_cases((1, 1, 10, 0.2), (1, 3, 30, 0.1), (2, 2, 100, 0.1), (2, 3, 30, 0.2), (1, 1.5, 10, 0.294)),
])  # fmt: skip
def test_exponents_where_a_contact_shrinks_what_another_stop_keeps(masses, z, k, part):
    """Both stops are touched while they relax, and contacts shrink vectors to e^-100 that have moved the other stop.

    Of two of these oscillators the last multiplier is one of a complex pair whose other one is not in the spectrum, of
    as many exponents as there are states.
    """
    law = dict(k_stop=k, c_stop=2 * z * k**0.5, release="force", stops="both", b=0.5, omega=0.8, zeta=0.03)
    two = vs.System(mu_m=3, mu_k=2, f2=0.4, **law)
    system = vs.Oscillator.named("one_mass", k=1, F=1, tau=0.3, **law) if masses == 1 else two
    report = compliant_exponents.compared_at([part * vs.grazing(system).b_right], system)
    hold([report])
    assert report.period and report.relaxing
    assert report.stated.max() < 1e-11


@pytest.mark.slow
@pytest.mark.parametrize("seed", [105, 19, 127])
def test_exponents_where_vectors_find_no_directions(seed):
    """Of five multipliers three have nearly one modulus, or the orbit has only just found its period."""
    report = compliant_exponents.compared_relaxing(seed)
    hold([report])
    assert report.period and report.stated.max() < 1e-9


@pytest.mark.slow
def test_exponents_of_twenty_orbits(capsys):
    reports = [compliant_exponents.compared(seed) for seed in range(22)]
    with capsys.disabled():
        print("\n" + "\n".join(compliant_exponents.table(reports)))
    hold(reports)
    assert sum(one.period > 0 and one.stated.max() < 1e-9 for one in reports) >= 18


@pytest.mark.soak
def test_exponents_of_two_hundred_oscillators(capsys):
    reports = [compliant_exponents.compared(seed) for seed in range(ORBITS)]
    with capsys.disabled():
        print("\n" + "\n".join(compliant_exponents.table(reports)))
    hold(reports)


@pytest.mark.parametrize("count", [*slow_cases(20), pytest.param(RELAXING, marks=pytest.mark.soak)])
def test_exponents_with_stops_that_are_touched_while_they_relax(count):
    reports = [compliant_exponents.compared_relaxing(seed) for seed in range(count)]
    hold([one for one in reports if one.period])
    assert sum(one.period > 0 and one.relaxing > 0 for one in reports) >= count // 2


@pytest.mark.parametrize("seeds", [(1,), *slow_cases([0, *range(2, 16)])])
def test_sums_of_exponents(seeds):
    """As they are stored, and as the share of contact and the impacts of the file give them."""
    for report in map(compliant_sums.summed, seeds):
        assert report.worst < MOST and report.apart < LESS * MOST, report


@pytest.mark.parametrize("count", [*slow_cases(1, 20), pytest.param(RELAXING, marks=pytest.mark.soak)])
def test_sums_with_stops_that_are_touched_while_they_relax(count):
    """Motion has one multiplier more than states there; where it is one of a pair with the last one both count."""
    reports = [compliant_sums.summed_relaxing(seed) for seed in range(count)]
    assert max(worst for _, worst in reports) < 1, reports
    assert sum(counted for counted, _ in reports) > 40 * count


@pytest.mark.soak
def test_sums_of_two_hundred_planes():
    reports = [compliant_sums.summed(seed) for seed in range(PLANES)]
    assert max(one.worst for one in reports) < MOST and max(one.apart for one in reports) < LESS * MOST


if __name__ == "__main__":
    sums, (first, last) = sys.argv[1] == "sums", map(int, sys.argv[-2:])
    compared = {"sums": compliant_sums.summed, "relaxing": compliant_exponents.compared_relaxing}
    function = compared.get(sys.argv[1], compliant_exponents.compared)
    reports = []
    for seed in range(first, last):
        reports.append(function(seed))
        print(reports[-1], flush=True)
    print("\n".join((compliant_sums if sums else compliant_exponents).table(reports)))


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_exponents_where_a_rigid_stop_loses_dimensions(release):
    """R = 0 on the other side: -inf, and what a small difference decays by."""
    system = vs.Oscillator.named(
        "one_mass", k=2.385, zeta=0.013, F=0.2096, omega=1.52, R=0.0, k_stop_left=721.0, b=0.366, tau=0.0,
        release=release,
    )  # fmt: skip
    row = vs.sweep(system, {"omega": [1.52]}, transient=600, record=100).isel(omega=0)
    assert row.status == 0 and row.period == 1 and row.lyapunov[-1] == -np.inf
    start = vs.simulate(system, (0, 0), 600).section[-1]
    beside = vs.simulate(system, start + np.array([1e-6, 0.0]), 3).section - start
    decays = np.log(np.linalg.norm(beside[2]) / np.linalg.norm(beside[1])) / (2 * np.pi / system.omega)
    assert float(row.lyapunov[0]) == pytest.approx(decays, abs=1e-4)


@pytest.mark.slow
def test_exponents_where_a_mass_rests_on_the_rigid_stop():
    """After chatter: two dimensions are lost, and in the plane of the others small differences grow as they say."""
    system = vs.System(mu_m=1.2756, mu_k=1.8346, zeta=0.12786, f2=0, omega=1.9463, R=0.12, b=0.2294, k_stop_left=1745.5)
    row = vs.sweep(system, {"b": [0.2294]}, transient=600, record=100).isel(b=0)
    assert row.status == 0 and np.all(row.lyapunov[2:] == -np.inf)
    start = vs.simulate(system, (0, 0, 0, 0), 600).section[-1]
    beside = np.array([vs.simulate(system, start + 1e-6 * one, 2).section - start for one in np.eye(4)])
    once, twice = beside[:, 1], beside[:, 2]
    plane = np.linalg.svd(once)[2][:2]
    turned = np.linalg.lstsq(once @ plane.T, twice @ plane.T)[0]
    expected = np.log(np.abs(np.linalg.eigvals(turned))) * system.omega / (2 * np.pi)
    assert np.sort(row.lyapunov.values[:2]) == pytest.approx(np.sort(expected), abs=1e-3)
