"""Economised series against exact rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest

from vibro_sweep.engine.tables import economy
from vibro_sweep.engine.tables.flight import ORDER


def shifted_chebyshev(n: int) -> list[Fraction]:
    """Coefficients of T*_n(s) = T_n(2 s - 1), by T*_n+1 = (4 s - 2) T*_n - T*_n-1."""
    before, last = [Fraction(1)], [Fraction(-1), Fraction(2)]
    for _ in range(n - 1):
        following = [Fraction(0)] * (len(last) + 1)
        for i, c in enumerate(last):
            following[i] -= 2 * c
            following[i + 1] += 4 * c
        for i, c in enumerate(before):
            following[i] -= c
        before, last = last, following
    return last


@pytest.mark.parametrize("terms", [economy.TERMS, economy.FEWER_TERMS])
def test_powers_are_replaced_by_the_nearest_polynomials(terms):
    powers = [[Fraction(i == j) for j in range(ORDER)] for i in range(ORDER)]
    for n in range(ORDER - 1, terms - 1, -1):
        shifted = shifted_chebyshev(n)
        for row in powers:
            part = row[n] / shifted[n]
            for j in range(n + 1):
                row[j] -= part * shifted[j]
    exact = np.array([[float(c) for c in row[:terms]] for row in powers[terms:]])
    np.testing.assert_allclose(economy.economy(terms), exact, rtol=1e-12)


@pytest.mark.parametrize(
    "terms, bounds", [(economy.TERMS, (8e-22, 3e-19, 3e-17)), (economy.FEWER_TERMS, (8e-20, 3e-17))]
)
def test_what_is_left_out_of_an_exponential_is_below_rounding(terms, bounds):
    """e^u over a cell as wide as rates allow, u = s/2: the stated errors of the sum and its derivatives by s."""
    c = np.array([Fraction(1, 2) ** n / np.prod([Fraction(k) for k in range(1, n + 1)] or [1]) for n in range(ORDER)])
    more = [[Fraction(x) for x in row] for row in economy.economy(terms)]
    change = [sum(c[terms + m] * more[m][n] for m in range(ORDER - terms)) for n in range(terms)]
    change += [-c[n] for n in range(terms, ORDER)]
    for derivative, bound in enumerate(bounds):
        largest = max(abs(sum(x * Fraction(i, 64) ** n for n, x in enumerate(change))) for i in range(65))
        assert largest < bound, derivative
        change = [n * x for n, x in enumerate(change)][1:]
