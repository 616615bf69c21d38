"""A frame in which free flight is N rotations with decay, for tangent vectors (engine/variational/tangent.py).

The plane of a pair of roots of A has vectors e1, e2 with

    A e2 = -eta e2 + g e1,    A e1 = -eta e1 - (square/g) e2,

eta half of minus the sum of the roots and eta^2 + square their product: a complex pair turns in it, a real pair shears.
With classical damping a plane is that of a mode. Otherwise it belongs to a complex pair of roots or to two real ones.
e2 has no part in y1, so that the gap moves by the first number of each plane alone. Planes that the contact does not
see come first: tangent vectors begin as the vectors of the planes, in this order, and what a rest takes is taken from
the last of them.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.model.contact import Contact, flight_matrix

CLASSICAL = 1e-13  # of the matrices: what may couple modes and be neglected
UNSEEN = 1e-10  # share of the gap in a plane, in the metric of the masses, that is none
LEAST_SCALE = 1e-3  # of the rate of a plane: near critical damping it shears instead of turning, and any scale serves


class Frame(NamedTuple):
    """Vectors are the columns of `back`; each number is of one plane."""

    eta: np.ndarray  # (N,)
    square: np.ndarray  # (N,)
    scale: np.ndarray  # (N,): g
    to: np.ndarray  # (2 N, 2 N)
    back: np.ndarray  # (2 N, 2 N): its inverse


def frame_of(contact: Contact, omega: float) -> Frame:
    """omega: a rate for planes that have none."""
    A = flight_matrix(contact.stiffness, contact.damping)
    planes = _modes(contact)
    if planes is None:
        planes = _planes(A, np.sqrt(np.repeat(contact.masses, 2)))
    eta, square, seconds = planes
    order = np.argsort(np.abs(seconds[1]) * np.sqrt(contact.masses[0]) > UNSEEN, kind="stable")
    eta, square, seconds = eta[order], square[order], seconds[:, order]
    product = square + eta**2
    scale = np.maximum(np.sqrt(np.abs(square)), LEAST_SCALE * np.sqrt(np.maximum(product, 0)))
    scale = np.where(scale > 0, scale, omega)
    back = np.empty(A.shape)
    back[:, 1::2] = seconds
    back[:, 0::2] = (A @ seconds + eta * seconds) / scale
    return Frame(eta, square, scale, np.linalg.inv(back), back)


def _modes(contact: Contact):
    """Planes of the modes, if damping is classical: K and C have common eigenvectors in the metric M."""
    root = np.sqrt(contact.masses)
    K, C = (root[:, None] * matrix / root for matrix in (contact.stiffness, contact.damping))
    sizes = [np.abs(matrix).max() or 1.0 for matrix in (K, C)]
    _, vectors = np.linalg.eigh((K / sizes[0] + K.T / sizes[0]) + 0.618 * (C / sizes[1] + C.T / sizes[1]))
    turned = [vectors.T @ matrix @ vectors for matrix in (K, C)]
    apart = max(np.abs(m - np.diag(np.diag(m))).max() / size for m, size in zip(turned, sizes, strict=True))
    if apart > CLASSICAL * len(K):
        return None
    squares, eta = np.maximum(np.diag(turned[0]), 0), np.maximum(np.diag(turned[1]), 0) / 2
    seconds = np.zeros((2 * len(K), len(K)))
    seconds[1::2] = vectors / root[:, None]
    return eta, squares - eta**2, seconds


def _planes(A: np.ndarray, root: np.ndarray):
    """Planes of pairs of roots, whatever the damping. root: the metric, square roots of masses, (2 N,)."""
    roots, vectors = np.linalg.eig(A)
    upper, real = np.flatnonzero(roots.imag > 0), np.flatnonzero(roots.imag == 0)
    real = real[np.argsort(roots[real].real)]
    half = len(real) // 2
    best = None
    for partners in (real.reshape(-1, 2), np.stack([real[:half], real[::-1][:half]], -1)):
        found = [_plane(roots[i], np.stack([vectors[:, i].real, vectors[:, i].imag], -1), root) for i in upper]
        found += [_plane_of_two(roots[pair].real, vectors[:, pair].real, root) for pair in partners]
        eta, square, seconds = (np.stack(part, -1) for part in zip(*found, strict=True))
        firsts = A @ seconds + eta * seconds
        firsts /= np.linalg.norm(firsts * root[:, None], axis=0)
        condition = np.linalg.cond(np.hstack([seconds, firsts]) * root[:, None])
        if best is None or condition < best[0]:
            best = condition, (eta, square, seconds)
    return best[1]


def _plane(one: complex, span: np.ndarray, root: np.ndarray):
    return -one.real, one.imag**2, _unseen(span, root)


def _plane_of_two(pair: np.ndarray, span: np.ndarray, root: np.ndarray):
    return -pair.sum() / 2, -(((pair[0] - pair[1]) / 2) ** 2), _unseen(span, root)


def _unseen(span: np.ndarray, root: np.ndarray) -> np.ndarray:
    """The vector of a plane without a part in y1, of length one in the metric; span (2 N, 2)."""
    first, second = span[0]
    vector = span @ ([second, -first] if first or second else [0.0, 1.0])
    vector = vector / np.linalg.norm(vector * root)
    vector[0] = 0.0
    return vector
