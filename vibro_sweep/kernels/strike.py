"""One impact in a cell, or none: eight orbits at once, each in a cell of its own.

What takes a closer look (impacts.py) is left alone: two contacts in a cell, a graze, a mass that turns back within
the cell, chatter and rest.
"""

import math

import numpy as np

from vibro_sweep.kernels.flight import ORDER
from vibro_sweep.kernels.jit import jit
from vibro_sweep.kernels.lanes import LANES, bits, put, put_transposed, record, row, select, transposed

TAIL = 8  # terms from here on are bounded together
LOOKS = 4  # at the gap, each followed by a step towards the contact
# In a row of `hit`, after what the impact adds to X at the end of the cell (4 numbers): its side, its offset in the
# cell, v1 before it, and -(1 + R) v1.
SIDE, OFFSET, SPEED, IMPULSE = 4, 5, 6, 7

# Eight orbits that may strike; one column each.
STRIKE = record(
    [
        # of the oscillator
        ("series1", float, (6 * ORDER, LANES)),
        ("impulse1", float, (ORDER, LANES)),  # series of x1, and
        ("impulse2", float, (ORDER, LANES)),  # of x2, after a unit impulse on M1
        ("tail", float, (6, LANES)),  # bound on what the series from TAIL on adds to the third derivative, for unit z
        ("width", float, LANES),
        ("zeta", float, LANES),
        ("impulse_third", float, LANES),
        ("left", float, LANES),
        ("right", float, LANES),
        ("R", float, LANES),
        ("z", float, (LANES, LANES)),  # one row for each orbit, at the beginning of its cell: x1, v1, x2, v2, sin, cos
        ("c", float, (ORDER, LANES)),  # Taylor coefficients of x1
        ("hit", float, (LANES, LANES)),  # one row for each orbit: its impact
        ("hits", float, (2, LANES)),  # impacts since `start_count`, on the left and on the right
        ("slowest", float, LANES),  # least |v1| before one
        ("miss", float, LANES),  # how far from the stop one was found at most, where `measured`
        ("steepness", float, LANES),  # (a+ + R a-)/v, for the saltation matrix
        ("measured", np.bool_),
    ]
)


@jit
def deal(t, i, q, stops):
    """Give lane i its oscillator and its stops."""
    for j in range(6):
        t.tail[j, i] = 0.0
        for n in range(ORDER):
            t.series1[ORDER * j + n, i] = q.series1[j, n]
            if n >= TAIL:
                t.tail[j, i] += q.third[n] * abs(q.series1[j, n])
    for n in range(ORDER):
        t.impulse1[n, i], t.impulse2[n, i] = q.series1[1, n], q.series2[1, n]
    t.width[i], t.zeta[i], t.impulse_third[i] = q.width, q.zeta, q.impulse_third
    t.left[i], t.right[i], t.R[i] = stops.left, stops.right, stops.R


@jit
def load(t, z, width):
    """Taylor coefficients of x1; how far x1 can move over the cell, and a bound on its third derivative."""
    s, c = t.series1, t.c
    x1, v1, x2, v2, sin, cos = z[0], z[1], z[2], z[3], z[4], z[5]
    for n in range(ORDER):
        put(
            c,
            n,
            (row(s, n) * x1 + row(s, ORDER + n) * v1)
            + (row(s, 2 * ORDER + n) * x2 + row(s, 3 * ORDER + n) * v2)
            + (row(s, 4 * ORDER + n) * sin + row(s, 5 * ORDER + n) * cos),
        )
    third = 0.0 * x1
    for n in range(TAIL - 1, 2, -1):
        third = third * width + n * (n - 1.0) * (n - 2.0) * abs(row(c, n))
    tail = t.tail
    third += row(tail, 0) * abs(x1) + row(tail, 1) * abs(v1) + row(tail, 2) * abs(x2) + row(tail, 3) * abs(v2)
    third += row(tail, 4) * abs(sin) + row(tail, 5) * abs(cos)
    return width * (abs(row(c, 1)) + width * (abs(row(c, 2)) + width * third / 6.0)), third


@jit
def parabola_root(gap, rate, curve):
    """First d > 0 with gap + rate d + curve d^2/2 = 0, for gap > 0; infinite where there is none."""
    square = rate * rate - 2.0 * curve * gap
    root = math.sqrt(select(square < 0.0, 0.0, square))
    d = select(rate < 0.0, 2.0 * gap / (root - rate), select(curve < 0.0, (rate + root) / -curve, np.inf))
    return select(square < 0.0, np.inf, d)


@jit
def derivatives(c, u):
    """x1 - c_0 at u, and its derivatives v, a and the jerk. It is u p(u), which keeps its digits when u is tiny."""
    p = row(c, ORDER - 1)
    p1, p2, p3 = 0.0 * u, 0.0 * u, 0.0 * u  # the n-th derivative of p over n!: four sums that hide each other's latency
    for n in range(ORDER - 2, 0, -1):
        p3 = p3 * u + p2
        p2 = p2 * u + p1
        p1 = p1 * u + p
        p = p * u + row(c, n)
    return u * p, p + u * p1, 2.0 * (p1 + u * p2), 6.0 * (p2 + u * p3)


@jit
def descend(c, gap, side, third, first, width, wanted):
    """The contact d in (0, width] by Chebyshev's method, where the gap g falls from 0 to there without fail.

    first: the earliest at which it can be. Returns d, v and a there, and which of the `wanted` lanes found it.
    """
    rate, curve, jerk = -side * row(c, 1), -2.0 * side * row(c, 2), -6.0 * side * row(c, 3)
    slope = rate + first * (curve + 0.5 * first * jerk)
    u = first - (gap + first * (rate + first * (0.5 * curve + first * jerk / 6.0))) / slope
    u = select((slope < 0.0) & (u > 0.0), u, first)
    u = select(u <= width, u, width)
    steepest = abs(curve) + third * width  # bound on the second derivative of g
    d, speed, acceleration = u, u, u
    found = wanted & ~wanted
    for _ in range(LOOKS):
        x, v, a, jerk = derivatives(c, u)
        inverse = 1.0 / v
        newton = (side * gap - x) * inverse
        step = newton - 0.5 * a * inverse * newton * newton
        after = u + step
        wanted = wanted & (side * v > 0.0) & (after > 0.0) & (after <= width)
        now = wanted & (newton * newton * steepest * abs(inverse) <= 2.0**-53 * u)  # what Newton's method leaves
        d = select(now, after, d)
        speed = select(now, v + step * (a + 0.5 * step * jerk), speed)
        acceleration = select(now, a + step * jerk, acceleration)
        found, wanted = found | now, wanted & ~now
        if bits(wanted) == 0:
            break
        u = select(wanted, after, u)
    falls = rate + select(curve > 0.0, curve, 0.0) * d + 0.5 * third * d * d < 0.0
    return d, speed, acceleration, found & falls


@jit
def evaluate(c, u):
    """Polynomial at u, and its derivative; even and odd terms go side by side."""
    v = u * u
    odd, even = row(c, ORDER - 1), row(c, ORDER - 2)
    slope_odd, slope_even = 0.0 * u, 0.0 * u
    for n in range(ORDER - 4, -1, -2):
        slope_odd = slope_odd * v + odd
        odd = odd * v + row(c, n + 1)
        slope_even = slope_even * v + even
        even = even * v + row(c, n)
    return even + u * odd, odd + 2.0 * u * (slope_even + u * slope_odd)


@jit
def start_count(t):
    """Count impacts from here on."""
    for i in range(LANES):
        t.hits[0, i] = t.hits[1, i] = t.miss[i] = 0.0
        t.slowest[i] = np.inf


@jit
def count(t, struck, side, v):
    """Count impacts with these speeds."""
    speed, slowest = abs(v), row(t.slowest, 0)
    put(t.hits, 0, row(t.hits, 0) + select(struck & (side < 0.0), 1.0, 0.0))
    put(t.hits, 1, row(t.hits, 1) + select(struck & (side > 0.0), 1.0, 0.0))
    put(t.slowest, 0, select(struck & (speed < slowest), speed, slowest))


@jit
def strike(t, waiting):
    """Cross a cell. Returns masks of the `waiting`: free flight (the orbit is left alone); one impact and none after.

    The motion goes on as if there were no stop, and what the impulse -(1 + R) v1 does is added at the cell's end.
    """
    z = transposed(t.z)
    c, width, x1, R = t.c, row(t.width, 0), z[0], row(t.R, 0)
    reach, third = load(t, z, width)
    right, left = row(t.right, 0) - x1, x1 - row(t.left, 0)
    near_right, near_left = right <= reach, left <= reach
    side, gap = select(near_right, 1.0, -1.0), select(near_right, right, left)
    rate, curve = -side * row(c, 1), -2.0 * side * row(c, 2)
    first = parabola_root(gap, rate, curve - third * width / 3.0)
    free = ~(near_right | near_left) | (~(near_right & near_left) & (first >= width))
    free = free & waiting
    if bits(waiting & ~free) == 0:
        return bits(free), 0
    d, v, a, struck = descend(
        c, gap, side, third, first, width, waiting & ~free & (rate < 0.0) & ~(near_right & near_left)
    )
    rest, impulse = width - d, -(1.0 + R) * v
    after = a - 2.0 * row(t.zeta, 0) * impulse
    third += abs(impulse) * row(t.impulse_third, 0)
    rebound, back = R * abs(v), side * after
    stays_off = rebound > 0.5 * rest * (select(back > 0.0, back, 0.0) + rest * third / 3.0)
    stays_short = rest * (rebound + 0.5 * rest * (abs(after) + rest * third / 3.0)) < row(t.right, 0) - row(t.left, 0)
    struck = struck & (side * v > 0.0) & stays_off & stays_short
    count(t, struck, side, v)
    if t.measured:
        miss = abs(gap - side * derivatives(c, d)[0])
        put(t.miss, 0, select(struck & (miss > row(t.miss, 0)), miss, row(t.miss, 0)))
    put(t.steepness, 0, (after + R * a) / v)
    pushed1, pushed2 = evaluate(t.impulse1, rest), evaluate(t.impulse2, rest)
    push = impulse * pushed1[0], impulse * pushed1[1], impulse * pushed2[0], impulse * pushed2[1]
    put_transposed(t.hit, (*push, side, d, v, impulse))
    return bits(free), bits(struck)
