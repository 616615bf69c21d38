"""Eight contacts at once, by their tables (contact_pieces.py): when they end, and in what state.

The root of the guard is sought in the piece at whose end it is below zero for the first time. It is the first root for
certain where the guard's control points up to that piece are positive, and where its Taylor polynomial about the root,
with a bound on what that leaves out, is positive within the piece. Other contacts are left alone.
"""

import math

from vibro_sweep.engine.compliant.contact_pieces import (
    FORCE,
    GUARD,
    PIECES,
    PLACE,
    POINTS,
    TERMS,
    WIDER,
)
from vibro_sweep.engine.compliant.contact_rows import of_stop
from vibro_sweep.engine.compliant.peaks import keep_peaks
from vibro_sweep.engine.compliant.piece_series import (
    delta_at,
    first_below,
    keep_others,
    load_course,
    load_delta,
    load_force,
    next_group,
    tables_of,
    times_u,
)
from vibro_sweep.engine.motion.strike import derivatives
from vibro_sweep.engine.simd.columns import rows_of, sizes, weigh
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables.flight import evaluate_rows

LOOKS = 5  # at a root, each followed by a step of fourth order
CLOSE = 2.0**-54  # fourth power of a step, of the length of a piece, whose error is rounding
REMAINDER = 1.0 / 20.0  # of the fourth derivative: 1/24, and what the last step changed of the third


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
    _, slope = evaluate_rows(end, 0, TERMS, v)
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
