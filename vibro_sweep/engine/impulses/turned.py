"""The equations of a curve in an order in which elimination leaves their zeros alone: its cost grows like K^2, not K^3.

The equations of an impact know the impacts before it, its own time and impulse, the state before the first one, and the
parameters. With the state and the parameters first, and then impact by impact, few entries of each column of the
transposed matrix lie below its diagonal. Pivots are found among them; `factorise` skips the others, which stay 0.
"""

from vibro_sweep.engine.impulses.factors import substitute, substitute_transposed
from vibro_sweep.engine.simd.jit import jit


@jit
def equation(i, K):
    """The place of an equation: gap and velocity impact by impact, then those that close the orbit and others."""
    if i < K:
        return 2 * i
    return 2 * (i - K) + 1 if i < 2 * K else i


@jit
def unknown(j, K, S, size):
    """The place of an unknown: what comes after the S of the orbit, its first state, and t and D impact by impact."""
    if j >= S:
        return j - S
    return size - S + j - 2 * K if j >= 2 * K else size - 2 * K + equation(j, K)


@jit
def put_equations(T, c, M, K, border, mu, without):
    """M(mu), scaled, to T, whose last `border` equations and unknowns are left to the caller.

    without : impact that is left out, or -1
    """
    S = len(M)
    size, state, impacts = S + border, border, S + border - 2 * K
    for i in range(S):
        line, scale = equation(i, K), 1.0 / c.row_unit[i]
        for j in range(K):
            T[impacts + 2 * j, line] = M[i, j] * c.unit[j] * scale
            T[impacts + 2 * j + 1, line] = M[i, K + j] * c.unit[K + j] * scale
        for j in range(2 * K, S):
            T[state + j - 2 * K, line] = M[i, j] * c.unit[j] * scale
    for i in range(2 * K, S):
        T[unknown(i, K, S, size), i] += c.sigma * mu * c.unit[i] / c.row_unit[i]
    if without >= 0:
        for i in (without, K + without):
            line, place = equation(i, K), unknown(i, K, S, size)
            for j in range(size):
                T[place, j] = T[j, line] = 0.0
            T[place, line] = 1.0


@jit
def turn(A, size, K, S, T):
    """A but its last row to T."""
    for j in range(size):
        place = unknown(j, K, S, size)
        for i in range(K):
            T[place, 2 * i], T[place, 2 * i + 1] = A[i, j], A[K + i, j]
        for i in range(2 * K, size - 1):
            T[place, i] = A[i, j]


@jit
def solve(T, size, order, K, S, x, scratch):
    """x <- A^-1 x with the factors of A, turned."""
    for i in range(size):
        scratch[equation(i, K)] = x[i]
    substitute_transposed(T, size, order, scratch)
    for j in range(size):
        x[j] = scratch[unknown(j, K, S, size)]


@jit
def solve_adjoint(T, size, order, K, S, x, scratch):
    """x <- A^-T x."""
    for j in range(size):
        scratch[unknown(j, K, S, size)] = x[j]
    substitute(T, size, order, scratch)
    for i in range(size):
        x[i] = scratch[equation(i, K)]
