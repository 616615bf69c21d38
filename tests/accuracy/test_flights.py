"""The exact flights of the search against the slow simulator and known zeros; contacts of high order."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.exponentials import Exponentials
from reference.flights import Flight, Oscillator, Rest, taylor
from reference.flow import FREE, HELD, matrix_of
from reference.follow import DIGITS, Follower
from reference.gmp import expm
from reference.machine import machine_of
from support import sample

import vibro_sweep as vs

SYSTEMS = [
    dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=1.0, tau=0.3),
    dict(mu_m=0.5, mu_k=1.0, zeta=0.7, f2=0.4, omega=1.3, R=0.5, b=0.2, tau=-1.0),  # one mode overdamped
    dict(mu_m=1e-3, mu_k=2.0, zeta=0.0, f2=1.0, omega=2.0, R=0.3, b=0.1, tau=2.0),
    dict(mu_m=3.0, mu_k=0.1, zeta=8.0, f2=0.2, omega=0.4, R=0.9, b=0.3, tau=0.0),  # both overdamped
]
STATE = (0.05, 0.3, -0.2, 0.1)


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(DIGITS):
        yield


@pytest.mark.parametrize("params", SYSTEMS, ids=str)
def test_motion_solves_the_equations(params):
    """Closed forms of flight and rest against exponentials of the whole system."""
    o, t, u = Oscillator(params), mpf(2), mpf("0.7")
    machine = machine_of(naive.linear_of(params))
    free, stuck = matrix_of(machine), matrix_of(machine, (HELD, FREE))
    turn = o.turn(t)
    y = mp.matrix([*map(mpf, STATE), turn.imag, turn.real, 1])
    exact = expm(free * u) * y
    at = Flight(o, t, y[:4]).at(u)
    assert max(abs(at[i] - exact[j]) for i, j in ((0, 0), (1, 1), (3, 2), (4, 3))) < mpf("1e-45")
    y[0], y[1] = mpf(params["b"]), mpf(0)
    exact = expm(stuck * u) * y
    rest = Rest(o, t, y[0], y[2], y[3])
    assert abs(rest.x2.derivatives(u, 2)[1] - exact[3]) < mpf("1e-45")
    pull = (free * exact)[1]
    assert abs(rest.pull.derivatives(u, 1)[0] - pull) < mpf("1e-45")


@pytest.mark.parametrize("params", sample(1, SYSTEMS), ids=str)
def test_impacts_as_the_slow_simulator_has_them(params):
    """Its impacts pass for an engine's, and one moved, left out or added does not."""
    state = tuple(params["b"] * x for x in STATE)
    orbit = naive.simulate(params, state, impacts=6, periods=20, digits=30)
    hits = [(float(p.t), p.side, float(p.v1), float(p.x2), float(p.v2)) for p in orbit.impacts]
    rests = [(float(r.t_on), float(r.t_off), r.side) for r in orbit.sticking]
    assert len(hits) >= 3

    def follow(impacts):
        follower = Follower({**params, "stops": "both"}, mpf(2) ** -50)
        follower.follow(0.0, state, impacts, rests, None, 3)
        return follower.found

    found = follow(hits)
    assert not found.defects and found.checked >= 3 and max(e[0] for e in found.errors.values()) < 2
    assert follow(hits[1:]).defects
    late = [(hits[0][0] * (1 + 1e-4), *hits[0][1:]), *hits[1:]]
    assert follow(late).defects
    t, side, *rest = hits[0]
    assert follow([(t / 2, side, *rest), *hits]).defects
    inexact = [(*hits[0][:2], hits[0][2] * (1 + 1e-12), *hits[0][3:]), *hits[1:]]
    assert max(e[0] for e in follow(inexact).errors.values()) > 100


@pytest.mark.parametrize("depth", ["1e-3", "1e-12", "1e-30", "0", "-1e-30", "-1e-3"])
@pytest.mark.parametrize("swings", [1, 1000])
def test_first_zero_of_a_known_function(depth, swings):
    """1 - depth + cos(swings u), to which a fast term of next to no size is added: zero where cos = depth - 1."""
    depth = mpf(depth)
    f = Exponentials([1 - depth, mpf(1), mpf("1e-50")], [mpf(0), mp.mpc(0, swings), mp.mpc(-1, 10**7)])
    u = f.first_zero(mpf(0), 8 * mp.pi / swings)
    if depth > 0:
        assert abs(u - mp.acos(depth - 1) / swings) < mpf("1e-30")
    elif depth < 0:
        assert u is None


def contact_of_order(order, rng):
    """Numbers of a system, and a start from which M1 reaches a stop with v1 and all derivatives below `order` zero.

    At order 4 it stays inside before and after; at order 3 it goes on into the stop.
    """
    while True:
        powers = 10.0 ** rng.uniform(-1, 1, 3)
        params = dict(zip(("mu_m", "mu_k", "omega"), powers.tolist(), strict=True))
        params |= dict(
            zeta=float(rng.choice([0.0, 0.05, 0.6])), f2=float(rng.uniform(0, 0.8)), tau=float(rng.uniform(-3, 3))
        )
        params |= dict(R=float(rng.uniform(0, 1)), b=float(10 ** rng.uniform(-2, 0.5)))
        side, t = int(rng.choice([1, -1])), mpf(float(rng.uniform(1, 2) / params["omega"]))
        o, x1 = Oscillator(params), side * mpf(params["b"])
        units = [taylor(o, t, (x1, mpf(0), x2, v2), 6)[0] for x2, v2 in ((0, 0), (1, 0), (0, 1))]
        columns = [[unit[n] - units[0][n] for unit in units[1:]] for n in (2, 3)]
        if order == 3:  # v2 is free
            x2, v2 = None, mpf(float(rng.normal()))
            x2 = -(units[0][2] + columns[0][1] * v2) / columns[0][0]
        else:
            x2, v2 = mp.lu_solve(mp.matrix(columns), -mp.matrix(units[0][2:4]))
        c, _ = taylor(o, t, (x1, mpf(0), x2, v2), 6)
        if (side * c[order] > 0) != (order == 3):
            continue
        flight = Flight(o, t, (x1, mpf(0), x2, v2))
        before = mpf(float(rng.uniform(0.1, 0.5))) / max(1, max(abs(rate) for rate in flight.rates))
        begin = mpf(float(t - before))
        start = flight.at(begin - t)
        if abs(start[0]) < params["b"]:
            state = tuple(float(start[i]) for i in (0, 1, 3, 4))
            if (
                Flight(o, begin, state).gap(side, mpf(params["b"]) * (1 + mpf("1e-12"))).first_zero(mpf(0), t - begin)
                is None
            ):
                return params, state, float(begin)


@pytest.mark.parametrize("order, seed", sample(6, [(3, seed) for seed in range(6)] + [(4, seed) for seed in range(12)]))
def test_contact_without_speed_and_acceleration(order, seed):
    """Also without jerk (order 4): the orbit goes on as the exact one does, with an impact within rounding or none."""
    params, state, start_time = contact_of_order(order, np.random.default_rng(seed))
    system = vs.System(**params)
    orbit = vs.simulate(system, state, 2, start_time)
    assert orbit.status == "ok"
    end = float(orbit.section_times[-1])
    hits = [tuple(x.item() for x in hit) for hit in orbit.impacts]
    rests = [
        (float(r["t_on"]), None if r["t_off"] >= end else float(r["t_off"]), int(r["side"])) for r in orbit.sticking
    ]
    follower = Follower({**params, "stops": "both"}, mpf(system.period) * mpf(2) ** -53)
    follower.follow(start_time, state, hits, rests, end, 4)
    assert not follower.found.defects
