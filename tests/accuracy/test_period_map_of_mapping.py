"""The period map of the discontinuity mapping, against difference quotients of a slow one in 30 digits."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.naive_map import NaiveMap
from support import slow_cases
from support.quotients import DIGITS, quotient

import vibro_sweep as vs
from vibro_sweep.engine.period_map import PeriodMap
from vibro_sweep.oscillator.models.two_mass import NAMES


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(DIGITS + 10):
        yield


def slow_map(order, expand_at, params, X, periods):
    slow = NaiveMap(params, order)
    if expand_at is not None:
        slow.graze[0] = mpf(expand_at)
    X = mp.matrix(X)
    return list(-slow.middle(X) if periods == 0.5 else slow(X))


@pytest.mark.parametrize("expand_at", [None, *slow_cases(6.7107356)])
@pytest.mark.parametrize("order", [1, *slow_cases(2)])
@pytest.mark.parametrize("periods", [0.5, *slow_cases(1)])
def test_derivatives_of_the_discontinuity_mapping(order, expand_at, periods):
    params = {**naive.PAPER, "b": 6.25, "f2": 0.1}  # b* = 6.358: both stops are hit
    step = PeriodMap(vs.System(**params), order, expand_at)
    for state in step.graze + np.array([[0.2, 0.3, -0.1, 0.1], [-0.3, -0.2, 0.4, 0.3], [-0.3, 0.1, -0.4, -0.3]]):
        mapped = step([state], periods, jacobian=True, parameters=True)
        X = [mpf(x) for x in state]

        def slow(i=None, x=None, X=X, **changes):
            return slow_map(order, expand_at, params | changes, [x if i == j else y for j, y in enumerate(X)], periods)

        np.testing.assert_allclose(mapped.states[0], [float(x) for x in slow()], rtol=0, atol=1e-12)
        exact = np.array([quotient(lambda x, i=i: slow(i, x), X[i]) for i in range(4)]).T
        np.testing.assert_allclose(mapped.jacobian[0], exact, rtol=0, atol=1e-10 * abs(exact).max())
        exact = np.array([quotient(lambda x, n=n: slow(**{n: x}), mpf(params[n])) for n in NAMES[:-1]]).T
        np.testing.assert_allclose(mapped.parameters[0, :, :-1], exact, rtol=0, atol=1e-10 * abs(exact).max())
        assert (mapped.parameters[0, :, -1] == 0).all()  # its section is the graze, whatever tau


def test_the_mapping_has_both_stops_or_one():
    system = vs.System(**naive.PAPER, b=6.6)
    X = PeriodMap(system, 2).graze + np.array([0.2, 0.3, -0.1, 0.1])
    hit = {stops: PeriodMap(system.replace(stops=stops), 2)([X]).impacts[0]["side"] for stops in ("both", "left")}
    assert 1 in hit["both"] and 1 not in hit["left"]
