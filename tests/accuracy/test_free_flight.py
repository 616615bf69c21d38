"""Flights without stops, also from beyond one: against matrix exponentials in 40 digits."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.flow import matrix_of
from reference.gmp import expm
from reference.machine import machine_of
from support import slow_cases

import vibro_sweep as vs
from vibro_sweep.engine.free_flight import FreeFlight
from vibro_sweep.tables import outcomes as status

SYSTEMS = {
    "paper": dict(**naive.PAPER, tau=1.0, b=3.0),
    "two forces": dict(mu_m=2.5, mu_k=2.5, zeta=0.03, f2=0.6, omega=0.3, R=0.7, tau=0.4, b=1.0),
    "overdamped": dict(**naive.PAPER | {"zeta": 3.0}, tau=1.0, b=0.3),
    "undamped": dict(**naive.PAPER | {"zeta": 0.0, "omega": 1.7}, tau=1.0, b=1.0),
    "stiff": dict(**naive.PAPER | {"mu_k": 1e9, "zeta": 0.0}, tau=1.0, b=1.0),
}
KINDS = ["paper", *slow_cases("overdamped", "two forces", "undamped", "stiff")]


class Exact:
    """The motion of one flight in 40 digits."""

    def __init__(self, params, state, start_time):
        self.A = matrix_of(machine_of(naive.linear_of(params)))[:6, :6]
        phase = mpf(params["omega"]) * mpf(start_time) + mpf(params["tau"])
        self.z = mp.matrix([*map(mpf, state), mp.sin(phase), mp.cos(phase)])

    def __call__(self, u):
        return expm(self.A * mpf(float(u))) * self.z

    def turning_point(self, u):
        """(time, x1) of the turning point near u, by Newton's method on v1."""
        u, step = mpf(float(u)), 1
        while abs(step) > mpf("1e-25"):  # its square is what is left
            z = expm(self.A * u) * self.z
            step = z[1] / (self.A * z)[1]
            u -= step
        return u, (expm(self.A * u) * self.z)[0]


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(40):
        yield


def states(b, count, seed):
    rng = np.random.default_rng(seed)
    X = 2 * b * rng.normal(size=(count, 4))
    X[::4, 0] = b  # on a stop, moving into it or away; and beyond one
    X[1::4, 0] = -1.5 * b
    return X


@pytest.mark.parametrize("name", ["paper", "overdamped", *slow_cases("two forces", "undamped")])
def test_motion(name):
    params = SYSTEMS[name]
    X, elapsed = states(params["b"], 3, 1), np.array([-1.0, 0.0, 1e-6, 4.0, 25.0])
    if name == "overdamped":
        elapsed = abs(elapsed)  # backwards it grows by 10^20
    found = FreeFlight(vs.System(**params)).sample(X, 0.7, elapsed)
    for i, state in enumerate(X):
        exact = Exact(params, state, 0.7)
        for n, u in enumerate(elapsed):
            np.testing.assert_allclose(found[i, n], [float(x) for x in exact(u)[:4]], rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", KINDS)
def test_first_contact(name):
    """x1 is on the stop there, and nowhere before by a dense look at the flight."""
    params = SYSTEMS[name]
    system, count = vs.System(**params), 200
    b, duration = system.b, 1.7 * system.period
    flights, X = FreeFlight(system), states(system.b, count, 2)
    elapsed, side, outcome = flights.first_contact(X, 0.7, duration)
    assert (outcome == status.OK).all()
    hit = np.isfinite(elapsed)
    assert hit.sum() > count / 4 and set(side[hit]) == {-1, 1} and (side[~hit] == 0).all()
    looks = np.linspace(0, 1, 801)[1:-1] * np.where(hit, elapsed, duration)[:, None]
    x1 = flights.sample(X, 0.7, looks)[..., 0]
    same = (np.sign(x1 - b) == np.sign(x1 - b)[:, :1]) & (np.sign(x1 + b) == np.sign(x1 + b)[:, :1])
    assert same.all()
    for i in np.flatnonzero(hit)[:25]:
        z = Exact(params, X[i], 0.7)(elapsed[i])
        assert abs(z[0] - int(side[i]) * mpf(b)) <= 1e-13 * max(1, abs(X[i]).max()) * max(1, abs(z[1]))


@pytest.mark.parametrize("name", KINDS)
def test_extremes(name):
    """Bounds hold the exact turning point, are narrow, and no other turning point lies outside them."""
    params = SYSTEMS[name]
    system, count = vs.System(**params), 60
    duration = 1.7 * system.period
    flights, X = FreeFlight(system), states(system.b, count, 3)
    found = flights.extremes(X, 0.7, duration)
    size = max(1.0, np.abs(X).max())
    looks = np.linspace(0, duration, 1501)
    x1 = flights.sample(X, 0.7, looks)[..., 0]
    for sign, bounds, at in ((1, found.highest, found.highest_at), (-1, found.lowest, found.lowest_at)):
        inner = sign * x1[:, 1:-1]
        peaks = (inner > sign * x1[:, :-2]) & (inner > sign * x1[:, 2:])
        seen = np.where(peaks, inner, -np.inf).max(axis=1)
        outer = sign * bounds[:, 1 if sign > 0 else 0]
        assert (seen <= outer + 1e-12 * size).all()
        turned = np.isfinite(at)
        assert (turned == np.isfinite(bounds).all(axis=1)).all() and (turned >= (seen > -np.inf)).all()
        assert (bounds[turned, 1] - bounds[turned, 0] <= 1e-12 * size).all()
        assert ((0 < at[turned]) & (at[turned] < duration)).all()
        for i in np.flatnonzero(turned)[: 4 if name == "stiff" else 12]:  # its exponentials take long
            u, exact = Exact(params, X[i], 0.7).turning_point(at[i])
            assert abs(u - at[i]) < 1e-6
            assert bounds[i, 0] <= exact <= bounds[i, 1]


def test_flight_from_stop_to_stop():
    """An impact that pulls leads beyond its stop, and the extremes say by how much; one that pushes stays inside."""
    system = vs.System(**SYSTEMS["paper"])
    flights = FreeFlight(system)
    X = np.array([[3.0, 1.0, 0.0, 0.0], [3.0, -1.0, 0.0, 0.0]])
    found = flights.extremes(X, 0.7, flights.first_contact(X, 0.7, 50.0).elapsed)
    assert found.highest[0, 0] > 3.0 and found.highest_at[0] > 0
    assert found.highest[1, 1] < 3.0


def test_bad_arguments():
    flights = FreeFlight(vs.System(**SYSTEMS["paper"]))
    with pytest.raises(ValueError, match=r"states: shape \(4,\)"):
        flights.sample([0, 0, 0, 0], 0.0, [1.0])
    with pytest.raises(ValueError, match=r"states: .*nan"):
        flights.first_contact([[0, 0, math.nan, 0]], 0.0, 1.0)
    with pytest.raises(ValueError, match=r"duration: .*inf"):
        flights.extremes([[0, 0, 0, 0]], 0.0, math.inf)
