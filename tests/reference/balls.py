"""Numbers with error bounds (flint's `arb`), and the first root of a polynomial of them, proven.

Where a reference computes for long it works in these: a product of matrices is one call.
"""

from contextlib import contextmanager

from flint import arb, arb_mat, arb_poly, ctx
from mpmath import mp, mpf


@contextmanager
def precision():
    """Balls in the working precision of mpmath."""
    before, ctx.prec = ctx.prec, mp.prec
    try:
        yield
    finally:
        ctx.prec = before


def to_ball(x):
    """A finite number of mpmath or of Python, exactly if the precision holds it."""
    sign, mantissa, exponent, _ = mpf(x)._mpf_
    return arb((-int(mantissa) if sign else int(mantissa), exponent))


def from_ball(x):
    mantissa, exponent = x.mid().man_exp()
    return mp.ldexp(mpf(int(mantissa)), int(exponent))


def to_balls(rows):
    """A matrix from rows of numbers."""
    return arb_mat([[to_ball(a) for a in row] for row in rows])


def falling_root(c, n, narrow):
    """Smallest u in [0, 1] where sum of c_(n + i) u^i, positive until then, falls through zero; else None.

    A touch of zero that cannot be told from a double root in an interval as `narrow` as this is a graze, and no root.
    """
    sizes = [abs(float(a)) for a in c[n:]]
    if sizes[0] > 1.000001 * sum(sizes[1:]):
        return arb(0) if c[n] < 0 else None
    f = arb_poly(c[n:])
    slope = f.derivative()
    intervals = [(arb(0), arb(1))]
    while intervals:
        low, high = intervals.pop()
        middle, r = (low + high) / 2, (high - low) / 2
        steepness = slope(arb(middle.mid(), r.upper()))
        value, reach = f(middle), abs(steepness) * r
        if abs(value) > reach:
            if value < 0:
                return low
        elif steepness < 0:
            if f(high) <= 0:
                return monotone_root(f, slope, low, high)
        elif not steepness > 0 and r > narrow:
            intervals += [(middle.mid(), high), (low, middle.mid())]
    return None


def monotone_root(f, slope, low, high):
    """The root of a polynomial that falls from low to high through zero."""
    if f(low) <= 0:
        return low
    u = ((low + high) / 2).mid()
    for _ in range(1000):
        value = f(u)
        if not (value > 0 or value < 0):
            return u
        low, high = (u, high) if value > 0 else (low, u)
        newton = (u - value / slope(u)).mid()
        u = newton if low < newton < high else ((low + high) / 2).mid()
        if high - low <= arb((1, -mp.prec)) * high:
            return u
    raise ArithmeticError("no convergence to a root")
