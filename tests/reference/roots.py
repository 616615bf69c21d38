"""Values and first roots of polynomials c_0 + c_1 u + ..., whose coefficients are numbers of gmpy2."""

import gmpy2

ZERO = gmpy2.mpfr(0)


def epsilon():
    """The distance of 1 from the next number."""
    return gmpy2.div_2exp(gmpy2.mpfr(1), gmpy2.get_context().precision - 1)


def horner(c, u):
    value = ZERO
    for a in reversed(c):
        value = value * u + a
    return value


def evaluate(terms, u):
    return [horner(column, u) for column in zip(*terms, strict=True)]


def recentred(c, centre):
    """Coefficients of the polynomial c in powers of u - centre."""
    d = list(c)
    for i in range(len(d) - 1):
        for j in range(len(d) - 2, i - 1, -1):
            d[j] += centre * d[j + 1]
    return d


def falling_root(c, low, high):
    """Smallest u in [low, high] where the polynomial c, positive until then, falls through zero; else None.

    A touch of zero that the working precision cannot tell from a double root is a graze, and no root.
    """
    centre, r = (low + high) / 2, (high - low) / 2
    d = recentred(c, centre)
    if abs(d[0]) > sum(abs(a) * r**n for n, a in enumerate(d[1:], 1)):
        return low if d[0] < 0 else None
    if abs(d[1]) > sum(n * abs(a) * r ** (n - 1) for n, a in enumerate(d[2:], 2)):
        return monotone_root(c, low, high) if d[1] < 0 else None
    if r < gmpy2.sqrt(epsilon()):
        return None
    left = falling_root(c, low, centre)
    return falling_root(c, centre, high) if left is None else left


def monotone_root(c, low, high):
    """The root of a polynomial that falls from low to high; None if it stays positive."""
    if horner(c, high) > 0:
        return None
    if horner(c, low) <= 0:
        return low
    slope = [n * a for n, a in enumerate(c[1:], 1)]
    u = (low + high) / 2
    for _ in range(2 * gmpy2.get_context().precision):
        value = horner(c, u)
        low, high = (u, high) if value > 0 else (low, u)
        newton = u - value / horner(slope, u)
        following = newton if low < newton < high else (low + high) / 2
        if abs(following - u) <= 4 * epsilon() * high:
            return following
        u = following
    raise ArithmeticError("no convergence to a contact")
