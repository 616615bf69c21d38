"""`dynamics: map` for any symmetric oscillator, against `discontinuity_map`: the same map in other formulas."""

import numpy as np
import pytest
from support.scene_texts import parsed

import vibro_sweep as vs

SYSTEMS = {
    "one mass": "{type: one_mass, k: 1, zeta: 0.05, F: 1, omega: 0.8, R: 0.7, b: %s}",
    "two masses by matrices": (
        "{type: linear, M: [[1, 0], [0, 2]], K: [[2, -1], [-1, 3]], C: [[0.3, -0.1], [-0.1, 0.05]], force: [1, 0.2], "
        "contact_normal: [1, -1], omega: 0.7, R: 0.6, b: %s}"
    ),
    "a chain of three": (
        "{type: chain, m: [1, 2, 1], k: [1, 1, 1, 1], c: [0.3, 0.05, 0.1, 0.3], force: [1, 0, 0], stop_at: 1, "
        "omega: 0.6, R: 0.6, b: %s}"
    ),
}
REST = "dynamics: map\norder: %d\norbit: {transient: %d, record: %d}\nobserve: [section, lyapunov]\n"


def dataset(system, order, transient, record, tmp_path):
    scene = parsed(f"system: {system}\n" + REST % (order, transient, record))
    vs.run(scene, tmp_path / "map.h5")
    with vs.open(tmp_path / "map.h5") as found:
        return scene.system, found.load()


def states_of(data, masses):
    names = [f"{what}{m}" for m in range(1, masses + 1) for what in "xv"]
    return np.stack([data[name].values for name in names], -1)


def far(system):
    """With the stops out of reach, at the same phase."""
    return system.replace(b=1e3 * system.b, tau=system.phase)


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("name", SYSTEMS)
def test_sections_and_exponents(name, order, tmp_path):
    """Iterations with impacts one by one; at a fixed point the exponents are those of the Jacobian's eigenvalues."""
    top = vs.grazing(
        parsed(f"system: {SYSTEMS[name] % 1}\nobserve: [section]\norbit: {{transient: 0, record: 1}}\n").system
    ).b
    system, data = dataset(SYSTEMS[name] % (0.97 * top), order, 400, 60, tmp_path)
    X, P = states_of(data, system.linear.M.shape[0]), vs.discontinuity_map(system, order)
    found, free = (np.array([mapped(x) for x in X[:-1]]) for mapped in (P, vs.discontinuity_map(far(system), order)))
    assert np.abs(found - free).max() > 1e-3 * abs(X).max()  # it has impacts
    np.testing.assert_allclose(found, X[1:], rtol=0, atol=1e-12 * abs(X).max())
    assert data.status == 0
    if (name, order) == ("a chain of three", 1):  # does not repeat itself
        return
    assert data.period > 0
    J = np.eye(X.shape[1])
    for x in X[: int(data.period)]:
        J = P.jacobian(x) @ J
    exact = np.sort(np.log(abs(np.linalg.eigvals(J))))[::-1] / (int(data.period) * system.period)
    np.testing.assert_allclose(data.lyapunov.values, exact, rtol=0, atol=1e-8)
