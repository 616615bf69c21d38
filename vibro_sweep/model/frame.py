"""A frame in which free flight is N rotations with decay, for tangent vectors (engine/variational/tangent.py).

The plane of a pair of roots of A has vectors e1, e2 with

    A e2 = -eta e2 + g e1,    A e1 = -eta e1 - (square/g) e2,

eta half of minus the sum of the roots and eta^2 + square their product: a complex pair turns in it, a real pair shears.
With classical damping a plane is that of a mode. Otherwise it belongs to a complex pair of roots or to two real ones.
e2 has no part in y1, so that the gap moves by the first number of each plane alone; only where such an e2 would be a
vector of one root, as where a damper alone holds a mass, it has one. Planes that the contact does not see come first:
tangent vectors begin as the vectors of the planes, in this order, and what a rest takes is taken from the last of them.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.model.contact import Natural, flight_matrix

CLASSICAL = 1e-13  # of the matrices: what may couple modes and be neglected
NO_PLANES = 1e10  # condition from which on coordinates that part what is not coupled are tried
NO_PART = 1e-14  # of the terms of the gap: what is rounding
UNSEEN = 1e-10  # share of the gap in a plane, in the metric of the masses, that is none
NO_EASE = 1e6  # condition from which on planes of real roots are tried whose e2 has a part in y1
NO_ROOT = 1e-12  # of the largest singular value: that of a root 0
SLOWEST = 1e-5  # of omega: a plane that turns more slowly has the scale of omega
LEAST_SCALE = 1e-3  # of the rate of a plane: near critical damping it shears instead of turning, and any scale serves


class Frame(NamedTuple):
    """Vectors are the columns of `back`, in contact coordinates; each number is of one plane."""

    eta: np.ndarray  # (N,)
    square: np.ndarray  # (N,)
    scale: np.ndarray  # (N,): g
    to: np.ndarray  # (2 N, 2 N)
    back: np.ndarray  # (2 N, 2 N): its inverse


def frame_of(natural: Natural, omega: float) -> Frame:
    """omega: a rate for planes that have none. `to` is NaN, and so are exponents, where roots cannot be parted."""
    A = flight_matrix(natural.stiffness, natural.damping)
    planes = _modes(natural)
    if planes is None:
        planes = _planes(A, natural)
    eta, square, seconds = planes
    effective = 1 / (natural.along @ (natural.along / natural.masses))
    order = np.argsort(np.abs(natural.along @ seconds[1::2]) * np.sqrt(effective) > UNSEEN, kind="stable")
    eta, square, seconds = eta[order], square[order], seconds[:, order]
    product = square + eta**2
    scale = np.maximum(np.sqrt(np.abs(square)), LEAST_SCALE * np.sqrt(np.maximum(product, 0)))
    scale = np.where(scale > SLOWEST * omega, scale, omega)
    back = np.empty(A.shape)
    back[:, 1::2] = seconds
    back[:, 0::2] = (A @ seconds + eta * seconds) / scale
    parted = np.linalg.cond(back) < NO_PLANES
    if natural.to_contact is not None:
        unseen = np.abs(natural.along @ seconds[0::2]) <= NO_PART * (np.abs(natural.along) @ np.abs(seconds[0::2]))
        back = np.kron(natural.to_contact, np.eye(2)) @ back
        back[0, 1::2][unseen] = 0.0
    return Frame(eta, square, scale, np.linalg.inv(back) if parted else np.full(back.shape, np.nan), back)


def _modes(natural: Natural):
    """Planes of the modes, if damping is classical: K and C have common eigenvectors in the metric M."""
    root = np.sqrt(natural.masses)
    K, C = (root[:, None] * matrix / root for matrix in (natural.stiffness, natural.damping))
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


def _planes(A: np.ndarray, natural: Natural):
    """Planes of pairs of roots, whatever the damping.

    Modes with neither stiffness nor damping are taken apart first: their two roots 0 have one eigenvector only.
    """
    root = np.sqrt(natural.masses)
    K, C = (root[:, None] * matrix / root for matrix in (natural.stiffness, natural.damping))
    together = sum((matrix + matrix.T) / (np.abs(matrix).max() or 1.0) for matrix in (K, C))
    values, vectors = np.linalg.eigh(together)
    idle = values <= CLASSICAL * len(K) * values[-1]
    if not idle.any():
        condition, planes = _pairs(A, np.eye(len(A)), np.eye(len(A)), np.repeat(root, 2), natural.along)
        if condition < NO_PLANES:
            return planes
    free, others = vectors[:, idle], vectors[:, ~idle]
    to, back = np.kron(others.T * root, np.eye(2)), np.kron(others / root[:, None], np.eye(2))
    _, (eta, square, seconds) = _pairs(A, to, back, np.repeat(root, 2), natural.along)
    drifting = np.zeros((len(A), free.shape[1]))
    drifting[1::2] = free / root[:, None]
    nothing = np.zeros(free.shape[1])
    return np.append(nothing, eta), np.append(nothing, square), np.hstack([drifting, seconds])


def _pairs(A: np.ndarray, to: np.ndarray, back: np.ndarray, root: np.ndarray, along: np.ndarray):
    """(condition, planes) of pairs of roots in the space of `back`. root: square roots of masses, (2 N,)."""
    gap = np.kron(along, [1.0, 0.0])
    effective = 1 / np.linalg.norm(gap / root)
    roots, vectors = _roots(to @ A @ back)
    vectors = back @ vectors
    upper, real = np.flatnonzero(roots.imag > 0), np.flatnonzero(roots.imag == 0)
    real = real[np.argsort(roots[real].real)]
    sizes = np.linalg.norm(vectors * root[:, None], axis=0)
    seen = np.abs(gap @ vectors[:, real]) * effective > UNSEEN * sizes[real]
    groups = [real[seen], real[~seen]] if np.sum(seen) % 2 == 0 else [real]  # one of each kind makes no plane

    def planes(partners, any_of=None):
        found = [_plane(roots[i], np.stack([vectors[:, i].real, vectors[:, i].imag], -1), root, gap) for i in upper]
        found += [_plane_of_two(roots[pair].real, vectors[:, pair].real, root, gap, any_of) for pair in partners]
        eta, square, seconds = (np.stack(part, -1) for part in zip(*found, strict=True))
        firsts = A @ seconds + eta * seconds
        sizes = np.linalg.norm(firsts * root[:, None], axis=0)
        # two equal roots, as 0 of two damped free modes, make no plane
        if np.any(sizes <= NO_ROOT * np.abs(roots).max()):
            return np.inf, (eta, square, seconds)
        condition = np.linalg.cond(np.hstack([seconds, firsts / sizes]) * root[:, None])
        return condition, (eta, square, seconds)

    ways = [np.concatenate([_partners(group, outwards) for group in groups]) for outwards in (False, True)]
    best = min((planes(partners) for partners in ways), key=lambda found: found[0])
    if best[0] > NO_EASE:
        best = min(best, planes(_partners(real, outwards=True), [1.0, 1.0]), key=lambda found: found[0])
    return best


def _roots(A: np.ndarray):
    """Roots and vectors. If the root 0 has several vectors, they are independent: free modes that only dampers hold."""
    roots, vectors = np.linalg.eig(A)
    _, sizes, rows = np.linalg.svd(A)
    free = rows[sizes <= NO_ROOT * sizes[0]].T
    if free.shape[1] > 1:
        least = np.argsort(np.abs(roots), kind="stable")[: free.shape[1]]
        roots[least], vectors[:, least] = 0.0, free
    return roots, vectors


def _partners(real: np.ndarray, outwards: bool) -> np.ndarray:
    """(m/2, 2) of m real roots in order: neighbours, or the first with the last."""
    half = len(real) // 2
    return np.stack([real[:half], real[::-1][:half]], -1) if outwards else real.reshape(-1, 2)


def _plane(one: complex, span: np.ndarray, root: np.ndarray, gap: np.ndarray):
    return -one.real, one.imag**2, _unseen(span, root, gap, [0.0, 1.0])


def _plane_of_two(pair: np.ndarray, span: np.ndarray, root: np.ndarray, gap: np.ndarray, any_of: list[float] | None):
    """any_of : parts in `span` of e2; None: such that it has no part in y1"""
    if any_of is None:
        second = _unseen(span, root, gap, [1.0, 1.0])
    else:
        second = span @ any_of
        second = second / np.linalg.norm(second * root)
    return -pair.sum() / 2, -(((pair[0] - pair[1]) / 2) ** 2), second


def _unseen(span: np.ndarray, root: np.ndarray, gap: np.ndarray, any_of: list[float]) -> np.ndarray:
    """The vector of a plane without a part in y1, of length one in the metric; span (2 N, 2).

    any_of : its parts in `span` where no vector of the plane has a part in y1
    """
    first, second = gap @ span
    vector = span @ ([second, -first] if first or second else any_of)
    vector = vector / np.linalg.norm(vector * root)
    if np.count_nonzero(gap) == 1:
        vector[gap != 0] = 0.0
    return vector
