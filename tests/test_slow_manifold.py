"""The two motions of a contact, set apart: against the matrix exponential of both together. Python runs the kernels."""

import numpy as np
import pytest
from scipy.linalg import expm

from vibro_sweep.engine.compliant.passage_tables import passages_of, set_duration
from vibro_sweep.engine.compliant.slow_manifold import set_apart

ORBIT, STOP = 3, 1


def random_contact(masses, k, seed):
    """The equations of a contact, (delta'', w2'', ...) by (delta, delta', w2, ..., sin, cos, 1); c, and omega."""
    rng = np.random.default_rng([masses, seed])
    G = rng.normal(size=(masses, 2 * masses + 3))
    for m in range(1, masses):
        G[m, 2 * m], G[m, 2 * m + 1] = -1.0 - abs(G[m, 2 * m]), -0.1 * abs(G[m, 2 * m + 1])
    c = 0.2 * np.sqrt(k) * rng.uniform()
    G[0, :2] = -k - rng.uniform(), -c - 0.1 * rng.uniform()
    return G, c, rng.uniform(0.3, 2.0)


def whole(G, omega):
    """The matrix of (delta, delta', w2, w2', ..., sin, cos, 1)."""
    masses = len(G)
    A = np.zeros((2 * masses + 3, 2 * masses + 3))
    for m in range(masses):
        A[2 * m, 2 * m + 1], A[2 * m + 1] = 1.0, G[m]
    A[-3, -2], A[-2, -3] = omega, -omega
    return A


def tables(G, c, omega):
    masses = len(G)
    passage = np.zeros(1, passages_of(masses, True)).view(np.recarray)[0]
    passage.compliant[STOP, ORBIT], passage.stiffness[STOP, ORBIT] = 1.0, -G[0, 0]
    set_duration(passage, STOP, ORBIT, -G[0, 0], -0.5 * G[0, 1])
    set_apart(passage, STOP, ORBIT, G, c, omega)
    return passage


@pytest.mark.parametrize("masses", [1, 2, 3, 4])
@pytest.mark.parametrize("k", [300.0, 1e4, 1e8])
def test_both_motions_are_those_of_the_whole(masses, k):
    counted = 0
    for seed in range(10):
        G, c, omega = random_contact(masses, k, seed)
        passage, A = tables(G, c, omega), whole(G, omega)
        u = passage.duration[STOP, ORBIT]
        if passage.reach[STOP, ORBIT] < u:
            continue
        counted += 1
        L, H, F, S = passage.L, passage.H, passage.F, passage.S
        gamma, kd = passage.fast[10 * STOP : 10 * STOP + 2, ORBIT]
        fast = np.exp(-gamma * u) * (np.cos(kd * u) * np.eye(2) + np.sin(kd * u) / kd * F)  # F: A - L C + gamma
        slow = expm(S * u)
        size = len(S)
        together = np.block([[np.eye(2) + L @ H, L], [H, np.eye(size)]])
        apart = np.block([[np.eye(2), -L], [-H, np.eye(size) + H @ L]])
        flights = np.block([[fast, np.zeros((2, size))], [np.zeros((size, 2)), slow]])
        scale = np.diag([np.sqrt(k), 1.0, *[1.0] * size])
        error = scale @ (together @ flights @ apart - expm(A * u)) @ np.linalg.inv(scale)
        assert np.abs(error).max() < 1e-11 * max(1.0, np.sqrt(k) * u)
    assert counted >= (8 if k >= 1e4 else 1)


@pytest.mark.parametrize("masses", [1, 2, 4])
def test_vectors_fly_in_coordinates_without_jumps_of_size_c(masses):
    """J (A - L C + gamma) J^-1, J = (1, 0; c, 1): multiplied out in longer floats."""
    G, c, omega = random_contact(masses, 1e4, 1)
    passage = tables(G, c, omega)
    J = np.array([[1, 0], [c, 1]], np.longdouble)
    J_inverse = np.array([[1, 0], [-c, 1]], np.longdouble)
    expected = J @ passage.F.astype(np.longdouble) @ J_inverse
    found = passage.fast[10 * STOP + 6 : 10 * STOP + 10, ORBIT].reshape(2, 2)
    assert np.allclose(found, expected.astype(float), rtol=1e-10, atol=1e-10)


def test_a_soft_stop_has_no_slow_motion_beside_it():
    """There the iteration does not converge; contacts go by Taylor series."""
    G, c, omega = random_contact(2, 0.5, 2)
    with np.errstate(all="ignore"):
        assert tables(G, c, omega).reach[STOP, ORBIT] == 0.0
