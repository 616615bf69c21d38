"""The period map of any number of masses: its derivatives against difference quotients of 30-digit orbits.

Chains whose matrices are formed here; all their numbers may be moved, masses and dampers among them.
"""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of
from reference.naive_map import AnyNaiveMap
from scipy.linalg import expm
from support.drawn_oscillators import drawn

import vibro_sweep as vs
from vibro_sweep.engine.free_flight import FreeFlight
from vibro_sweep.engine.period_map import PeriodMap
from vibro_sweep.oscillator.models.two_mass import NAMES
from vibro_sweep.tables import outcomes as status
from vibro_sweep.types import Linear

pytestmark = pytest.mark.slow

DIGITS = 30
STEP = mpf(10) ** -15
CHAIN = dict(
    m=[1.0, 2.0, 1.5], k=[0.5, 1.0, 1.5, 0.3], c=[0.05, 0.2, 0.1, 0.02], force=[0.5, 0.0, 1.0], stop_at=2,
    constant=[0.1, 0.0, -0.05], omega=0.9, R=0.8, R_left=0.6, b=0.4, offset=0.1, tau=0.3, stops="both",
)  # fmt: skip
STATE = (0.1, 0.5, 0.2, -0.1, -0.2, 0.3)
CASES = {
    "both stops": (dict(R=0.9, R_left=0.85), 1, False),
    "rests": (dict(R=0.3, R_left=0.2, b=0.3), 1, True),
    "no restitution": (dict(R=0.0, R_left=0.3, b=0.3), 1, True),
}
FAST = ("m2", "c3", "omega", "b", "offset", "R", "tau")


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(DIGITS + 10):
        yield


def chain(**changes):
    return vs.Oscillator.named("chain", **CHAIN | changes)


def slow_chain(numbers):
    """The oscillator, of floats or of numbers of mpmath."""
    n = len(CHAIN["m"])
    m, k, c, force, constant = (
        [mpf(numbers[f"{name}{i}"]) for i in range(1, count + 1)]
        for name, count in (("m", n), ("k", n + 1), ("c", n + 1), ("force", n), ("constant", n))
    )

    def linked(a):
        return [[a[i] + a[i + 1] if i == j else -a[max(i, j)] * (abs(i - j) == 1) for j in range(n)] for i in range(n)]

    nothing, along = [mpf(0)] * n, [mpf(i + 1 == CHAIN["stop_at"]) for i in range(n)]
    b, offset = mpf(numbers["b"]), mpf(numbers["offset"])
    return Linear(
        [[m[i] * (i == j) for j in range(n)] for i in range(n)], linked(k), linked(c), along, constant, force, nothing,
        mpf(numbers["omega"]), mpf(numbers["tau"]), offset - b, offset + b, mpf(numbers["R_left"]), mpf(numbers["R"]),
    )  # fmt: skip


def quotient(function, x):
    return [float((p - q) / (2 * STEP)) for p, q in zip(function(x + STEP), function(x - STEP), strict=True)]


@pytest.mark.parametrize("case", CASES)
def test_derivatives_against_thirty_digits(case):
    changes, periods, rests = CASES[case]
    system = chain(**changes)
    step = PeriodMap(system)
    found = step([STATE], periods, jacobian=True, parameters=True)
    assert found.status[0] == status.OK and set(found.impacts[0]["side"]) == {-1, 1}
    assert (len(found.sticking[0]) > 0) == rests
    numbers, start = system.numbers, [mpf(x) for x in STATE]

    def end_of(state=start, **moved):
        machine = machine_of(slow_chain(numbers | moved))
        return simulate(machine, state, periods=periods, digits=DIGITS).section[-1]

    columns = range(len(STATE)) if rests else (0, 3)
    exact = [
        quotient(lambda x, i=i: end_of([x if i == j else s for j, s in enumerate(start)]), start[i]) for i in columns
    ]
    assert np.abs(found.jacobian[0][:, columns] - np.array(exact).T).max() < 1e-10 * np.abs(exact).max()
    names = [name for name in (step.names if rests else FAST) if name != "R" or numbers["R"] > 0]
    exact = [quotient(lambda x, n=name: end_of(**{n: x}), mpf(numbers[name])) for name in names]
    at = [step.names.index(name) for name in names]
    assert np.abs(found.parameters[0][:, at] - np.array(exact).T).max() < 1e-10 * np.abs(exact).max()


def test_states_and_impacts_are_those_of_simulate():
    for system, state in ((chain(R=0.4), STATE), drawn(2, 3)):
        mapped = PeriodMap(system)([state, np.full(6, np.nan)], 3)
        orbit = vs.simulate(system, state, 3)
        assert list(mapped.status) == [status.OK, status.NOT_FINITE]
        np.testing.assert_array_equal(mapped.states[0], orbit.section[-1])
        np.testing.assert_array_equal(mapped.impacts[0], orbit.impacts)
        np.testing.assert_array_equal(mapped.sticking[0], orbit.sticking)


def test_a_period_is_two_halves():
    """The second half is the first one of a force half a period later; no symmetry is needed."""
    system, state = drawn(5, 3)
    whole = PeriodMap(system)([state], jacobian=True, parameters=True)
    first = PeriodMap(system)([state], 0.5, jacobian=True, parameters=True)
    second = PeriodMap(system.replace(tau=system.tau + np.pi))(first.states, 0.5, jacobian=True, parameters=True)
    assert len(first.impacts[0]) > 0 and len(second.impacts[0]) > 0
    np.testing.assert_allclose(second.states, whole.states, rtol=0, atol=1e-12)
    size = np.abs(whole.jacobian).max()
    np.testing.assert_allclose(second.jacobian @ first.jacobian, whole.jacobian, rtol=0, atol=1e-11 * size)
    chained = second.jacobian @ first.parameters + second.parameters
    np.testing.assert_allclose(chained, whole.parameters, rtol=0, atol=1e-11 * np.abs(whole.parameters).max())


def test_tau_that_follows_the_graze():
    """The total derivative is that at a fixed phase and what the phase changes."""
    system = chain(tau="grazing")
    found = PeriodMap(system)([STATE], parameters=True)
    names, fixed = PeriodMap(system).names, PeriodMap(system.replace(tau=system.linear.tau))([STATE], parameters=True)
    for j, name in enumerate(names[:-1]):
        change = 0.0 if name == "tau" else system.family.derivative(name).tau
        total = fixed.parameters[0, :, j] + change * fixed.parameters[0, :, names.index("tau")]
        np.testing.assert_allclose(found.parameters[0, :, j], total, rtol=0, atol=1e-10, err_msg=name)
    assert np.abs(found.parameters - fixed.parameters).max() > 0.1


# --- flights without stops


def test_flights_without_stops():
    """The motion, first contacts and turning points of the gap, against the simulation and a dense look."""
    system, state = drawn(3, 3)
    flights, q = FreeFlight(system), system.linear
    X = state + 4 * np.random.default_rng(1).normal(size=(40, 6))
    contacts = flights.first_contact(X, 0.7, 2 * system.period)
    assert (contacts.status == status.OK).all() and np.isfinite(contacts.elapsed).sum() > 20
    inside = (X[:, 0::2] @ q.normal > q.low) & (X[:, 0::2] @ q.normal < q.high)
    assert 5 < inside.sum() < 40
    for i in np.flatnonzero(inside & np.isfinite(contacts.elapsed))[:5]:
        first = vs.simulate(system, X[i], 3, start_time=0.7).impacts[0]
        assert first["side"] == contacts.side[i] and abs(first["t"] - 0.7 - contacts.elapsed[i]) < 1e-12
        there = flights.sample(X[i : i + 1], 0.7, [contacts.elapsed[i]])[0, 0]
        np.testing.assert_allclose(there[0::2], first["x"], rtol=0, atol=1e-12)
    found = flights.extremes(X, 0.7, 2 * system.period)
    gap = flights.sample(X, 0.7, np.linspace(0, 2 * system.period, 2001))[..., 0::2] @ q.normal
    peaks = (gap[:, 1:-1] > gap[:, :-2]) & (gap[:, 1:-1] > gap[:, 2:])
    seen = np.where(peaks, gap[:, 1:-1], -np.inf).max(1)
    assert (seen <= found.highest[:, 1] + 1e-12).all() and (found.highest[:, 1] - seen < 1e-3)[seen > -np.inf].all()
    assert (found.highest[:, 1] - found.highest[:, 0])[seen > -np.inf].max() < 1e-12


# --- the discontinuity mapping

SYMMETRIC = dict(constant=[0.0, 0.0, 0.0], offset=0.0, R_left=None, tau="grazing")


@pytest.mark.parametrize(
    ("order", "expand_at"),
    [(2, 0.9), (1, None), (1, 0.9), (2, None)],
)
def test_discontinuity_mapping(order, expand_at):
    """The map and its derivatives, by masses and springs too, against the slow one."""
    system = chain(**SYMMETRIC)
    system = system.replace(b=0.95 * vs.grazing(system).b)
    step, numbers = PeriodMap(system, order, expand_at), system.numbers | {"offset": 0.0, "tau": 0.0}
    for moved in ((0.03, 0.01, 0.08, -0.05, 0.01, 0.03), (-0.02, -0.03, 0.05, 0.04, -0.01, 0.1)):
        state = step.graze + moved
        found = step([state], jacobian=True, parameters=True)
        assert len(found.impacts[0]) > 0

        X = [mpf(x) for x in state]

        def slow(X=X, **changes):
            given = numbers | changes
            return list(AnyNaiveMap(slow_chain(given | {"R_left": given["R"]}), order, expand_at)(mp.matrix(X)))

        np.testing.assert_allclose(found.states[0], [float(x) for x in slow()], rtol=0, atol=1e-12)
        exact = [quotient(lambda x, i=i, X=X: slow([*X[:i], x, *X[i + 1 :]]), X[i]) for i in range(6)]
        assert np.abs(found.jacobian[0] - np.array(exact).T).max() < 1e-10 * np.abs(exact).max()
        for name in ("m1", "m2", "k3", "c2", "force1", "omega", "b", "R"):
            exact = np.array(quotient(lambda x, n=name: slow(**{n: x}), mpf(numbers[name])))
            error = np.abs(found.parameters[0, :, step.names.index(name)] - exact).max()
            assert error < 1e-9 * max(1, np.abs(exact).max()), name


def test_discontinuity_mapping_of_the_paper_by_its_matrices():
    numbers = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.1, omega=0.63, R=0.8, b=6.25)
    system = vs.System(**numbers)
    q = system.linear
    same = vs.Oscillator(
        q.M, q.K, q.C, contact_normal=q.normal, force=q.sine, force_cos=q.cosine, omega=0.63, R=0.8, b=6.25
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


def monodromy(q, state, periods):
    """The Jacobian of the map over so many periods, by difference quotients in 30 digits."""
    columns = []
    with mp.workdps(30):
        step = mpf(10) ** -14
        for j in range(len(state)):
            ends = []
            for sign in (1, -1):
                start = [mpf(float(x)) + (sign * step if i == j else 0) for i, x in enumerate(state)]
                ends.append(simulate(machine_of(q), start, periods=periods).section[periods])
            columns.append([float((a - b) / (2 * step)) for a, b in zip(*ends, strict=True)])
    return np.array(columns).T


@pytest.mark.parametrize("masses", (1, 2, 3))
def test_growth_of_tangent_vectors(masses):
    """Over a record of some periods: singular values of its Jacobian, in the metric of the tangent vectors.

    The sum rule alone would not see a wrong term beside the diagonal of the saltation matrix.
    """
    for seed in (6, 7):
        system, state = drawn(seed, masses)
        periods = 2
        jacobian = monodromy(system.linear, state, periods)
        point = vs.simulate(system, state, 0)._engine.point[0]
        turned = np.kron(point["P"], np.eye(2))
        frame = point["to_frame"] @ turned
        lengths = np.abs(np.diag(np.linalg.qr(frame @ jacobian @ np.linalg.inv(frame))[1]))
        exponents = vs.lyapunov(system, state, transient=0, record=periods)
        assert abs(exponents.residual) < 1e-12
        np.testing.assert_allclose(exponents, np.sort(np.log(lengths) / (periods * system.period))[::-1], atol=1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        dict(offset=0.3, R_left=0.6),
        dict(offset=0.2),
        dict(mu_c=2.0, offset=-0.2, R_left=0.7),
        dict(mu_c=9.0),
    ],
)
def test_derivatives_of_the_period_map(changes):
    """By the state and by every parameter, against difference quotients; unequal stops, damping not proportional."""
    numbers = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.25, omega=0.63, R=0.8, b=2.0, tau=0.4) | changes
    state = np.array([0.1, 0.9, 0.3, -0.1])

    def end(state, **more):
        return PeriodMap(vs.System(**numbers | more))([state], 2).states[0]

    found = PeriodMap(vs.System(**numbers))([state], 2, jacobian=True, parameters=True)
    assert set(found.impacts[0]["side"]) == {-1, 1}
    h, size = 1e-6, np.abs(found.jacobian[0]).max()
    for j, unit in enumerate(np.eye(4)):
        quotient = (end(state + h * unit) - end(state - h * unit)) / (2 * h)
        np.testing.assert_allclose(found.jacobian[0][:, j], quotient, atol=1e-7 * size)
    for j, name in enumerate(NAMES):
        step = h * numbers[name]
        quotient = (end(state, **{name: numbers[name] + step}) - end(state, **{name: numbers[name] - step})) / (
            2 * step
        )
        bound = 1e-6 * max(np.abs(found.parameters[0][:, j]).max(), 1)
        np.testing.assert_allclose(found.parameters[0][:, j], quotient, atol=bound, err_msg=name)
