"""Small matrices of tangent vectors: factors Q R by rotations, which leave a large row alone, and inverses of R."""

import math

from vibro_sweep.engine.simd.jit import jit


@jit
def factorise(R, Q):
    """R becomes that of Q R, with a diagonal that is not negative.

    Its second row may be large, and stay the only such: others are brought to Hessenberg's form without it first.
    """
    size = len(R)
    for a in range(size):
        for j in range(size):
            Q[a, j] = 1.0 if a == j else 0.0
    swap_rows(R)
    for first in (1, 0):
        for j in range(size - first):
            for m in range(j + first + 1, size):
                if R[m, j] != 0.0:
                    rotate(R, Q, j, j + first, m)
    for j in range(size):
        if R[j, j] < 0.0:
            for a in range(size):
                R[j, a], Q[a, j] = -R[j, a], -Q[a, j]
    swap_rows(Q)


@jit
def rotate(R, Q, j, n, m):
    """Rotate entry j of row m of R into row n, and the columns of Q with them."""
    length = math.hypot(R[n, j], R[m, j])
    cos, sin = R[n, j] / length, R[m, j] / length
    for k in range(j, len(R)):
        x, y = R[n, k], R[m, k]
        R[n, k], R[m, k] = cos * x + sin * y, cos * y - sin * x
    R[m, j] = 0.0
    for a in range(len(Q)):
        x, y = Q[a, n], Q[a, m]
        Q[a, n], Q[a, m] = cos * x + sin * y, cos * y - sin * x


@jit
def swap_rows(A):
    """Exchange the first two rows."""
    for j in range(len(A)):
        A[0, j], A[1, j] = A[1, j], A[0, j]


@jit
def invert(R, size):
    """R^-1 in place of an upper triangular matrix R."""
    for j in range(size):
        R[j, j] = 1.0 / R[j, j]
        for k in range(j):
            total = 0.0
            for m in range(k, j):
                total += R[k, m] * R[m, j]
            R[k, j] = -R[j, j] * total
