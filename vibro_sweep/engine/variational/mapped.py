"""Tangent vectors of one orbit after a linear map, for what happens seldom."""

from vibro_sweep.engine.simd.jit import jit


@jit
def vector_of(t, i, j, x):
    """Fill x with tangent vector j of orbit i, by (x1, v1, x2, ...)."""
    Z, back, size = t.Z, t.from_frame, len(t.growth)
    for a in range(size):
        x[a] = 0.0
        for m in range(size):
            x[a] += back[size * a + m, i] * Z[size * m + j, i]


@jit
def put_vector(t, i, j, x):
    """x, by (x1, v1, x2, ...), becomes tangent vector j of orbit i."""
    Z, to, size = t.Z, t.to_frame, len(t.growth)
    for m in range(size):
        Z[size * m + j, i] = 0.0
        for a in range(size):
            Z[size * m + j, i] += to[size * m + a, i] * x[a]


@jit
def apply_matrix(t, i, J):
    """All tangent vectors of orbit i are multiplied by J, by (x1, v1, x2, ...)."""
    t.mixed[i] = 1.0
    for j in range(len(J)):
        vector_of(t, i, j, t.before)
        for a in range(len(J)):
            t.after[a] = 0.0
            for b in range(len(J)):
                t.after[a] += J[a, b] * t.before[b]
        put_vector(t, i, j, t.after)
