"""Arithmetic of gmpy2, several times faster than that of mpmath, at the precision that mpmath works in.

Where a reference computes for long it changes to these numbers, and back at its end.
"""

import math
from operator import mul

import gmpy2
from mpmath import mp, mpf


def context(extra=0):
    """The context of mpmath's precision and `extra` bits."""
    return gmpy2.context(precision=mp.prec + extra)


def to_gmp(x):
    """A finite number of mpmath or of Python, exactly if the precision holds it."""
    sign, mantissa, exponent, _ = mpf(x)._mpf_
    number = gmpy2.mpfr(-mantissa if sign else mantissa)
    return gmpy2.mul_2exp(number, exponent) if exponent >= 0 else gmpy2.div_2exp(number, -exponent)


def from_gmp(x):
    mantissa, exponent = x.as_mantissa_exp()
    return mp.ldexp(mpf(mantissa), int(exponent))


def dot(a, b):
    return sum(map(mul, a, b))


def product(A, B):
    columns = list(zip(*B, strict=True))
    return [[dot(row, column) for column in columns] for row in A]


def expm(A):
    """exp(A) of a matrix of mpmath, by its series at A / 2^n, which is then squared n times."""
    norm = float(mp.mnorm(A, mp.inf))
    n = max(0, math.ceil(math.log2(norm)) + 8) if norm else 0
    with context(2 * n + 20):
        step = [[gmpy2.div_2exp(to_gmp(a), n) for a in row] for row in A.tolist()]
        term = result = [[gmpy2.mpfr(i == j) for j in range(A.rows)] for i in range(A.rows)]
        order, smallest = 0, gmpy2.div_2exp(gmpy2.mpfr(1), mp.prec + 2 * n + 20)
        while max(abs(a) for row in term for a in row) > smallest:
            order += 1
            term = [[a / order for a in row] for row in product(term, step)]
            result = [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(result, term, strict=True)]
        for _ in range(n):
            result = product(result, result)
        return mp.matrix([[from_gmp(a) for a in row] for row in result])
