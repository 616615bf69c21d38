"""Integrals of squares, peaks, and the energy of impacts: added up from the pieces of one orbit's motion.

A piece is a polynomial: the motion is analytic within it, and a series resolves every rate, so that eight nodes of
Gauss and Legendre give the integral of a square to rounding. `sums` is None where nobody asks for them, and nothing of
this is compiled then.
"""

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.memory import record
from vibro_sweep.engine.tables.flight import ORDER, evaluate

_x, _w = np.polynomial.legendre.leggauss(8)
PLACES, WEIGHTS = (_x + 1) / 2, _w / 2  # on 0 .. 1
STEPS = 60  # of Newton's method, or halvings, towards an extreme
NEAR = 1e-9  # of the length of a piece: its square is below rounding


def sums_of(masses: int) -> np.dtype:
    """The record of what is added up for one orbit."""
    states = 2 * masses
    fields = [
        ("back", float, (masses, masses)),  # from contact coordinates to the positions of the masses, and
        ("origin", float, (masses,)),
        ("loss", float),  # of the squares of speeds, over two, at impacts
        ("squares", float, (states,)),  # integrals over time, of x1, v1, x2, ...
        ("peaks", float, (states,)),
        ("course", float, (masses, ORDER)),  # of a piece: the contact coordinates,
        ("place", float, (ORDER,)),  # one position, and
        ("speed", float, (ORDER,)),  # its velocity
    ]
    return record(fields)


@inline
def are_wanted(sums):
    """Whether all pieces of the motion are: cells are not skipped then."""
    if sums is not None:
        return True
    return False


@inline
def add_flight(sums, o, u):
    """Add the flight, or the rest, of which the orbit's series are, over the time u."""
    if sums is not None:
        copy_flight(sums[0], o)
        add_piece(sums[0], u)


@jit
def copy_flight(s, o):
    for m in range(len(o.c)):
        for n in range(ORDER):
            s.course[m, n] = o.c[m, n]
    if o.resting != 0.0:  # there the first series is of the acceleration
        for n in range(ORDER):
            s.course[0, n] = 0.0
        s.course[0, 0] = o.X[0]


@inline
def add_contact(sums, o, push, wall, side, u):
    """Add the contact of which the orbit's series of delta, w2, ... are, over the time u."""
    if sums is not None:
        copy_contact(sums[0], o, push, wall, side)
        add_piece(sums[0], u)


@jit
def copy_contact(s, o, push, wall, side):
    for n in range(ORDER):
        s.course[0, n] = side * o.c[0, n] + (wall if n == 0 else 0.0)
        for m in range(1, len(s.course)):
            s.course[m, n] = o.c[m, n] + push[m] * s.course[0, n]


@inline
def add_impact(sums, R, speed):
    """Add the energy that an impact takes, of a unit mass."""
    if sums is not None:
        sums[0].loss += 0.5 * (1.0 - R) * (1.0 + R) * speed * speed


@jit
def add_piece(s, u):
    """Add the squares of all masses' positions and velocities over the time u, and raise their peaks."""
    masses, place, speed = len(s.course), s.place, s.speed
    for i in range(masses):
        for n in range(ORDER):
            place[n] = s.origin[i] if n == 0 else 0.0
            for m in range(masses):
                place[n] += s.back[i, m] * s.course[m, n]
        speed[ORDER - 1] = 0.0
        for n in range(1, ORDER):
            speed[n - 1] = n * place[n]
        s.squares[2 * i] += integral_of_square(place, u)
        s.squares[2 * i + 1] += integral_of_square(speed, u)
        s.peaks[2 * i] = max(s.peaks[2 * i], largest_size(place, u))
        s.peaks[2 * i + 1] = max(s.peaks[2 * i + 1], largest_size(speed, u))


@jit
def integral_of_square(c, u):
    """The integral over [0, u] of the square of a polynomial."""
    total = 0.0
    for n in range(len(PLACES)):
        x, _ = evaluate(c, PLACES[n] * u)
        total += WEIGHTS[n] * x * x
    return total * u


@jit
def largest_size(c, u):
    """The largest modulus of a polynomial on [0, u] that turns back there once, or not."""
    most = max(abs(c[0]), abs(evaluate(c, u)[0]))
    return max(most, abs(evaluate(c, turning_point(c, u))[0]))


@jit
def largest_value(c, u):
    """Its largest value."""
    most = max(c[0], evaluate(c, u)[0])
    return max(most, evaluate(c, turning_point(c, u))[0])


@jit
def turning_point(c, u):
    """Where the slope of a polynomial is zero in [0, u], 0 where it has one sign at both ends."""
    begins, ends = c[1], evaluate(c, u)[1]
    if not begins * ends < 0.0:
        return 0.0
    low, high, at = 0.0, u, u * begins / (begins - ends)
    for _ in range(STEPS):
        slope, curve = 0.0, 0.0
        for n in range(ORDER - 1, 0, -1):
            curve = curve * at + slope
            slope = slope * at + n * c[n]
        if slope * begins > 0.0:
            low = at
        else:
            high = at
        newton = at - slope / curve if curve != 0.0 else low
        after = newton if low < newton < high else 0.5 * (low + high)
        if abs(after - at) <= NEAR * u:
            break
        at = after
    return at
