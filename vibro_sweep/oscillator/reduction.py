"""From the matrices of a large model, as a finite-element program writes them, to an oscillator of a few coordinates.

The lowest modes, and one vector more: how the contact gives way to a force that is constant, beyond what these modes
give (residual flexibility; R. R. Craig, Structural Dynamics, ch. 19). Without it the contact would be too stiff, since
all modes that are left out move there, too.
"""

from typing import Any

import numpy as np

from vibro_sweep.checks.arguments import checked_count
from vibro_sweep.checks.real import array_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.tables.coordinates import MOST_MASSES

SHIFT = 1e-6  # of the square of the first frequency that is not zero: K may be singular, K + shift M is not
RIGID = 1e-13  # of the square of the highest frequency there may be, below which a mode is one of the rigid body


def basis_of(M: Any, K: Any, normal: np.ndarray, modes: int) -> tuple[np.ndarray, np.ndarray]:
    """The vectors (n, modes + 1) of the reduction, M-orthonormal and K-orthogonal, and their squares of frequencies.

    M, K : (n, n), symmetric, arrays or sparse matrices of SciPy; normal : (n,) n of the gap n . x. Raises
    ParameterError.
    """
    M = matrix_of("M", M)
    count = M.shape[0]
    K = matrix_of("K", K, count)
    if not (M.diagonal() > 0).all():
        raise ParameterError("M", f"{count} x {count}", "positive definite")
    if normal.shape != (count,):
        raise ParameterError("contact_normal", normal.tolist()[:3], f"a list of {count} numbers, one for each row of M")
    modes = checked_count("modes", modes, 1, min(MOST_MASSES - 1, count - 1))
    try:
        with np.errstate(all="ignore"):
            vectors, squares = _basis(M, K, normal, modes)
    except (ArithmeticError, RuntimeError, ValueError):  # of LAPACK, ARPACK and SuperLU: LinAlgError is a ValueError
        vectors = squares = np.array([np.nan])
    if not (np.isfinite(vectors).all() and np.isfinite(squares).all()):
        raise ParameterError(
            "M, K and contact_normal",
            f"{count} rows",
            "of a model with a mass in each row, and a contact force that the modes alone do not carry",
        )
    return vectors, squares


def _basis(M: Any, K: Any, normal: np.ndarray, modes: int) -> tuple[np.ndarray, np.ndarray]:
    """What `basis_of` gives, of sparse matrices that fit; not finite where the modes take all of the contact force."""
    from scipy.sparse.linalg import eigsh

    count = M.shape[0]
    _factors(M)
    size = float(np.abs(K.diagonal() / M.diagonal()).max())
    if count < 3 * modes + 10:  # few enough for all of them
        from scipy.linalg import eigh

        squares, vectors = eigh(K.toarray(), M.toarray(), subset_by_index=[0, modes - 1])
    else:
        start = np.random.default_rng(0).standard_normal(count)  # the same vectors in each call
        squares, vectors = eigsh(K.tocsc(), modes, M.tocsc(), sigma=-SHIFT * size / count**2, v0=start)
    order = np.argsort(squares)
    squares, vectors = squares[order], vectors[:, order]
    squares = np.where(squares < RIGID * size, 0.0, squares)
    first = squares[squares > 0].min(initial=size / count**2 if not squares[-1] > 0 else squares[-1])
    load = normal - M @ (vectors @ (vectors.T @ normal))  # what no mode takes
    factors = _factors(K + SHIFT * first * M)
    residual = factors.solve(load)
    for _ in range(2):  # the shift changes little, and nothing of it is left
        residual += factors.solve(load - K @ residual)
        residual -= vectors @ (vectors.T @ (M @ residual))
    residual /= np.sqrt(residual @ (M @ residual))
    residual *= np.sign(residual @ normal) or 1.0
    return np.column_stack([vectors, residual]), np.append(squares, residual @ (K @ residual))


def _factors(matrix: Any) -> Any:
    """The LU factors of a positive definite matrix. Raises ValueError where it is not: by the signs of its pivots."""
    from scipy.sparse.linalg import splu

    factors = splu(matrix.tocsc(), "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    if not (np.array_equal(factors.perm_r, factors.perm_c) and (factors.U.diagonal() > 0).all()):
        raise ValueError
    return factors


def matrix_of(name: str, matrix: Any, count: int | None = None) -> Any:
    """A symmetric matrix of finite numbers as a sparse one, of `count` rows if given. Raises ParameterError."""
    from scipy import sparse

    if sparse.issparse(matrix):
        given = matrix if matrix.ndim == 2 and matrix.dtype.kind in "fiu" else None
    else:
        given = array_of(matrix, 2)
    result = None if given is None else sparse.csr_matrix(given, dtype=float)
    if result is None or len(set(result.shape)) > 1 or result.shape[0] < 2 or not np.isfinite(result.data).all():
        raise ParameterError(name, matrix, "a square matrix of finite numbers, of two rows or more")
    if count is not None and result.shape[0] != count:
        raise ParameterError(name, f"{result.shape[0]} x {result.shape[0]}", f"of the size of M, {count} x {count}")
    apart = abs(result - result.T)
    if apart.nnz and apart.max() > 1e-9 * abs(result).max():
        raise ParameterError(name, f"{result.shape[0]} x {result.shape[0]}", "symmetric")
    return result
