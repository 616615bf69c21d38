"""The discontinuity mapping: against itself in 50 digits, against the oscillator, and its exact identities."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.naive_map import NaiveMap, linear_family, root_family
from support import slow_cases
from support.scene_texts import parsed

import vibro_sweep as vs

PAPER = vs.System(**naive.PAPER, b=6.6)
CASES = [(right, left) for right in (False, True) for left in (False, True)]  # of (48): which stops are hit
ORDERS = (1, 2)
SCENE = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\ndynamics: map\n"
ORBIT = "orbit: {transient: 500, record: 400}\n"


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(50):
        yield


def states(slow, case, count):
    """States (4,) of this case, at least 0.05 (in squared speed) away from another."""
    rng, found = np.random.default_rng(0), []
    graze = np.array([float(x) for x in slow.graze])
    while len(found) < count:
        X = graze + 0.4 * rng.normal(size=4)
        margins = [slow.strike(point)[1] for point in (mp.matrix(X), slow.middle(mp.matrix(X)))]
        if slow.case(mp.matrix(X)) == case and min(map(abs, margins)) > 0.05:
            found.append(X)
    return found


def floats(matrix):
    return np.array(matrix.tolist(), float).squeeze()


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("case", CASES)
def test_map_and_jacobian_against_fifty_digits(order, case):
    slow, fast = NaiveMap(PAPER.parameters(), order), vs.discontinuity_map(PAPER, order)
    h = mpf(10) ** -18
    for X in states(slow, case, 3):
        start = mp.matrix(X)
        np.testing.assert_allclose(fast(X), floats(slow(start)), rtol=0, atol=1e-13)
        steps = [mp.matrix([h if i == j else 0 for j in range(4)]) for i in range(4)]
        exact = np.stack([floats((slow(start + step) - slow(start - step)) / (2 * h)) for step in steps], axis=1)
        np.testing.assert_allclose(fast.jacobian(X), exact, rtol=0, atol=1e-10)


@pytest.mark.parametrize("system", [{"zeta": 0.9}, {"mu_m": 0.1, "f2": 0.7}, {"omega": 1.3, "zeta": 0.3, "R": 0.0}])
def test_jacobian_of_other_systems(system):
    other = PAPER.replace(**system)
    other = other.replace(b=0.98 * vs.grazing(other).b)  # X* then hits the right stop
    for order in ORDERS:
        slow, fast = NaiveMap(other.parameters(), order), vs.discontinuity_map(other, order)
        X, h = fast.graze, mpf(10) ** -18
        start = mp.matrix(X)
        np.testing.assert_allclose(fast(X), floats(slow(start)), rtol=0, atol=1e-13)
        steps = [mp.matrix([h if i == j else 0 for j in range(4)]) for i in range(4)]
        exact = np.stack([floats((slow(start + step) - slow(start - step)) / (2 * h)) for step in steps], axis=1)
        np.testing.assert_allclose(fast.jacobian(X), exact, rtol=0, atol=1e-10 * max(1, abs(exact).max()))


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("expand_at", [None, 6.7107356])
def test_the_grazing_point_is_fixed_above_its_clearance(order, expand_at):
    start = vs.discontinuity_map(PAPER, order, expand_at).graze
    for b in (start[0], 6.75, 7.0):
        fixed = vs.discontinuity_map(PAPER.replace(b=b), order, expand_at)
        np.testing.assert_allclose(fixed(start), start, rtol=0, atol=5e-15)
    struck = vs.discontinuity_map(PAPER.replace(b=start[0] - 1e-6), order, expand_at)
    assert abs(struck(start) - start).max() > 1e-4  # the square root of 1e-6


def test_where_it_is_expanded():
    np.testing.assert_allclose(vs.discontinuity_map(PAPER).graze, vs.grazing(PAPER).state, rtol=1e-14, atol=1e-15)
    assert vs.discontinuity_map(PAPER, expand_at=6.7107356).graze[0] == 6.7107356


@pytest.mark.parametrize("order", ORDERS)
def test_one_stop_only(order):
    slow, both = NaiveMap(PAPER.parameters(), order), vs.discontinuity_map(PAPER, order)
    right, left = (vs.discontinuity_map(PAPER.replace(stops=stops), order) for stops in ("right", "left"))
    for X in states(slow, (True, False), 2):  # the right stop alone is hit
        np.testing.assert_array_equal(right(X), both(X))
        np.testing.assert_array_equal(right.jacobian(X), both.jacobian(X))
        assert abs(left(X) - both(X)).max() > 0.1
    for X in states(slow, (False, True), 2):
        np.testing.assert_array_equal(left(X), both(X))
        assert abs(right(X) - both(X)).max() > 0.1


def test_how_much_an_impact_contracts():
    """|det S| = R^2 for the oscillator; the order-1 map keeps volumes at an impact, order 2 has R^2 at the graze."""
    free = np.exp(PAPER.divergence * PAPER.period)
    (X,) = states(NaiveMap(PAPER.parameters(), 1), (True, False), 1)
    assert np.linalg.det(vs.discontinuity_map(PAPER, 1).jacobian(X)) == pytest.approx(free, rel=1e-12)
    fast = vs.discontinuity_map(PAPER.replace(b=vs.grazing(PAPER).b, stops="right"), 2)
    losses = [np.linalg.det(fast.jacobian(fast.graze + np.array([psi, 0, 0, 0]))) / free for psi in (1e-4, 1e-6)]
    assert losses[1] == pytest.approx(0.8**2, abs=2e-3)
    assert abs(losses[1] - 0.8**2) < abs(losses[0] - 0.8**2) / 5  # the difference falls like the square root of psi


# --- exponents


def spectrum(step, X, periods, before=0):
    """Exponents by numpy's QR of Jacobians, and the sum of ln|det|, over `periods` from X, after so many `before`."""
    Q, logs, volume = np.eye(4), np.zeros(4), 0.0
    for n in range(before + periods):
        if n == before:
            logs, volume = np.zeros(4), 0.0
        J = step.jacobian(X)
        Q, upper = np.linalg.qr(J @ Q)
        logs += np.log(abs(np.diag(upper)))
        volume += np.linalg.slogdet(J)[1]
        X = step(X)
    time = periods * PAPER.period
    return logs / time, volume / time


@pytest.mark.parametrize(("b", "order"), [(6.6, 1), *slow_cases((6.8, 2), (6.6, 2), (6.69, 1), (6.69, 2), (6.8, 1))])
def test_exponents_add_up_to_the_logarithm_of_the_determinant(tmp_path, b, order):
    step = vs.discontinuity_map(PAPER.replace(b=b), order)
    exponents, volume = spectrum(step, step.graze, 500)
    assert sum(exponents) == pytest.approx(volume, abs=1e-12)
    scene = SCENE.replace("b: 6.6", f"b: {b}") + f"order: {order}\n{ORBIT}start: {{x1: 6}}\nobserve: [lyapunov]"
    vs.run(parsed(scene), tmp_path / "map.h5")
    with vs.open(tmp_path / "map.h5") as data:
        assert abs(float(data.lyapunov_residual)) < 1e-12
        if order == 1:
            assert float(data.lyapunov.sum()) == pytest.approx(PAPER.divergence, abs=1e-12)


def test_the_drivers_exponents_are_those_of_the_jacobians(tmp_path):
    scene = SCENE + "order: 2\norbit: {transient: 2000, record: 400}\nobserve: [section, lyapunov, impacts]"
    vs.run(parsed(scene), tmp_path / "map.h5")
    step = vs.discontinuity_map(PAPER, 2)
    with vs.open(tmp_path / "map.h5") as data:
        period = int(data.period)
        X = np.array([data[name][-1] for name in ("x1", "v1", "x2", "v2")])
        for _ in range(period):
            X = step(X)
        np.testing.assert_allclose(X, [data[name][-1] for name in ("x1", "v1", "x2", "v2")], atol=1e-9)
        exponents, _ = spectrum(step, X, 20 * period, before=60 * period)
        np.testing.assert_allclose(data.lyapunov, np.sort(exponents)[::-1], atol=1e-4)


@pytest.mark.parametrize(("order", "b", "mirrored"), [(1, 6.5, 0), (2, 6.5, 0), (2, 6.6, 1)])
def test_the_driver_iterates_the_map(tmp_path, order, b, mirrored):
    scene = SCENE.replace("b: 6.6", f"b: {b}") + f"order: {order}\nstart: {{x1: 6.5, v1: 0.1}}\n"
    vs.run(parsed(scene + "orbit: {transient: 0, record: 12}"), tmp_path / "map.h5")
    step, X = vs.discontinuity_map(PAPER.replace(b=b), order), np.array([6.5, 0.1, 0, 0])
    with vs.open(tmp_path / "map.h5") as data:
        for n in range(12):
            X = step(X)
            np.testing.assert_allclose(X, [data[name][n] for name in ("x1", "v1", "x2", "v2")], rtol=0, atol=1e-9)


# --- how good it is


def fitted_orders(family, case):
    """Exponents of psi in the one-period error, between 1e-6 and 1e-10, for both orders."""
    sizes, errors = [mpf(10) ** -6, mpf(10) ** -10], []
    for psi in sizes:
        maps = [NaiveMap(PAPER.parameters(), order, shift=0) for order in ORDERS]
        X = family(maps[0], case, psi, (1, 0.7, -0.6, 0.5))
        exact, hit = maps[0].exact(X)
        assert hit == case == maps[1].case(X)
        errors.append([mp.norm(P(X) - exact) for P in maps])
    return [float(mp.log(a / b) / mp.log(sizes[0] / sizes[1])) for a, b in zip(*errors, strict=True)]


def test_without_an_impact_the_map_is_exact():
    P = NaiveMap(PAPER.parameters(), 1, shift=0)
    X = root_family(P, (False, False), mpf(10) ** -6, (1, 0.7, -0.6, 0.5))
    exact, hit = P.exact(X)
    assert hit == (False, False)
    assert mp.norm(P(X) - exact) < 1e-38


@pytest.mark.parametrize("case", [(True, False), (False, True)])
def test_order_of_the_error_for_displacements_like_the_penetration(case):
    assert fitted_orders(linear_family, case) == pytest.approx([1, 1.5], abs=0.01)


@pytest.mark.parametrize(
    ("case", "orders"), [((True, False), (0.5, 1.5)), ((False, True), (0.5, 1.5)), ((True, True), (0.25, 1))]
)
def test_order_of_the_error_for_displacements_like_its_root(case, orders):
    """Two impacts: the square root at the second stop takes away from what the first one left."""
    assert fitted_orders(root_family, case) == pytest.approx(orders, abs=0.05)


# --- scenes


def test_points_beyond_the_stops_are_starts_of_the_map_alone(tmp_path):
    start = ORBIT.replace("500", "0") + "start: {x1: 7}\n"
    vs.run(parsed(SCENE + start), tmp_path / "map.h5")
    with vs.open(tmp_path / "map.h5") as data:
        first = [float(data[name][0]) for name in ("x1", "v1", "x2", "v2")]
    np.testing.assert_allclose(first, vs.discontinuity_map(PAPER)((7, 0, 0, 0)), rtol=0, atol=1e-12)
