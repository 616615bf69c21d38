"""Equations of motion in contact coordinates without rounding, for oscillators whose rates lie apart.

A force k x of a stiffly held mass and the force on it balance but for what moves the soft ones. Where each is rounded
by itself, what is left of them has lost as many digits as they have in common. Here each coefficient is computed from
the numbers of the oscillator in fractions, and given as the sum of two floats.
"""

from fractions import Fraction

import numpy as np

from vibro_sweep.engine.points.contact import ContactCoordinates, least_restrained
from vibro_sweep.oscillator.linear import Linear


def exact_motion(q: Linear, contact: ContactCoordinates) -> tuple[np.ndarray, np.ndarray]:
    """(N, 2 N + 3) q'' as a function of (q, q', sin, cos, 1): rounded, and what that leaves."""
    n, spare = len(q.normal), least_restrained(q)
    M, K, C, along, origin = (_fractions(one) for one in (q.M, q.K, q.C, q.normal, contact.origin))
    others = [i for i in range(n) if i != spare]

    def by_coordinates(matrix):
        """matrix P^-1: x_spare = (q_1 - sum of n_i x_i)/n_spare."""
        last = [row[spare] / along[spare] for row in matrix]
        return [[end, *(row[i] - end * along[i] for i in others)] for row, end in zip(matrix, last, strict=True)]

    constant = [
        f - sum(a * x for a, x in zip(row, origin, strict=True))
        for row, f in zip(K, _fractions(q.constant), strict=True)
    ]
    forces = zip(_fractions(q.sine), _fractions(q.cosine), constant, strict=True)
    stiffness, damping = by_coordinates(K), by_coordinates(C)
    rows = [[*(-a for a in k), *(-a for a in c), *f] for k, c, f in zip(stiffness, damping, forces, strict=True)]
    rows = _solved(M, rows)
    gap = [sum(a * b for a, b in zip(along, column, strict=True)) for column in zip(*rows, strict=True)]
    exact = [gap, *(rows[i] for i in others)]
    rounded = np.array([[float(a) for a in row] for row in exact])
    left = [
        [float(a - Fraction(b)) for a, b in zip(row, other, strict=True)]
        for row, other in zip(exact, rounded.tolist(), strict=True)
    ]
    return rounded, np.array(left)


def _fractions(values: np.ndarray) -> list:
    return [_fractions(one) for one in values] if np.ndim(values) > 1 else [Fraction(float(one)) for one in values]


def _solved(M: list, rows: list) -> list:
    """M^-1 rows, by elimination; M is positive definite."""
    n = len(M)
    wide = [[*left, *right] for left, right in zip(M, rows, strict=True)]
    for i in range(n):
        for j in range(n):
            if j != i and wide[j][i]:
                factor = wide[j][i] / wide[i][i]
                wide[j] = [a - factor * b for a, b in zip(wide[j], wide[i], strict=True)]
    return [[a / row[i] for a in row[n:]] for i, row in enumerate(wide)]
