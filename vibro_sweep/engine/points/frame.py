"""Frames in which free flight is N rotations with decay, for tangent vectors (engine/variational/tangent.py).

The plane of a pair of roots of A has vectors e1, e2 with

    A e2 = -eta e2 + g e1,    A e1 = -eta e1 - (square/g) e2,

eta half of minus the sum of the roots and eta^2 + square their product: a complex pair turns in it, a real pair shears.
With classical damping a plane is that of a mode. Otherwise it belongs to a complex pair of roots or to two real ones.
e2 has no part in y1, so that the gap moves by the first number of each plane alone; only where such an e2 would be a
vector of one root, as where a damper alone holds a mass, it has one. Planes that the contact does not see come first:
tangent vectors begin as the vectors of the planes, in this order, and what a rest takes is taken from the last of them.

What springs or dampers do in a mode is rounding where it lies below `ROUNDING` of the terms that it is the sum of
(metric.py). It is 0 then: a mode that nothing holds neither grows nor decays.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.points.contact import Natural, flight_matrix
from vibro_sweep.engine.points.invariant_planes import NO_PLANES, UNOBSERVABLE, Planes, invariant_planes, moved
from vibro_sweep.engine.points.metric import Matrix, in_the_metric, parts
from vibro_sweep.oscillator.stacks import diagonal, different, dot, finite, kron2, only, transposed

CLASSICAL = 1e-13  # of the matrices: what may couple modes and be neglected
NO_PART = 1e-14  # of the terms of the gap: what is rounding
SLOWEST = 1e-5  # of omega: a plane that turns more slowly has the scale of omega
LEAST_SCALE = 1e-3  # of the rate of a plane: near critical damping it shears instead of turning, and any scale serves


class Frame(NamedTuple):
    """Of each oscillator of a stack. Vectors are the columns of `back`; each number is of one plane."""

    eta: np.ndarray  # (..., N)
    square: np.ndarray  # (..., N)
    scale: np.ndarray  # (..., N): g
    rounding: np.ndarray  # (...): how far rounding may have moved the real part of a root
    to: np.ndarray  # (..., 2 N, 2 N)
    back: np.ndarray  # (..., 2 N, 2 N): its inverse


def frame_of(natural: Natural, omega: np.ndarray, of: np.ndarray) -> Frame:
    """Of n oscillators, those of which `of` (n,) says which of `natural` it moves like without forces.

    omega (n,): rates for planes that have none. `to` is NaN, and so are exponents, where roots cannot be parted.
    """
    A = flight_matrix(natural.stiffness, natural.damping)
    root = np.sqrt(natural.masses)
    K, C = (in_the_metric(natural, matrix) for matrix in (natural.stiffness, natural.damping))
    planes, classical = _modes(root, K, C)
    if not classical.all():
        others = np.flatnonzero(~classical)
        found = invariant_planes(A[others], root[others], K.at(others), C.at(others), natural.normal[others])
        for known, more in zip(planes, found, strict=True):
            known[others] = more
    eta, square, seconds, rounding = planes
    effective = 1 / dot(natural.normal, natural.normal / natural.masses)
    share = np.abs((natural.normal[:, None] @ seconds[:, 1::2])[:, 0]) * np.sqrt(effective)[:, None]
    order = np.argsort(share > UNOBSERVABLE, axis=-1, kind="stable")
    eta, square = (np.take_along_axis(one, order, -1) for one in (eta, square))
    seconds = np.take_along_axis(seconds, order[:, None], -1)
    product = square + eta**2
    scale = np.maximum(np.sqrt(np.abs(square)), LEAST_SCALE * np.sqrt(np.maximum(product, 0)))
    turns = scale[of] > SLOWEST * omega[:, None]
    unlike, place = different(np.column_stack([of, np.where(turns.all(-1), 0.0, omega)]))
    which, scale = of[unlike], np.where(turns, scale[of], omega[:, None])[unlike]
    A, eta, square, seconds, natural = (
        *(one[which] for one in (A, eta, square, seconds)), Natural(*(one[which] for one in natural)),
    )  # fmt: skip
    back = np.empty(A.shape)
    back[..., 1::2] = seconds
    back[..., 0::2] = (A @ seconds + eta[:, None] * seconds) / scale[:, None]
    known = finite(back)
    parted = known & (np.linalg.cond(only(known, back)) < NO_PLANES)
    normal = natural.normal[:, None]
    unseen = np.abs(normal @ seconds[:, 0::2]) <= NO_PART * (np.abs(normal) @ np.abs(seconds[:, 0::2]))
    back = kron2(natural.to_contact) @ back
    back[:, 0, 1::2][unseen[:, 0]] = 0.0
    to = np.where(parted[:, None, None], np.linalg.inv(only(parted, back)), np.nan)
    of_these = (one[place] for one in (eta, square, scale, rounding[which], to, back))
    return Frame(*of_these)


def _modes(root: np.ndarray, stiffness: Matrix, damping: Matrix) -> tuple[Planes, np.ndarray]:
    """Planes of the modes, and whether damping is classical: K and C have common eigenvectors in the metric M."""
    K, C = stiffness.values, damping.values
    sizes = [matrix.largest[:, None, None] for matrix in (stiffness, damping)]
    together = (K / sizes[0] + transposed(K) / sizes[0]) + 0.618 * (C / sizes[1] + transposed(C) / sizes[1])
    vectors = np.linalg.eigh(together)[1]
    apart = np.zeros(len(K))
    for matrix, size in zip((K, C), sizes, strict=True):
        turned = transposed(vectors) @ matrix @ vectors
        beside = turned - diagonal(turned)[..., None] * np.eye(turned.shape[-1])
        apart = np.maximum(apart, np.abs(beside).max((-2, -1)) / size[:, 0, 0])
    (squares, of_squares), (dampings, of_dampings) = (parts(vectors, matrix) for matrix in (stiffness, damping))
    eta = dampings / 2
    seconds = np.zeros((len(K), 2 * K.shape[-1], K.shape[-1]))
    seconds[:, 1::2] = vectors / root[..., None]
    rounding = moved(eta, squares - eta**2, of_dampings / 2, of_squares)
    planes = Planes(eta, squares - eta**2, seconds, rounding.max(-1, initial=0.0))
    return planes, apart <= CLASSICAL * K.shape[-1]
