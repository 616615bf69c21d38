"""Flight in contact: Taylor series of delta, w2, ..., of the force, and of tangent vectors; and where the contact ends.

A series reaches as far as rate * time <= 1/2 (tables/flight.py), with the fastest rate in contact. The end is the first
zero of a guard (stop_laws.py); that which delta has at the touch is divided out (motion/first_contact.py), so that
contacts of any shortness keep their digits, and no end is passed.
"""

import numpy as np

from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.motion.distance import delta_of, set_delta
from vibro_sweep.engine.motion.energy_sums import PLACES, WEIGHTS, largest_value
from vibro_sweep.engine.motion.first_contact import first_contact, set_gap, size_at
from vibro_sweep.engine.motion.rest import first_nonzero
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER, bound_third_over, evaluate
from vibro_sweep.engine.tables.products import change_within
from vibro_sweep.engine.tables.series import fill_taylor
from vibro_sweep.engine.tables.twofold import add, multiply

NOTHING = 1e-250  # a contact that has died away, which has no end


@jit
def enter(contact, o, stops, side):
    """Set delta, w2, ... from the orbit's state."""
    X, finer, y, low = o.X, o.finer, contact.y, contact.low
    y[0], low[0] = delta_of(o, stops, side), 0.0
    y[1], low[1] = side * X[1], side * finer[1]
    for j in range(2, len(y)):
        share, share_low = multiply(contact.push[j // 2], 0.0, X[j % 2], finer[j % 2])
        y[j], low[j] = add(X[j], finer[j], -share, -share_low)


@jit
def leave(contact, o, stops, side):
    """Set the orbit's state from delta, w2, ..."""
    X, finer, y, low = o.X, o.finer, contact.y, contact.low
    set_delta(o, stops, side, y[0])
    X[1], finer[1] = side * y[1], side * low[1]
    for j in range(2, len(y)):
        share, share_low = multiply(contact.push[j // 2], 0.0, X[j % 2], finer[j % 2])
        X[j], finer[j] = add(y[j], low[j], share, share_low)


@jit
def dot_slow(contact, o, row):
    """row . (w2, w2', ..., sin, cos, 1), which stand after delta and delta', of products and sums in twice the digits.

    So a of delta'' = -(k0 + k) delta - (c0 + c) delta' + a is formed. In a contact of many series delta follows a,
    whose terms are large where it is small at the end. Constant errors of a shift that end a little, but a rounding of
    its own in each series would be a jump that delta' follows.
    """
    states, a, low = len(contact.y), row[len(contact.y) + 2], 0.0
    for j in range(2, states):
        term, term_low = multiply(row[j], 0.0, contact.y[j], contact.low[j])
        a, low = add(a, low, term, term_low)
    for j in range(2):
        term, term_low = multiply(row[states + j], 0.0, o.phase[j], o.phase_low[j])
        a, low = add(a, low, term, term_low)
    return a


@jit
def load_contact(contact, o, side, omega):
    """Taylor series from y on."""
    G, c, y = contact.equations[lane_of(side)], o.c, contact.y
    for i in range(len(c)):
        c[i, 0], c[i, 1] = y[2 * i], y[2 * i + 1]
    fill_taylor(G, 0, dot_slow(contact, o, G[0]), o.phase[0], o.phase[1], 1.0, omega, c)


@jit
def load_form(contact, c, form):
    """Taylor series of a linear form of (delta, delta', 1)."""
    series = contact.form
    for n in range(ORDER - 1):
        series[n] = form[0] * c[n] + form[1] * ((n + 1.0) * c[n + 1])
    series[0] += form[2]
    series[ORDER - 1] = form[0] * c[ORDER - 1]


@jit
def first_zero(o, c, n, length):
    """The first zero in (0, length] of a polynomial that is positive after a zero of order n at 0."""
    set_gap(o.gap, c, c[0], -1.0, n)
    if size_at(o.gap, length) < NOTHING:
        return np.inf
    if not o.gap[0] > 0.0:
        return 0.0
    return first_contact(o.gap, bound_third_over(o.gap, length), length)


@jit
def end_of_contact(contact, o, side, length):
    """When contact ends within the series, infinite if it does not; NaN where that cannot be decided. Of the guard that
    ends it the place is kept."""
    n_stop, end = lane_of(side), np.inf
    for i in range(contact.guards[n_stop]):
        form = contact.guard[n_stop, i]
        load_form(contact, o.c[0], form)
        order = 0
        if form[1] != 0.0:
            order = first_nonzero(contact.form, 0)
        elif contact.entered:
            order = first_nonzero(contact.form, contact.least)
        d = first_zero(o, contact.form, order, min(end, length))
        if d != d:
            return d
        if d < end:
            end, contact.ended_by = d, i
    return end


@jit
def go_on_in_contact(contact, o, u):
    """y at offset u of the series."""
    y, low = contact.y, contact.low
    for i in range(len(o.c)):
        x, v = change_within(o.c[i], u)
        y[2 * i], low[2 * i] = add(y[2 * i], low[2 * i], x, 0.0)
        y[2 * i + 1], low[2 * i + 1] = add(y[2 * i + 1], low[2 * i + 1], v, 0.0)


@jit
def watch_contact(contact, o, side, u):
    """What is recorded of the contact over the time u of the series."""
    n = lane_of(side)
    load_form(contact, o.c[0], contact.force[n])
    contact.largest = max(contact.largest, largest_value(o.c[0], u))
    contact.strongest = max(contact.strongest, largest_value(contact.form, u))
    contact.work += contact.damping[n] * integral_of_squared_slope(o.c[0], u)


@jit
def stored_energy(contact, n):
    """What the spring of stop n holds, over m_e: k delta^2/2 + p delta."""
    return (0.5 * contact.stiffness[n] * contact.y[0] + contact.preload[n]) * contact.y[0]


@jit
def integral_of_squared_slope(c, u):
    """The integral over [0, u] of the square of the derivative of a polynomial, which has the length of a series."""
    total = 0.0
    for n in range(len(PLACES)):
        _, slope = evaluate(c, PLACES[n] * u)
        total += WEIGHTS[n] * slope * slope
    return total * u


@jit
def second_derivative(c, u):
    """Of a polynomial, which has the length of a series."""
    total = 0.0
    for n in range(ORDER - 1, 1, -1):
        total = total * u + n * (n - 1.0) * c[n]
    return total


@jit
def begin_matrix(contact):
    """The unit matrix."""
    for i in range(len(contact.matrix)):
        for j in range(len(contact.matrix)):
            contact.matrix[i, j] = 1.0 if i == j else 0.0


@jit
def carry_matrix(contact, side, u):
    """Multiply the matrix of the contact by that of the time u. Its vectors are (delta, delta' + c delta, w2, w2', ..).

    In these no jump of size c or k acts at touch and release, and nothing of that size is taken off again.
    """
    n_stop, terms = lane_of(side), contact.terms
    G, d, states = contact.equations[n_stop], contact.damping[n_stop], len(contact.matrix)
    for column in range(states):
        for i in range(states):
            terms[0, i] = contact.matrix[i, column]
        for n in range(1, ORDER + 1):
            # before, after: terms of the series; a tangent vector's delta' is its pi - c delta
            now, then = terms[(n - 1) % 2], terms[n % 2]
            slope = now[1] - d * now[0]
            for i in range(0, states, 2):
                then[i] = slope if i == 0 else now[i + 1]
                rate = G[0, 1] + d if i == 0 else G[i // 2, 1]  # of pi' the damper's own part is taken off
                total = G[i // 2, 0] * now[0] + rate * slope
                for j in range(2, states):
                    total += G[i // 2, j] * now[j]
                then[i + 1] = total
            for i in range(states):
                then[i] *= u / n
                contact.matrix[i, column] += then[i]
