"""The small matrices of tangent vectors while stops relax, compared with NumPy and with 50 digits."""

import numpy as np
from mpmath import mp

from vibro_sweep.engine.compliant.rotations import factorise, invert
from vibro_sweep.engine.simd.jit import exported


@exported
def invert_some(R, size):
    invert(R, size)


@exported
def factorise_some(R, Q):
    factorise(R, Q)


def test_the_inverse_of_a_triangle():
    R = np.triu(np.random.default_rng(1).uniform(0.5, 2, (5, 5)))
    found = R.copy()
    invert_some(found, 5)
    np.testing.assert_allclose(np.triu(found) @ R, np.eye(5), rtol=0, atol=1e-13)


def test_one_large_row_leaves_the_others_their_digits():
    """R of vectors that all lie close to one direction: each of its entries to rounding, not to that of the largest."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        A = rng.normal(size=(4, 4))
        A[1] *= np.sort(10 ** rng.uniform(0, 16, 4))  # later vectors move the stop by more
        R, Q = A.copy(), np.empty((4, 4))
        factorise_some(R, Q)
        with mp.workdps(50):
            _, exact = mp.qr(mp.matrix(A))
            exact = np.array([[float(exact[i, j] * mp.sign(exact[i, i])) for j in range(4)] for i in range(4)])
        np.testing.assert_allclose(np.triu(R), exact, rtol=1e-12, atol=0)
        np.testing.assert_allclose(Q.T @ Q, np.eye(4), rtol=0, atol=1e-14)
