"""Tables of contacts in pieces, for eight orbits at once.

In contact z' = A z, with z = (delta, delta', w2, w2', ..., sin, cos, 1) of law.py. The time u since the touch is cut
into pieces about the nodes p h, p = 0, 1, ..., where h is a quarter turn of the fastest rate in contact. In each of
them delta, and what w2, ... do beside w + w' u, are polynomials in u - p h, linear in z at the touch, where delta is 0:

    z(p h + v) = e^{A v} e^{A p h} z(0)

In piece 0, which begins at the touch, it is delta/u, so that the touch is no zero of it. The guard of a contact is what
is positive as long as it lasts: delta, or F/m_e where the stop is left when the force is zero. Control points bound it
from the touch to the beginning of a piece, and its values at the ends of pieces say in which one it falls below zero.
"""

import math

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

from vibro_sweep.engine.compliant.stop_laws import is_shared
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.tables.series import clear, derive

PIECES = 5
FULL = 24  # terms of a series, from which those of a piece are economised:
TERMS = 16
WIDER = 1.1  # than a piece: where its polynomials serve
POINTS = 8  # control points of a guard
GUARD, SLOPE, FORCE_SLOPE = range(3)  # of what there are values at the ends of pieces; slopes of delta and of F/m_e
PLACE, FORCE = range(2)  # of what there are control points: delta/u and F/m_e
ROUNDING = 1e-14  # of a control point


def reduced(terms: int, domain: list) -> np.ndarray:
    """Powers below FULL as polynomials of so many terms, near to them on `domain`, (FULL, terms)."""
    powers = np.eye(FULL)
    for n in range(FULL - 1, terms - 1, -1):
        basis = Chebyshev.basis(n, domain).convert(kind=Polynomial).coef
        powers[:, : n + 1] -= np.outer(powers[:, n], basis / basis[n])
    return powers[:, :terms].copy()


def control_points() -> tuple[np.ndarray, np.ndarray]:
    """Control points on [0, 1] of powers below FULL, (POINTS, FULL), and bounds on what they leave out, (FULL,)."""
    few, s = reduced(POINTS, [0, 1]), np.linspace(0, 1, 4001)[:, None]
    bernstein = np.array([[math.comb(j, k) / math.comb(POINTS - 1, k) for k in range(POINTS)] for j in range(POINTS)])
    left = np.abs(s ** np.arange(FULL) - s ** np.arange(POINTS) @ few.T).max(0) * 1.01
    left[:POINTS] = 0.0
    return (bernstein @ few.T).copy(), left


ECONOMY = reduced(TERMS, [-1, 1])
CONTROL, LEFT_OUT = control_points()


def piece_fields(masses: int) -> list:
    """The fields of `passages_of` for them. Tables have a row for each input, that is each entry of z but delta, which
    is 0 at the touch; those of polynomials one more, of a unit delta, for tangent vectors."""
    size, inputs = 2 * masses + 3, 2 * masses + 2
    return [
        ("length", float, (2, LANES)),  # h
        ("pull", float, (2 * 2 * masses, LANES)),  # delta'', w2'', ... by delta and by delta'
        ("mirrored", float, (LANES,)),  # 1: contacts with the left stop take the tables of the right one
        ("course", float, (2 * PIECES * size * TERMS, LANES)),  # of delta; in piece 0 of delta/u, but for a unit delta
        ("others", float, (2 * PIECES * (masses - 1) * size * TERMS, LANES)),  # of w2, ... beside w + w' u
        ("ends", float, (3 * 2 * PIECES * inputs, LANES)),  # at the end of each piece
        ("before", float, (2 * 2 * PIECES * inputs * (POINTS + 1), LANES)),  # control points, and what they leave out
        # for one sum that bounds all of them: of a unit delta' the least one, of others minus the largest size
        ("least", float, (2 * 2 * PIECES * inputs, LANES)),
        # of the contact
        ("touch", float, (inputs, LANES)),  # z but delta
        ("piece", float, (LANES,)),  # where it ends
        ("now", float, (TERMS + 1, LANES)),  # the polynomial of delta in a piece, and
        ("end", float, (TERMS + 1, LANES)),  # of the guard, or of what is sought
        ("other", float, (TERMS, LANES)),  # of one of w2, ...
        ("flight", float, ((2 * masses) ** 2, LANES)),  # of (delta, delta', w2, ..) from the touch to the release
        # of one orbit, while tables are made
        ("A", float, (size, size)),
        ("unit", float, (size,)),
        ("expansion", float, (masses, size, FULL)),
        ("few", float, (masses + 1, TERMS, size)),  # of delta, w2, ..., and of delta/u
        ("powers", float, (FULL,)),
        ("flights", float, (3, size, size)),  # E - 1 of a piece, up to a node, and scratch
    ]


@jit
def is_mirrored(contact):
    """Whether the left stop does to (delta, -w2, ...) what the right one does to (delta, w2, ...)."""
    G, states = contact.equations, len(contact.y)
    same = contact.compliant[0] == contact.compliant[1] and contact.preload[0] == contact.preload[1]
    same = same and contact.stiffness[0] == contact.stiffness[1] and contact.damping[0] == contact.damping[1]
    for m in range(len(contact.push)):
        for j in range(states + 3):
            odd = (m == 0) != (j < 2 or j == states + 2)
            same = same and G[0, m, j] == (-G[1, m, j] if odd else G[1, m, j])
    return same


@jit
def set_pieces(passage, i, contact, rates, omega):
    """The tables of orbit i. rates (2,): the fastest in contact with each stop."""
    for n in range(2):
        passage.length[n, i] = 0.5 * math.pi / rates[n]
    same = is_mirrored(contact) and rates[0] == rates[1]
    passage.mirrored[i] = 1.0 if same else 0.0
    for n in range(1 if same else 0, 2):
        if contact.compliant[n] != 0:
            fill_pieces(passage, n, i, contact, omega)
            if not is_shared(contact, n):
                leave_alone(passage, n, i)


@jit
def leave_alone(passage, n, i):
    """The guard never falls below zero: no contact with stop n of orbit i is passed here."""
    count = PIECES * len(passage.touch)
    for row in range((2 * GUARD + n) * count, (2 * GUARD + n + 1) * count):
        passage.ends[row, i] = 0.0


@jit
def fill_pieces(passage, n, i, contact, omega):
    """The tables of contacts with stop n of orbit i."""
    masses, states, h = len(contact.push), len(contact.y), passage.length[n, i]
    size, A = states + 3, passage.A
    for m in range(masses):
        for j in range(2):
            passage.pull[2 * (n * masses + m) + j, i] = contact.equations[n, m, j]
    D, E, joined = passage.flights[0], passage.flights[1], passage.flights[2]
    clear(A), clear(E)
    for m in range(masses):
        A[2 * m, 2 * m + 1] = 1.0
        for j in range(size):
            A[2 * m + 1, j] = contact.equations[n, m, j]
    A[states, states + 1], A[states + 1, states] = omega, -omega
    for m in range(masses):
        for j in range(size):
            passage.unit[j] = 1.0 if j == 2 * m else 0.0
        derive(A, passage.unit, size, passage.expansion[m])
    fill_change(D, passage.expansion, h, omega)
    fill_few(passage.few, passage.expansion, passage.powers, 0.5 * WIDER * h)
    for p in range(PIECES):
        fill_course(passage, n, p, i, E)
        fill_ends(passage, n, p, i)
        if p > 0:
            fill_before(passage, PLACE, n, p, i)
        if p > 0 and passage.by_force[n, i] > 0.0:
            fill_before(passage, FORCE, n, p, i)
        for a in range(size):
            for j in range(size):
                total = E[a, j] + D[a, j]
                for e in range(size):
                    total += D[a, e] * E[e, j]
                joined[a, j] = total
        for a in range(size):
            for j in range(size):
                E[a, j] = joined[a, j]


@jit
def fill_change(D, series, u, omega):
    """E - 1 of a flight over the time u in contact."""
    masses, size, last = len(series), len(D), series.shape[2] - 1
    clear(D)
    for m in range(masses):
        for j in range(size):
            c, x, v = series[m, j], series[m, j, last], 0.0
            for k in range(last - 1, 1, -1):
                v = v * u + x
                x = x * u + c[k]
            D[2 * m, j] = (x * u + c[1]) * u
            D[2 * m + 1, j] = (v * u + 2.0 * x) * u + (c[1] if j != 2 * m + 1 else 0.0)
    swing = math.sin(0.5 * omega * u)
    D[size - 3, size - 3] = D[size - 2, size - 2] = -2.0 * swing * swing
    D[size - 3, size - 2], D[size - 2, size - 3] = math.sin(omega * u), -math.sin(omega * u)


@jit
def fill_few(few, series, powers, reach):
    """The series in TERMS terms that serve within `reach`: of delta, w2, ... without their first two terms, and last of
    delta/u."""
    masses, size = len(series), series.shape[1]
    for m in range(masses + 1):
        clear(few[m])
    powers[0] = 1.0
    for k in range(1, FULL):
        powers[k] = powers[k - 1] * reach
    for k in range(FULL):
        for e in range(k if k < TERMS else k % 2, min(k + 1, TERMS), 2):
            weight = ECONOMY[k, e] * powers[k - e]
            for j in range(size):
                for m in range(masses if k > 1 else 0):
                    few[m, e, j] += weight * series[m, j, k]
                if k < FULL - 1:
                    few[masses, e, j] += weight * series[0, j, k + 1]


@jit
def fill_course(passage, n, p, i, E):
    """The polynomials of piece p. E: the flight to its node, less 1."""
    few, masses, size, at = passage.few, len(passage.expansion), len(E), n * PIECES + p
    for c in range(size):
        j = c + 1 if c + 1 < size else 0
        if p == 0 and j > 0:
            for e in range(TERMS):
                passage.course[(at * size + c) * TERMS + e, i] = few[masses, e, j]
        else:
            put_polynomial(passage.course, (at * size + c) * TERMS, i, few[0], E, 0, j)
            if j < 2:
                passage.course[(at * size + c) * TERMS + j, i] += 1.0
        for m in range(1, masses):
            first = ((at * (masses - 1) + m - 1) * size + c) * TERMS
            put_polynomial(passage.others, first, i, few[m], E, m, j)
            if j == 2 * m + 1:
                passage.others[first, i] -= p * passage.length[n, i]


@jit
def put_polynomial(table, first, i, few, E, m, j):
    """That of mass m as a function of input j; of a unit j itself nothing."""
    for e in range(TERMS):
        total = few[e, j]
        for a in range(len(E)):
            total += few[e, a] * E[a, j]
        table[first + e, i] = total + E[2 * m + e, j] if e < 2 else total


@jit
def fill_ends(passage, n, p, i):
    """The guard and slopes at the end of piece p."""
    inputs, course, v = len(passage.touch), passage.course, 0.5 * passage.length[n, i]
    k, c, by_force = passage.stiffness[n, i], passage.damping[n, i], passage.by_force[n, i] > 0.0
    for j in range(inputs):
        first = ((n * PIECES + p) * (inputs + 1) + j) * TERMS
        x, slope, curve = 0.0, 0.0, 0.0
        for e in range(TERMS - 1, -1, -1):
            curve = curve * v + 2.0 * slope
            slope = slope * v + x
            x = x * v + course[first + e, i]
        if p == 0:
            x, slope, curve = v * x, x + v * slope, 2.0 * slope + v * curve
        row = (n * PIECES + p) * inputs + j
        step = 2 * PIECES * inputs
        guard = x
        if by_force:
            guard = k * x + c * slope + (passage.preload[n, i] if j == inputs - 1 else 0.0)
        passage.ends[GUARD * step + row, i], passage.ends[SLOPE * step + row, i] = guard, slope
        passage.ends[FORCE_SLOPE * step + row, i] = k * slope + c * curve


@jit
def fill_before(passage, kind, n, p, i):
    """Control points of delta/u, or of F/m_e, from the touch to the beginning of piece p."""
    k, c, b = passage.stiffness[n, i], passage.damping[n, i], (p - 0.5) * passage.length[n, i]
    points, series, inputs = passage.before, passage.expansion, len(passage.touch)
    for j in range(inputs):
        at = ((kind * 2 + n) * PIECES + p) * inputs + j
        first, power, left, last = at * (POINTS + 1), 1.0, 0.0, 0.0
        for q in range(POINTS):
            points[first + q, i] = 0.0
        for t in range(FULL - 1):
            g = series[0, j + 1, t + 1]
            if kind == FORCE:
                g = k * series[0, j + 1, t] + c * (t + 1.0) * g
                if t == 0 and j == inputs - 1:
                    g += passage.preload[n, i]
            g *= power
            power *= b
            for q in range(POINTS):
                points[first + q, i] += CONTROL[q, t] * g
            left += LEFT_OUT[t] * abs(g)
            if t > FULL - 4:
                last += 2.0 * abs(g)  # the terms after those of the series fall by more than a half
        least, largest = np.inf, 0.0
        for q in range(POINTS):
            least, largest = min(least, points[first + q, i]), max(largest, abs(points[first + q, i]))
        left += last + ROUNDING * largest
        points[first + POINTS, i] = left
        passage.least[at, i] = least - left if j == 0 else -(largest + left)
