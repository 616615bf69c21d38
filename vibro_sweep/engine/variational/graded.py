"""A matrix whose eigenvalues lie far apart becomes block triangular, so that none drown in larger ones.

Such a matrix is graded: D^1/2 B D^1/2, with D falling. The QR algorithm with shifts finds its small eigenvalues only
where B couples all alike, and modes may hardly see each other. Steps without shifts, A = Q R -> R Q, bring what is
below the blocks down by the ratio of their eigenvalues, and keep the grading.
"""

import math

from vibro_sweep.engine.simd.jit import jit

ROUNDING = 2.0**-52
GAP = 16.0  # ratio of eigenvalues from which on they are separated
MOST_STEPS = 60  # 13 are enough unless eigenvalues stand in the wrong order


@jit
def separate(a, n, size):
    """The leading n x n block of a becomes block upper triangular, with the same eigenvalues. size: scratch (n,)."""
    for _ in range(MOST_STEPS):
        rotate_rows(a, n, size)
        rotate_columns(a, n)
        if is_separate(a, n, size):
            return


@jit
def rotation(tangent):
    """Cosine and sine of an angle."""
    if abs(tangent) <= 1.0:
        c = 1.0 / math.sqrt(1.0 + tangent * tangent)
        return c, tangent * c
    cotangent = 1.0 / tangent
    s = 1.0 / math.sqrt(1.0 + cotangent * cotangent)
    return cotangent * s, s


@jit
def rotate_rows(a, n, size):
    """A becomes R by rotations whose tangents stay where they have put zeros; size: the diagonal of R."""
    for k in range(n):
        for i in range(k + 1, n):
            tangent = a[i, k] / a[k, k] if a[i, k] != 0.0 else 0.0
            c, s = rotation(tangent)
            for j in range(k, n):
                x, y = a[k, j], a[i, j]
                a[k, j], a[i, j] = c * x + s * y, c * y - s * x
            a[i, k] = tangent
        size[k] = abs(a[k, k])


@jit
def rotate_columns(a, n):
    """R becomes R Q."""
    for k in range(n):
        for i in range(k + 1, n):
            c, s = rotation(a[i, k])
            a[i, k] = 0.0
            for j in range(i + 1):
                x, y = a[j, k], a[j, i]
                a[j, k], a[j, i] = c * x + s * y, c * y - s * x


@jit
def is_separate(a, n, size):
    """Whether nothing is left below the blocks but rounding, which becomes zero. size: of the eigenvalues, roughly."""
    separate = True
    for m in range(1, n):
        smallest, largest = size[0], size[m]
        for j in range(1, m):
            smallest = min(smallest, size[j])
        for i in range(m + 1, n):
            largest = max(largest, size[i])
        if smallest > GAP * largest:
            for i in range(m, n):
                for j in range(m):
                    if abs(a[i, j]) > ROUNDING * math.sqrt(size[i]) * math.sqrt(size[j]):
                        separate = False
                    else:
                        a[i, j] = 0.0
    return separate
