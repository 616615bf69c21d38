"""Taylor series of a contact, for eight orbits at once: of delta, w2, ... and of tangent vectors."""

import math

import numpy as np

from vibro_sweep.engine.compliant.passage_tables import TERMS
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import select
from vibro_sweep.engine.simd.memory import put, row

INVERSE = 1.0 / np.arange(1.0, TERMS + 2.0)  # of n + 1
SIN = tuple((-1.0) ** n / math.factorial(2 * n + 1) for n in range(1, 12))  # from the third power of the angle on
COS = tuple((-1.0) ** n / math.factorial(2 * n) for n in range(1, 12))  # from the second on
MARGIN = 1.0 + 1e-9  # of bounds that rounding may have moved


@inline
def of_stop(rows, right):
    """The numbers of the stop that is touched."""
    return select(right, row(rows, 1), row(rows, 0))


@inline
def turn(angle):
    """sin and cos of angles below pi/2 in size, by their series."""
    square = angle * angle
    fourth, last = square * square, len(SIN) - 1
    sin, sin_odd = SIN[last] + 0.0 * angle, SIN[last - 1] + 0.0 * angle
    cos, cos_odd = COS[last] + 0.0 * angle, COS[last - 1] + 0.0 * angle
    for n in range(last - 2, 0, -2):
        sin, cos = sin * fourth + SIN[n], cos * fourth + COS[n]
        sin_odd, cos_odd = sin_odd * fourth + SIN[n - 1], cos_odd * fourth + COS[n - 1]
    sin, cos = sin * fourth + SIN[0], cos * fourth + COS[0]
    return angle + (angle * square) * (sin + square * sin_odd), 1.0 + square * (cos + square * cos_odd)


@inline
def choose_equations(passage, right):
    """Take the equations of the stop that is touched."""
    count = len(passage.row)
    for j in range(count):
        put(passage.row, j, select(right, row(passage.equations, count + j), row(passage.equations, j)))


@inline
def acceleration_of(passage, sin, cos):
    """a: what drives delta, in the state y, at the phase (sin, cos) of the force."""
    states, G, y = len(passage.y), passage.row, passage.y
    total = row(G, states) * sin + row(G, states + 1) * cos + row(G, states + 2)
    for j in range(2, states):
        total = total + row(G, j) * row(y, j)
    return total


@inline
def add_pull(total, G, first, x, v, size, begin, end, n):
    """Add what the coordinates from `begin` to `end` do, by the n-th terms of their series of `size` terms and the row
    of equations that begins at `first`."""
    for j in range(begin, end):
        place, speed, term = row(G, first + 2 * j), row(G, first + 2 * j + 1), j * size + n
        total = total + (place * row(x, term) + speed * row(v, term))
    return total


@jit
def load_passage(passage, sin, cos):
    """Taylor series from y on, at the phase (sin, cos) of the force: of the motion, and of a."""
    masses, states, G, x, v = len(passage.push), len(passage.y), passage.row, passage.x, passage.v
    omega = row(passage.omega, 0)
    for m in range(masses):
        put(x, m * TERMS, row(passage.y, 2 * m))
        put(v, m * TERMS, row(passage.y, 2 * m + 1))
    for n in range(TERMS - 1):
        for m in range(masses):
            first = m * (states + 3)
            total = row(G, first + states) * sin + row(G, first + states + 1) * cos
            if n == 0:
                total = total + row(G, first + states + 2)
            total = add_pull(total, G, first, x, v, TERMS, 1, masses, n)
            if m == 0:
                put(passage.drive, n, total)
            total = total + (row(G, first + 1) * row(v, n) + row(G, first) * row(x, n))
            put(v, m * TERMS + n + 1, total * INVERSE[n])
        for m in range(masses):
            put(x, m * TERMS + n + 1, row(v, m * TERMS + n) * INVERSE[n])
        sin, cos = omega * cos * INVERSE[n], -omega * sin * INVERSE[n]


@inline
def from_contact(passage, y, to, side, wall):
    """The coordinates and velocities x1, v1, ... from delta, delta', w2, ..."""
    put(to, 0, wall + side * row(y, 0))
    put(to, 1, side * row(y, 1))
    for m in range(1, len(passage.push)):
        put(to, 2 * m, row(y, 2 * m) + row(passage.push, m) * row(to, 0))
        put(to, 2 * m + 1, row(y, 2 * m + 1) + row(passage.push, m) * row(to, 1))


@inline
def at(c, first, count, u):
    """The series of `count` terms that begin in row `first`, at u. Even and odd terms go side by side."""
    square, last = u * u, first + count - 1
    odd, even = row(c, last), row(c, last - 1)
    for n in range(last - 2, first, -2):
        odd = odd * square + row(c, n)
        even = even * square + row(c, n - 1)
    return even + u * odd


@inline
def expanded_at(c, first, count, u):
    """Taylor coefficients at u, up to the fourth power, of the series of `count` terms that begin in row `first`.

    Even and odd terms go side by side: their sums are functions of u^2, of which the n-th derivative over n! is taken.
    """
    square, last = u * u, first + count - 1
    odd, even = row(c, last), row(c, last - 1)
    odd1 = even1 = odd2 = even2 = odd3 = even3 = odd4 = even4 = 0.0 * u
    for n in range(last - 2, first, -2):
        odd4, even4 = odd4 * square + odd3, even4 * square + even3
        odd3, even3 = odd3 * square + odd2, even3 * square + even2
        odd2, even2 = odd2 * square + odd1, even2 * square + even1
        odd1, even1 = odd1 * square + odd, even1 * square + even
        odd, even = odd * square + row(c, n), even * square + row(c, n - 1)
    return (
        even + u * odd,
        odd + 2.0 * (u * even1 + square * odd1),
        even1 + 3.0 * (u * odd1) + 4.0 * square * (even2 + u * odd2),
        odd1 + 4.0 * (u * even2) + 8.0 * square * (odd2 + u * even3 + square * odd3),
        even2 + 5.0 * (u * odd2) + square * (12.0 * even3 + 20.0 * (u * odd3) + 16.0 * square * (even4 + u * odd4)),
    )


@inline
def load_sum(to, of, count, k, c, p, who):
    """The series of k f + c f' + p from that of f, for lanes that are not `who` of f itself; its last term is k f."""
    last = count - 1
    for n in range(last):
        put(to, n, select(who, k * row(of, n) + c * ((n + 1.0) * row(of, n + 1)), row(of, n)))
    put(to, last, select(who, k * row(of, last), row(of, last)))
    put(to, 0, row(to, 0) + select(who, p, 0.0))


@inline
def changes_of(c, last, u):
    """By how much a series up to the `last` power changes at most within u, and its derivative."""
    size, slope = abs(row(c, last)), float(last) * abs(row(c, last))
    for n in range(last - 1, 0, -1):
        size = size * u + abs(row(c, n))
        if n > 1:
            slope = slope * u + float(n) * abs(row(c, n))
    return size * u * MARGIN, slope * u * MARGIN


@jit
def carry_vector(passage, damping, u, going):
    """Carry the tangent `vector`, (delta, delta' + c delta, w2, w2', ...), on by the time u in contact.

    In these coordinates no jump of size c or k acts at touch and release (tangent_in_contact.py).
    """
    masses, states, G, x, v = len(passage.push), len(passage.y), passage.row, passage.x, passage.v
    for m in range(masses):
        put(x, m * TERMS, row(passage.vector, 2 * m))
        put(v, m * TERMS, row(passage.vector, 2 * m + 1))
    for n in range(TERMS - 1):
        speed = row(v, n) - damping * row(x, n)  # delta'
        for m in range(masses):
            first = m * (states + 3)
            rate = row(G, 1) + damping if m == 0 else row(G, first + 1)  # of pi' the damper's own part is taken off
            total = add_pull(rate * speed + row(G, first) * row(x, n), G, first, x, v, TERMS, 1, masses, n)
            put(v, m * TERMS + n + 1, total * INVERSE[n])
        put(x, n + 1, speed * INVERSE[n])
        for m in range(1, masses):
            put(x, m * TERMS + n + 1, row(v, m * TERMS + n) * INVERSE[n])
    for m in range(masses):
        put(passage.vector, 2 * m, select(going, at(x, m * TERMS, TERMS, u), row(passage.vector, 2 * m)))
        put(passage.vector, 2 * m + 1, select(going, at(v, m * TERMS, TERMS, u), row(passage.vector, 2 * m + 1)))
