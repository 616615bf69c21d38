"""Invariant planes of a flight, each of a pair of roots, whatever the damping (see frame.py).

The oscillators of a stack are taken in groups in which the same things are there: so many modes that nothing holds, so
many complex pairs, so many real roots that the contact sees.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.points.metric import ROUNDING, Matrix, forms, parts
from vibro_sweep.oscillator.stacks import columns, dot, finite, kron2, times, transposed

NO_PLANES = 1e10  # condition from which on coordinates that part what is not coupled are tried
UNOBSERVABLE = 1e-10  # largest share of the gap in a plane or a root, in the metric of the masses, that counts as zero
NO_EASE = 1e6  # condition from which on planes of real roots are tried whose e2 has a part in y1
MAY_BE_NONE = 1e-6  # of the largest root: one that may be 0
NO_ROOT = 1e-12  # of the largest root: length of the first vector below which there is no plane


class Planes(NamedTuple):
    """Of each oscillator of a stack."""

    eta: np.ndarray  # (n, N)
    square: np.ndarray  # (n, N)
    seconds: np.ndarray  # (n, 2 N, N): e2
    rounding: np.ndarray  # (n,)


def moved(eta: np.ndarray, square: np.ndarray, of_eta: np.ndarray, of_product: np.ndarray) -> np.ndarray:
    """The distance by which rounding of eta and of eta^2 + square moves the roots -eta +- sqrt(-square) along the real
    axis."""
    apart = np.sqrt(np.maximum(-square, 0.0))
    more = np.maximum(2 * eta * of_eta + of_product - np.maximum(square, 0.0), 0.0)  # of apart^2
    return of_eta + np.divide(more, apart + np.sqrt(apart**2 + more), where=more > 0, out=np.zeros(more.shape))


class _Flight(NamedTuple):
    """What planes follow from, of each oscillator of a group."""

    A: np.ndarray  # (n, 2 N, 2 N)
    root: np.ndarray  # (n, N): square roots of the masses
    K: Matrix
    C: Matrix
    normal: np.ndarray  # (n, N)

    def at(self, which: np.ndarray) -> "_Flight":
        A, root, K, C, normal = self
        return _Flight(A[which], root[which], K.at(which), C.at(which), normal[which])

    @property
    def twice(self) -> np.ndarray:
        """(n, 2 N): root, of each coordinate and of its velocity."""
        return np.repeat(self.root, 2, axis=-1)


def invariant_planes(A: np.ndarray, root: np.ndarray, K: Matrix, C: Matrix, normal: np.ndarray) -> Planes:
    """The invariant planes of a stack of oscillators, whatever the damping.

    Modes with neither stiffness nor damping are taken apart first: their two roots 0 have one eigenvector only.
    """
    f = _Flight(A, root, K, C, normal)
    together = sum((one.values + transposed(one.values)) / one.largest[:, None, None] for one in (K, C))
    vectors = np.linalg.eigh(together)[1]
    (squares, of_squares), (dampings, of_dampings) = (parts(vectors, one) for one in (K, C))
    idle = (squares == 0) & (dampings == 0)
    first = np.argsort(~idle, axis=-1, kind="stable")
    vectors = np.take_along_axis(vectors, first[:, None], -1)
    nothing = np.zeros(idle.shape)
    of_idle = np.where(idle, moved(nothing, nothing, of_dampings / 2, of_squares), 0.0).max(-1)
    result = _room(len(A), A.shape[-1])
    for (count,), group in _groups(idle.sum(-1)):
        _put(result, group, _parted(f.at(group), vectors[group], count, of_idle[group]))
    return result


def _room(n: int, states: int) -> Planes:
    N = states // 2
    return Planes(np.empty((n, N)), np.empty((n, N)), np.empty((n, states, N)), np.empty(n))


def _put(result: tuple, group: np.ndarray, found: tuple) -> None:
    for known, more in zip(result, found, strict=True):
        known[group] = more


def _groups(*numbers: np.ndarray) -> Iterator[tuple[tuple[int, ...], np.ndarray]]:
    """Each row of numbers that there is, and the oscillators that have it."""
    rows = np.stack(numbers, -1)
    for row in np.unique(rows, axis=0):
        yield tuple(row.tolist()), np.flatnonzero((rows == row).all(-1))


def _parted(f: _Flight, vectors: np.ndarray, idle: int, of_idle: np.ndarray) -> Planes:
    """Planes where the first `idle` of the modes `vectors` are free of springs and dampers."""
    free, others = vectors[..., :idle], vectors[..., idle:]
    if not idle:
        eye = np.broadcast_to(np.eye(f.A.shape[-1]), f.A.shape)
        condition, planes = _pairs(f, eye, eye, others)
        bad = np.flatnonzero(~(condition < NO_PLANES))
        if bad.size:
            _put(planes, bad, _in_modes(f.at(bad), others[bad])[1])
        return planes
    _, (eta, square, seconds, rounding) = _in_modes(f, others)
    drifting = np.zeros((*f.A.shape[:-1], idle))
    drifting[:, 1::2] = free / f.root[..., None]
    nothing = np.zeros((len(f.A), idle))
    return Planes(
        np.append(nothing, eta, -1), np.append(nothing, square, -1), np.append(drifting, seconds, -1),
        np.maximum(rounding, of_idle),
    )  # fmt: skip


def _in_modes(f: _Flight, modes: np.ndarray) -> tuple[np.ndarray, Planes]:
    """Planes in the coordinates of these modes (n, N, m)."""
    return _pairs(f, kron2(transposed(modes) * f.root[:, None]), kron2(modes / f.root[..., None]), modes)


def _pairs(f: _Flight, to: np.ndarray, back: np.ndarray, space: np.ndarray) -> tuple[np.ndarray, Planes]:
    """Conditions (n,) and planes of pairs of roots in the space of `back`, that of these modes (n, N, m)."""
    roots, vectors = _roots(to @ f.A @ back, space, f.K)
    vectors = back @ vectors
    rounding = _moved(roots, vectors[:, 0::2] * f.root[..., None], f.K, f.C)
    roots = np.where(np.abs(roots.real) > rounding, roots, 1j * roots.imag)
    gap = kron2(f.normal[..., None])[..., 0]
    sizes = np.sqrt(columns(np.abs(vectors * f.twice[..., None]) ** 2))
    effective = 1 / np.sqrt(dot(gap / f.twice, gap / f.twice))
    seen = np.abs(gap[:, None] @ vectors)[:, 0] * effective[:, None] > UNOBSERVABLE * sizes
    # in this order: of each complex pair one root, real roots from below, the other roots
    place = np.where(roots.imag > 0, 0, np.where(roots.imag == 0, 1, 2))
    order = np.lexsort((np.where(place == 1, roots.real, 0.0), place))
    roots, seen = (np.take_along_axis(one, order, -1) for one in (roots, seen))
    vectors = np.take_along_axis(vectors, order[:, None], -1)
    upper, real = (place == 0).sum(-1), (place == 1).sum(-1)
    seen &= roots.imag == 0
    planes = Planes(*(one[..., : space.shape[-1]] for one in _room(len(f.A), f.A.shape[-1])[:3]), rounding.max(-1))
    condition = np.empty(len(f.A))
    for (pairs, reals, visible), group in _groups(upper, real, seen.sum(-1)):
        last = pairs + reals
        if visible % 2 == 0:  # one of each kind makes no plane
            hidden = np.argsort(~seen[group, pairs:last], axis=-1, kind="stable")
            kinds = [slice(0, visible), slice(visible, reals)]
        else:
            hidden, kinds = np.broadcast_to(np.arange(reals), (len(group), reals)), [slice(0, reals)]
        both = _Roots(f.at(group), gap[group], roots[group, :last], vectors[group][..., :last], pairs)
        condition[group], found = both.best([hidden[:, one] for one in kinds])
        _put(planes[:3], group, found)
    return condition, planes


class _Roots(NamedTuple):
    """Roots (n, r) and vectors (n, 2 N, r) of a group: of `pairs` complex pairs one each, then real ones from below."""

    f: _Flight
    gap: np.ndarray  # (n, 2 N)
    roots: np.ndarray
    vectors: np.ndarray
    pairs: int

    def best(self, kinds: list[np.ndarray]) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
        """Conditions, and eta, square and e2 of the planes with the best one. kinds: real roots (n, m) to be paired."""
        reals = self.roots.shape[-1] - self.pairs
        ways = [np.concatenate([_partners(one, out) for one in kinds], 1) for out in (False, True)[: 1 + (reals > 2)]]
        best = self.planes(ways[0], None)
        for way in ways[1:]:
            best = _better(best, self.planes(way, None))
        if reals and (best[0] > NO_EASE).any():
            every = np.broadcast_to(np.arange(reals), (len(self.roots), reals))
            other = self.planes(_partners(every, outwards=True), np.ones(2))
            other[0][best[0] <= NO_EASE] = np.inf
            best = _better(best, other)
        return best

    def planes(self, partners: np.ndarray, any_of: np.ndarray | None) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
        """The same of given pairs (n, p, 2) of real roots. any_of: parts in their vectors of e2; None: such that it has
        no part in y1."""
        f, pairs = self.f, self.pairs
        complex_ = self.roots[:, :pairs], transposed(self.vectors[..., :pairs])
        two = np.take_along_axis(self.roots[:, pairs:].real[:, None], partners, -1)  # (n, p, 2)
        of_two = np.take_along_axis(
            transposed(self.vectors[..., pairs:].real)[:, None], partners[..., None], 2
        )  # (n, p, 2, 2 N)
        eta = np.append(-complex_[0].real, -(two[..., 0] + two[..., 1]) / 2, -1)
        square = np.append(complex_[0].imag ** 2, -(((two[..., 0] - two[..., 1]) / 2) ** 2), -1)
        turning = np.stack([complex_[1].real, complex_[1].imag], -1)
        shearing = np.ascontiguousarray(transposed(of_two))
        seconds = self._unseen(turning, np.array([0.0, 1.0]))
        if any_of is None:
            others = self._unseen(shearing, np.ones(2))
        else:
            others = shearing @ any_of
            others = others / _length(others * f.twice[:, None])
        seconds = np.ascontiguousarray(transposed(np.append(seconds, others, 1)))
        firsts = f.A @ seconds + eta[:, None] * seconds
        root = f.twice[..., None]
        sizes = np.sqrt(columns((firsts * root) ** 2))
        # two equal roots, as 0 of two damped free modes, make no plane
        there = ~(sizes <= NO_ROOT * np.abs(self.roots).max(-1, keepdims=True)).any(-1)
        with np.errstate(all="ignore"):
            whole = np.append(seconds, firsts / sizes[:, None], -1) * root
        there &= finite(whole)
        whole = np.where(there[:, None, None], whole, np.eye(*whole.shape[1:]))
        return np.where(there, np.linalg.cond(whole), np.inf), (eta, square, seconds)

    def _unseen(self, span: np.ndarray, any_of: np.ndarray) -> np.ndarray:
        """The vectors (n, p, 2 N) of planes without a part in y1, of length one in the metric; span (n, p, 2 N, 2).

        any_of : its parts in `span` where no vector of the plane has a part in y1
        """
        gap, twice = self.gap[:, None], self.f.twice[:, None]
        first, second = np.moveaxis((gap[..., None, :] @ span)[..., 0, :], -1, 0)
        some = (first != 0) | (second != 0)
        vector = times(span, np.where(some[..., None], np.stack([second, -first], -1), any_of))
        vector = vector / _length(vector * twice)
        alone = (gap != 0).sum(-1, keepdims=True) == 1
        return np.where(alone & (gap != 0), 0.0, vector)


def _length(x: np.ndarray) -> np.ndarray:
    return np.sqrt(dot(x, x))[..., None]


def _better(one, other):
    """Of each oscillator the planes with the smaller condition."""
    which = other[0] < one[0]
    _put((one[0], *one[1]), which, [new[which] for new in (other[0], *other[1])])
    return one


def _partners(real: np.ndarray, outwards: bool) -> np.ndarray:
    """(n, m/2, 2) of m real roots in order (n, m): neighbours, or the first with the last."""
    n, m = real.shape
    half = m // 2
    return np.stack([real[:, :half], real[:, ::-1][:, :half]], -1) if outwards else real.reshape(n, half, 2)


def _moved(roots: np.ndarray, x: np.ndarray, K: Matrix, C: Matrix) -> np.ndarray:
    """The distance (n, m) by which rounding may have moved each of the roots r (n, m) with these shapes x (n, N, m).

    From (r^2 + C r + K) x = 0: x.(2 r + C)x dr = -x.(dC r + dK)x, and dr^2 in place of 2 r dr where two roots meet.
    """
    size, moduli = np.abs(x), np.abs(roots)
    lengths = columns(size**2)
    terms = moduli**2 * lengths + moduli * forms(size, C.terms) + forms(size, K.terms)
    changes = ROUNDING * x.shape[-2] * terms
    slopes = np.abs(2 * roots * columns(x * x) + forms(x, C.values))
    return np.divide(changes, np.maximum(slopes, np.sqrt(changes * lengths)), where=changes > 0, out=0 * changes)


def _roots(A: np.ndarray, space: np.ndarray, K: Matrix) -> tuple[np.ndarray, np.ndarray]:
    """Roots (n, 2 m) and vectors of A, in a space of modes (n, N, m). Each mode that only dampers hold has one root 0.

    Where there are several, their vectors are independent.
    """
    roots, vectors = (np.asarray(one, complex) for one in np.linalg.eig(A))
    order = np.argsort(np.abs(roots), axis=-1, kind="stable")
    least, largest = (np.abs(np.take_along_axis(roots, order[:, [at]], -1))[:, 0] for at in (0, -1))
    for i in np.flatnonzero(least <= MAY_BE_NONE * largest):
        modes = space[i] @ np.linalg.eigh(space[i].T @ K.values[i] @ space[i])[1]
        free = np.count_nonzero(parts(modes[None], K.at([i]))[0] == 0)
        slowest = order[i, :free]
        if free and roots[i, slowest].imag.sum() != 0:  # rounding made it one of a pair
            roots[i, order[i, free]] = roots[i, order[i, free]].real
        roots[i, slowest] = 0.0
        if free > 1:
            vectors[i][:, slowest] = np.linalg.svd(A[i])[2][-free:].T
    return roots, vectors
