"""Numbers with more digits than floats have: numpy's longdouble where it has 64 bits, else sums of two floats.

On Windows and on ARM longdouble is a float. There `Twofold` takes its place, with the error-free sums and products of
Knuth and Dekker (T. J. Dekker, Numer. Math. 18, 1971): 106 bits, in ten times the time. Arrays of either kind are made
here; sums, products, slices, `@`, np.concatenate and np.stack then do the same with both.
"""

import numpy as np

NATIVE = np.finfo(np.longdouble).nmant >= 63
SPLIT = 2.0**27 + 1


def extended(values):
    """An array or a number with more digits, that has these values."""
    if isinstance(values, Twofold):
        return values
    return np.asarray(values).astype(np.longdouble)[()] if NATIVE else Twofold(values)


def identity(n: int):
    return extended(np.eye(n))


def _sum(a, b):
    total = a + b
    other = total - a
    return total, (a - (total - other)) + (b - other)


def _product(a, b):
    product, c, d = a * b, SPLIT * a, SPLIT * b
    a_high, b_high = c - (c - a), d - (d - b)
    a_low, b_low = a - a_high, b - b_high
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


class Twofold:
    """An array of sums high + low."""

    __array_ufunc__ = None  # floats leave sums and products to the methods below
    __hash__ = None

    def __init__(self, high, low=0.0):
        self.high = np.asarray(high, float)
        self.low = np.broadcast_to(np.asarray(low, float), self.high.shape).copy()

    @classmethod
    def _of(cls, high, low):
        return cls(*_sum(high, low))

    def __array_function__(self, function, kinds, arguments, options):
        if function in (np.concatenate, np.stack):
            parts = [Twofold(part) if not isinstance(part, Twofold) else part for part in arguments[0]]
            both = ([part.high for part in parts], [part.low for part in parts])
            return Twofold(*(function(part, *arguments[1:], **options) for part in both))
        return NotImplemented

    shape = property(lambda self: self.high.shape)
    T = property(lambda self: Twofold(self.high.T, self.low.T))

    def __len__(self):
        return len(self.high)

    def __getitem__(self, place):
        return Twofold(self.high[place], self.low[place])

    def __setitem__(self, place, value):
        value = value if isinstance(value, Twofold) else Twofold(value)
        self.high[place], self.low[place] = value.high, value.low

    def __float__(self):
        return float(self.high + self.low)

    def astype(self, kind):
        return (self.high + self.low).astype(kind)

    def __neg__(self):
        return Twofold(-self.high, -self.low)

    def __add__(self, other):
        other = other if isinstance(other, Twofold) else Twofold(other)
        high, low = _sum(self.high, other.high)
        return Twofold._of(high, low + (self.low + other.low))

    def __sub__(self, other):
        return self + -(other if isinstance(other, Twofold) else Twofold(other))

    def __rsub__(self, other):
        return Twofold(other) - self

    def __mul__(self, other):
        other = other if isinstance(other, Twofold) else Twofold(other)
        high, low = _product(self.high, other.high)
        return Twofold._of(high, low + (self.high * other.low + self.low * other.high))

    def __truediv__(self, other):
        other = other if isinstance(other, Twofold) else Twofold(other)
        first = Twofold(self.high / other.high)
        rest = self - first * other
        return first + Twofold(rest.high / other.high)

    def __rtruediv__(self, other):
        return Twofold(other) / self

    def __pow__(self, count: int):
        result = self
        for _ in range(count - 1):
            result = result * self
        return result

    def __matmul__(self, other):
        """The product of a matrix with a matrix or a vector, or of a vector with either."""
        other = other if isinstance(other, Twofold) else Twofold(other)
        columns, rows = self if self.high.ndim > 1 else self[None], other if other.high.ndim > 1 else other[:, None]
        total = Twofold(np.zeros((columns.shape[0], rows.shape[1])))
        for k in range(rows.shape[0]):
            total = total + columns[:, k, None] * rows[k]
        total = total if self.high.ndim > 1 else total[0]
        return total if other.high.ndim > 1 else total[..., 0]

    def __rmatmul__(self, other):
        return Twofold(other) @ self

    __radd__, __rmul__ = __add__, __mul__
