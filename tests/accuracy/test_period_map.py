"""The period map: its derivatives against difference quotients of the slow simulator in 30 digits, and its identities.

The slow simulator knows nothing of saltation matrices, sources or phases: its quotients are those of orbits.
"""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.machine import machine_of
from support import sample, slow_cases
from support.quotients import DIGITS, STEP, quotient

import vibro_sweep as vs
from vibro_sweep.engine.free_flight import FreeFlight
from vibro_sweep.engine.period_map import PeriodMap
from vibro_sweep.engine.variational.parameter_sensitivity import differentiate
from vibro_sweep.oscillator.models.two_mass import NAMES
from vibro_sweep.tables import outcomes as status

TOLERANCE = 1e-10  # of the largest entry
ROUNDING = 2.0**-53
PAPER = dict(**naive.PAPER, tau=1.0)
SOFT = dict(mu_m=2.5, mu_k=2.5, zeta=0.03, f2=0.3, omega=0.492, R=0.7, tau=0.4)


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(DIGITS + 10):
        yield


def end_of(params, state, periods):
    """The state after whole periods, or half a period more: then from t = T/2, with the phase moved back."""
    if periods == int(periods):
        return naive.simulate(params, state, periods=int(periods), digits=DIGITS).section[-1]
    start, length = mp.pi / mpf(params["omega"]), mpf(periods) + mpf(10) ** -DIGITS
    moved = {**params, "tau": mpf(params["tau"]) - mp.pi}
    return naive.simulate(moved, state, periods=length, start_time=start, digits=DIGITS).section[-1]


def by_state(params, state, periods):
    def moved(i, x):
        return end_of(params, [x if i == j else mpf(s) for j, s in enumerate(state)], periods)

    return np.array([quotient(lambda x, i=i: moved(i, x), mpf(state[i])) for i in range(4)]).T


def by_parameters(params, state, periods, names=NAMES):
    def moved(name, x):
        return end_of({**params, name: x}, [mpf(s) for s in state], periods)

    return np.array([quotient(lambda x, n=n: moved(n, x), mpf(params[n])) for n in names]).T


def compare(params, state, periods, tolerance=TOLERANCE):
    """Both derivatives of the map against quotients. Returns what the map gives."""
    mapped = PeriodMap(vs.System(**params))([state], periods, jacobian=True, parameters=True)
    assert mapped.status[0] == status.OK
    end = [float(x) for x in end_of(params, [mpf(s) for s in state], periods)]
    np.testing.assert_allclose(mapped.states[0], end, rtol=0, atol=1e-12 * max(map(abs, end)))
    for found, exact in (
        (mapped.jacobian[0], by_state(params, state, periods)),
        (mapped.parameters[0], by_parameters(params, state, periods)),
    ):
        error = abs(found - exact).max()
        assert error <= tolerance * abs(exact).max(), (error, abs(exact).max())
    return mapped


# (system, state, periods, stops that are hit, rests)
START = (0.1, 0.3, 0.2, -0.1)
CASES = {
    "no impact": (dict(PAPER, b=30.0), (0.3, -0.2, 0.1, 0.5), 2, set(), 0),
    "both stops": (dict(PAPER, b=1.0), (0.3, 0.5, -0.2, 0.1), 1, {1, -1}, 0),
    "many impacts": (dict(SOFT, b=0.5, R=0.95), START, 2, {1, -1}, 0),
    "half a period": (dict(PAPER, b=1.0), (0.3, 0.5, -0.2, 0.1), 0.5, {1}, 0),
    "three halves": (dict(SOFT, b=0.5), START, 1.5, {1, -1}, 0),
    "right stop": (dict(SOFT, b=1.0, stops="right"), (-2.0, 0.3, 0.2, -0.1), 2, {1}, 0),
    "left stop": (dict(SOFT, b=0.2, stops="left"), (2.0, 0.3, 0.2, -0.1), 2, {-1}, 0),
    "one mode overdamped": (dict(PAPER, zeta=1.2, mu_m=0.5, b=0.3, omega=1.5), START, 2, {1, -1}, 0),
    "both modes overdamped": (dict(PAPER, zeta=1.5, mu_m=0.5, b=0.3, omega=3.0), START, 1, {1}, 0),
    "undamped": (dict(PAPER, zeta=0.0, b=1.0, f2=0.5), START, 1, {1}, 0),
    "light second mass": (dict(PAPER, mu_m=0.2, b=1.0), START, 1, {1, -1}, 0),
    "chatter and rests": (dict(PAPER, R=0.3, b=0.5, tau=0.3), (0.1, 0.0, 0.0, 0.0), 1, {1, -1}, 2),
    "at rest in the end": (dict(PAPER, R=0.3, b=0.5, tau=-0.5), (0.1, 0.0, 0.0, 0.0), 0.5, {1}, 1),
}


@pytest.mark.parametrize(
    "case",
    ["no impact", "right stop", *slow_cases(*(case for case in CASES if case not in ("no impact", "right stop")))],
)
def test_derivatives_against_thirty_digits(case):
    params, state, periods, sides, rests = CASES[case]
    mapped = compare(params, state, periods)
    assert (set(mapped.impacts[0]["side"]), len(mapped.sticking[0])) == (sides, rests)
    if rests:  # what happened before is known to M2 alone
        assert np.linalg.matrix_rank(mapped.jacobian[0], tol=1e-12) == 2


def test_without_restitution():
    """R = 0: two dimensions are lost where M1 rests at once. No R is below, so its quotient is taken on one side."""
    params, state = dict(PAPER, R=0.0, b=0.2, tau=0.3), [mpf(x) for x in (0.1, 0.0, 0.0, 0.0)]
    mapped = PeriodMap(vs.System(**params))([[0.1, 0, 0, 0]], jacobian=True, parameters=True)
    assert len(mapped.sticking[0]) > 0
    exact = by_state(params, state, 1)
    assert abs(mapped.jacobian[0] - exact).max() <= TOLERANCE * abs(exact).max()
    others = [name for name in NAMES if name != "R"]
    exact, found = by_parameters(params, state, 1, others), mapped.parameters[0]
    assert abs(np.delete(found, NAMES.index("R"), axis=1) - exact).max() <= TOLERANCE * abs(exact).max()
    here, there = (end_of({**params, "R": R}, state, 1) for R in (0, STEP))
    forward = [float((q - p) / STEP) for p, q in zip(here, there, strict=True)]
    np.testing.assert_allclose(found[:, NAMES.index("R")], forward, rtol=0, atol=1e-10)


def test_start_at_rest_on_a_stop():
    """One-sided: into the gap by x1 and v1, which brings a chatter of its own; the stop moves away from M1."""
    params, state, h = dict(PAPER, R=0.3, b=0.5, tau=0.0), [mpf(x) for x in (0.5, 0.0, 2.0, 0.0)], mpf(10) ** -26
    mapped = PeriodMap(vs.System(**params))([[0.5, 0, 2, 0]], 0.5, jacobian=True, parameters=True)
    assert mapped.sticking[0]["t_on"][0] == 0
    with mp.workdps(70):

        def end(b=0, **moved):
            there = [x + moved.get(name, 0) for name, x in zip(("x1", "v1"), state[:2], strict=True)] + state[2:]
            changed = {**params, "b": params["b"] + b, "tau": params["tau"] - mp.pi}
            length = mpf(1) / 2 + mpf(10) ** -55
            start = mp.pi / mpf(params["omega"])
            return naive.simulate(changed, there, periods=length, start_time=start, digits=60).section[-1]

        here = end()
        for column, there in (
            (mapped.jacobian[0, :, 0], [-x for x in map(mp.fsub, end(x1=-h), here)]),
            (mapped.jacobian[0, :, 1], [-x for x in map(mp.fsub, end(v1=-h), here)]),
            (mapped.parameters[0, :, NAMES.index("b")], list(map(mp.fsub, end(b=h), here))),
        ):
            np.testing.assert_allclose(column, [float(x / h) for x in there], rtol=0, atol=1e-10)


@pytest.mark.parametrize("depth", sample(1, [1e-2, 1e-5, 1e-8]))
def test_next_to_a_graze(depth):
    """Entries grow like 1/v1; rounding of the state acts on them like 1/v1^2."""
    state = (0.3, 0.5, -0.2, 0.1)
    free = FreeFlight(vs.System(**dict(PAPER, b=50.0)))
    peak = free.extremes([state], 0.0, 2 * math.pi / PAPER["omega"]).highest[0, 0]
    system = vs.System(**dict(PAPER, b=peak - depth, stops="right"))
    speed = abs(PeriodMap(system)([state]).impacts[0]["v1"]).min()
    condition = (system.omega * system.b / speed) ** 2
    compare(dict(PAPER, b=system.b, stops="right"), state, 1, max(TOLERANCE, 10 * condition * ROUNDING))


def test_tau_that_follows_the_graze():
    """tau: grazing: the derivatives by the others include the change of tau*."""
    params, state = dict(PAPER, b=5.0), (0.3, 0.5, -0.2, 0.1)
    del params["tau"]
    found = PeriodMap(vs.System(**params))([state], parameters=True).parameters[0]

    def grazing(name, x):
        moved = {**params, name: x}
        return end_of({**moved, "tau": naive.grazing(moved)[1]}, [mpf(s) for s in state], 1)

    exact = np.array([quotient(lambda x, n=n: grazing(n, x), mpf(params[n])) for n in params]).T
    assert abs(found[:, : len(params)] - exact).max() <= TOLERANCE * abs(exact).max()
    fixed = PeriodMap(vs.System(**params, tau=vs.System(**params).phase))([state], parameters=True).parameters[0]
    np.testing.assert_array_equal(found[:, -1], fixed[:, -1])
    assert abs(found - fixed)[:, :5].max() > 1e-3


# --- identities


@pytest.mark.parametrize("order", [0, 2])
def test_the_period_is_its_half_twice(order):
    """Q(X) = -P_(T/2)(X) is a map of the same section, by symmetry, and Q twice is P: states and the chain rule."""
    system = vs.System(**naive.PAPER, b=1.0 if order == 0 else 6.6)
    step = PeriodMap(system, order)
    X = np.array([[0.3, 0.5, -0.2, 0.1]]) + (0 if order == 0 else step.graze)
    first = step(X, 0.5, jacobian=True, parameters=True)
    second = step(-first.states, 0.5, jacobian=True, parameters=True)
    whole = step(X, jacobian=True, parameters=True)
    np.testing.assert_allclose(-second.states, whole.states, rtol=0, atol=1e-13)
    np.testing.assert_allclose(second.jacobian @ first.jacobian, whole.jacobian, rtol=1e-11, atol=1e-12)
    chain = second.jacobian @ first.parameters - second.parameters
    np.testing.assert_allclose(chain, whole.parameters, rtol=1e-11, atol=1e-11)
    times = np.concatenate([first.impacts[0]["t"], second.impacts[0]["t"] + system.period / 2])
    np.testing.assert_allclose(times, whole.impacts[0]["t"], rtol=0, atol=1e-12)


def test_determinant():
    """det J = R^(2 impacts) e^(-tr(M^-1 C) T)."""
    system = vs.System(**dict(SOFT, b=0.5))
    mapped = PeriodMap(system)([[0.1, 0.3, 0.2, -0.1]], 3, jacobian=True)
    exact = system.R ** (2 * len(mapped.impacts[0])) * math.exp(system.divergence * 3 * system.period)
    assert np.linalg.det(mapped.jacobian[0]) == pytest.approx(exact, rel=1e-9)


def test_multipliers_against_forty_digits():
    system = vs.System(**naive.PAPER, b=3.7576)
    X = vs.simulate(system, (0, 0, 0, 0), 3000).section[-1]
    mapped = PeriodMap(system)([X], jacobian=True)
    machine, hits = machine_of(system.linear), mapped.impacts[0]
    closed = ClosedOrbit(machine, impacts_of(machine, hits["side"]), 1)
    exact = np.array([complex(mu) for mu in closed.multipliers(*closed.solve(X, hits["t"]))])
    found = np.linalg.eigvals(mapped.jacobian[0])
    for value in found:
        assert abs(exact - value).min() < 1e-10


def test_many_states_at_once_are_the_orbits_of_simulate():
    system = vs.System(**dict(PAPER, R=0.5, b=0.5))
    X = np.random.default_rng(3).uniform(-0.5, 0.5, (19, 4))
    together = PeriodMap(system)(X, 3, jacobian=True, parameters=True)
    assert (together.status == status.OK).all()
    for i, state in enumerate(X):
        alone = PeriodMap(system)([state], 3, jacobian=True, parameters=True)
        orbit = vs.simulate(system, state, 3)
        np.testing.assert_array_equal(together.states[i], orbit.section[-1])
        np.testing.assert_array_equal(together.impacts[i], orbit.impacts)
        np.testing.assert_array_equal(together.sticking[i], orbit.sticking)
        for name in ("states", "jacobian", "parameters"):
            np.testing.assert_array_equal(getattr(alone, name)[0], getattr(together, name)[i])


def test_one_state_and_several_are_computed_by_one_kernel():
    """Of contiguous arrays alone: fields of one record are, those of several are not, and it was compiled for both."""
    step, X = PeriodMap(vs.System(**dict(PAPER, b=1.0))), np.zeros((3, 4))
    for states in (X[:1], X):
        step(states, jacobian=True)
    assert {kind.layout for kinds in differentiate._whole.signatures for kind in kinds if hasattr(kind, "layout")} == {
        "C"
    }


def test_more_impacts_than_there_is_room_for():
    system = vs.System(**dict(PAPER, R=0.99, b=0.01))
    mapped = PeriodMap(system)([[0.0, 0.3, 0.0, 0.0]], 40, jacobian=True)
    assert len(mapped.impacts[0]) > 300 and np.isfinite(mapped.jacobian).all()


def test_what_goes_wrong_is_a_status():
    mapped = PeriodMap(vs.System(**dict(PAPER, b=1.0)))(
        [[0, 0, 0, 0], [1.5, 0, 0, 0], [0, math.nan, 0, 0]], jacobian=True, parameters=True
    )
    np.testing.assert_array_equal(mapped.status, [status.OK, status.BEYOND_STOP, status.NOT_FINITE])
    for values in (mapped.states, mapped.jacobian, mapped.parameters):
        assert np.isfinite(values[0]).all() and np.isnan(values[1:]).all()
    assert len(mapped.impacts[1]) == 0


def test_bad_arguments():
    system = vs.System(**dict(PAPER, b=1.0))
    with pytest.raises(ValueError, match=r"order: 3 .*1 or 2"):
        PeriodMap(system, order=3)
    for periods in (0.3, -1, math.nan, math.inf):
        with pytest.raises(ValueError, match=r"periods: .*multiple of 1/2"):
            PeriodMap(system)([[0, 0, 0, 0]], periods)
    with pytest.raises(ValueError, match=r"states: shape \(4,\)"):
        PeriodMap(system)([0, 0, 0, 0])
    same = PeriodMap(system)([[0.1, 0, 0, 0]], 0, jacobian=True)
    np.testing.assert_array_equal(same.states, [[0.1, 0, 0, 0]])
    np.testing.assert_array_equal(same.jacobian, [np.eye(4)])
