"""A frame in which free flight is N rotations with decay, for tangent vectors (engine/variational/tangent.py).

The plane of a pair of roots of A has vectors e1, e2 with

    A e2 = -eta e2 + g e1,    A e1 = -eta e1 - (square/g) e2,

eta half of minus the sum of the roots and eta^2 + square their product: a complex pair turns in it, a real pair shears.
With classical damping a plane is that of a mode. Otherwise it belongs to a complex pair of roots or to two real ones.
e2 has no part in y1, so that the gap moves by the first number of each plane alone; only where such an e2 would be a
vector of one root, as where a damper alone holds a mass, it has one. Planes that the contact does not see come first:
tangent vectors begin as the vectors of the planes, in this order, and what a rest takes is taken from the last of them.

What springs or dampers do in a mode is rounding where it lies below `ROUNDING` of the terms that it is the sum of
(`_parts`). It is 0 then: a mode that nothing holds neither grows nor decays.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.model.contact import Natural, flight_matrix

CLASSICAL = 1e-13  # of the matrices: what may couple modes and be neglected
ROUNDING = 2.0**-48  # of the terms of a sum: what rounding may leave of it, for each mass
NO_PLANES = 1e10  # condition from which on coordinates that part what is not coupled are tried
NO_PART = 1e-14  # of the terms of the gap: what is rounding
UNVISITED = 1e-10  # share of the gap in a plane, in the metric of the masses, that counts as zero
NO_EASE = 1e6  # condition from which on planes of real roots are tried whose e2 has a part in y1
MAY_BE_NONE = 1e-6  # of the largest root: one that may be 0
NO_ROOT = 1e-12  # of the largest root: length of the first vector below which there is no plane
SLOWEST = 1e-5  # of omega: a plane that turns more slowly has the scale of omega
LEAST_SCALE = 1e-3  # of the rate of a plane: near critical damping it shears instead of turning, and any scale serves


class Frame(NamedTuple):
    """Vectors are the columns of `back`; each number is of one plane."""

    eta: np.ndarray  # (N,)
    square: np.ndarray  # (N,)
    scale: np.ndarray  # (N,): g
    rounding: float  # how far rounding may have moved the real part of a root
    to: np.ndarray  # (2 N, 2 N)
    back: np.ndarray  # (2 N, 2 N): its inverse


class _Planes(NamedTuple):
    eta: np.ndarray  # (N,)
    square: np.ndarray  # (N,)
    seconds: np.ndarray  # (2 N, N): e2
    rounding: float


def frame_of(natural: Natural, omega: float) -> Frame:
    """omega: a rate for planes that have none. `to` is NaN, and so are exponents, where roots cannot be parted."""
    A = flight_matrix(natural.stiffness, natural.damping)
    root = np.sqrt(natural.masses)
    K, C = (_in_the_metric(natural, matrix) for matrix in (natural.stiffness, natural.damping))
    planes = _modes(root, K, C)
    if planes is None:
        planes = _planes(A, root, K, C, natural.normal)
    eta, square, seconds, rounding = planes
    effective = 1 / (natural.normal @ (natural.normal / natural.masses))
    order = np.argsort(np.abs(natural.normal @ seconds[1::2]) * np.sqrt(effective) > UNVISITED, kind="stable")
    eta, square, seconds = eta[order], square[order], seconds[:, order]
    product = square + eta**2
    scale = np.maximum(np.sqrt(np.abs(square)), LEAST_SCALE * np.sqrt(np.maximum(product, 0)))
    scale = np.where(scale > SLOWEST * omega, scale, omega)
    back = np.empty(A.shape)
    back[:, 1::2] = seconds
    back[:, 0::2] = (A @ seconds + eta * seconds) / scale
    parted = np.linalg.cond(back) < NO_PLANES
    if natural.to_contact is not None:
        unseen = np.abs(natural.normal @ seconds[0::2]) <= NO_PART * (np.abs(natural.normal) @ np.abs(seconds[0::2]))
        back = np.kron(natural.to_contact, np.eye(2)) @ back
        back[0, 1::2][unseen] = 0.0
    return Frame(eta, square, scale, rounding, np.linalg.inv(back) if parted else np.full(back.shape, np.nan), back)


class _Matrix(NamedTuple):
    """K or C in the metric of the masses, symmetric."""

    values: np.ndarray  # (N, N)
    terms: np.ndarray  # (N, N): sums of the moduli of the terms that each number is the sum of


def _in_the_metric(natural: Natural, matrix: np.ndarray) -> _Matrix:
    root = np.sqrt(natural.masses)
    values = root[:, None] * matrix / root
    if natural.of_masses is None:
        return _Matrix(values, np.abs(values))
    to, back = natural.of_masses, np.linalg.inv(natural.of_masses)
    return _Matrix(values, np.abs(to) @ np.abs(back @ values @ back.T) @ np.abs(to.T))


def _parts(vectors: np.ndarray, matrix: _Matrix) -> tuple[np.ndarray, np.ndarray]:
    """The values of K or C in each of the modes `vectors` (N, m), 0 where it is below its rounding; and its error."""
    found = np.diag(vectors.T @ matrix.values @ vectors)
    # vectors of length 1 have errors too
    rounding = ROUNDING * len(vectors) * (_forms(np.abs(vectors), matrix.terms) + ROUNDING * matrix.terms.max())
    kept = found > rounding
    if kept.all():
        return found, rounding
    left = np.linalg.norm(matrix.values @ vectors, axis=0)  # an eigenvalue is no farther from 0
    return np.where(kept, found, 0.0), np.where(kept, rounding, np.minimum(rounding, 4 * left))


def _forms(x: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """x.matrix x of each column."""
    return (x * (matrix @ x)).sum(axis=0)


def _modes(root: np.ndarray, stiffness: _Matrix, damping: _Matrix) -> _Planes | None:
    """Planes of the modes, if damping is classical: K and C have common eigenvectors in the metric M."""
    K, C = stiffness.values, damping.values
    sizes = [np.abs(matrix).max() or 1.0 for matrix in (K, C)]
    _, vectors = np.linalg.eigh((K / sizes[0] + K.T / sizes[0]) + 0.618 * (C / sizes[1] + C.T / sizes[1]))
    turned = [vectors.T @ matrix @ vectors for matrix in (K, C)]
    apart = max(np.abs(m - np.diag(np.diag(m))).max() / size for m, size in zip(turned, sizes, strict=True))
    if apart > CLASSICAL * len(K):
        return None
    (squares, of_squares), (dampings, of_dampings) = (_parts(vectors, matrix) for matrix in (stiffness, damping))
    eta = dampings / 2
    seconds = np.zeros((2 * len(K), len(K)))
    seconds[1::2] = vectors / root[:, None]
    rounding = moved(eta, squares - eta**2, of_dampings / 2, of_squares)
    return _Planes(eta, squares - eta**2, seconds, float(rounding.max(initial=0.0)))


def moved(eta: np.ndarray, square: np.ndarray, of_eta: np.ndarray, of_product: np.ndarray) -> np.ndarray:
    """The distance by which rounding of eta and of eta^2 + square moves the roots -eta +- sqrt(-square) along the real
    axis."""
    apart = np.sqrt(np.maximum(-square, 0.0))
    more = np.maximum(2 * eta * of_eta + of_product - np.maximum(square, 0.0), 0.0)  # of apart^2
    return of_eta + np.divide(more, apart + np.sqrt(apart**2 + more), where=more > 0, out=np.zeros(more.shape))


def _planes(A: np.ndarray, root: np.ndarray, K: _Matrix, C: _Matrix, along: np.ndarray) -> _Planes:
    """Planes of pairs of roots, whatever the damping.

    Modes with neither stiffness nor damping are taken apart first: their two roots 0 have one eigenvector only.
    """
    together = sum((matrix + matrix.T) / (np.abs(matrix).max() or 1.0) for matrix in (K.values, C.values))
    vectors = np.linalg.eigh(together)[1]
    (squares, of_squares), (dampings, of_dampings) = (_parts(vectors, matrix) for matrix in (K, C))
    idle = (squares == 0) & (dampings == 0)
    free, others = vectors[:, idle], vectors[:, ~idle]
    if not idle.any():
        condition, planes = _pairs(A, np.eye(len(A)), np.eye(len(A)), np.repeat(root, 2), others, K, C, along)
        if condition < NO_PLANES:
            return planes
    to, back = np.kron(others.T * root, np.eye(2)), np.kron(others / root[:, None], np.eye(2))
    _, (eta, square, seconds, rounding) = _pairs(A, to, back, np.repeat(root, 2), others, K, C, along)
    drifting = np.zeros((len(A), free.shape[1]))
    drifting[1::2] = free / root[:, None]
    nothing = np.zeros(free.shape[1])
    rounding = max([rounding, *moved(nothing, nothing, of_dampings[idle] / 2, of_squares[idle])])
    return _Planes(np.append(nothing, eta), np.append(nothing, square), np.hstack([drifting, seconds]), rounding)


def _moved(roots: np.ndarray, x: np.ndarray, K: _Matrix, C: _Matrix) -> np.ndarray:
    """The distance by which rounding may have moved each of the roots r with these shapes x (N, m).

    From (r^2 + C r + K) x = 0: x.(2 r + C)x dr = -x.(dC r + dK)x, and dr^2 in place of 2 r dr where two roots meet.
    """
    size, moduli = np.abs(x), np.abs(roots)
    lengths = np.sum(size**2, axis=0)
    terms = moduli**2 * lengths + moduli * _forms(size, C.terms) + _forms(size, K.terms)
    changes = ROUNDING * len(x) * terms
    slopes = np.abs(2 * roots * (x * x).sum(axis=0) + _forms(x, C.values))
    return np.divide(changes, np.maximum(slopes, np.sqrt(changes * lengths)), where=changes > 0, out=0 * changes)


def _pairs(
    A: np.ndarray, to: np.ndarray, back: np.ndarray, root: np.ndarray, space: np.ndarray, K: _Matrix, C: _Matrix,
    along: np.ndarray,
):  # fmt: skip
    """(condition, planes) of pairs of roots in the space of `back`, that of these modes (N, m).

    root: square roots of masses, (2 N,)
    """
    gap = np.kron(along, [1.0, 0.0])
    effective = 1 / np.linalg.norm(gap / root)
    roots, vectors = _roots(to @ A @ back, space, K)
    vectors = back @ vectors
    rounding = _moved(roots, vectors[0::2] * root[::2, None], K, C)
    roots = np.where(np.abs(roots.real) > rounding, roots, 1j * roots.imag)
    rounding = float(rounding.max())
    fastest = np.abs(roots).max()
    upper, real = np.flatnonzero(roots.imag > 0), np.flatnonzero(roots.imag == 0)
    real = real[np.argsort(roots[real].real)]
    sizes = np.linalg.norm(vectors * root[:, None], axis=0)
    seen = np.abs(gap @ vectors[:, real]) * effective > UNVISITED * sizes[real]
    groups = [real[seen], real[~seen]] if np.sum(seen) % 2 == 0 else [real]  # one of each kind makes no plane

    def planes(partners, any_of=None):
        found = [_plane(roots[i], np.stack([vectors[:, i].real, vectors[:, i].imag], -1), root, gap) for i in upper]
        found += [_plane_of_two(roots[pair].real, vectors[:, pair].real, root, gap, any_of) for pair in partners]
        eta, square, seconds = (np.stack(part, -1) for part in zip(*found, strict=True))
        firsts = A @ seconds + eta * seconds
        sizes = np.linalg.norm(firsts * root[:, None], axis=0)
        # two equal roots, as 0 of two damped free modes, make no plane
        if np.any(sizes <= NO_ROOT * fastest):
            return np.inf, _Planes(eta, square, seconds, rounding)
        condition = np.linalg.cond(np.hstack([seconds, firsts / sizes]) * root[:, None])
        return condition, _Planes(eta, square, seconds, rounding)

    both = (False, True) if len(real) > 2 else (False,)
    ways = [np.concatenate([_partners(group, outwards) for group in groups]) for outwards in both]
    best = min((planes(partners) for partners in ways), key=lambda found: found[0])
    if best[0] > NO_EASE:
        best = min(best, planes(_partners(real, outwards=True), [1.0, 1.0]), key=lambda found: found[0])
    return best


def _roots(A: np.ndarray, space: np.ndarray, K: _Matrix):
    """Roots and vectors of A, in a space of modes (N, m). Each mode that only dampers hold has one root 0.

    Where there are several, their vectors are independent.
    """
    roots, vectors = np.linalg.eig(A)
    order = np.argsort(np.abs(roots), kind="stable")
    if abs(roots[order[0]]) > MAY_BE_NONE * abs(roots[order[-1]]):
        return roots, vectors
    modes = space @ np.linalg.eigh(space.T @ K.values @ space)[1]
    free = np.count_nonzero(_parts(modes, K)[0] == 0)
    if free and roots[order[:free]].imag.sum() != 0:  # rounding made it one of a pair
        roots[order[free]] = roots[order[free]].real
    roots[order[:free]] = 0.0
    if free > 1:
        vectors[:, order[:free]] = np.linalg.svd(A)[2][-free:].T
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
