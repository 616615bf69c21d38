"""A flight as if there were no stops: where x1 reaches the position of one first, and between which bounds it turns.

The flight is followed from series to series, with the states at the nodes from the closed form as in the event loop.
A turning point is a root of v1. On an interval of radius r about u, Taylor's theorem bounds

    |v1(u + d) - v1(u)| <= |a(u)| r + j r^2/2,        |a(u + d) - a(u)| <= j r,        |d| <= r

with j a bound on the third derivative of x1. An interval where v1 cannot vanish has no turning point, one where a
cannot has at most one, and others are halved. What is left undecided at `FINEST` of a series has v1 and a so near to
zero that its ends differ by less than rounding: it counts as a maximum and as a minimum.
"""

import math

import numpy as np

from vibro_sweep.engine.motion.first_contact import ROUNDING, first_contact, set_gap
from vibro_sweep.engine.motion.orbits import (
    advance,
    advance_exactly,
    begin_free_flight,
    is_finite,
    round_off,
    set_state,
    wall_of,
)
from vibro_sweep.engine.motion.rest import first_nonzero
from vibro_sweep.engine.motion.scan import state_at
from vibro_sweep.engine.simd.jit import exported, jit
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables.flight import ORDER, bounds, load
from vibro_sweep.tables import outcomes as status

FINEST = 2.0**-24
HALVINGS = 64  # of an interval with one turning point
CHAIN = 16.0 * 2.0**-52  # rounding of x1 after a period of flight, in sizes of its terms


@jit
def load_series(f, o):
    """Taylor series from where the flight is. Returns how far they reach, and whether that ends the cell."""
    q, X, left = f.oscillator[0], o.X, f.oscillator[0].width - o.offset
    last = left <= 1.001 * q.step
    z, states = f.nodes[o.cell].z, 2 * len(o.c)
    sin, cos = z[states], z[states + 1]
    if o.offset > 0.0:
        swing, turn = math.sin(q.omega * o.offset), math.cos(q.omega * o.offset)
        sin, cos = sin * turn + cos * swing, cos * turn - sin * swing
    load(q.series, row(X, 0), sin, cos, o.c)
    return left if last else q.step, last


@jit
def go_on(f, o, length, last, from_node):
    """Go on to the end of the series. from_node: the flight since node `base` is the closed form. Returns it for the
    next."""
    q = f.oscillator[0]
    if q.exact:
        advance_exactly(o, length)
    else:
        advance(o, length)
    o.offset += length
    if not last:
        return from_node
    o.offset = 0.0
    o.cell += 1
    if from_node:
        put(o.X, 0, state_at(o, f.nodes, o.cell))
        round_off(o)
    if o.cell == q.cells:
        o.cell = 0
        o.period += 1
        from_node = False
    if not from_node:
        begin_free_flight(o, f.nodes, row(o.X, 0))
    return True


@jit
def size_here(f, o, from_node, length):
    """The sum of the sizes of the terms of x1, of the closed form up to here and of the series."""
    series, power = 0.0, 1.0
    for n in range(ORDER):
        series += abs(o.c[0, n]) * power
        power *= length
    if not from_node:
        return series
    closed, E = abs(f.nodes[o.cell].z[0]), f.nodes[o.cell - o.base].E
    for j in range(2 * len(o.c)):
        closed += abs(E[j, 0] * o.y[j])
    return max(series, closed)


@jit
def start(f, o, stops, k, s, X):
    """Begin a flight at offset s of cell k. Returns whether that is a node."""
    set_state(o, f.nodes, stops, k, s, X)
    return s == 0.0


# --- first contact


@jit
def crossing(q, o, stops, side, sign, n, left):
    """Offset at which x1 reaches the stop on `side`; infinite if not in this series up to `left`.

    sign: 1 where M1 is inside of it, -1 beyond. n: order of the zero of the gap at the beginning, if it begins there.
    """
    gap = sign * side * (wall_of(stops, side) - o.X[0])
    if n == 0 and gap <= 0.0:  # rounding: it was reached at the end of the last series
        return 0.0
    set_gap(o.gap, o.c[0], gap, sign * side, n)
    return first_contact(o.gap, bounds(q, o.gap[:])[1], left)


@jit
def sign_of_gap(o, side, wall):
    """1 where the flight begins inside of a stop, -1 beyond; and the order of the gap's zero if it begins there."""
    gap = side * (wall - o.X[0])
    if gap != 0.0:
        return math.copysign(1.0, gap), 0
    n = first_nonzero(o.c[0], 1)
    return math.copysign(1.0, -side * o.c[0, n]), n


@exported
def find_contacts(f, o, stops, cells, offsets, states, durations, found, sides, statuses):
    """Find for each flight the time until x1 first is at a stop again, infinite if later than its duration, and the
    side."""
    q = f.oscillator[0]
    for i in range(len(states)):
        from_node = start(f, o, stops, cells[i], offsets[i], states[i])
        found[i], sides[i], statuses[i] = np.inf, 0, status.OK
        right, left_sign, n_right, n_left, begins = 1.0, 1.0, 0, 0, True
        while found[i] == np.inf and statuses[i] == status.OK:
            flown = ((o.period * q.cells + o.cell) - cells[i]) * q.width + (o.offset - offsets[i])
            rest = durations[i] - flown
            if not rest > 0.0:
                break
            length, last = load_series(f, o)
            if begins:
                right, n_right = sign_of_gap(o, 1.0, stops.right)
                left_sign, n_left = sign_of_gap(o, -1.0, stops.left)
                begins = False
            d, e = np.inf, np.inf
            if stops.right < np.inf:
                d = crossing(q, o, stops, 1.0, right, n_right, min(length, rest))
            if stops.left > -np.inf:
                e = crossing(q, o, stops, -1.0, left_sign, n_left, min(length, rest))
            n_right = n_left = 0
            if d != d or e != e:
                found[i], statuses[i] = np.nan, status.UNRESOLVED
            elif min(d, e) < np.inf:
                found[i], sides[i] = flown + min(d, e), 1 if d <= e else -1
            elif not is_finite(o):
                found[i], statuses[i] = np.nan, status.NOT_FINITE
            else:
                from_node = go_on(f, o, length, last, from_node)


# --- extremes


@jit
def motion_at(c, u):
    """x1, v1 and a of the series c at u, and the rounding of v1 and of a."""
    x, v, a, v_size, a_size = c[ORDER - 1], 0.0, 0.0, 0.0, 0.0
    for n in range(ORDER - 2, -1, -1):
        a = a * u + v
        v = v * u + x
        x = x * u + c[n]
    for n in range(ORDER - 1, 0, -1):
        v_size = v_size * u + n * abs(c[n])
    for n in range(ORDER - 1, 1, -1):
        a_size = a_size * u + n * (n - 1.0) * abs(c[n])
    return x, v, 2.0 * a, ROUNDING * v_size, ROUNDING * a_size


@jit
def root_between(c, low, high, falling):
    """The root of v1, monotone between."""
    for _ in range(HALVINGS):
        u = 0.5 * (low + high)
        if (motion_at(c, u)[1] > 0.0) == falling:
            low = u
        else:
            high = u
    return 0.5 * (low + high)


@jit
def keep(out, x, width, at, is_maximum):
    """Widen the bounds out[0:2] on the highest turning point, out[2] at; or out[3:5], out[5] on the lowest."""
    if is_maximum:
        if x > out[0]:
            out[2] = at
        out[0], out[1] = max(out[0], x - width), max(out[1], x + width)
    else:
        if x < out[4]:
            out[5] = at
        out[3], out[4] = min(out[3], x - width), min(out[4], x + width)


@jit
def find_turns(c, length, third, flown, ends, out):
    """Keep the turning points of a series in (0, length], or before `length` where the flight `ends` there.

    A v1 of the size of its rounding at the end may have the other sign in the next series: it counts as a root.
    """
    u, r = 0.0, 0.5 * length
    while u < length:
        r = min(r, 0.5 * (length - u))
        x, v, a, v_rounding, a_rounding = motion_at(c, u + r)
        if abs(v) > abs(a) * r + 0.5 * third * r * r + v_rounding:
            u, r = u + 2.0 * r, 2.0 * r
        elif abs(a) > third * r + a_rounding:
            before, after = motion_at(c, u)[1], motion_at(c, u + 2.0 * r)[1]
            at_end = u + 2.0 * r >= length and not ends and abs(after) <= 8.0 * v_rounding
            if before * after < 0.0 or (after == 0.0 and u + 2.0 * r < length) or at_end:
                there = u + 2.0 * r if at_end else root_between(c, u, u + 2.0 * r, a < 0.0)
                keep(out, motion_at(c, there)[0], 0.0, flown + there, a < 0.0)
            u, r = u + 2.0 * r, 2.0 * r
        elif r <= FINEST * length:
            width = (abs(v) + v_rounding) * r + 0.5 * (abs(a) + a_rounding) * r * r + third * r * r * r / 6.0
            keep(out, x, width, flown + u + r, True)
            keep(out, x, width, flown + u + r, False)
            u, r = u + 2.0 * r, 2.0 * r
        else:
            r *= 0.5


@exported
def find_extremes(f, o, stops, cells, offsets, states, durations, out):
    """out (n, 6): bounds on x1 at the highest turning point of each flight and its time, and at the lowest."""
    q = f.oscillator[0]
    for i in range(len(states)):
        from_node = start(f, o, stops, cells[i], offsets[i], states[i])
        row, size = out[i], 0.0
        row[0], row[1], row[2], row[3], row[4], row[5] = -np.inf, -np.inf, np.nan, np.inf, np.inf, np.nan
        while True:
            flown = ((o.period * q.cells + o.cell) - cells[i]) * q.width + (o.offset - offsets[i])
            rest = durations[i] - flown
            if not (rest > 0.0 and math.isfinite(o.X[0] + o.X[1])):
                break
            length, last = load_series(f, o)
            size = max(size, size_here(f, o, from_node, length))
            find_turns(o.c[0], min(length, rest), bounds(q, o.c[0])[1], flown, rest <= length, row)
            from_node = go_on(f, o, length, last, from_node)
        stop_distance = CHAIN * (o.period + 1.0) * size
        row[0], row[1] = row[0] - stop_distance, row[1] + stop_distance
        row[3], row[4] = row[3] - stop_distance, row[4] + stop_distance
