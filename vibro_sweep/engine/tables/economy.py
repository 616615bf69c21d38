"""Fewer terms for a Taylor series over a cell, without loss: Lanczos's economisation.

On 0 <= s <= 1 the polynomial of degree below n that is nearest to s^n is s^n - T*_n(s)/2^(2n - 1), with the shifted
Chebyshev polynomial T*_n; it is no further away than 2^(1 - 2n). The first term that is left out of the series of x1
is c_13 w^13, below 2e-14 of the terms before it; spread over these it leaves an error of 8e-22. Its first two
derivatives are in error by 3e-19 and 3e-17: the speed and the acceleration at an impact keep their digits, too. Where
no acceleration is asked for, 12 terms suffice.
"""

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER


def economy(terms: int) -> np.ndarray:
    """The terms that each power of s from s^terms on adds to the powers below it, (ORDER - terms, terms)."""
    powers, polynomials = np.eye(ORDER), shifted_chebyshev(ORDER)
    for n in range(ORDER - 1, terms - 1, -1):
        powers -= np.outer(powers[:, n], polynomials[n] / polynomials[n, n])
    return powers[terms:, :terms].copy()


def shifted_chebyshev(count: int) -> np.ndarray:
    """Coefficients of T*_0, T*_1, ..., whole numbers: T*_(n+1) = 2 (2 s - 1) T*_n - T*_(n-1)."""
    polynomials = np.zeros((count, count))
    polynomials[0, 0], polynomials[1, 0], polynomials[1, 1] = 1, -1, 2
    for n in range(2, count):
        polynomials[n] = -2 * polynomials[n - 1] - polynomials[n - 2]
        polynomials[n, 1:] += 4 * polynomials[n - 1, :-1]
    return polynomials


TERMS, FEWER_TERMS = 13, 12
TO_TERMS, TO_FEWER_TERMS = economy(TERMS), economy(FEWER_TERMS)


@jit
def economise(economy, q, c, rows, first, i):
    """Put the terms of the series c, economised over a cell of q, into column i of `rows` from row `first` on."""
    left, terms = economy.shape
    for n in range(terms):
        more = 0.0
        for m in range(left - 1, -1, -1):
            more = more * q.width + c[terms + m] * economy[m, n]
        rows[first + n, i] = c[n] + q.reach[terms - n] * more
