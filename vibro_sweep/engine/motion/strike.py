"""One impact in a cell, or none: eight orbits at once, each in a cell of its own.

What impacts.py resolves event by event is left alone: two contacts in a cell, a graze, a mass that turns back within
the cell, chatter and rest.
"""

import functools
import math

import numpy as np

from vibro_sweep.engine.simd.columns import put_transposed, sizes, transposed, weigh
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, bits, select
from vibro_sweep.engine.simd.memory import put, record, row
from vibro_sweep.engine.tables import flight
from vibro_sweep.engine.tables.economy import FEWER_TERMS, TERMS, TO_FEWER_TERMS, TO_TERMS, economise
from vibro_sweep.engine.tables.flight import evaluate_rows, inputs_of, width_of

TAIL = 8  # terms from here on are bounded together
ROUGH = 10  # terms that bring the search so near to the contact that one look with all of them suffices, as a rule
SIXTH = 1.0 / 6.0  # for a product: a division takes as long as all else in a bound
MARGIN = 2.0**-45  # of x1 and its terms: an extremum this near to a stop is left to a closer look
LOOKS = 4  # at the gap, each followed by a step towards the contact


@functools.cache
def strikes_of(masses: int, constant: bool = False) -> np.dtype:
    """The record of eight orbits that may strike, one column each."""
    states, inputs, width = 2 * masses, inputs_of(masses, constant), width_of(masses, constant)
    fields = [
        # of the oscillator
        ("series", float, (inputs * TERMS, LANES)),  # of x1
        ("end", float, (states * inputs, LANES)),  # row 2 N j + i: X_i at the cell's end, of z_j at its beginning
        ("impulses", float, (masses * FEWER_TERMS, LANES)),  # series of x1, x2, ... after a unit impulse on M1
        ("third", float, (TAIL, LANES)),  # weights of |c_n| in a bound on the third derivative over the cell
        ("tail", float, (inputs, LANES)),  # bound on what the series from TAIL on adds to it, for unit z
        ("width", float, (LANES,)),
        ("drag", float, (LANES,)),  # 2 zeta
        ("impulse_third", float, (LANES,)),
        ("left", float, (LANES,)),
        ("right", float, (LANES,)),
        ("restitution", float, (2, LANES)),  # of the left stop and of the right one
        ("z", float, (LANES, width)),  # one row for each orbit, at the beginning of its cell: x1, v1, ..., sin, cos
        ("c", float, (TERMS, LANES)),  # Taylor coefficients of x1, economised
        # of the impact
        ("landing", float, (states, LANES)),  # the states at the ends of the cells, and
        ("X", float, (LANES, width)),  # the same, one row for each orbit; padded with zeros
        ("side", float, (LANES,)),
        ("R", float, (LANES,)),  # of the stop that was hit
        ("offset", float, (LANES,)),
        ("speed", float, (LANES,)),  # v1 before it
        ("impulse", float, (LANES,)),  # -(1 + R) v1
        ("jump", float, (LANES,)),  # a+ + R a-, for the saltation matrix
        ("hits", float, (2, LANES)),  # impacts since `clear_counts`, on the left and on the right
        ("slowest", float, (LANES,)),  # least |v1| before one
        ("missed", float, (LANES,)),  # how far from the stop a contact was found, and
        ("miss", float, (LANES,)),  # of those of impacts the largest, where `measured`
        ("measured", np.bool_),
    ]
    return record(fields)


@jit
def set_oscillator(strikes, i, q):
    """Give orbit i its oscillator."""
    masses, states = len(q.series), 2 * len(q.series)
    for j in range(len(q.force)):
        economise(TO_TERMS, q, q.series[0, j], strikes.series[:], TERMS * j, i)
        strikes.tail[j, i] = 0.0
        for n in range(TAIL, TERMS):
            strikes.tail[j, i] += q.third[n] * abs(strikes.series[TERMS * j + n, i])
        for m in range(masses):
            x, v = flight.evaluate(q.series[m, j], q.width)
            strikes.end[states * j + 2 * m, i], strikes.end[states * j + 2 * m + 1, i] = x, v
    for m in range(masses):
        economise(TO_FEWER_TERMS, q, q.impulse[m], strikes.impulses[:], FEWER_TERMS * m, i)
    for n in range(TAIL):
        strikes.third[n, i] = q.third[n]
    strikes.width[i], strikes.drag[i], strikes.impulse_third[i] = q.width, -q.drag, q.impulse_third


@jit
def set_stops(strikes, i, stops):
    """Give orbit i its stops."""
    strikes.left[i], strikes.right[i] = stops.left, stops.right
    strikes.restitution[0, i], strikes.restitution[1, i] = stops.R_left, stops.R_right


@inline
def load_x1(strikes, z, first, last):
    """Taylor coefficients of x1."""
    for n in range(first, last):
        put(strikes.c, n, weigh(strikes.series, n, TERMS, z))


@inline
def bound_third(strikes, z):
    """A bound on the third derivative of x1 over the cell."""
    c, weight, tail = strikes.c, strikes.third, strikes.tail
    even = row(weight, 4) * abs(row(c, 4)) + row(weight, 6) * abs(row(c, 6))
    odd = row(weight, 3) * abs(row(c, 3)) + row(weight, 5) * abs(row(c, 5)) + row(weight, 7) * abs(row(c, 7))
    return even + odd + weigh(tail, 0, 1, sizes(z))


@inline
def stays_clear(gap, rate, curve, width):
    """Whether gap + rate d + curve d^2/2 > 0 for all d up to `width`, where gap > 0."""
    falls_short = (rate >= 0.0) | (curve <= 0.0) | (rate + curve * width <= 0.0) | (rate * rate < 2.0 * curve * gap)
    return falls_short & (gap + width * (rate + 0.5 * width * curve) > 0.0)


@inline
def turns_clear(c, x1, gap, rate, curve, side, third, width):
    """Whether x1 turns back within the cell without touching the stop, where its least gap seems to be.

    There gap + rate d + curve d^2/2 - third |d|^3/6 > 0 for all d of the cell.
    """
    u = select(curve > 0.0, -rate / curve, width)
    u = select(u <= width, u, width)
    x, v, a, _ = derivatives(c, u, TERMS)
    least = gap - side * x - MARGIN * (abs(x1) + gap + u * (abs(rate) + abs(curve) * u))
    bend = -2.0 * side * a - third * width * (1.0 / 3.0)
    return (bend > 0.0) & (2.0 * least * bend > v * v)


@inline
def derivatives(c, u, last):
    """x1 - c_0 at u, v, a/2 and a sixth of the jerk, from terms before `last`.

    It is u p(u), which keeps its digits when u is tiny. Four sums hide each other's latency.
    """
    p3 = p2 = p1 = row(c, last - 1)  # the n-th derivative of p over n!
    p = p1 * u + row(c, last - 2)
    p1, p = p1 * u + p, p * u + row(c, last - 3)
    p2, p1, p = p2 * u + p1, p1 * u + p, p * u + row(c, last - 4)
    for n in range(last - 5, 0, -1):
        p3 = p3 * u + p2
        p2 = p2 * u + p1
        p1 = p1 * u + p
        p = p * u + row(c, n)
    return u * p, p + u * p1, p1 + u * p2, p2 + u * p3


@inline
def nearest_root(gap, rate, curve, width):
    """The d at which gap + rate d + curve d^2/2 = 0, or is least; no further than `width`."""
    square = rate * rate - 2.0 * curve * gap
    u = 2.0 * gap / (math.sqrt(select(square > 0.0, square, 0.0)) - rate)
    return select(u <= width, u, width)


@inline
def approach(c, u, gap, side, width):
    """Near the contact, by a step of fourth order."""
    x, v, a, jerk = derivatives(c, u, ROUGH)
    inverse = 1.0 / v
    newton, a, jerk = (side * gap - x) * inverse, a * inverse, jerk * inverse
    after = u + newton * (1.0 - newton * (a - newton * (2.0 * a * a - jerk)))
    return select((side * v > 0.0) & (after > 0.0) & (after <= width), after, u)


@inline
def descend(c, u, gap, side, steepest, width, wanted):
    """The contact d in (0, width], from near it, by Chebyshev's method.

    steepest: bound on the second derivative. Returns d, v and a there, and which of the `wanted` lanes found it.
    """
    d, speed, acceleration = u, u, u
    found = wanted & ~wanted
    for _ in range(LOOKS):
        x, v, a, jerk = derivatives(c, u, TERMS)
        inverse = 1.0 / v
        newton = (side * gap - x) * inverse
        step = newton - a * inverse * newton * newton
        after = u + step
        d = select(wanted, after, d)
        speed = select(wanted, v + step * (2.0 * a + 3.0 * step * jerk), speed)
        acceleration = select(wanted, 2.0 * a + 6.0 * step * jerk, acceleration)
        wanted = wanted & (side * v > 0.0) & (after > 0.0) & (after <= width)
        now = wanted & (newton * newton * steepest * abs(inverse) <= 2.0**-53 * u)  # what Newton's method leaves
        found, wanted = found | now, wanted & ~now
        if bits(wanted) == 0:
            break
        u = d
    return d, speed, acceleration, found


@jit
def clear_counts(strikes):
    """Count impacts from here on."""
    for i in range(LANES):
        strikes.hits[0, i] = strikes.hits[1, i] = strikes.miss[i] = 0.0
        strikes.slowest[i] = np.inf


@inline
def count(strikes, struck, side, v):
    """Count impacts with these speeds."""
    speed, slowest = abs(v), row(strikes.slowest, 0)
    put(strikes.hits, 0, row(strikes.hits, 0) + select(struck & (side < 0.0), 1.0, 0.0))
    put(strikes.hits, 1, row(strikes.hits, 1) + select(struck & (side > 0.0), 1.0, 0.0))
    put(strikes.slowest, 0, select(struck & (speed < slowest), speed, slowest))


@inline
def leaves_freely(strikes, rebound, after, side, rest, third):
    """Whether M1 touches neither stop in the time `rest` after an impact that leaves it with this speed `rebound` and
    this acceleration.

    third: bound on the third derivative.
    """
    back, bend = side * after, rest * third * SIXTH
    stays_off = rebound > rest * (0.5 * select(back > 0.0, back, 0.0) + bend)
    return stays_off & (
        rest * (rebound + rest * (0.5 * abs(after) + bend)) < row(strikes.right, 0) - row(strikes.left, 0)
    )


@inline
def land(strikes, z, impulse, rest):
    """X at the end of the cell: of the motion as if there were no stop, and what the impulse has done by then."""
    landing, states = strikes.landing, len(strikes.landing)
    for m in range(states // 2):
        x, v = evaluate_rows(strikes.impulses, m * FEWER_TERMS, FEWER_TERMS, rest)
        put(landing, 2 * m, weigh(strikes.end, 2 * m, states, z) + impulse * x)
        put(landing, 2 * m + 1, weigh(strikes.end, 2 * m + 1, states, z) + impulse * v)
    put_transposed(strikes.X, landing)


@inline
def gaps_at(strikes, z):
    """The gaps to the right stop and to the left one."""
    return row(strikes.right, 0) - z[0], z[0] - row(strikes.left, 0)


@inline
def find_contact(strikes, z, right, left, waiting):
    """The first contact in the cell, from its beginning z, where the gaps are `right` and `left`.

    Returns masks of the `waiting`: free flight; a contact. Then, of the contact: side, offset, v1, acceleration, and a
    bound on the third derivative over the cell.
    """
    c, width, v1 = strikes.c, row(strikes.width, 0), z[1]
    put(c, 1, v1)
    load_x1(strikes, z, 2, 3)
    side, gap, behind = select(v1 > 0.0, 1.0, -1.0), select(v1 > 0.0, right, left), select(v1 > 0.0, left, right)
    rate, curve = -abs(v1), -2.0 * side * row(c, 2)
    u = nearest_root(gap, rate, curve, width)
    load_x1(strikes, z, 3, TERMS)  # while the processor takes that root
    third = bound_third(strikes, z)
    bend = 2.0 * third * width * SIXTH
    safe = waiting & stays_clear(behind, -rate, -curve - bend, width)
    clear = stays_clear(gap, rate, curve - bend, width)
    free, wanted = safe & clear, safe & ~clear & (rate < 0.0)
    turning = wanted & (rate * rate < 2.0 * curve * gap)
    if bits(turning) != 0:
        turning = turning & turns_clear(c, z[0], gap, rate, curve, side, third, width)
        free, wanted = free | turning, wanted & ~turning
    if bits(wanted) == 0:
        return free, wanted, side, u, u, u, third
    u = approach(c, u, gap, side, width)
    d, v, a, touching = descend(c, u, gap, side, abs(curve) + third * width, width, wanted)
    falls = rate + select(curve > 0.0, curve, 0.0) * d + 0.5 * third * d * d < 0.0  # all the way to the contact
    if strikes.measured:
        miss = abs(gap - side * derivatives(c, d, TERMS)[0])
        put(strikes.missed, 0, miss)
    return free, touching & falls & (side * v > 0.0), side, d, v, a, third


@inline
def rebound(strikes, z, touching, side, d, v, a, third):
    """The impacts of the orbits that are `touching` a rigid stop. Returns those that touch none after it in the cell.

    Of the impact are left its `side`, `offset`, `speed`, `impulse` and `jump`, and X at the end of the cell.
    """
    R = select(side > 0.0, row(strikes.restitution, 1), row(strikes.restitution, 0))
    impulse, rest = -(1.0 + R) * v, row(strikes.width, 0) - d
    after = a - row(strikes.drag, 0) * impulse
    third += abs(impulse) * row(strikes.impulse_third, 0)
    struck = touching & leaves_freely(strikes, R * abs(v), after, side, rest, third)
    count(strikes, struck, side, v)
    if strikes.measured:
        miss = row(strikes.missed, 0)
        put(strikes.miss, 0, select(struck & (miss > row(strikes.miss, 0)), miss, row(strikes.miss, 0)))
    put(strikes.side, 0, side)
    put(strikes.R, 0, R)
    put(strikes.offset, 0, d)
    put(strikes.speed, 0, v)
    put(strikes.impulse, 0, impulse)
    put(strikes.jump, 0, after + R * a)
    land(strikes, z, impulse, rest)
    return struck


@inline
def strike(strikes, waiting):
    """Cross a cell. Returns, of the `waiting`, those that fly freely, which are left alone, and that strike once."""
    z = transposed(strikes.z, strikes.tail)
    right, left = gaps_at(strikes, z)
    free, touching, side, d, v, a, third = find_contact(strikes, z, right, left, waiting)
    if bits(touching) == 0:
        return bits(free), 0
    return bits(free), bits(rebound(strikes, z, touching, side, d, v, a, third))
