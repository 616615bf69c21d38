"""Chatter, rest on a stop, and release, against the slow simulator."""

import math
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.flights import Oscillator, Rest
from support import slow_cases

import vibro_sweep as vs

PAPER = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63)
ORIGIN = (0.0, 0.0, 0.0, 0.0)
# (system, start, forcing periods): the paper's oscillator between near stops, then others, drawn at random
NEAR = [
    (dict(**PAPER, R=R, b=b), (x * b, 0.0, 0.0, 0.0), 4)
    for R, b, x in [
        (0.05, 0.2, 0.0), (0.05, 1.0, 0.0), (0.1, 0.3, 0.5), (0.2, 0.5, 0.0), (0.2, 1.5, 0.0), (0.3, 0.5, 0.0),
        (0.3, 0.5, -0.4), (0.3, 1.2, 0.0), (0.4, 0.2, 0.0), (0.4, 0.8, 0.3), (0.5, 0.2, 0.0), (0.6, 0.2, 0.0),
    ]
]  # fmt: skip
PERIODIC = [(dict(**PAPER, R=R, b=b, tau=0.0), None, 3) for R, b in [(0.1, 0.8), (0.2, 0.5), (0.3, 0.5), (0.35, 0.4)]]
OTHERS = [
    (dict(mu_m=mu_m, mu_k=mu_k, zeta=zeta, f2=f2, omega=omega, R=R, b=b, tau=tau), ORIGIN, 4)
    for mu_m, mu_k, zeta, f2, omega, R, b, tau in [
        (2.0, 3.0, 0.02, 0.0, 0.5, 0.3, 0.4, 0.0), (0.5, 1.0, 0.1, 0.3, 0.8, 0.2, 0.3, 1.0),
        (1.0, 1.0, 0.01, 0.5, 0.4, 0.4, 0.5, 2.0), (5.0, 2.0, 0.2, 0.0, 0.3, 0.5, 0.3, -1.0),
        (3.0, 0.5, 0.0, 0.1, 0.7, 0.1, 0.5, 0.5), (1.0, 4.0, 0.5, 0.0, 1.0, 0.3, 0.2, 3.0),
        (10.0, 1.0, 0.05, 0.9, 0.2, 0.3, 0.3, 0.0), (0.3, 6.0, 0.03, 0.2, 0.6, 0.25, 0.2, -2.0),
        (4.0, 4.0, 1.0, 0.0, 0.5, 0.35, 0.25, 1.5), (2.0, 2.0, 0.07, 0.4, 0.9, 0.05, 0.1, 0.3),
        (8.0, 3.0, 0.05, 0.0, 0.35, 0.6, 0.4, -0.7), (1.5, 5.0, 0.04, 0.0, 0.45, 0.0, 0.3, 0.0),
    ]
]  # fmt: skip
CASES = NEAR + PERIODIC + OTHERS
# M2 swings some 1e5 rad while M1 rests; its rate lies far beyond what the cells resolve
LIGHT = [
    dict(mu_m=1e-6, mu_k=1.0, zeta=0.0, f2=0.0, omega=0.01, R=0.5, b=0.1, tau=0.5),
    dict(mu_m=1e-6, mu_k=1.0, zeta=0.0, f2=0.4, omega=0.01, R=0.5, b=0.1, tau=0.5),
    dict(mu_m=1e-5, mu_k=3.0, zeta=1e-7, f2=0.2, omega=0.02, R=0.5, b=0.1, tau=0.5),
    dict(mu_m=1e-3, mu_k=0.5, zeta=0.8, f2=0.5, omega=0.003, R=0.5, b=0.1, tau=0.5),
]


def compare(case, digits=30):
    """Hold one orbit against the slow simulator. Returns the number of rests and the largest error of their times.

    Without a start it is the periodic orbit, with a rest in every period, that the orbit from the origin settles on.
    """
    parameters, state, periods = case
    system = vs.System(**parameters)
    if state is None:
        *_, before, state = vs.simulate(system, ORIGIN, periods=400).section
        assert np.abs(state - before).max() < 1e-12
    orbit = vs.simulate(system, state, periods=periods)
    assert orbit.status == "ok"
    exact = naive.simulate(system.parameters(), state, periods=periods, digits=digits)
    assert [rest.side for rest in exact.sticking] == orbit.sticking["side"].tolist()
    worst = 0.0
    for rest, found in zip(exact.sticking, orbit.sticking, strict=True):
        worst = max(worst, abs(float(rest.t_on - found["t_on"])), abs(float(rest.t_off - found["t_off"])))
    # Chatter lists fewer impacts than the slow simulator: what it leaves out lies just before a rest.
    onsets = [float(rest.t_on) for rest in exact.sticking]
    listed = iter(orbit.impacts)
    hit = next(listed, None)
    for p in exact.impacts:
        if hit is not None and abs(float(p.t) - hit["t"]) < 1e-9 and p.side == hit["side"]:
            assert abs(float(p.v1) - hit["v1"]) < 1e-9
            hit = next(listed, None)
        else:
            before = min((t - float(p.t) for t in onsets if t >= float(p.t) - 1e-9), default=math.inf)
            assert before < 1e-4, f"an impact at t = {float(p.t)} is missing"
    assert hit is None, "an impact is invented"
    section = np.array([[float(x) for x in y] for y in exact.section])
    assert np.abs(orbit.section - section).max() < 1e-9 * max(1.0, np.abs(section).max())
    return len(exact.sticking), worst


@pytest.mark.parametrize("place", [1, 13, *slow_cases(5, 18)])
def test_rests(place):
    rests, worst = compare((*CASES[place][:2], 2))
    assert rests > 0
    assert worst < 1e-10


@pytest.mark.slow
def test_rests_of_many_systems(capsys):
    with ProcessPoolExecutor(2) as pool:
        results = list(pool.map(compare, CASES))
    with capsys.disabled():
        print("\n  R    b    omega  rests  largest error of their times")
        for (p, _, _), (rests, worst) in zip(CASES, results, strict=True):
            print(f"{p['R']:5.2f} {p['b']:5.2f} {p['omega']:5.2f} {rests:6d}  {worst:.1e}")
    assert sum(rests > 0 for rests, _ in results) >= 24
    assert max(worst for _, worst in results) < 1e-10


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


@pytest.mark.parametrize("side", [1, -1])
def test_start_on_a_stop(side):
    tau = 0.0 if side > 0 else math.pi
    into = start_on_stop((0.5 * side, 0.3 * side, 0.2 * side, 0.1), tau=tau)
    assert into.impacts[0]["t"] == 0.0
    assert into.impacts[0]["v1"] == 0.3 * side
    resting = start_on_stop((0.5 * side, 0.0, 2.0 * side, 0.0), tau=tau)
    assert resting.sticking[0]["t_on"] == 0.0
    assert not (resting.impacts["t"] == 0.0).any()
    free = start_on_stop((0.5 * side, 0.0, -1.0 * side, 0.0), tau=tau)
    assert not (free.sticking["t_on"] == 0.0).any()
    assert not (free.impacts["t"] == 0.0).any()
    away = start_on_stop((0.5 * side, -0.3 * side, 0.2 * side, 0.1), tau=tau)
    assert not (away.impacts["t"] == 0.0).any()


@pytest.mark.parametrize("tau", [0.0, -1.0, 1.0])
@pytest.mark.parametrize("zeta", [0.0, 0.05])
def test_start_on_a_stop_with_the_spring_at_its_length(tau, zeta):
    """x1 = x2 = b at rest and no force on M1: the acceleration is exactly zero, and perhaps its derivative too."""
    start_on_stop((0.5, 0.0, 0.5, 0.0), mu_m=1.0, mu_k=1.0, zeta=zeta, f2=1.0, omega=1.0, tau=tau)


def test_start_in_the_middle_of_a_period():
    parameters = dict(**PAPER, R=0.3, b=0.5, tau=0.3)
    system = vs.System(**parameters)
    orbit = vs.simulate(system, (0.5, 0.0, 2.0, 0.0), periods=1, start_time=3.25)
    exact = naive.simulate(parameters, (0.5, 0.0, 2.0, 0.0), periods=2, start_time=3.25, digits=25)
    assert orbit.sticking[0]["t_on"] == 3.25
    assert abs(orbit.sticking[0]["t_off"] - float(exact.sticking[0].t_off)) < 1e-10


@pytest.mark.parametrize("b", [0.2, 1.0])
def test_no_restitution(b):
    """R = 0: an impact with the acceleration into the stop is the onset of a rest."""
    rests, worst = compare((dict(**PAPER, R=0.0, b=b), ORIGIN, 3))
    assert rests > 0
    assert worst < 1e-10


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


# M1 leaves a stop without speed (a start at rest on it, release after a rest, R = 0) and soon reaches the other one.
DEPARTURES = [
    (dict(**PAPER, R=0.8, b=0.02, tau=0.0), (0.02, 0.0, -1.0, 0.0)),
    *((dict(**PAPER, R=0.5, b=b, tau=0.3), (b, 0.0, -0.2, -0.3)) for b in (1e-3, 1e-4, 1e-6, 1e-9)),
    *((dict(**PAPER, R=0.0, b=b, tau=2.5), (-b, 0.0, 0.3, 0.1)) for b in (1e-2, 1e-4, 1e-6)),
    (
        dict(mu_m=8.553, mu_k=0.187, zeta=0.00246, f2=0.910, omega=0.3737, R=0.0, b=0.19, tau=0.0),
        (0.19, 0.0, -1.0, 0.3),
    ),
]


@pytest.mark.parametrize("case", DEPARTURES)
def test_the_opposite_stop_is_seen_from_the_start(case):
    parameters, state = case
    orbit = vs.simulate(vs.System(**parameters), state, periods=1)
    exact = naive.simulate(parameters, state, impacts=2, digits=30).impacts
    assert orbit.status == "ok" and len(exact) == 2
    for found, hit in zip(orbit.impacts, exact, strict=False):
        assert found["side"] == hit.side
        assert abs(found["t"] - float(hit.t)) < 1e-13 * max(1.0, float(hit.t))
        assert abs(found["v1"] - float(hit.v1)) < 1e-11 * abs(float(hit.v1)) + 1e-14


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
    """At the release the exact pull on M1 is zero, but for the rounding of the time."""
    system = vs.System(**numbers)
    x2 = 0.08
    rest = vs.simulate(system, (system.b, 0.0, x2, 0.0), periods=1).sticking[0]
    assert rest["t_on"] == 0.0 and rest["t_off"] > 0.3 * system.period
    with mp.workdps(40):
        alone = Rest(Oscillator(numbers), mpf(0), mpf(system.b), mpf(x2), mpf(0))
        pull, slope = alone.pull.derivatives(mpf(rest["t_off"]), 2)
    assert abs(pull) <= 2.0**-53 * (1.0 + abs(slope) * rest["t_off"])
