"""The equations of a curve in an order in which elimination leaves their zeros alone: its cost grows like K^2, not K^3.

The equations of an impact know the impacts before it, its own time and impulse, the state before the first one, and the
parameters. Impact by impact, each equation knows two unknowns that those before it do not. So in each column of the
transposed matrix only as many entries below the diagonal are not zero as there are other unknowns than times and
impulses, whichever rows pivots bring up; `factorise` skips the zeros.
"""

from vibro_sweep.engine.impulses.factors import substitute, substitute_transposed
from vibro_sweep.engine.simd.jit import jit


@jit
def place_of(i, K):
    """Of an equation or an unknown: those of the impacts, two of each, one impact after another; then the others."""
    if i < K:
        return 2 * i
    return 2 * (i - K) + 1 if i < 2 * K else i


@jit
def put_equations(T, c, M, K, mu, without):
    """M(mu), scaled, to T. without : impact that is left out, or -1."""
    S = len(M)
    for i in range(S):
        line, scale = place_of(i, K), 1.0 / c.row_unit[i]
        for j in range(K):
            T[2 * j, line] = M[i, j] * c.unit[j] * scale
            T[2 * j + 1, line] = M[i, K + j] * c.unit[K + j] * scale
        for j in range(2 * K, S):
            T[j, line] = M[i, j] * c.unit[j] * scale
    for i in range(2 * K, S):
        T[i, i] += c.sigma * mu * c.unit[i] / c.row_unit[i]
    if without >= 0:
        for i in (2 * without, 2 * without + 1):
            for j in range(S):
                T[i, j] = T[j, i] = 0.0
            T[i, i] = 1.0


@jit
def turn(A, size, K, T):
    """A but its last row to T."""
    for j in range(size):
        place = place_of(j, K)
        for i in range(K):
            T[place, 2 * i], T[place, 2 * i + 1] = A[i, j], A[K + i, j]
        for i in range(2 * K, size - 1):
            T[place, i] = A[i, j]


@jit
def solve(T, size, order, K, x, scratch):
    """x <- A^-1 x with the factors of A, turned."""
    line_up(size, K, x, scratch)
    substitute_transposed(T, size, order, scratch)
    take_back(size, K, scratch, x)


@jit
def solve_adjoint(T, size, order, K, x, scratch):
    """x <- A^-T x."""
    line_up(size, K, x, scratch)
    substitute(T, size, order, scratch)
    take_back(size, K, scratch, x)


@jit
def line_up(size, K, x, scratch):
    for i in range(size):
        scratch[place_of(i, K)] = x[i]


@jit
def take_back(size, K, scratch, x):
    for i in range(size):
        x[i] = scratch[place_of(i, K)]
