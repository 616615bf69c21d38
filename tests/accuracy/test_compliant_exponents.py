"""Exponents with compliant stops: of periodic orbits against eighty digits, and their sum against its exact value."""

import numpy as np
import pytest
from support import compliant_exponents, compliant_sums, slow_cases
from support.searching import searched

import vibro_sweep as vs


def test_exponents_of_an_orbit_against_eighty_digits():
    counted, wrong = compliant_exponents.study(0)
    assert wrong == [] and counted["orbits"] == 1


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
    assert compliant_exponents.reported(report).wrong == []
    assert report.period and report.relaxing
    assert report.stated.max() < 1e-11


@pytest.mark.slow
@pytest.mark.parametrize("seed", [105, 19, 127])
def test_exponents_where_vectors_find_no_directions(seed):
    """Of five multipliers three have nearly one modulus, or the orbit has only just found its period."""
    counted, wrong = compliant_exponents.study_of_relaxing(seed)
    assert wrong == [] and counted["precise"] == 1


@pytest.mark.slow
def test_exponents_of_eight_orbits_and_one_of_stiff_contacts():
    counted, wrong = searched(compliant_exponents.study, [*range(1, 9), 38])
    assert wrong == [] and counted["precise"] >= 7


@pytest.mark.slow
def test_exponents_with_stops_that_are_touched_while_they_relax():
    counted, wrong = searched(compliant_exponents.study_of_relaxing, range(8))
    assert wrong == [] and counted["relaxing"] >= 4


@pytest.mark.parametrize("seeds", [[1], *slow_cases([0, *range(2, 16)])], ids=len)
def test_sums_of_exponents(seeds):
    counted, wrong = searched(compliant_sums.study, seeds)
    assert wrong == [] and counted["counted"] > 10 * len(seeds)


@pytest.mark.parametrize("count", slow_cases(1, 6))
def test_sums_with_stops_that_are_touched_while_they_relax(count):
    counted, wrong = searched(compliant_sums.study_of_relaxing, range(count))
    assert wrong == [] and counted["points"] > 40 * count


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


@pytest.mark.parametrize("k", [5.742e6, 1e8])
def test_stiff_contacts_keep_the_digits_of_vectors(k):
    """What a contact makes of delta' is small at the release: known to the rate in contact times 2^-53 alone, it would
    move these exponents by 1e-14 to 1e-13 where the stiffness is rounded."""
    system = vs.System(mu_m=10, mu_k=5, zeta=0.02, f2=0.1, omega=0.63, b=3, tau=0.3, k_stop=k)
    found = [
        np.asarray(vs.lyapunov(system.replace(k_stop=k * part), [0.1, 0.4, 0, 0.2], 4, 6))
        for part in (1, 1 + 2.0**-52, 1 - 2.0**-52)
    ]
    assert np.abs(np.array(found[1:]) - found[0]).max() < 3e-15


@pytest.mark.slow
def test_exponents_where_both_numbers_of_a_plane_move_the_gap():
    """A damper alone holds the second mass. Beside a compliant stop that is never reached impacts are those without."""
    machine = dict(m=[1.0, 1.5], k=[1.0, 0.0, 0.0], c=[0.02, 0.3, 0.0], force=[1.0, 0.0], omega=0.8)
    alone = vs.Oscillator.named("chain", **machine, b=0.4, R=0.8, stops="right")
    beside = vs.Oscillator.named(
        "chain", **machine, stop_right=0.4, stop_left=-50.0, R=0.8, R_left=None, k_stop_left=100
    )
    one, other = (vs.lyapunov(system, None, 300, 300) for system in (alone, beside))
    assert np.abs(one - other).max() <= (one.error + other.error).max() < 1e-9 and one[1] < -0.2
