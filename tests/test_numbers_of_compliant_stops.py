"""Numbers of compliant stops: which are refused, and which follow from others."""

import math

import pytest
from support.soft_stops import ELASTIC, PAPER, one_mass

import vibro_sweep as vs
from vibro_sweep.scene import SceneError, parse_scene


@pytest.mark.parametrize(
    "numbers, key",
    [
        (dict(k_stop=-1), "k_stop"),
        (dict(k_stop=0), "k_stop"),
        (dict(k_stop=math.inf), "k_stop"),
        (dict(k_stop="stiff"), "k_stop"),
        (dict(k_stop=10, R=0.5), "k_stop"),
        (dict(R=0.5, R_left=0.5, k_stop_left=3), "k_stop_left"),
        (dict(k_stop=10, c_stop=-1), "c_stop"),
        (dict(k_stop=10, preload=-1), "preload"),
        (dict(R=0.5, preload=1), "preload"),
        (dict(R=0.5, c_stop=1), "c_stop"),
        (dict(R=0.5, preload_left=1), "preload_left"),
        (dict(k_stop=10, R_left=0.5, c_stop_left=1), "c_stop_left"),
        (dict(R=0.5, release="force"), "release"),
        (dict(k_stop=10, release="speed"), "release"),
        (dict(k_stop=10, release=None), "release"),
        ({}, "R"),
        (dict(preload=1), "R"),
        (dict(c_stop=1, release="force"), "R"),
    ],
)
def test_numbers_that_do_not_fit(numbers, key):
    for make in (
        lambda: vs.System(**PAPER, b=4, **numbers),
        lambda: one_mass(**{**ELASTIC, "stops": "both"}, **numbers),
    ):
        with pytest.raises(vs.ParameterError) as caught:
            make()
        assert caught.value.key == key


SOFT = (
    "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, b: 5, k_stop: 100}\n"
    + "orbit: {transient: 1, record: 1}\n"
)


@pytest.mark.parametrize(
    "more, key",
    [
        ("dynamics: map\n", "dynamics"),
        ("section: {kind: impact, stop: right}\n", "section.stop"),
        ("sweep: {R: {values: [0.5]}}\n", "k_stop"),
        ("sweep: {k_stop: {values: [0, 1]}}\n", "sweep.k_stop"),
    ],
)
def test_scenes_that_are_refused(more, key):
    with pytest.raises(SceneError) as caught:
        parse_scene(SOFT + more)
    assert any(key in line for line in caught.value.problems)
    with pytest.raises(SceneError, match="rigid"):
        parse_scene(SOFT.replace("k_stop: 100", "R: 0.8") + "observe: [contacts]\n")


@pytest.mark.parametrize(
    "call",
    [
        lambda one: vs.born_at_grazing(one),
        lambda one: vs.discontinuity_map(one),
    ],
)
def test_what_belongs_to_rigid_stops_says_so(call):
    with pytest.raises(ValueError, match=r"(of|with) rigid stops"):
        call(vs.System(**PAPER, b=5, k_stop=100))


def test_numbers_follow_those_of_the_right_stop():
    system = vs.System(**PAPER, b=5, k_stop=100, c_stop=1)
    assert system.linear.symmetric and system.parameters()["k_stop_left"] == 100
    mixed = system.replace(R_left=0.5)
    assert (mixed.linear.k_low, mixed.linear.R_low, mixed.linear.k_high) == (0, 0.5, 100)
    assert "k_stop_left" not in mixed.parameters()
    physical = vs.System.physical(
        M1=2, M2=20, K1=800, K2=4000, C1=4, C2=20, P1=10, P2=0, Omega=12.6, B=0.05, k_stop=8e5, c_stop=40, preload=5
    )
    assert (physical.k_stop, physical.c_stop, physical.preload) == pytest.approx((1000, 1.0, 0.5))
