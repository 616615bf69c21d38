"""Stiffness and damping in the metric of the masses, and what rounding leaves of them in a mode."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.points.contact import Natural
from vibro_sweep.oscillator.stacks import columns, diagonal, transposed

ROUNDING = 2.0**-48  # of the terms of a sum: what rounding may leave of it, for each mass


class Matrix(NamedTuple):
    """K or C in the metric of the masses, symmetric; of each oscillator of a stack."""

    values: np.ndarray  # (n, N, N)
    terms: np.ndarray  # (n, N, N): sums of the moduli of the terms that each number is the sum of

    @property
    def largest(self) -> np.ndarray:
        """(n,): the largest modulus; 1 of a matrix of zeros."""
        found = np.abs(self.values).max((-2, -1))
        return np.where(found == 0, 1.0, found)

    def at(self, which: np.ndarray) -> "Matrix":
        """Those of some oscillators."""
        return Matrix(*(one[which] for one in self))


def in_the_metric(natural: Natural, matrix: np.ndarray) -> Matrix:
    """K or C, given as `stiffness` or `damping` of `natural`."""
    root = np.sqrt(natural.masses)
    values = root[..., :, None] * matrix / root[..., None, :]
    to, back = natural.of_masses, np.linalg.inv(natural.of_masses)
    return Matrix(values, np.abs(to) @ np.abs(back @ values @ transposed(back)) @ np.abs(transposed(to)))


def parts(vectors: np.ndarray, matrix: Matrix) -> tuple[np.ndarray, np.ndarray]:
    """The values (n, m) of K or C in each of the modes `vectors` (n, N, m), 0 where below rounding; and its error."""
    found = diagonal(transposed(vectors) @ matrix.values @ vectors)
    # vectors of length 1 have errors too
    more = ROUNDING * matrix.terms.max((-2, -1))[:, None]
    rounding = ROUNDING * vectors.shape[-2] * (forms(np.abs(vectors), matrix.terms) + more)
    kept = found > rounding
    left = np.sqrt(columns((matrix.values @ vectors) ** 2))  # an eigenvalue is no farther from 0
    return np.where(kept, found, 0.0), np.where(kept, rounding, np.minimum(rounding, 4 * left))


def forms(x: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """x.matrix x of each column."""
    return columns(x * (matrix @ x))
