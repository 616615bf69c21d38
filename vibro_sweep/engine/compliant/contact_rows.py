"""Coordinates of contacts, for eight orbits at once."""

import math

from vibro_sweep.engine.simd.jit import inline
from vibro_sweep.engine.simd.lanes import select
from vibro_sweep.engine.simd.memory import put, row

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
def turn_far(angle):
    """The same of angles up to eight."""
    s, c = turn(0.125 * angle)
    for _ in range(3):
        s, c = 2.0 * (s * c), 1.0 - 2.0 * (s * s)
    return s, c


@inline
def from_contact(passage, y, to, side, wall):
    """The coordinates and velocities x1, v1, ... from delta, delta', w2, ..."""
    put(to, 0, wall + side * row(y, 0))
    put(to, 1, side * row(y, 1))
    for m in range(1, len(passage.push)):
        put(to, 2 * m, row(y, 2 * m) + row(passage.push, m) * row(to, 0))
        put(to, 2 * m + 1, row(y, 2 * m + 1) + row(passage.push, m) * row(to, 1))
