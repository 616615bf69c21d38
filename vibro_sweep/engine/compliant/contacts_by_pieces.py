"""Eight contacts at once, by their tables (contact_pieces.py): when they end, in what state, and the largest in them.

The root of the guard is sought in the piece at whose end it is below zero for the first time. It is the first root for
certain where the guard's control points up to that piece are positive, and where its Taylor polynomial about the root,
with a bound on what that leaves out, is positive within the piece. Other contacts are left alone.
"""

import math

from vibro_sweep.engine.compliant.contact_pieces import (
    FORCE,
    FORCE_SLOPE,
    GUARD,
    PIECES,
    PLACE,
    POINTS,
    SLOPE,
    TERMS,
    WIDER,
)
from vibro_sweep.engine.compliant.contact_rows import of_stop
from vibro_sweep.engine.motion.strike import derivatives
from vibro_sweep.engine.simd.columns import rows_of, sizes, weigh
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import bits, lowest, number, select
from vibro_sweep.engine.simd.memory import put, row

LOOKS = 5  # at a root, each followed by a step of fourth order
CLOSE = 2.0**-54  # fourth power of a step, of the length of a piece, whose error is rounding
REMAINDER = 1.0 / 20.0  # of the fourth derivative: 1/24, and what the last step changed of the third
ROUGH = 7  # terms of a first look at a peak
PEAK_LOOKS = 8
NEAR_PEAK = 1e-3  # of the length of a piece: a step whose error in the largest value is rounding


@inline
def tables_of(passage, right):
    """Which orbits take the tables of the right stop, and with which sign w2, ..., sin and cos enter them."""
    mirrored = row(passage.mirrored, 0) > 0.0
    return right | mirrored, select(mirrored & ~right, -1.0, 1.0)


@inline
def next_group(waiting, block, piece):
    """The orbits that are `waiting` in the same piece of the same tables as the first of them, these tables, and the
    piece."""
    first = lowest(bits(waiting))
    n, p = bits(block) >> first & 1, int(number(piece, first))
    return waiting & (piece >= float(p)) & (piece <= float(p)) & (block if n == 1 else ~block), n, p


@inline
def first_below(passage, kind, who, block, z):
    """The first piece at whose end a number of the contact is not positive, PIECES where there is none; and the number
    at both ends of that piece, 0 at the touch."""
    piece, begins, ends, inputs = 0.0 * z[0], 0.0 * z[0], 0.0 * z[0], len(z)
    for n in range(2):
        those = who & (block if n == 1 else ~block)
        for p in range(PIECES):
            if bits(those) == 0:
                break
            value = weigh(passage.ends, ((kind * 2 + n) * PIECES + p) * inputs, 1, z)
            ends = select(those, value, ends)
            those = those & (value > 0.0)
            begins = select(those, value, begins)
            piece = select(those, p + 1.0, piece)
    return piece, begins, ends


@inline
def load_course(passage, z, n, p):
    """The polynomial of delta in piece p; in piece 0 that of delta/u."""
    first = (n * PIECES + p) * (len(z) + 1) * TERMS
    for e in range(TERMS):
        put(passage.now, e, weigh(passage.course, first + e, TERMS, z))
    put(passage.now, TERMS, 0.0)


@inline
def load_delta(passage, z, n, p):
    """The polynomial of delta in any piece."""
    load_course(passage, z, n, p)
    if p == 0:
        times_u(passage.now)


@noinline
def times_u(c):
    """From the polynomial of delta/u that of delta."""
    for e in range(TERMS, 0, -1):
        put(c, e, row(c, e - 1))
    put(c, 0, 0.0)


@inline
def load_force(passage, k, c, preload):
    """The polynomial of F/m_e from that of delta."""
    for e in range(TERMS):
        force = k * row(passage.now, e) + (e + 1.0) * (c * row(passage.now, e + 1))
        put(passage.end, e, force + preload if e == 0 else force)


@inline
def value_and_slope(c, first, u):
    """Of the polynomial of TERMS terms that begins in row `first`. Even and odd terms go side by side."""
    v, last = u * u, first + TERMS - 1
    slope_odd, slope_even = row(c, last), row(c, last - 1)
    odd, even = slope_odd * v + row(c, last - 2), slope_even * v + row(c, last - 3)
    for n in range(last - 5, first - 1, -2):
        slope_odd = slope_odd * v + odd
        odd = odd * v + row(c, n + 1)
        slope_even = slope_even * v + even
        even = even * v + row(c, n)
    return even + u * odd, odd + 2.0 * u * (slope_even + u * slope_odd)


@inline
def delta_at(c, v):
    """delta and delta' at v, from all terms of `load_delta`."""
    x, slope = row(c, TERMS), 0.0 * v
    for e in range(TERMS - 1, -1, -1):
        slope = slope * v + x
        x = x * v + row(c, e)
    return x, slope


@noinline
def keep_others(passage, z, n, p, to, who, u, v, sign):
    """w2, w2', ... of these orbits at u, which is v after the node."""
    size, other = len(z) + 1, passage.other
    for m in range(1, len(passage.push)):
        first = ((n * PIECES + p) * (len(passage.push) - 1) + m - 1) * size * TERMS
        for e in range(TERMS):
            put(other, e, weigh(passage.others, first + e, TERMS, z))
        x, slope = value_and_slope(other, 0, v)
        w, rate = z[2 * m - 1], z[2 * m]
        put(to, 2 * m, select(who, sign * (w + (rate * u + x)), row(to, 2 * m)))
        put(to, 2 * m + 1, select(who, sign * (rate + slope), row(to, 2 * m + 1)))


@noinline
def pass_by_pieces(passage, ready, right, speed, sin, cos, to_section):
    """Pass the contacts of the orbits that are `ready`.

    Returns those that are passed, with their state in `passage.y`; which of them are over a section by then, with the
    state there in `passage.section`; and the time in contact.
    """
    touch, states, time = passage.touch, len(passage.y), 0.0 * speed
    block, sign = tables_of(passage, right)
    put(touch, 0, speed)
    for j in range(2, states):
        put(touch, j - 1, sign * row(passage.y, j))
    put(touch, states - 1, sign * sin)
    put(touch, states, sign * cos)
    put(touch, states + 1, 1.0)
    z = rows_of(touch)
    piece, _, _ = first_below(passage, GUARD, ready, block, z)
    put(passage.piece, 0, piece)
    waiting, passed = ready & (piece < float(PIECES)), ready & ~ready
    while bits(waiting) != 0:
        who, n, p = next_group(waiting, block, piece)
        waiting = waiting & ~who
        ended, u = end_in_piece(passage, z, n, p, who, sign)
        passed, time = passed | ended, select(ended, u, time)
    crossing = passed & (to_section <= time)
    if bits(crossing) != 0:
        keep_section(passage, z, crossing, block, sign, to_section)
    if passage.watched:
        keep_peaks(passage, z, passed, right, block, time)
    return passed, crossing, time


@noinline
def end_in_piece(passage, z, n, p, who, sign):
    """The end in piece p of contacts with the tables of stop n. Returns who ends there for certain, and when; the state
    there is in `passage.y`."""
    preload = row(passage.preload, n)
    by_force, h, end = who & (row(passage.by_force, n) > 0.0), row(passage.length, n), passage.now
    forced = bits(by_force) != 0
    load_course(passage, z, n, p)
    if forced:
        load_guard(passage, n, p, by_force)
        end = passage.end
    most, least = (0.5 * WIDER) * h, 0.0 * h if p == 0 else (-0.5 * WIDER) * h
    f, slope, half_curve_there = row(end, 0), row(end, 1), row(end, 2)
    square = slope * slope - 4.0 * f * half_curve_there
    v = 2.0 * f / (math.sqrt(select(square > 0.0, square, 0.0)) - slope)
    v = select(v <= most, select(v >= least, v, least), most)
    wanted, found, sixth_there = who, who & ~who, 0.0 * v
    for _ in range(LOOKS):
        g, slope, half_curve, sixth = derivatives(end, v, TERMS)
        inverse = 1.0 / slope
        newton, bent, more = -(g + f) * inverse, half_curve * inverse, sixth * inverse
        after = v + newton * (1.0 - newton * (bent - newton * (2.0 * bent * bent - more)))
        wanted = wanted & (slope < 0.0) & (after >= least) & (after <= most)
        step = after - v
        v, sixth_there = select(wanted, after, v), select(wanted, sixth, sixth_there)
        half_curve_there = select(wanted, half_curve + 3.0 * step * sixth, half_curve_there)
        left = newton * (abs(bent) + 1.0 / h)
        left = left * left
        now = wanted & (left * left <= CLOSE)
        found, wanted = found | now, wanted & ~now
        if bits(wanted) == 0:
            break
    u, length = v + p * h, v if p == 0 else v + 0.5 * h
    _, slope = value_and_slope(end, 0, v)
    certain = is_positive_within(end, slope, half_curve_there, sixth_there, length, most)
    passed = found & certain & (u > 0.0)
    if p > 0:
        passed = passed & (by_force | is_positive_before(passage, PLACE, n, p, z, passed & ~by_force))
        if forced:
            passed = passed & (~by_force | is_positive_before(passage, FORCE, n, p, z, passed & by_force))
    place, speed = 0.0 * v, slope * u if p == 0 else slope
    if forced:
        there, rate = delta_at(passage.now, v)
        place, speed = select(by_force, there, place), select(by_force, rate, speed)
    preloaded = passed & by_force & (preload > 0.0)
    if bits(preloaded) != 0:  # the mass may not leave the stop before the force is zero
        _, slope, half_curve, sixth = derivatives(passage.now, v, TERMS)
        inside = is_positive_within(passage.now, slope, half_curve, sixth, length, most) & (place > 0.0)
        if p > 0:
            inside = inside & is_positive_before(passage, PLACE, n, p, z, preloaded)
        passed = passed & (~preloaded | inside)
    put(passage.y, 0, select(passed, place, row(passage.y, 0)))
    put(passage.y, 1, select(passed, speed, row(passage.y, 1)))
    keep_others(passage, z, n, p, passage.y, passed, u, v, sign)
    return passed, u


@noinline
def load_guard(passage, n, p, by_force):
    """The polynomial of the guard: of the force, in place of delta, for orbits that leave the stop `by_force`."""
    shift = 1 if p == 0 else 0
    if p == 0:
        times_u(passage.now)
    load_force(passage, row(passage.stiffness, n), row(passage.damping, n), row(passage.preload, n))
    for e in range(TERMS):
        put(passage.end, e, select(by_force, row(passage.end, e), row(passage.now, e + shift)))


@inline
def is_positive_within(c, slope, half_curve, sixth, length, most):
    """Whether a polynomial is positive, for certain, all over the `length` before its root at v, where it is where that
    begins; or above its value at v, which is positive. The derivatives are those at v.

    c(v - w)/w = -slope + half_curve w - sixth w^2 +- fourth w^3/24; or it bends down all the way.
    """
    fourth = 0.0 * slope
    for e in range(TERMS - 1, 3, -1):
        fourth = fourth * most + (e * (e - 1.0) * (e - 2.0) * (e - 3.0)) * abs(row(c, e))
    fall = select(half_curve < 0.0, half_curve, 0.0) - select(sixth > 0.0, sixth, 0.0) * length
    rising = -slope + length * (fall - fourth * length * length * REMAINDER) > 0.0
    return rising | (2.0 * half_curve + length * (6.0 * abs(sixth) + fourth * length) < 0.0)


@inline
def is_positive_before(passage, kind, n, p, z, wanted):
    """Which are positive for certain from the touch to the beginning of piece p: mostly one sum says so."""
    at = ((kind * 2 + n) * PIECES + p) * len(z)
    positive = weigh(passage.least, at, 1, sizes(z)) > 0.0
    if bits(wanted & ~positive) == 0:
        return positive
    first, step = at * (POINTS + 1), POINTS + 1
    least = weigh(passage.before, first, step, z)
    for q in range(1, POINTS):
        point = weigh(passage.before, first + q, step, z)
        least = select(point < least, point, least)
    return positive | (least > weigh(passage.before, first + POINTS, step, sizes(z)))


@noinline
def keep_section(passage, z, who, block, sign, time):
    """The state at a section that is passed in contact."""
    last, h, section = row(passage.piece, 0), of_stop(passage.length, block), passage.section
    piece = math.floor(time / h + 0.5)
    piece = select(piece < last, piece, last)
    while bits(who) != 0:
        now, n, p = next_group(who, block, piece)
        who = who & ~now
        load_delta(passage, z, n, p)
        v = time - p * h
        x, slope = delta_at(passage.now, v)
        put(section, 0, select(now, x, row(section, 0)))
        put(section, 1, select(now, slope, row(section, 1)))
        keep_others(passage, z, n, p, section, now, time, v, sign)


@noinline
def keep_peaks(passage, z, passed, right, block, time):
    """Keep the largest delta and F/m_e of the contacts that are `passed`: where their slopes fall below zero."""
    k, c, preload = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    damped, largest, strongest = passed & (c > 0.0), 0.0 * time, c * z[0] + preload
    piece, at = place_of_peak(passage, SLOPE, passed, block, z)
    for_force, at_force = piece, at
    if bits(damped) != 0:
        for_force, at_force = place_of_peak(passage, FORCE_SLOPE, damped, block, z)
    elsewhere, waiting = damped & ((for_force < piece) | (for_force > piece)), passed
    while bits(waiting) != 0:
        who, n, p = next_group(waiting, block, piece)
        waiting, with_it = waiting & ~who, who & damped & ~elsewhere
        load_delta(passage, z, n, p)
        low, high, h = within_piece(passage, n, p, time)
        largest = select(who, peak(passage.now, who, at * h, low, high, NEAR_PEAK * h), largest)
        if bits(with_it) != 0:
            strongest = stronger(passage, with_it, n, p, at_force, time, strongest)
    while bits(elsewhere) != 0:
        who, n, p = next_group(elsewhere, block, for_force)
        elsewhere = elsewhere & ~who
        load_delta(passage, z, n, p)
        strongest = stronger(passage, who, n, p, at_force, time, strongest)
    put(passage.largest, 0, select(passed, largest, row(passage.largest, 0)))
    strongest = select(damped, strongest, k * largest + preload)
    put(passage.strongest, 0, select(passed, strongest, row(passage.strongest, 0)))


@inline
def place_of_peak(passage, kind, who, block, z):
    """The piece in which a slope falls below zero, which is not after the end; and about where in it, over its length:
    a sine has that zero."""
    piece, begins, ends = first_below(passage, kind, who, block, z)
    last, share = row(passage.piece, 0), (begins + ends) / (begins - ends)
    share = select((piece <= last) & (piece > 0.0), share, 0.0)
    return select(piece < last, piece, last), (2.0 / math.pi) * share * (1.0 - share * share * (1.0 / 3.0))


@inline
def within_piece(passage, n, p, time):
    """Where in piece p a peak may be, in a contact of so long a `time`; and the length of a piece."""
    h = row(passage.length, n)
    low, high = 0.0 * h if p == 0 else -0.5 * h, time - p * h
    return low, select(high < 0.5 * h, high, 0.5 * h), h


@inline
def stronger(passage, who, n, p, at, time, strongest):
    """The largest F/m_e of these orbits in the piece that is loaded, or what is larger."""
    load_force(passage, row(passage.stiffness, n), row(passage.damping, n), row(passage.preload, n))
    low, high, h = within_piece(passage, n, p, time)
    found = peak(passage.end, who, at * h, low, high, NEAR_PEAK * h)
    return select(who & (found > strongest), found, strongest)


@noinline
def peak(c, wanted, v, low, high, near):
    """The largest value of a polynomial between `low` and `high`, where its slope falls through zero, near v."""
    v = select((v >= low) & (v <= high), v, 0.5 * (low + high))
    _, slope, half_curve, sixth = derivatives(c, v, ROUGH)  # mostly one look brings it near enough
    after = v + peak_step(slope, half_curve, sixth)
    v = select((half_curve < 0.0) & (after >= low) & (after <= high), after, v)
    largest = row(c, 0)
    for _ in range(PEAK_LOOKS):
        x, slope, half_curve, sixth = derivatives(c, v, TERMS)
        low, high = select(slope > 0.0, v, low), select(slope > 0.0, high, v)
        step = peak_step(slope, half_curve, sixth)
        after = v + step
        inside = (half_curve < 0.0) & (after >= low) & (after <= high)
        change = select(inside, step * (slope + step * (half_curve + step * sixth)), 0.0)
        largest = select(wanted, row(c, 0) + (x + change), largest)
        wanted = wanted & ~(inside & (abs(step) <= near))
        if bits(wanted) == 0:
            break
        v = select(inside, after, 0.5 * (low + high))
    return largest


@inline
def peak_step(slope, half_curve, sixth):
    """To where the slope is zero, by a step of third order."""
    newton = -0.5 * slope / half_curve
    return newton * (1.0 - 1.5 * (newton / half_curve) * sixth)
