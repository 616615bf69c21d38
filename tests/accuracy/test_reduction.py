"""Large models by their lowest modes and the static flexibility at the contact: `Oscillator.reduced`."""

import pickle

import numpy as np
import pytest
from scipy import sparse

import vibro_sweep as vs


def bar(nodes: int, length: float = 1.0, held: bool = False):
    """Mass and stiffness of an elastic bar of linear elements; density, section and modulus are 1, and so is c."""
    step = length / (nodes - 1)
    M, K = np.zeros((nodes, nodes)), np.zeros((nodes, nodes))
    for i in range(nodes - 1):
        M[i : i + 2, i : i + 2] += step / 6 * np.array([[2, 1], [1, 2]])
        K[i : i + 2, i : i + 2] += np.array([[1, -1], [-1, 1]]) / step
    return (M[1:, 1:], K[1:, 1:]) if held else (M, K)


def at_end(size: int):
    return np.eye(size)[-1]


@pytest.mark.parametrize("modes", [1, 4, 9])
@pytest.mark.parametrize("held", [True, False])
def test_the_reduction_has_the_modes_and_the_static_flexibility(modes, held):
    M, K = bar(60, held=held)
    n = at_end(len(M))
    small = vs.Oscillator.reduced(M, K, modes=modes, contact_normal=n, force=n, omega=1, R=0.5, b=1, modal_damping=0.02)
    basis, q = small.basis, small.linear
    assert basis.shape == (len(M), modes + 1) and np.allclose(basis.T @ M @ basis, np.eye(modes + 1), atol=1e-10)
    assert np.allclose(basis.T @ K @ basis, q.K, atol=1e-7 * q.K.max()) and np.allclose(basis.T @ n, q.contact.normal)
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(M, K)).real)[:modes]
    assert np.allclose(np.sqrt(np.diag(q.K)[:modes]), np.sqrt(np.maximum(squares, 0)), rtol=1e-7, atol=1e-5)
    if held:  # the whole flexibility at the contact
        normal = q.contact.normal
        assert normal @ np.linalg.solve(q.K, normal) == pytest.approx(n @ np.linalg.solve(K, n), rel=1e-9)
    assert np.allclose(np.diag(q.C), 0.04 * np.sqrt(np.diag(q.K)), atol=1e-9)


def test_sparse_matrices_and_a_damping_matrix():
    M, K = bar(400, held=True)
    n = at_end(len(M))
    arguments = dict(modes=5, contact_normal=n, force=n, omega=1, R=0.5, b=1)
    dense = vs.Oscillator.reduced(M, K, 0.01 * K, **arguments)
    thin = vs.Oscillator.reduced(
        *(sparse.csc_matrix(matrix) for matrix in (M, K)), sparse.csr_matrix(0.01 * K), **arguments
    )
    assert np.allclose(np.diag(dense.linear.K), np.diag(thin.linear.K), rtol=1e-8)
    assert np.allclose(dense.linear.C, 0.01 * dense.linear.K, atol=1e-7 * dense.linear.K.max())
    assert vs.grazing(dense).b == pytest.approx(vs.grazing(thin).b, rel=1e-8)
    again = pickle.loads(pickle.dumps(dense.replace(b=2)))
    assert again.b == 2 and np.array_equal(again.basis, dense.basis)


@pytest.mark.slow
def test_a_bar_against_a_wall_stays_there_until_the_wave_returns():
    """2 L/c after it touches; with one modes fewer the rest is shorter or longer by more."""
    M, K = bar(100)
    n = at_end(100)
    system = vs.Oscillator.reduced(
        M, K, modes=15, contact_normal=n, omega=2 * np.pi / 50, R=0, b=0, stops="right", tau=0
    )
    shares = system.basis.T @ M
    state = np.column_stack([shares @ np.full(100, -0.1), shares @ np.ones(100)]).ravel()
    orbit = vs.simulate(system, state, 1)
    (rest,) = orbit.sticking
    assert rest["t_on"] == pytest.approx(0.1, abs=1e-9)
    assert rest["t_off"] - rest["t_on"] == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize(
    "changes, said",
    [
        ({"M": np.ones((3, 4))}, "M: "), ({"K": np.eye(9)}, "K: "), ({"K": np.triu(np.ones((20, 20)))}, "symmetric"),
        ({"modes": 16}, "modes: 16"), ({"modes": 0}, "modes: 0"), ({"contact_normal": [1, 0]}, "20 numbers"),
        ({"force": [1, 2]}, "20 numbers"), ({"contact_normal": "a"}, "a list of finite numbers"),
        ({"M": np.full((20, 20), np.nan)}, "finite"),
    ],
)  # fmt: skip
def test_what_cannot_be_reduced(changes, said):
    M, K = bar(21, held=True)
    arguments = {"M": M, "K": K, "modes": 3, "contact_normal": at_end(20), "omega": 1, "R": 0.5, "b": 1} | changes
    with pytest.raises(ValueError, match=said):
        vs.Oscillator.reduced(**arguments)
