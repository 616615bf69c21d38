"""Algebra on stacks of small matrices (..., N, N) and vectors (..., N), one of each oscillator.

Each oscillator of a stack gets the bits that it has alone: NumPy calls LAPACK and BLAS once for each matrix, and sums
over the entries of a vector are dot products or are added in their order. So no sum over a last axis and no einsum
stands here: NumPy may add them in another order where a stack is longer.
"""

import numpy as np


def vector(entries) -> np.ndarray:
    """(..., N) from N numbers, or arrays (...) of one number of each oscillator."""
    if any(isinstance(entry, np.ndarray) for entry in entries):
        return np.stack(np.broadcast_arrays(*entries), -1)
    return np.array(entries)


def matrix(rows) -> np.ndarray:
    """(..., N, N) from rows of such numbers."""
    size = len(rows)
    flat = vector([entry for row in rows for entry in row])
    return flat.reshape(*flat.shape[:-1], size, size)


def transposed(A: np.ndarray) -> np.ndarray:
    """A^T of each."""
    return A.swapaxes(-1, -2)


def diagonal(A: np.ndarray) -> np.ndarray:
    """(..., N): the diagonal of each."""
    return np.diagonal(A, axis1=-2, axis2=-1)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a . b of each, (...)."""
    return (a[..., None, :] @ b[..., None])[..., 0, 0]


def times(A: np.ndarray, x: np.ndarray) -> np.ndarray:
    """A x of each, (..., N)."""
    return (A @ x[..., None])[..., 0]


def columns(x: np.ndarray) -> np.ndarray:
    """(..., m): the sum of each column of x (..., N, m)."""
    return sum(np.moveaxis(x, -2, 0))


def modulus(z: np.ndarray) -> np.ndarray:
    """|z| (...), as it is computed of a single number."""
    return np.hypot(z.real, z.imag)


def finite(A: np.ndarray, axes: int = 2) -> np.ndarray:
    """(...): whether all entries of each are, of matrices or (axes: 1) vectors."""
    return np.isfinite(A).all(tuple(range(-axes, 0)))


def only(which: np.ndarray, A: np.ndarray) -> np.ndarray:
    """A where `which` (...), else a matrix of which nothing goes wrong: the unit matrix."""
    return np.where(which[..., None, None], A, np.eye(A.shape[-1]))


def solved(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """x (..., N) of A x = b; NaN where A is singular."""
    try:
        return np.linalg.solve(A, b[..., None])[..., 0]
    except np.linalg.LinAlgError:
        if A.ndim == 2:
            return np.full(b.shape, np.nan)
        return np.stack([solved(*entry) for entry in zip(A, np.broadcast_to(b, A.shape[:-1]), strict=True)])


def well_conditioned(A: np.ndarray) -> np.ndarray:
    """(...): whether the condition number of each is certainly below 1e-3 of that of a matrix singular to rounding."""
    n = A.shape[-1]
    try:
        inverse = np.linalg.inv(A)
    except np.linalg.LinAlgError:
        return np.zeros(A.shape[:-2], bool)
    return n**2 * np.abs(A).max((-2, -1)) * np.abs(inverse).max((-2, -1)) < 1e-3 / (n * np.finfo(float).eps)


def least_squares(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """x (..., N) with the least |A x - b|, and of these the least |x|."""
    left, sizes, right = np.linalg.svd(A)
    kept = sizes > A.shape[-1] * np.finfo(float).eps * sizes[..., :1]
    parts = np.divide(times(transposed(left), b), sizes, where=kept, out=np.zeros(sizes.shape))
    return times(transposed(right), parts)


def different(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One index of each different row of bits of (n, m), and to which of these each row belongs, (n,)."""
    as_bytes = np.ascontiguousarray(rows, float).view(f"V{rows.shape[-1] * 8}")[:, 0]
    _, first, place = np.unique(as_bytes, return_index=True, return_inverse=True)
    return first, place


def unrepeated(fields: list[np.ndarray], axes: int) -> tuple[slice, ...]:
    """What selects the first entry of each of the first `axes` axes along which np.broadcast_to repeats all fields."""
    return tuple(slice(None if any(x.strides[axis] for x in fields) else 1) for axis in range(axes))


def kron2(A: np.ndarray) -> np.ndarray:
    """(..., 2 N, 2 M) that does with x1, v1, x2, v2, ... what A (..., N, M) does with x1, x2, ..."""
    n, m = A.shape[-2:]
    result = np.zeros((*A.shape[:-2], 2 * n, 2 * m), A.dtype)
    result[..., 0::2, 0::2] = result[..., 1::2, 1::2] = A
    return result
