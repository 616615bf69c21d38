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


@jit
def solve_scaled(J, F, size, rows):
    """Overwrite F by J^-1 F, of the first `size` rows, each scaled by its largest entry. False where J is singular.

    rows : scratch (size,)
    """
    for i in range(size):
        largest = 0.0
        for j in range(size):
            largest = max(largest, abs(J[i, j]))
        if not largest > 0.0:
            return False
        rows[i] = 1.0 / largest
    for j in range(size):
        p, best = j, abs(J[j, j]) * rows[j]
        for i in range(j + 1, size):
            if abs(J[i, j]) * rows[i] > best:
                p, best = i, abs(J[i, j]) * rows[i]
        if not best > 0.0:
            return False
        if p != j:
            for k in range(size):
                J[p, k], J[j, k] = J[j, k], J[p, k]
            F[p], F[j] = F[j], F[p]
            rows[p], rows[j] = rows[j], rows[p]
        inverse = 1.0 / J[j, j]
        for i in range(j + 1, size):
            factor = J[i, j] * inverse
            if factor != 0.0:
                for k in range(j + 1, size):
                    J[i, k] -= factor * J[j, k]
                F[i] -= factor * F[j]
    for i in range(size - 1, -1, -1):
        total = F[i]
        for k in range(i + 1, size):
            total -= J[i, k] * F[k]
        F[i] = total / J[i, i]
    return True
