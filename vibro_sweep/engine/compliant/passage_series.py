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
            for j in range(1, masses):
                total = total + (
                    row(G, first + 2 * j) * row(x, j * TERMS + n) + row(G, first + 2 * j + 1) * row(v, j * TERMS + n)
                )
            if m == 0:
                put(passage.drive, n, total)
            total = total + (row(G, first + 1) * row(v, n) + row(G, first) * row(x, n))
            put(v, m * TERMS + n + 1, total * INVERSE[n])
        for m in range(masses):
            put(x, m * TERMS + n + 1, row(v, m * TERMS + n) * INVERSE[n])
        sin, cos = omega * cos * INVERSE[n], -omega * sin * INVERSE[n]


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
def derivatives_at(c, first, count, u):
    """The series of `count` terms that begin in row `first`, at u, its derivative, and half its second one.

    Even and odd terms go side by side.
    """
    square, last = u * u, first + count - 1
    odd, even = row(c, last), row(c, last - 1)
    odd_slope = even_slope = odd_curve = even_curve = 0.0 * u
    for n in range(last - 2, first, -2):
        odd_curve, even_curve = odd_curve * square + odd_slope, even_curve * square + even_slope
        odd_slope, even_slope = odd_slope * square + odd, even_slope * square + even
        odd, even = odd * square + row(c, n), even * square + row(c, n - 1)
    slope = odd + 2.0 * (u * even_slope + square * odd_slope)
    curve = even_slope + 3.0 * (u * odd_slope) + 4.0 * square * (even_curve + u * odd_curve)
    return even + u * odd, slope, curve


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
            total = row(G, first + 1) * speed + row(G, first) * row(x, n)
            if m == 0:
                total = total + damping * speed
            for j in range(1, masses):
                total = total + (
                    row(G, first + 2 * j) * row(x, j * TERMS + n) + row(G, first + 2 * j + 1) * row(v, j * TERMS + n)
                )
            put(v, m * TERMS + n + 1, total * INVERSE[n])
        put(x, n + 1, speed * INVERSE[n])
        for m in range(1, masses):
            put(x, m * TERMS + n + 1, row(v, m * TERMS + n) * INVERSE[n])
    for m in range(masses):
        put(passage.vector, 2 * m, select(going, at(x, m * TERMS, TERMS, u), row(passage.vector, 2 * m)))
        put(passage.vector, 2 * m + 1, select(going, at(v, m * TERMS, TERMS, u), row(passage.vector, 2 * m + 1)))
