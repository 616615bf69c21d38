"""Any linear oscillator with one contact, against a reference that works in the coordinates of its masses."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of
from support import slow_cases
from support.any_oscillators import drawn
from support.first_impacts import MASSES, study
from support.searching import searched

import vibro_sweep as vs
from vibro_sweep.engine.period_map import PeriodMap
from vibro_sweep.model.parameters import NAMES

# Each number of masses compiles kernels of its own, and so does a constant force.
SMALL = slow_cases(1, 2, 3)


@pytest.mark.parametrize(
    ("masses", "draws", "least"),
    slow_cases((2, 1, 1), (1, 6, 5), (2, 9, 5), (3, 15, 5), (5, 8, 2), (8, 7, 1)),
)
def test_first_impacts(masses, draws, least):
    """No further from 30 digits than 10 times what rounding the inputs does."""
    counted, wrong = searched(study, range(MASSES.index(masses), draws * len(MASSES), len(MASSES)))
    assert wrong == [] and counted["orbits"] >= least


@pytest.mark.parametrize("masses", SMALL)
def test_sticking_and_release(masses):
    """Chatter summed up, and rests that the other masses outlast: their times and the states that they lead to."""
    rests = 0
    for seed, R in ((3, 0.3), (4, 0.0), (5, 0.4)):
        system, state = drawn(seed, masses, R=R, R_left=R, b=0.15)
        orbit = vs.simulate(system, state, 6)
        exact = simulate(machine_of(system.linear), state, periods=6)
        assert orbit.status == "ok"
        long = [rest for rest in exact.rests if rest.t_off - rest.t_on > 1e-6]
        found = orbit.sticking[orbit.sticking["t_off"] - orbit.sticking["t_on"] > 1e-6]
        np.testing.assert_allclose(found["t_on"], [float(rest.t_on) for rest in long], rtol=0, atol=1e-9)
        np.testing.assert_allclose(found["t_off"], [float(rest.t_off) for rest in long], rtol=0, atol=1e-9)
        assert list(found["side"]) == [rest.side for rest in long]
        np.testing.assert_allclose(orbit.section, np.array(exact.section, float), rtol=0, atol=1e-9)
        rests += len(long)
    assert rests > 5


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


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.parametrize("masses", MASSES)
def test_sum_rule(masses):
    for seed in (8, 9, 10):
        system, state = drawn(seed, masses)
        exponents = vs.lyapunov(system, state, transient=50, record=500)
        hits = len(vs.simulate(system, state, 100).impacts)
        assert hits > 50 and (abs(exponents.residual) < 1e-12 or exponents[-1] == -np.inf)


def test_unequal_restitution_in_the_sum_rule():
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0.25, omega=0.63, b=2.0, offset=0.3, R=0.8, R_left=0.6)
    exponents = vs.lyapunov(system, [0.1, 0.2, 0.3, -0.1], transient=100, record=1000)
    sides = vs.simulate(system, [0.1, 0.2, 0.3, -0.1], 200).impacts["side"]
    assert set(sides) == {-1, 1} and abs(exponents.residual) < 1e-13


@pytest.mark.slow
def test_kinds_of_damping_and_of_modes():
    """Free, critical, overdamped, equal and unseen modes: without impacts the exponents are real parts of the roots."""
    chain = np.array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    eye = np.eye(3)
    kinds = {
        "free, undamped": (chain, 0 * eye),
        "free, damped inside": (chain, 0.1 * chain),
        "free, damped outside": (chain, np.diag([0, 0, 0.3])),
        "dampers alone": (0 * eye, 0.2 * chain + 0.1 * eye),
        "critical": (np.diag([1.0, 4, 9]), np.diag([2.0, 0.2, 6])),
        "overdamped": (chain + eye, np.diag([9.0, 0.1, 4])),
        "equal": (2 * eye, 0.1 * eye),
        "equal, not classical": (2 * eye, np.array([[0.3, 0.1, 0], [0.1, 0.2, 0], [0, 0, 0.1]])),
    }
    for name, (K, C) in kinds.items():
        system = vs.Oscillator(
            eye,
            K,
            C,
            contact_normal=[1, 0, 0],
            force=[1e-3, 0, 0],
            constant=[0, 1e-6, 0],
            omega=0.7,
            tau=0.0,
            b=1e6,
            R=0.8,
        )
        A = np.block([[0 * eye, eye], [-K, -C]])
        exact = np.sort(np.linalg.eigvals(A).real)[::-1]
        found = vs.lyapunov(system, np.zeros(6), transient=200, record=50)
        np.testing.assert_allclose(found, exact, atol=1e-6 if "critical" in name else 1e-7, err_msg=name)
        assert abs(found.residual) < 1e-12, name


@pytest.mark.slow
@pytest.mark.parametrize(("R", "K1"), [(0.6, 0.0), (0.6, 4.0), (0.0, 4.0)])
@pytest.mark.parametrize(("K2", "C2"), [(1.0, 0.1), (0.0, 0.0), (9.0, 0.2)])
def test_masses_that_the_contact_does_not_see(R, K1, K2, C2):
    """They keep their exponents, whatever a rest or an impact without restitution takes from the other."""
    system = vs.Oscillator(
        np.eye(3), np.diag([K1, K2, 2]), np.diag([0.02, C2, 0.06]), contact_normal=[1, 0, 0], force=[1, 0, 0],
        constant=[-1, 0, 0], omega=0.8, tau=0.0, b=0.0, R=R, stops="left",
    )  # fmt: skip
    state = np.array([0.2, 0.0, 0.1, 0.0, 0.1, 0.2])
    found, orbit = vs.lyapunov(system, state, 20, 200), vs.simulate(system, state, 200)
    alone = vs.Oscillator(
        [[1.0]],
        [[K1]],
        [[0.02]],
        contact_normal=[1],
        force=[1],
        constant=[-1],
        omega=0.8,
        tau=0.0,
        b=0.0,
        R=R,
        stops="left",
    )
    other = vs.lyapunov(alone, state[:2], 20, 200)
    assert len(orbit.impacts) > 10
    exact = np.sort([*other, -C2 / 2, -C2 / 2, -0.03, -0.03])[::-1]
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    "changes",
    [
        dict(offset=0.3, R_left=0.6),
        dict(offset=0.2),
        *slow_cases(dict(mu_c=2.0, offset=-0.2, R_left=0.7), dict(mu_c=9.0)),
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


@pytest.mark.parametrize("stops", ["both", "right"])
def test_units_change_nothing(stops):
    """In units that are a power of two larger all is the same, also where the search leaves single precision."""
    K, start = np.array([[2.0, -1.0], [-1.0, 2.0]]), np.zeros(4)
    units = [2.0**k for k in (0, -300, -140, -110, 90, 120, 126, 128, 400)]
    systems = [
        vs.Oscillator(
            np.eye(2),
            K,
            0.05 * K,
            force=[unit, 0],
            contact_normal=[1, 0],
            omega=0.9,
            b=0.8 * unit,
            R=0.8,
            tau=0.0,
            stops=stops,
        )
        for unit in units
    ]
    first, *others = (vs.simulate(system, start, 60).impacts["t"] for system in systems)
    assert len(first) > 100
    for unit, times in zip(units[1:], others, strict=True):
        np.testing.assert_array_equal(times, first, f"{unit:g}")
