"""Gaussian elimination with pivots, for the small systems of periodic orbits."""

from vibro_sweep.engine.simd.jit import jit


@jit
def bring_up(a, j):
    """Bring the largest entry of column j, from the diagonal down, onto it: -1 for a change of rows; 0 without one."""
    best = j
    for i in range(j + 1, len(a)):
        if abs(a[i, j]) > abs(a[best, j]):
            best = i
    if not abs(a[best, j]) > 0.0:
        return 0.0
    if best == j:
        return 1.0
    for k in range(a.shape[1]):
        a[best, k], a[j, k] = a[j, k], a[best, k]
    return -1.0


@jit
def solve(a):
    """Overwrite the columns of a (n, n + m) after the first n by the solutions. Returns whether there are any."""
    n, width = a.shape
    for j in range(n):
        if bring_up(a, j) == 0.0:
            return False
        inverse = 1.0 / a[j, j]
        for k in range(j, width):
            a[j, k] *= inverse
        for i in range(n):
            if i != j:
                factor = a[i, j]
                for k in range(j, width):
                    a[i, k] -= factor * a[j, k]
    return True
