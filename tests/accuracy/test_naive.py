"""The slow simulator against what is known without it: a general ODE solver, and exact identities."""

import json

import pytest
from mpmath import mp, mpf
from reference import naive
from reference.flow import matrix_of
from reference.gmp import expm
from reference.machine import machine_of
from support import slow_cases

PAPER = {**naive.PAPER, "b": 6.6, "tau": 2.2}
START = (1.0, 0.5, -0.3, 0.2)


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(40):
        yield


def equations(params):
    """Right-hand sides (of free flight, of rest on a stop), as one writes them on paper."""
    mu_m, mu_k, zeta, f2, omega, _, _, tau = (mpf(params[name]) for name in naive.NAMES)

    def accelerations(t, y):
        x1, v1, x2, v2 = y
        link = x1 - x2 + 2 * zeta * (v1 - v2)
        ground = mu_k * (x2 + 2 * zeta * v2)
        force = mp.sin(omega * t + tau)
        return (1 - f2) * force - link, (f2 * force + link - ground) / mu_m

    def free(t, y):
        a1, a2 = accelerations(t, y)
        return [y[1], a1, y[3], a2]

    def stuck(t, y):
        return [0, 0, y[3], accelerations(t, y)[1]]

    return free, stuck


def solve(rhs, t, y, until):
    with mp.workdps(25):
        return mp.odefun(rhs, t, [mpf(x) for x in y])(until)


def distance(a, b):
    return max(abs(x - y) for x, y in zip(a, b, strict=True))


@pytest.mark.parametrize("zeta", [0.0, 0.05, 40.0])
@pytest.mark.parametrize("u", [0, 1e-3, 20, 500])
def test_exponential_of_a_matrix_as_mpmath_has_it(zeta, u):
    A = matrix_of(machine_of(naive.linear_of(PAPER | {"zeta": zeta}))) * u
    with mp.workdps(80):
        exact = mp.expm(A)
    assert mp.mnorm(expm(A) - exact) <= mpf("1e-39") * mp.mnorm(exact)


@pytest.mark.parametrize("recorded", json.loads(naive.REFERENCE.read_text()), ids=lambda one: f"b={one['params']['b']}")
def test_recorded_impacts(recorded):
    """They were computed by another simulator, in gmpy2."""
    impacts = naive.simulate(recorded["params"], recorded["state"], impacts=naive.COUNT).impacts
    assert [hit.side for hit in impacts] == recorded["side"] and len(impacts) == naive.COUNT
    for field in naive.FIELDS:
        exact = [mpf(one) for one in recorded["impacts"][field]]
        assert distance([getattr(hit, field) for hit in impacts], exact) < mpf("1e-24") * max(map(abs, exact))


def test_grazing_of_the_paper():
    b, tau = naive.grazing(PAPER)
    assert mp.nstr(b, 15) == "6.70571674097302"
    assert mp.nstr(tau, 13) == "2.229306509033"


@pytest.mark.parametrize("changes", [{}, *slow_cases({"zeta": 1.5, "f2": 0.7, "mu_m": 0.5})])
def test_free_flight_as_an_ode_solver_has_it(changes):
    params = {**PAPER, **changes, "b": 100, "omega": 2.0}
    section = naive.simulate(params, START, periods=1, start_time=mp.pi).section
    assert distance(section[1], solve(equations(params)[0], mp.pi, START, 2 * mp.pi)) < mpf("1e-22")


@pytest.mark.slow
def test_impacts_as_an_ode_solver_has_them():
    params = {**PAPER, "b": 1.5, "f2": 0.2}
    orbit = naive.simulate(params, START, impacts=4)
    assert {hit.side for hit in orbit.impacts} == {1, -1}
    t, y = mpf(0), START
    for hit in orbit.impacts:
        y = solve(equations(params)[0], t, y, hit.t)
        assert distance(y, (hit.side * mpf(1.5), *hit[2:])) < mpf("1e-20")
        t, y = hit.t, (y[0], -mpf(params["R"]) * y[1], *y[2:])


def test_conservative_motion_runs_backwards():
    params = {**PAPER, "b": 2.0, "zeta": 0.0, "R": 1.0, "f2": 0.3}
    forth = naive.simulate(params, START, periods=5)
    x1, v1, x2, v2 = forth.section[-1]
    reflected = mp.pi - params["tau"]  # sin(omega (5 T - t) + tau) = sin(omega t + pi - tau)
    back = naive.simulate({**params, "tau": reflected}, (x1, -v1, x2, -v2), periods=5)
    assert len(forth.impacts) > 5
    assert [hit.side for hit in back.impacts] == [hit.side for hit in forth.impacts][::-1]
    assert distance(back.section[-1], (1.0, -0.5, -0.3, -0.2)) < mpf("1e-30")


@pytest.mark.parametrize("depth", ["1e-6", "1e-20", "1e-32", "-1e-32"])
def test_graze_of_the_steady_motion(depth):
    """x1 = b* cos(omega t) reaches b at omega t = -arccos(b/b*) with the speed omega sqrt(b*^2 - b^2)."""
    omega = mpf(PAPER["omega"])
    b_star, tau = naive.grazing(PAPER)
    b = b_star - mpf(depth)
    amplitudes = naive.response(PAPER)
    turned = [x * mp.expj(tau - mp.pi / 2) for x in amplitudes]  # a quarter of a period before the graze
    start = [part for x in turned for part in (x.imag, omega * x.real)]
    params = {**PAPER, "b": b, "tau": tau, "stops": "right"}
    impacts = naive.simulate(params, start, periods=0.5, start_time=-mp.pi / (2 * omega)).impacts
    if mpf(depth) < 0:
        assert not impacts
    else:
        assert abs(impacts[0].t + mp.acos(b / b_star) / omega) < mpf("1e-20")
        assert abs(impacts[0].v1 / (omega * mp.sqrt(b_star**2 - b**2)) - 1) < mpf("1e-5")


@pytest.mark.slow
def test_chatter_ends_in_sticking():
    params = {**PAPER, "b": 0.3, "R": 0.2, "omega": 0.5, "mu_m": 3.0}
    orbit = naive.simulate(params, (0, 0, 0, 0), periods=0.8)
    t_on, t_off, side = orbit.sticking[0]
    chatter = [hit for hit in orbit.impacts if hit.t < t_on]
    assert abs(chatter[-1].v1 / chatter[-2].v1 - mpf(0.2)) < mpf("1e-15")
    assert 0 < t_on - chatter[-1].t < mpf("1e-19")

    # At rest only M2 moves; M1 is released where its free acceleration changes sign.
    free, stuck = equations(params)
    y = solve(stuck, t_on, (side * mpf(0.3), 0, chatter[-1].x2, chatter[-1].v2), t_off)
    assert abs(free(t_off, y)[1]) < mpf("1e-18")
    assert side * free(t_off - 1, y)[1] > 0
    y = solve(free, t_off, y, t_off + 1)
    assert side * y[0] < 0.3

    other = naive.simulate(params, (0, 0, 0, 0), periods=0.8, digits=60).sticking
    assert len(other) == len(orbit.sticking)
    assert all(distance(p, q) < mpf("1e-30") for p, q in zip(orbit.sticking, other, strict=True))


def test_starts_on_a_stop():
    params = {**PAPER, "b": 1.0}
    against = naive.simulate(params, (1.0, 0.5, 0, 0), impacts=1, start_time=2).impacts[0]
    assert (against.t, against.side, against.v1) == (2, 1, 0.5)
    pressed = naive.simulate(params, (1.0, 0, 5.0, 0), periods=0.1)
    assert not pressed.impacts and pressed.sticking[0].t_on == 0
    drawn = naive.simulate(params, (1.0, 0, -5.0, 0), periods=0.05)
    assert not drawn.impacts and not drawn.sticking and drawn.section[0] == (1, 0, -5, 0)
    with pytest.raises(ValueError, match="behind a stop"):
        naive.simulate({**params, "stops": "left"}, (-1.1, 0, 0, 0), periods=1)
