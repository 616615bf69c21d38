"""Contact coordinates y = T x of a linear oscillator: in them an impact changes the velocity of y1 and nothing else.

The first row of T is n, so that y1 is the gap n.x. The other rows are orthogonal to it and to each other in M^-1, which
makes the mass matrix of y diagonal; for n = e1 and a diagonal M, T is the identity. An impulse along n then acts on
y1 alone.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.model.linear import Linear


class Contact(NamedTuple):
    """y'' + damping y' + stiffness y = force (sin, cos, 1)."""

    T: np.ndarray  # (N, N)
    back: np.ndarray  # (N, N): its inverse
    masses: np.ndarray  # (N,): diagonal of the mass matrix of y
    stiffness: np.ndarray  # (N, N)
    damping: np.ndarray  # (N, N)
    force: np.ndarray  # (N, 3)


def contact_coordinates(q: Linear) -> Contact:
    """The oscillator in contact coordinates."""
    T = coordinates(q.M, q.along)
    n = len(T)
    if np.array_equal(T, np.eye(n)):
        back, masses = np.eye(n), np.diag(q.M).astype(float)
    else:
        across = np.linalg.solve(q.M, T.T)  # M^-1 T^T
        masses = 1 / np.einsum("ij,ji->i", T, across)
        back = across * masses
    stiffness, damping = (back.T @ matrix @ back / masses[:, None] for matrix in (q.K, q.C))
    force = back.T @ np.stack([q.sine, q.cosine, q.constant], -1) / masses[:, None]
    return Contact(T, back, masses, stiffness, damping, force)


def coordinates(M: np.ndarray, along: np.ndarray) -> np.ndarray:
    """T (N, N), by Gram and Schmidt's method in the metric M^-1, begun with n and the unit vectors but one."""
    n, inverse = len(along), np.linalg.inv(M)
    if np.count_nonzero(M - np.diag(np.diag(M))) == 0:
        inverse = np.diag(1 / np.diag(M))
    shares = np.abs(inverse @ along) / np.sqrt(np.diag(inverse))
    spare = int(np.argmax(shares))  # the unit vector that is nearest to n
    rows = [np.array(along, float)]
    for i in (i for i in range(n) if i != spare):
        row = np.eye(n)[i]
        for _ in range(2):  # once more for what rounding left
            for other in rows:
                row = row - other * ((other @ inverse @ row) / (other @ inverse @ other))
        rows.append(row)
    return np.array(rows)


def flight_matrix(stiffness: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """A (2 N, 2 N) of (y1, v1, y2, v2, ...)' = A (y1, v1, ...) without forces."""
    n = len(stiffness)
    A = np.zeros((2 * n, 2 * n))
    A[0::2, 1::2] = np.eye(n)
    A[1::2, 0::2], A[1::2, 1::2] = -stiffness, -damping
    return A


def fastest_rate(stiffness: np.ndarray, damping: np.ndarray) -> float:
    """The largest modulus of a root; infinite beyond the range of the floats."""
    A = flight_matrix(stiffness, damping)
    if not (len(A) and np.isfinite(A).all()):
        return np.inf if len(A) else 0.0
    return float(np.abs(np.linalg.eigvals(A)).max())
