"""Real functions f(u) = Re(sum of a_k e^{l_k u}) with Re l_k <= 0, and the first zero of one, certified.

Every derivative is known exactly, and |f^(n)| <= sum of |a_k| |l_k|^n e^{Re l_k low} from `low` on. First, in extended
precision (numpy's longdouble) and with its rounding bounded, all intervals are excluded on which f is positive for
certain; what is left is decided by bisection in the working precision of mpmath. A term that an interval does not
resolve is not followed there but bounded by its size.

Where rates are 1e4 apart, steps of exp(A h) (flow.py) take 40 to 90 times as long to the first impact, and longer still
through a rest.
"""

from functools import cached_property

import gmpy2
import numpy as np
from mpmath import mp, mpf

from reference.gmp import context, from_gmp, to_gmp

UNIT = float(np.finfo(np.longdouble).eps)
PARTS = 8  # into which an interval is split
MOST = 400_000  # intervals looked at together


class TooManySwingsError(ArithmeticError):
    """The interval holds too many swings to look at."""


def longdouble(x) -> np.longdouble:
    high = float(x)
    return np.longdouble(high) + np.longdouble(float(x - mpf(high)))


class Exponentials:
    """f; amplitudes a_k and rates l_k are numbers of mpmath, real or complex."""

    def __init__(self, amplitudes, rates):
        self.amplitudes, self.rates = list(amplitudes), list(rates)

    def times(self, factor):
        return Exponentials([factor * a for a in self.amplitudes], self.rates)

    def derivative(self):
        return Exponentials([a * rate for a, rate in zip(self.amplitudes, self.rates, strict=True)], self.rates)

    def derivatives(self, u, count):
        """f(u), f'(u), ...: so many."""
        with context():
            values, u = [gmpy2.mpfr(0)] * count, to_gmp(mpf(u))
            for a, rate in self._terms:
                term = a * gmpy2.exp(rate * u)
                for n in range(count):
                    values[n] += term.real
                    term *= rate
            return [from_gmp(value) for value in values]

    @cached_property
    def _terms(self):
        """Amplitudes and rates as numbers of gmpy2; they hold to the precision at their first use."""
        numbers = zip(self.amplitudes, self.rates, strict=True)
        return [tuple(gmpy2.mpc(to_gmp(x.real), to_gmp(x.imag)) for x in pair) for pair in numbers]

    @cached_property
    def sizes(self):
        """(|a_k|, |l_k|, Re l_k), rounded up."""
        up = 1 + 1e-14
        return [
            (float(abs(a)) * up, float(abs(rate)) * up, float(rate.real) * (1 - 1e-14))
            for a, rate in zip(self.amplitudes, self.rates, strict=True)
        ]

    def bound(self, n, low):
        """On |f^(n)| from `low` on."""
        low = float(low) * (1 - 1e-14)
        return mpf(sum(a * rate**n * np.exp(decay * low) for a, rate, decay in self.sizes)) * (1 + mpf(2) ** -40)

    @cached_property
    def rounded(self):
        """Amplitudes and rates (terms, 1) as complex longdoubles."""
        rows = []
        for numbers in (self.amplitudes, self.rates):
            rows.append([longdouble(mpf(x.real)) + 1j * longdouble(mpf(x.imag)) for x in numbers])
        return [np.array(row, np.clongdouble)[:, None] for row in rows]

    def suspects(self, low, high):
        """Intervals [(low, high), ...] in order, outside of which f > 0 up to the first certain negative value."""
        a, rate = self.rounded
        size, speed, decay = np.abs(a) * (1 + 8 * UNIT), np.abs(rate) * (1 + 8 * UNIT), rate.real
        edges = np.linspace(longdouble(low), longdouble(high), 65)
        edges[0], edges[-1] = (1 - 2 * UNIT) * longdouble(low), (1 + 2 * UNIT) * longdouble(high)
        low, high = edges[:-1], edges[1:]
        left = []
        while len(low):
            middle, r = (low + high) / 2, (high - low) / 2 * (1 + 4 * UNIT) + 4 * UNIT * high
            largest = size * np.exp(decay * low * (1 - 8 * UNIT))
            slow = speed * r <= 1
            term = np.where(slow, a * np.exp(rate * middle), 0)
            f = term.real.sum(0)
            slope = (rate * term).real.sum(0)
            bend = (rate * rate * term).real.sum(0)
            rest = np.where(slow, largest * (speed * r) ** 3 / 6, largest).sum(0)
            error = 8 * UNIT * (largest * (16 + speed * high)).sum(0)
            inner = (bend > 0) & (np.abs(slope) < bend * r)
            with np.errstate(divide="ignore", invalid="ignore"):
                least = np.where(inner, f - slope**2 / (2 * bend), f + bend * r * r / 2 - np.abs(slope) * r)
            open_ = ~(least - rest - error > 0)
            negative = np.flatnonzero(f + rest + error < 0)
            if len(negative):
                open_[negative[0] + 1 :] = False
            done = open_ & (rest < 1e-4 * np.where(slow, largest, 0).sum(0) + error)
            left += list(zip(low[done], high[done], strict=True))
            low, high = low[open_ & ~done], high[open_ & ~done]
            if PARTS * len(low) > MOST:
                raise TooManySwingsError(f"{len(low)} intervals")
            steps = np.arange(PARTS + 1) / np.longdouble(PARTS)
            edges = low[:, None] + (high - low)[:, None] * steps
            edges[:, -1] = high
            low, high = edges[:, :-1].ravel(), edges[:, 1:].ravel()
        merged = []
        for begin, end in sorted(left):
            if merged and begin <= merged[-1][1] * (1 + 4 * UNIT):
                merged[-1][1] = max(end, merged[-1][1])
            else:
                merged.append([begin, end])
        return [(exactly(begin), exactly(end)) for begin, end in merged]

    def first_zero(self, low, high):
        """First u in [low, high] at which f, positive until then, becomes negative; None if there is none."""
        if not low < high:
            return None
        for begin, end in self.suspects(low, high):
            u = self.zero_in(max(begin, low), min(end, high))
            if u is not None:
                return u
        return None

    def zero_in(self, low, high):
        stack = [(low, high)]
        while stack:
            low, high = stack.pop()
            middle, r = (low + high) / 2, (high - low) / 2
            f, slope, bend = self.derivatives(middle, 3)
            third = self.bound(3, low)
            if abs(f) > abs(slope) * r + abs(bend) * r**2 / 2 + third * r**3 / 6:
                if f < 0:
                    return low
                continue
            if abs(slope) > abs(bend) * r + third * r**2 / 2:
                if slope < 0 and self.derivatives(high, 1)[0] < 0:
                    return self.root(0, low, high)
                if slope > 0 and self.derivatives(low, 1)[0] < 0:
                    return low
                continue
            if abs(bend) > third * r:
                at_low, at_high = self.derivatives(low, 2), self.derivatives(high, 2)
                if at_low[0] < 0:
                    return low
                if at_low[1] * at_high[1] < 0:
                    extreme = self.root(1, low, high)
                    if bend > 0:
                        if self.derivatives(extreme, 1)[0] < 0:
                            return self.root(0, low, extreme)
                    elif at_high[0] < 0:
                        return self.root(0, extreme, high)
                elif at_high[0] < 0:
                    return self.root(0, low, high)
                continue
            if r < mp.eps * high * 1000:
                return middle  # a zero of higher order, to the working precision
            stack += [(middle, high), (low, middle)]
        return None

    def root(self, n, low, high):
        """The zero of f^(n), monotone from low to high with a change of sign."""
        falling = self.derivatives(low, n + 1)[n] > 0
        u, close = (low + high) / 2, mp.eps ** mpf("0.75")
        for _ in range(3 * mp.prec):
            value, slope = self.derivatives(u, n + 2)[n:]
            low, high = (u, high) if (value > 0) == falling else (low, u)
            newton = u - value / slope if slope else low
            after = newton if low < newton < high else (low + high) / 2
            if abs(after - u) <= close * abs(high):  # the next step would be its square
                return after
            u = after
        return u


def exactly(x: np.longdouble) -> mpf:
    high = float(x)
    return mpf(high) + mpf(float(x - np.longdouble(high)))
