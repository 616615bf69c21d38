"""More digits than floats have, where numpy's longdouble is a float: as on Windows and on ARM, here by force."""

import numpy as np
import pytest
from mpmath import mp, mpf

import vibro_sweep as vs
from vibro_sweep.analysis.periodic import orbit_multipliers
from vibro_sweep.engine.impulses import extended, flow, free_modes
from vibro_sweep.engine.impulses.taylor_orders import exponential, power

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=3.0, tau=0.1)


def forget():
    for module in (free_modes, flow, orbit_multipliers):
        for thing in vars(module).values():
            getattr(thing, "cache_clear", lambda: None)()


@pytest.fixture
def narrow(monkeypatch):
    """As if longdouble had 53 bits."""

    def choose():
        forget()
        monkeypatch.setattr(extended, "NATIVE", False)
        monkeypatch.setattr(np, "longdouble", np.float64)

    yield choose
    monkeypatch.undo()
    forget()


def exact(x):
    return np.vectorize(lambda a, b: mpf(float(a)) + mpf(float(b)), otypes=[object])(x.high, x.low)


def test_sums_and_products():
    rng = np.random.default_rng(0)
    with mp.workdps(50):
        high = rng.normal(size=(2, 200)) * 10.0 ** rng.uniform(-8, 8, (2, 200))
        a, b = (extended.Twofold(one, one * 2.0**-54 * rng.uniform(-1, 1, 200)) for one in high)
        x, y = exact(a), exact(b)
        for found, true in ((a * b, x * y), (a / b, x / y), (2.0 / b, 2 / y), (b**2, y * y)):
            assert max(abs(exact(found) / true - 1)) < mpf(2) ** -100
        for found, true in ((a + b, x + y), (a - b, x - y), (1.0 - b, 1 - y)):
            assert max(abs(exact(found) - true) / (abs(x) + abs(y) + 1)) < mpf(2) ** -102


def test_exponentials(narrow):
    narrow()
    A = np.array([[0.0, 1.0, 0.0], [-3.0, -0.2, 1e-3], [0.0, 7.0, -1.0]])
    E = power(exponential(A, 0.03125), 37)
    with mp.workdps(50):
        true = np.array(mp.expm(mp.matrix(A.tolist()) * mpf(0.03125) * 37).tolist())
        assert isinstance(E, extended.Twofold) and np.abs(exact(E) - true).max() < 1e-26


@pytest.mark.skipif(not extended.NATIVE, reason="longdouble is a float")
def test_tables_are_the_same_but_for_rounding(narrow):
    """Of flights."""
    orbit = vs.periodic_orbit(SYSTEM, vs.simulate(SYSTEM, [0.1, 0.2, 0.1, -0.3], 400).section[-1])
    assert orbit.status == "ok" and orbit._solution.K > 0
    s = orbit._solution

    def all_of_it():
        q = s.family.linear
        free = flow.flow(q)
        return [free.powers[:12], free.series]

    tables = all_of_it()
    narrow()
    for table, same in zip(tables, all_of_it(), strict=True):
        np.testing.assert_allclose(same, table, rtol=0, atol=4e-16 * np.abs(table).max())
