"""The two motions of a contact, set apart: against the matrix exponential of both together. Python runs the kernels."""

import numpy as np
import pytest
from scipy.linalg import expm

from vibro_sweep.engine.compliant.closed_tables import set_closed_form
from vibro_sweep.engine.compliant.law import law_of
from vibro_sweep.engine.compliant.passage_tables import passages_of, set_duration
from vibro_sweep.engine.compliant.slow_manifold import is_set_apart, part_of

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
    contact = np.zeros(1, law_of(masses)).view(np.recarray)[0]
    contact.equations[STOP], passage.damping[STOP, ORBIT] = G, c
    passage.compliant[STOP, ORBIT], passage.stiffness[STOP, ORBIT] = 1.0, -G[0, 0]
    set_duration(passage, STOP, ORBIT, -G[0, 0], -0.5 * G[0, 1])
    set_closed_form(passage, STOP, ORBIT, contact, omega)
    return passage, contact


def parts_of(contact, fast):
    """L, H, F, S, as they stand: delta' before delta."""
    part, size = part_of(STOP, fast), len(contact.whole)
    L, H = contact.L[part][:fast, fast:], contact.H[part][fast:, :fast]
    return L, H, contact.F[part][:fast, :fast], contact.S[part][fast:size, fast:size]


@pytest.mark.parametrize("masses", [1, 2, 3, 4])
@pytest.mark.parametrize(
    "z, k, fast", [(0.1, 1e4, 2), (0.5, 1e8, 2), (1.5, 1e8, 2), (10, 1e6, 2), (10, 1e6, 1), (20, 50.0, 1)]
)
def test_equations_set_apart(masses, z, k, fast):
    """They are those of the whole, in other coordinates; z: the damping ratio."""
    for seed in range(10):
        G, _, omega = random_contact(masses, k, seed)
        c = 2 * z * np.sqrt(k)
        G[0, 1] = -c
        contact = np.zeros(1, law_of(masses)).view(np.recarray)[0]
        contact.equations[STOP] = G
        assert is_set_apart(contact, STOP, fast, omega)
        L, H, F, S = parts_of(contact, fast)
        size, nothing = len(S), np.zeros((fast, len(S)))
        together = np.block([[np.eye(fast) + L @ H, L], [H, np.eye(size)]])
        apart = np.block([[np.eye(fast), -L], [-H, np.eye(size) + H @ L]])
        order = [1, 0, *range(2, fast + size)]
        scale = np.array([np.sqrt(k) if fast == 2 else c, 1.0, *[1.0] * (fast + size - 2)])
        error = together @ np.block([[F, nothing], [nothing.T, S]]) @ apart - whole(G, omega)[np.ix_(order, order)]
        assert np.abs(error * scale / scale[:, None] / np.abs(np.linalg.eigvals(F)).max()).max() < 1e-13


@pytest.mark.parametrize("masses", [1, 2, 3, 4])
@pytest.mark.parametrize("k", [300.0, 1e4, 1e8])
def test_both_motions_are_those_of_the_whole(masses, k):
    counted = 0
    for seed in range(10):
        G, c, omega = random_contact(masses, k, seed)
        (passage, contact), A = tables(G, c, omega), whole(G, omega)
        u = passage.duration[STOP, ORBIT]
        if passage.reach[STOP, ORBIT] < u:
            continue
        counted += 1
        L, H, F, S = parts_of(contact, 2)
        L, H, F = L[::-1], H[:, ::-1], F[::-1, ::-1]  # delta first
        gamma, kd = passage.fast[10 * STOP : 10 * STOP + 2, ORBIT]
        fast = np.exp(-gamma * u) * (np.cos(kd * u) * np.eye(2) + np.sin(kd * u) / kd * (F + gamma * np.eye(2)))
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
    passage, contact = tables(G, c, omega)
    gamma, F = passage.fast[10 * STOP, ORBIT], parts_of(contact, 2)[2][::-1, ::-1].astype(np.longdouble)
    J = np.array([[1, 0], [c, 1]], np.longdouble)
    J_inverse = np.array([[1, 0], [-c, 1]], np.longdouble)
    expected = J @ (F + gamma * np.eye(2)) @ J_inverse
    found = passage.fast[10 * STOP + 6 : 10 * STOP + 10, ORBIT].reshape(2, 2)
    assert np.allclose(found, expected.astype(float), rtol=1e-10, atol=1e-10)


def test_a_soft_stop_has_no_slow_motion_beside_it():
    """There the iteration does not converge; contacts go by Taylor series."""
    G, c, omega = random_contact(2, 0.5, 2)
    with np.errstate(all="ignore"):
        assert tables(G, c, omega)[0].reach[STOP, ORBIT] == 0.0
