"""Rests on a stop as users see them, and those that rounding decides; others: tests/cases/events.yaml."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.flights import Oscillator, Rest
from support import slow_cases

import vibro_sweep as vs

PAPER = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63)
ORIGIN = (0.0, 0.0, 0.0, 0.0)
# M2 swings some 1e5 rad while M1 rests; its rate lies far beyond what the cells resolve
LIGHT = [
    dict(mu_m=1e-6, mu_k=1.0, zeta=0.0, f2=0.0, omega=0.01, R=0.5, b=0.1, tau=0.5),
    dict(mu_m=1e-6, mu_k=1.0, zeta=0.0, f2=0.4, omega=0.01, R=0.5, b=0.1, tau=0.5),
    dict(mu_m=1e-5, mu_k=3.0, zeta=1e-7, f2=0.2, omega=0.02, R=0.5, b=0.1, tau=0.5),
    dict(mu_m=1e-3, mu_k=0.5, zeta=0.8, f2=0.5, omega=0.003, R=0.5, b=0.1, tau=0.5),
]


def test_a_fourth_of_the_time_at_rest():
    """R = 0.3, b = 0.5: 20 rests in 10 periods, 27.6 % of the time."""
    system = vs.System(**PAPER, R=0.3, b=0.5, tau=0.0)
    orbit = vs.simulate(system, ORIGIN, periods=10)
    assert len(orbit.sticking) == 20
    rest = (orbit.sticking["t_off"] - orbit.sticking["t_on"]).sum() / (10 * system.period)
    assert rest == pytest.approx(0.276, abs=0.001)
    assert "chatter" in orbit.status.note


def start_on_stop(state, **changes):
    system = vs.System(**{**PAPER, "R": 0.8, "b": 0.5, "tau": 0.0, **changes})
    orbit = vs.simulate(system, state, periods=2)
    exact = naive.simulate(system.parameters(), state, periods=2, digits=25)
    assert orbit.status == "ok"
    assert orbit.sticking["side"].tolist() == [rest.side for rest in exact.sticking]
    if exact.sticking:
        times = [[float(rest.t_on), float(rest.t_off)] for rest in exact.sticking]
        np.testing.assert_allclose(np.stack([orbit.sticking["t_on"], orbit.sticking["t_off"]], 1), times, atol=1e-10)
    # at an impact the start is given just before it, and the slow simulator's first section point is just after
    np.testing.assert_allclose(orbit.section[1:], np.array(exact.section, float)[1:], atol=1e-10)
    return orbit


@pytest.mark.parametrize("tau", [0.0, -1.0, 1.0])
@pytest.mark.parametrize("zeta", [0.0, 0.05])
def test_start_on_a_stop_with_the_spring_at_its_length(tau, zeta):
    """x1 = x2 = b at rest and no force on M1: the acceleration is exactly zero, and perhaps its derivative too."""
    start_on_stop((0.5, 0.0, 0.5, 0.0), mu_m=1.0, mu_k=1.0, zeta=zeta, f2=1.0, omega=1.0, tau=tau)


def test_resting_over_the_section():
    """A rest that spans t = 0 mod T is one rest, and M1 is on the stop there."""
    parameters = dict(**PAPER, R=0.3, b=0.5)
    orbit = vs.simulate(vs.System(**parameters), ORIGIN, periods=6)
    t_on, t_off = orbit.sticking["t_on"][4], orbit.sticking["t_off"][4]
    omega = PAPER["omega"]
    tau = math.remainder(vs.System(**parameters).phase + omega * (t_on + t_off) / 2, 2 * math.pi)
    system = vs.System(**parameters, tau=tau)  # the section moves to the middle of this rest
    state = orbit.sample([(t_on + t_off) / 2])[0]
    state[:2] = math.copysign(0.5, state[0]), 0.0
    orbit = vs.simulate(system, state, periods=4)
    exact = naive.simulate(system.parameters(), state, periods=4, digits=25)
    assert len(orbit.sticking) == len(exact.sticking)
    for rest, found in zip(exact.sticking, orbit.sticking, strict=True):
        assert abs(float(rest.t_on) - found["t_on"]) < 1e-10
        assert abs(float(rest.t_off) - found["t_off"]) < 1e-10
    spanning = [
        (r["t_on"], r["t_off"]) for r in orbit.sticking if r["t_on"] // system.period < r["t_off"] // system.period
    ]
    assert len(spanning) > 1
    at_rest = np.abs(orbit.section[:, 0]) == 0.5
    assert at_rest.sum() >= len(spanning)
    assert (orbit.section[at_rest, 1] == 0.0).all()
    np.testing.assert_allclose(orbit.sample(orbit.section_times[1:3]), orbit.section[1:3], atol=1e-12)


def test_sampled_rest():
    orbit = vs.simulate(vs.System(**PAPER, R=0.3, b=0.5), ORIGIN, periods=3)
    assert len(orbit.sticking) == 6
    for rest in orbit.sticking:
        times = np.linspace(rest["t_on"], rest["t_off"], 30)[1:-1]
        assert (orbit.sample(times)[:, :2] == (0.5 * rest["side"], 0.0)).all()


def test_sticking_time_and_exponents_in_a_file(tmp_path):
    system = vs.System(**PAPER, R=0.3, b=0.5)
    text = (
        f"system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.3, b: 0.5, tau: {system.phase!r}}}\n"
        "start: {x1: 0, v1: 0, x2: 0, v2: 0}\n"
        "orbit: {transient: 0, record: 20}\n"
        "observe: [section, impacts, lyapunov]\n"
    )
    (tmp_path / "rest.yaml").write_text(text)
    vs.run(vs.load_scene(tmp_path / "rest.yaml"), tmp_path / "rest.h5")
    orbit = vs.simulate(system, ORIGIN, periods=20)
    with vs.open(tmp_path / "rest.h5") as data:
        total = (orbit.sticking["t_off"] - orbit.sticking["t_on"]).sum()
        assert float(data["sticking_time"]) == pytest.approx(total, rel=1e-12)
        assert np.isneginf(data["lyapunov"].values[-2:]).all()
        assert np.isfinite(data["lyapunov"].values[:2]).all()


@pytest.mark.parametrize("R", [0.0, 0.3])
def test_exponents_lost_by_resting(R):
    exponents = vs.lyapunov(vs.System(**PAPER, R=R, b=0.5), ORIGIN, transient=200, record=400)
    assert np.isfinite(exponents[:2]).all()
    assert np.isneginf(exponents[2:]).all()
    assert exponents[0] >= exponents[1]


@pytest.mark.parametrize("R", [1e-12, 1e-50, 1e-100, 1e-200, 1e-300])
def test_a_restitution_next_to_none(R):
    """What R leaves of the speed is below all rounding: impacts as with R = 0."""
    system = vs.System(**PAPER, R=R, b=0.3)
    orbit = vs.simulate(system, ORIGIN, 50)
    plain = vs.simulate(system.replace(R=0.0), ORIGIN, 50)
    assert orbit.status == "ok" and len(orbit.sticking) == len(plain.sticking) > 50
    np.testing.assert_allclose(orbit.section, plain.section, atol=1e-9)


def test_exponents_of_a_rest_that_outlasts_the_record():
    """Resting from before the record on, M2 is a damped oscillator alone: eta = zeta (1 + mu_k)/mu_m, twice."""
    system = vs.System(mu_m=1000, mu_k=0.01, zeta=0.05, f2=0, omega=1, R=0.8, b=1)
    exponents = vs.lyapunov(system, (0.0, 0.0, 5.0, 0.0), transient=3, record=3)
    np.testing.assert_allclose(exponents[:2], -0.05 * 1.01 / 1000, rtol=1e-9)
    assert np.isneginf(exponents[2:]).all()


@pytest.mark.slow
@pytest.mark.parametrize("numbers", [LIGHT[0], *slow_cases(*LIGHT[1:])])
def test_a_light_mass_while_the_other_rests(numbers):
    """At the release the exact pull on M1 is zero, but for a few roundings of the time: until then M2 may turn through
    10^5 radians, in 10^6 series."""
    system = vs.System(**numbers)
    x2 = 0.08
    rest = vs.simulate(system, (system.b, 0.0, x2, 0.0), periods=1).sticking[0]
    assert rest["t_on"] == 0.0 and rest["t_off"] > 0.3 * system.period
    with mp.workdps(40):
        alone = Rest(Oscillator(numbers), mpf(0), mpf(system.b), mpf(x2), mpf(0))
        pull, slope = alone.pull.derivatives(mpf(rest["t_off"]), 2)
    assert abs(pull) <= 16 * 2.0**-53 * (1.0 + abs(slope) * rest["t_off"])
