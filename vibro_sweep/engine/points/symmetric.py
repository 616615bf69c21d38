"""Symmetric matrices of a few rows, in kernels: eigenvectors, and equations with a positive definite one."""

import math

from vibro_sweep.engine.simd.jit import jit

SWEEPS = 20  # of rotations; four or five are enough
NEGLIGIBLE = 1e-17  # of the diagonal: an entry beside it


@jit
def diagonalise(A, V):
    """A becomes diagonal, V its eigenvectors, one in each column, in rising order of eigenvalues; by Jacobi rotations.
    Returns whether it did."""
    n = len(A)
    for i in range(n):
        for j in range(n):
            V[i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        done = True
        for i in range(n - 1):
            for j in range(i + 1, n):
                if abs(A[i, j]) > NEGLIGIBLE * (abs(A[i, i]) + abs(A[j, j])):
                    done = False
                    rotate(A, V, i, j)
        if done:
            sort_columns(A, V)
            return True
    return False


@jit
def rotate(A, V, i, j):
    """Turn rows and columns i and j of A such that A_ij = 0."""
    n, half = len(A), (A[j, j] - A[i, i]) / (2.0 * A[i, j])
    t = math.copysign(1.0, half) / (abs(half) + math.hypot(half, 1.0))
    c = 1.0 / math.hypot(t, 1.0)
    s = t * c
    A[i, i], A[j, j] = A[i, i] - t * A[i, j], A[j, j] + t * A[i, j]
    A[i, j] = A[j, i] = 0.0
    for k in range(n):
        if k != i and k != j:
            first, second = A[k, i], A[k, j]
            A[k, i], A[k, j] = c * first - s * second, s * first + c * second
            A[i, k], A[j, k] = A[k, i], A[k, j]
    for k in range(n):
        first, second = V[k, i], V[k, j]
        V[k, i], V[k, j] = c * first - s * second, s * first + c * second


@jit
def sort_columns(A, V):
    """Eigenvalues, the diagonal of A, in rising order, and their vectors."""
    for i in range(len(A) - 1):
        for j in range(i, -1, -1):
            if A[j, j] > A[j + 1, j + 1]:
                A[j, j], A[j + 1, j + 1] = A[j + 1, j + 1], A[j, j]
                for k in range(len(A)):
                    V[k, j], V[k, j + 1] = V[k, j + 1], V[k, j]


@jit
def factorise(A, n):
    """A = L D L^T of the first n rows, in place: D, and L below it. Returns whether A is positive definite."""
    for j in range(n):
        for k in range(j):
            A[j, j] -= A[j, k] * A[j, k] * A[k, k]
        if not 0.0 < A[j, j] < math.inf:
            return False
        for i in range(j + 1, n):
            for k in range(j):
                A[i, j] -= A[i, k] * A[j, k] * A[k, k]
            A[i, j] /= A[j, j]
    return True


@jit
def solve(A, n, b):
    """b (n,) becomes the x of L D L^T x = b."""
    for i in range(n):
        for k in range(i):
            b[i] -= A[i, k] * b[k]
    for i in range(n):
        b[i] /= A[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            b[i] -= A[k, i] * b[k]
