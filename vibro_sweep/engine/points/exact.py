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
    n, spare = q.masses, least_restrained(q)
    units = [[Fraction(int(i == j)) for j in range(n)] for i in range(n) if i != spare]
    P = [as_fractions(q.contact.normal), *units]
    K, constant, origin = as_fractions(q.K), as_fractions(q.constant), as_fractions(contact.origin)
    still = [f - sum(a * x for a, x in zip(row, origin, strict=True)) for row, f in zip(K, constant, strict=True)]
    forces = [*zip(as_fractions(q.sine), as_fractions(q.cosine), still, strict=True)]
    exact = accelerations(q.M, q.K, q.C, forces, P, inverse(P))
    rounded = np.array([[float(a) for a in row] for row in exact])
    left = [
        [float(a - Fraction(b)) for a, b in zip(row, other, strict=True)]
        for row, other in zip(exact, rounded.tolist(), strict=True)
    ]
    return rounded, np.array(left)


def accelerations(M, K, C, forces, P: list, back: list) -> list:
    """y'' of y = P x as a function of (y, y', inputs): P M^-1 (-K back, -C back, forces), of fractions.

    forces : (N, inputs)
    """
    stiffness, damping = (product(as_fractions(np.array(matrix, float)), back) for matrix in (K, C))
    inputs = [[Fraction(a) for a in row] for row in forces]
    rows = [[*(-a for a in k), *(-a for a in c), *f] for k, c, f in zip(stiffness, damping, inputs, strict=True)]
    return product(P, solved(as_fractions(np.array(M, float)), rows))


def as_fractions(values: np.ndarray) -> list:
    return [as_fractions(one) for one in values] if np.ndim(values) > 1 else [Fraction(float(one)) for one in values]


def product(a: list, b: list) -> list:
    columns = [*zip(*b, strict=True)]
    return [[sum(x * y for x, y in zip(row, column, strict=True)) for column in columns] for row in a]


def inverse(a: list) -> list:
    return solved(a, [[Fraction(int(i == j)) for j in range(len(a))] for i in range(len(a))])


def solved(a: list, rows: list) -> list:
    """a^-1 rows, by elimination."""
    n = len(a)
    wide = [[*left, *right] for left, right in zip(a, rows, strict=True)]
    for i in range(n):
        pivot = next(j for j in range(i, n) if wide[j][i])
        wide[i], wide[pivot] = wide[pivot], wide[i]
        for j in range(n):
            if j != i and wide[j][i]:
                factor = wide[j][i] / wide[i][i]
                wide[j] = [x - factor * y for x, y in zip(wide[j], wide[i], strict=True)]
    return [[x / row[i] for x in row[n:]] for i, row in enumerate(wide)]
