"""Numbers of stops that follow from others."""

import pytest

import vibro_sweep as vs

PAPER = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63)


def test_the_left_stop_has_the_numbers_of_the_right_one():
    system = vs.System(**PAPER, b=5, k_stop=100, c_stop=1)
    assert system.linear.symmetric and system.parameters()["k_stop_left"] == 100
    mixed = system.replace(R_left=0.5)
    assert (mixed.linear.contact.k_low, mixed.linear.contact.R_low, mixed.linear.contact.k_high) == (0, 0.5, 100)
    assert "k_stop_left" not in mixed.parameters()


def test_physical_numbers_of_a_compliant_stop():
    physical = vs.System.physical(
        M1=2, M2=20, K1=800, K2=4000, C1=4, C2=20, P1=10, P2=0, Omega=12.6, B=0.05, k_stop=8e5, c_stop=40, preload=5
    )
    assert (physical.k_stop, physical.c_stop, physical.preload) == pytest.approx((1000, 1.0, 0.5))


def test_an_oscillator_that_is_replaced_stays_as_it_was():
    before = vs.Oscillator(
        [[1, 0], [0, 2]], [[2, -1], [-1, 3]], force=[1, 0], contact_normal=[1, 0], omega=0.7, b=1, R=0.8
    )
    assert before.replace(force2=3.0).force == (1.0, 3.0) and before.force2 == 0.0
