"""What two modes of nearly the same frequency do in different ways.

The motion of x2 enters x1 by the difference of the two modes' flights, times a weight that grows like 1/gap, with gap =
omega_2^2 - omega_1^2. Formed from the two flights the difference would lose the digits that they have in common; here
it is formed from the gap.
"""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import decaying

CLOSE = 0.25  # part of omega_2^2 below which the gap is called small
TERMS = 12  # of a series in omega_d^2 u^2 <= 1


@jit
def series_difference(z1, apart):
    """C(z2) - C(z1) and S(z2) - S(z1) for C(z) = cos(sqrt z), S(z) = sin(sqrt z)/sqrt z, and |z| up to 1.

    apart: z2 - z1.
    """
    z2 = z1 + apart
    c, s, power, quotient, factor = 0.0, 0.0, 1.0, 1.0, 1.0
    for n in range(1, TERMS):
        factor /= -(2.0 * n - 1.0) * (2.0 * n)  # (-1)^n/(2 n)!; quotient: (z2^n - z1^n)/(z2 - z1)
        c += factor * quotient
        s += factor / (2.0 * n + 1.0) * quotient
        power *= z1
        quotient = quotient * z2 + power
    return c * apart, s * apart


@jit
def difference(zeta, first, gap, u):
    """The difference of `decaying` between omega_j^2 = first + gap and `first`, eta_j = zeta omega_j^2.

    (s, c + eta s, c - eta s, omega_j^2 s), each with the decay; u: time of flight.
    """
    second = first + gap
    eta1, eta2 = zeta * first, zeta * second
    slope = 1.0 - zeta * zeta * (first + second)  # of omega_d^2 over omega_j^2
    square1, square2 = first - eta1 * eta1, second - eta2 * eta2
    _, s1, _, _ = decaying(eta1, first, u)
    if square1 < 0.0 and square2 < 0.0 and max(-square1, -square2) * u * u > 1.0:
        r1, r2 = math.sqrt(-square1), math.sqrt(-square2)
        apart = -gap * slope / (r1 + r2)  # r2 - r1
        slow1, slow2 = first / (eta1 + r1), second / (eta2 + r2)
        slower = -first * second * gap / ((second * r1 + first * r2) * (eta1 + r1) * (eta2 + r2))  # slow2 - slow1
        slow = math.exp(-slow1 * u) * math.expm1(-slower * u)
        fast = math.exp(-(eta1 + r1) * u) * math.expm1(-(zeta * gap + apart) * u)
        s = (slow - fast) / (2.0 * r2) - s1 * apart / r2
        return s, slow + slow2 * s + slower * s1, fast - slow2 * s - slower * s1, second * s + gap * s1
    decay, lost = math.exp(-eta1 * u), math.expm1(-zeta * gap * u)
    if square1 > 0.0 and square2 > 0.0 and max(square1, square2) * u * u > 1.0:
        w1, w2 = math.sqrt(square1), math.sqrt(square2)
        apart = gap * slope / (w1 + w2)  # w2 - w1
        half, middle = 0.5 * apart * u, 0.5 * (w1 + w2) * u
        sin = 2.0 * math.cos(middle) * math.sin(half)
        c = decay * (lost * math.cos(w2 * u) - 2.0 * math.sin(middle) * math.sin(half))
        s = decay * (lost * math.sin(w2 * u) + sin) / w2 - s1 * apart / w2
    elif max(abs(square1), abs(square2)) * u * u <= 1.0:
        dc, ds = series_difference(square1 * u * u, gap * slope * u * u)
        c2, s2, _, _ = decaying(0.0, square2, u)
        c, s = decay * (lost * c2 + dc), decay * (lost * s2 + u * ds)
    else:  # one oscillates and one does not: they have little in common
        c1, _, _, _ = decaying(eta1, first, u)
        c, s2, _, _ = decaying(eta2, second, u)
        c, s = c - c1, s2 - s1
    bend = eta2 * s + zeta * gap * s1
    return s, c + bend, c - bend, second * s + gap * s1
