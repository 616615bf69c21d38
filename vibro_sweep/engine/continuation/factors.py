"""Triangular factors of a small real or complex matrix, for solutions, adjoint solutions and determinants."""

from vibro_sweep.engine.simd.jit import small
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import eight, put_eight


@small
def square(x):
    """|x|^2 of a real or complex number."""
    return x.real * x.real + x.imag * x.imag


@small
def factorise(a, size, order):
    """Replace the leading block of a by its factors, rows exchanged as in `order`; its determinant, 0 if singular."""
    determinant = a[0, 0] * 0.0 + 1.0
    for j in range(size):
        best = j
        for i in range(j + 1, size):
            if square(a[i, j]) > square(a[best, j]):
                best = i
        order[j] = best
        if best != j:
            determinant = -determinant
            for k in range(size):
                a[best, k], a[j, k] = a[j, k], a[best, k]
        determinant *= a[j, j]
        if not square(a[j, j]) > 0.0:
            return a[j, j] * 0.0
        inverse = 1.0 / a[j, j]
        for i in range(j + 1, size):
            if square(a[i, j]) == 0.0:
                continue
            factor = a[i, j] * inverse
            a[i, j] = factor
            for k in range(j + 1, size):
                a[i, k] -= factor * a[j, k]
    return determinant


@small
def substitute(a, size, order, x):
    """x <- a^-1 x."""
    for j in range(size):
        x[j], x[order[j]] = x[order[j]], x[j]
    for j in range(size):
        for i in range(j + 1, size):
            x[i] -= a[i, j] * x[j]
    for j in range(size - 1, -1, -1):
        x[j] /= a[j, j]
        for i in range(j):
            x[i] -= a[i, j] * x[j]


@small
def substitute_transposed(a, size, order, x):
    """x <- a^-T x."""
    for j in range(size):
        for i in range(j):
            x[j] -= a[i, j] * x[i]
        x[j] /= a[j, j]
    for j in range(size - 1, -1, -1):
        for i in range(j + 1, size):
            x[j] -= a[i, j] * x[i]
    for j in range(size - 1, -1, -1):
        x[j], x[order[j]] = x[order[j]], x[j]


@small
def solve_rows(a, size, width):
    """Overwrite columns `size` .. `width` - 1 of a by the solutions of the system before them. False: singular.

    Rows are whole vectors.
    """
    stride = a.shape[1]
    for j in range(size):
        best, begin = j, j - j % LANES
        for i in range(j + 1, size):
            if abs(a[i, j]) > abs(a[best, j]):
                best = i
        if not abs(a[best, j]) > 0.0:
            return False
        scale = 1.0 / a[best, j]
        for k in range(begin, width, LANES):
            pivot = eight(a, stride * best + k)
            put_eight(a, stride * best + k, eight(a, stride * j + k))
            put_eight(a, stride * j + k, scale * pivot)
        for i in range(size):
            if i != j:
                factor = a[i, j]
                for k in range(begin, width, LANES):
                    put_eight(a, stride * i + k, eight(a, stride * i + k) - factor * eight(a, stride * j + k))
    return True
