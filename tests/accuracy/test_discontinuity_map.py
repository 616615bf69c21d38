"""`discontinuity_map` and its Jacobian: against slow mappings in 30 digits, and by matrix exponentials."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.naive_map import AnyNaiveMap, NaiveMap
from scipy.linalg import expm
from support import slow_cases
from support.quotients import DIGITS, quotient

import vibro_sweep as vs

CHAIN = dict(
    m=[1.0, 2.0, 1.5], k=[0.5, 1.0, 1.5, 0.3], c=[0.05, 0.2, 0.1, 0.02], force=[0.5, 0.0, 1.0], stop_at=2,
    omega=0.9, R=0.8, b=0.4, stops="both",
)  # fmt: skip


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(DIGITS + 10):
        yield


def compare(step, slow, state):
    """The map and its Jacobian at a state against the slow map, a function of a column."""
    X = [mpf(x) for x in state]
    np.testing.assert_allclose(step(state), [float(x) for x in slow(mp.matrix(X))], rtol=0, atol=1e-12)

    def moved(i, x):
        return list(slow(mp.matrix([x if i == j else y for j, y in enumerate(X)])))

    exact = np.array([quotient(lambda x, i=i: moved(i, x), X[i]) for i in range(len(X))]).T
    assert np.abs(step.jacobian(state) - exact).max() < 1e-10 * np.abs(exact).max()


@pytest.mark.parametrize("expand_at", [None, *slow_cases(6.7107356)])
@pytest.mark.parametrize("order", [1, 2])
def test_of_the_paper(order, expand_at):
    params = {**naive.PAPER, "b": 6.25, "f2": 0.1}  # b* = 6.358: both stops are hit
    step, slow = vs.discontinuity_map(vs.System(**params), order, expand_at), NaiveMap(params, order)
    if expand_at is not None:
        slow.graze[0] = mpf(expand_at)
    hit = set()
    for moved in ([0.2, 0.3, -0.1, 0.1], [-0.3, -0.2, 0.4, 0.3], [-0.3, 0.1, -0.4, -0.3]):
        compare(step, slow, step.graze + np.array(moved))
        hit.add(slow.case(mp.matrix((step.graze + np.array(moved)).tolist())))
    assert len(hit) > 1


@pytest.mark.parametrize("order", [1, 2])
def test_beside_one_stop(order):
    """The left stop alone: half a period of flight, C2 mirrored, and half a period."""
    params = {**naive.PAPER, "b": 6.25, "f2": 0.1}
    step = vs.discontinuity_map(vs.System(**params, stops="left"), order)
    slow = NaiveMap(params, order)
    state = step.graze + np.array([-0.3, -0.2, 0.4, 0.3])
    compare(step, lambda X: slow.middle(slow.graze - slow.L * (X - slow.graze)), state)


@pytest.mark.parametrize(("order", "expand_at"), [(2, 0.9), (1, None), *slow_cases((1, 0.9), (2, None))])
def test_of_a_chain(order, expand_at):
    system = vs.Oscillator.named("chain", **CHAIN)
    system = system.replace(b=0.95 * vs.grazing(system).b)
    step, slow = vs.discontinuity_map(system, order, expand_at), AnyNaiveMap(system.linear, order, expand_at)
    for moved in ((0.03, 0.01, 0.08, -0.05, 0.01, 0.03), (-0.02, -0.03, 0.05, 0.04, -0.01, 0.1)):
        compare(step, slow, step.graze + moved)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("seed", [1, 2, *slow_cases(*range(3, 12))])
def test_of_drawn_chains(seed, order):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 6))
    system = vs.Oscillator.named(
        "chain", m=rng.uniform(0.5, 2, n), k=rng.uniform(0.1, 2, n + 1), c=rng.uniform(0, 0.3, n + 1),
        force=rng.normal(size=n), omega=float(rng.uniform(0.4, 2)), R=float(rng.uniform(0.3, 1)), b=1.0,
        stop_at=int(rng.integers(1, n + 1)),
    )  # fmt: skip
    system = system.replace(b=float(rng.uniform(0.9, 1)) * vs.grazing(system).b)
    step, slow = vs.discontinuity_map(system, order), AnyNaiveMap(system.linear, order)
    state = step.graze + 0.1 * system.b * rng.normal(size=2 * n)
    while abs(float(slow.strike(mp.matrix(state.tolist()))[0])) < 1e-3 * system.b:  # singular beside the stop
        state = step.graze + 0.1 * system.b * rng.normal(size=2 * n)
    compare(step, slow, state)


def test_discontinuity_mapping_of_the_paper_by_its_matrices():
    numbers = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.1, omega=0.63, R=0.8, b=6.25)
    system = vs.System(**numbers)
    q = system.linear
    same = vs.Oscillator(
        q.M, q.K, q.C, contact_normal=q.contact.normal, force=q.sine, force_cos=q.cosine, omega=0.63, R=0.8, b=6.25
    )
    one, other = vs.discontinuity_map(system, 2), vs.discontinuity_map(same, 2)
    X = one.graze + np.array([0.2, 0.3, -0.1, 0.1])
    np.testing.assert_allclose(other.graze, one.graze, rtol=0, atol=1e-13)
    np.testing.assert_allclose(other(X), one(X), rtol=0, atol=1e-12)
    np.testing.assert_allclose(other.jacobian(X), one.jacobian(X), rtol=0, atol=1e-11)


def test_discontinuity_mapping_of_a_ball_in_a_cavity():
    """A model without the number `stops`: (41) by the matrix exponential of half a period."""
    system = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.1, zeta=0.02, F=0.2, omega=1.3, R=0.6, b=0.28)
    step, touch, q = vs.discontinuity_map(system), vs.grazing(system), system.linear
    A = np.zeros((4, 4))  # of (x1, v1, x2, v2)
    A[0, 1] = A[2, 3] = 1
    A[1, 0], A[1, 1] = -q.K[0, 0] / q.M[0, 0], -q.C[0, 0] / q.M[0, 0]
    L, push = expm(A * system.period / 2), np.array([0, -0.1, 0, 1.0]) / 1.1  # of the gap x2 - x1

    def strike(D, side):
        beyond = side * (D[2] - D[0]) + touch.b - 0.28
        return D - side * 1.6 * np.sqrt(2 * 1.3**2 * touch.b * max(beyond, 0.0)) * push

    for D in np.array([[0.01, 0.02, -0.01, 0.03], [-0.02, 0.01, 0.01, 0.0], [0.01, 0.0, 0.0, 0.1]]):
        exact = touch.state + L @ strike(L @ strike(D, 1), -1)
        np.testing.assert_allclose(step(touch.state + D), exact, rtol=0, atol=1e-13)


@pytest.mark.parametrize("changes", [dict(offset=0.1), dict(R_left=0.5), dict(constant=[0.1, 0, 0])])
def test_no_discontinuity_mapping_without_symmetry(changes):
    given = dict(
        M=np.eye(3), K=np.eye(3), C=0.1 * np.eye(3), contact_normal=[1, 0, 0], force=1.0, omega=0.7, R=0.8, b=1.0
    )
    given["force"] = [1, 0, 0]
    with pytest.raises(ValueError, match="must be one with equal stops about 0"):
        vs.discontinuity_map(vs.Oscillator(**given | changes))
