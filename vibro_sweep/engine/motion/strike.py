"""One impact in a cell, or none: eight orbits at once, each in a cell of its own.

What takes a closer look (impacts.py) is left alone: two contacts in a cell, a graze, a mass that turns back within
the cell, chatter and rest.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, alike, bits, put, put_transposed, record, row, select, transposed
from vibro_sweep.engine.tables import flight
from vibro_sweep.engine.tables.flight import ORDER

TAIL = 8  # terms from here on are bounded together
ROUGH = 10  # terms that bring the search so near to the contact that one look with all of them suffices, as a rule
SIXTH = 1.0 / 6.0  # for a product: a division takes as long as all else in a bound
LOOKS = 4  # at the gap, each followed by a step towards the contact

# Eight orbits that may strike; one column each.
STRIKE = record(
    [
        # of the oscillator
        ("series1", float, (6 * ORDER, LANES)),
        ("end", float, (24, LANES)),  # row 4 j + i: X_i at the cell's end, from z_j at its beginning
        ("impulse1", float, (ORDER, LANES)),  # series of x1, and
        ("impulse2", float, (ORDER, LANES)),  # of x2, after a unit impulse on M1
        ("third", float, (TAIL, LANES)),  # weights of |c_n| in a bound on the third derivative over the cell
        ("tail", float, (6, LANES)),  # bound on what the series from TAIL on adds to it, for unit z
        ("width", float, LANES),
        ("zeta", float, LANES),
        ("impulse_third", float, LANES),
        ("left", float, LANES),
        ("right", float, LANES),
        ("R", float, LANES),
        ("z", float, (LANES, LANES)),  # one row for each orbit, at the beginning of its cell: x1, v1, x2, v2, sin, cos
        ("c", float, (ORDER, LANES)),  # Taylor coefficients of x1
        # of the impact
        ("X", float, (LANES, LANES)),  # one row for each orbit: the state at the end of the cell, and four zeros
        ("side", float, LANES),
        ("offset", float, LANES),
        ("speed", float, LANES),  # v1 before it
        ("impulse", float, LANES),  # -(1 + R) v1
        ("jump", float, LANES),  # a+ + R a-, for the saltation matrix
        ("hits", float, (2, LANES)),  # impacts since `clear_counts`, on the left and on the right
        ("slowest", float, LANES),  # least |v1| before one
        ("miss", float, LANES),  # how far from the stop one was found at most, where `measured`
        ("measured", np.bool_),
    ]
)


@jit
def set_oscillator(strikes, i, q, stops):
    """Give lane i its oscillator and its stops."""
    for j in range(6):
        strikes.tail[j, i] = 0.0
        for n in range(ORDER):
            strikes.series1[ORDER * j + n, i] = q.series1[j, n]
            if n >= TAIL:
                strikes.tail[j, i] += q.third[n] * abs(q.series1[j, n])
        strikes.end[4 * j, i], strikes.end[4 * j + 1, i] = flight.evaluate(q.series1[j], q.width)
        strikes.end[4 * j + 2, i], strikes.end[4 * j + 3, i] = flight.evaluate(q.series2[j], q.width)
    for n in range(ORDER):
        strikes.impulse1[n, i], strikes.impulse2[n, i] = q.series1[1, n], q.series2[1, n]
    for n in range(TAIL):
        strikes.third[n, i] = q.third[n]
    strikes.width[i], strikes.zeta[i], strikes.impulse_third[i] = q.width, q.zeta, q.impulse_third
    strikes.left[i], strikes.right[i], strikes.R[i] = stops.left, stops.right, stops.R


@inline
def of_z(rows, n, step, z):
    """A sum of six products: row n of the first of `rows` with x1, that `step` rows on with v1, ..."""
    return (
        (row(rows, n) * z[0] + row(rows, n + step) * z[1])
        + (row(rows, n + 2 * step) * z[2] + row(rows, n + 3 * step) * z[3])
        + (row(rows, n + 4 * step) * z[4] + row(rows, n + 5 * step) * z[5])
    )


@inline
def load_x1(strikes, z, first, last):
    """Taylor coefficients of x1."""
    for n in range(first, last):
        put(strikes.c, n, of_z(strikes.series1, n, ORDER, z))


@inline
def bound_third(strikes, z):
    """A bound on the third derivative of x1 over the cell."""
    c, weight, tail = strikes.c, strikes.third, strikes.tail
    even = row(weight, 4) * abs(row(c, 4)) + row(weight, 6) * abs(row(c, 6))
    odd = row(weight, 3) * abs(row(c, 3)) + row(weight, 5) * abs(row(c, 5)) + row(weight, 7) * abs(row(c, 7))
    return even + odd + of_z(tail, 0, 1, (abs(z[0]), abs(z[1]), abs(z[2]), abs(z[3]), abs(z[4]), abs(z[5])))


@inline
def stays_clear(gap, rate, curve, width):
    """Whether gap + rate d + curve d^2/2 > 0 for all d up to `width`, where gap > 0."""
    falls_short = (rate >= 0.0) | (curve <= 0.0) | (rate + curve * width <= 0.0) | (rate * rate < 2.0 * curve * gap)
    return falls_short & (gap + width * (rate + 0.5 * width * curve) > 0.0)


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
    """Where gap + rate d + curve d^2/2 = 0, or is least; no further than `width`."""
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
        x, v, a, jerk = derivatives(c, u, ORDER)
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


@inline
def position_and_speed(c, u):
    """Polynomial at u, and its derivative; even and odd terms go side by side."""
    v = u * u
    slope_odd, slope_even = row(c, ORDER - 1), row(c, ORDER - 2)
    odd, even = slope_odd * v + row(c, ORDER - 3), slope_even * v + row(c, ORDER - 4)
    for n in range(ORDER - 6, -1, -2):
        slope_odd = slope_odd * v + odd
        odd = odd * v + row(c, n + 1)
        slope_even = slope_even * v + even
        even = even * v + row(c, n)
    return even + u * odd, odd + 2.0 * u * (slope_even + u * slope_odd)


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
def leaves_freely(strikes, v, after, side, rest, third):
    """Whether M1 touches neither stop in the time `rest` after an impact with v, that leaves it with this acceleration.

    third: bound on the third derivative.
    """
    rebound, back, bend = row(strikes.R, 0) * abs(v), side * after, rest * third * SIXTH
    stays_off = rebound > rest * (0.5 * select(back > 0.0, back, 0.0) + bend)
    return stays_off & (
        rest * (rebound + rest * (0.5 * abs(after) + bend)) < row(strikes.right, 0) - row(strikes.left, 0)
    )


@inline
def land(strikes, z, impulse, rest):
    """X at the end of the cell: of the motion as if there were no stop, and what the impulse has done by then."""
    x1, v1 = position_and_speed(strikes.impulse1, rest)
    x2, v2 = position_and_speed(strikes.impulse2, rest)
    x1 = of_z(strikes.end, 0, 4, z) + impulse * x1
    v1 = of_z(strikes.end, 1, 4, z) + impulse * v1
    x2 = of_z(strikes.end, 2, 4, z) + impulse * x2
    v2 = of_z(strikes.end, 3, 4, z) + impulse * v2
    nothing = alike(0.0)
    put_transposed(strikes.X, (x1, v1, x2, v2, nothing, nothing, nothing, nothing))


@inline
def strike(strikes, waiting):
    """Cross a cell. Returns masks of the `waiting`: free flight (the orbit is left alone); one impact and none after.

    Of the impact are left its `side`, `offset`, `speed`, `impulse` and `jump`, and X at the end of the cell.
    """
    z = transposed(strikes.z)
    c, width, v1 = strikes.c, row(strikes.width, 0), z[1]
    put(c, 1, v1)
    load_x1(strikes, z, 2, 3)
    right, left = row(strikes.right, 0) - z[0], z[0] - row(strikes.left, 0)
    side, gap, behind = select(v1 > 0.0, 1.0, -1.0), select(v1 > 0.0, right, left), select(v1 > 0.0, left, right)
    rate, curve = -abs(v1), -2.0 * side * row(c, 2)
    u = nearest_root(gap, rate, curve, width)
    load_x1(strikes, z, 3, ORDER)  # while the processor takes that root
    third = bound_third(strikes, z)
    bend = 2.0 * third * width * SIXTH
    safe = waiting & stays_clear(behind, -rate, -curve - bend, width)
    clear = stays_clear(gap, rate, curve - bend, width)
    free, wanted = safe & clear, safe & ~clear & (rate < 0.0)
    if bits(wanted) == 0:
        return bits(free), 0
    u = approach(c, u, gap, side, width)
    d, v, a, struck = descend(c, u, gap, side, abs(curve) + third * width, width, wanted)
    falls = rate + select(curve > 0.0, curve, 0.0) * d + 0.5 * third * d * d < 0.0  # all the way to the contact
    impulse, rest = -(1.0 + row(strikes.R, 0)) * v, width - d
    after = a - 2.0 * row(strikes.zeta, 0) * impulse
    third += abs(impulse) * row(strikes.impulse_third, 0)
    struck = struck & falls & (side * v > 0.0) & leaves_freely(strikes, v, after, side, rest, third)
    count(strikes, struck, side, v)
    if strikes.measured:
        miss = abs(gap - side * derivatives(c, d, ORDER)[0])
        put(strikes.miss, 0, select(struck & (miss > row(strikes.miss, 0)), miss, row(strikes.miss, 0)))
    put(strikes.side, 0, side)
    put(strikes.offset, 0, d)
    put(strikes.speed, 0, v)
    put(strikes.impulse, 0, impulse)
    put(strikes.jump, 0, after + row(strikes.R, 0) * a)
    land(strikes, z, impulse, rest)
    return bits(free), bits(struck)
