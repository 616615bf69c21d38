"""Contacts by Taylor series, eight orbits at once: those that the closed form does not serve, soft ones and tiny ones.

A contact takes two to four series, whose lengths follow from a guess of its time; in the last one its end is found. The
guess may be bad: then the orbit is left alone. passage.py says when an end is the first one for certain.
"""

from vibro_sweep.engine.compliant.damped_wave import peak, seek
from vibro_sweep.engine.compliant.passage_series import (
    at,
    changes_of,
    expanded_at,
    load_passage,
    load_sum,
    of_stop,
    turn,
)
from vibro_sweep.engine.compliant.passage_tables import NEARLY, REACH, TERMS
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import put, row

FARTHER = 1.1  # how much longer than guessed the last series may be
DRIVEN = TERMS - 3  # the last power of the series of L of what ends


@inline
def load_force(passage, to, k, c, p):
    """The series of F/m_e."""
    for n in range(TERMS):
        put(to, n, k * row(passage.x, n) + c * row(passage.v, n))
    put(to, 0, row(to, 0) + p)


@inline
def load_end(passage, k, c, p, by_force):
    """The series of what is zero at the end: delta, or F/m_e."""
    load_force(passage, passage.end, k, c, p)
    for n in range(TERMS):
        put(passage.end, n, select(by_force, row(passage.end, n), row(passage.x, n)))


@inline
def keeps_sign(value, change, going, positive, negative):
    """Which lanes are still positive, and negative, where a value changes by so much at most while they are `going`."""
    return positive & (~going | (value >= change)), negative & (~going | (-value >= change))


@noinline
def pass_by_series(passage, ready, right, speed, about, sin, cos, to_section):
    """Pass the contacts of the orbits that are `ready`, by Taylor series, for `about` so long.

    Returns those that are passed, with their state in `passage.y`; which of them are over a section by then, with the
    state there in `passage.section`; the time in contact; and sin and cos of the force at its end.
    """
    k, c, p = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    by_force, rate = of_stop(passage.by_force, right) > 0.0, of_stop(passage.rate, right)
    half_turn, omega = of_stop(passage.half_turn, right), row(passage.omega, 0)
    reach = about * rate * (1.0 / REACH)
    parts = select(reach <= 1.0, 1.0, select(reach <= 2.0, 2.0, select(reach <= 3.0, 3.0, 4.0)))
    going = ready & (reach <= 4.0)
    u, found, crossing = about / parts, going & ~going, going & ~going
    pressed, pulled, rising, falling = going, going, going, going  # the signs of L of what ends, and of its slope
    preloaded = by_force & (p > 0.0)  # delta may come to zero before the force does, if a changes its sign
    into, away = going, going
    strongest, time, part = 0.0 * u, 0.0 * u, 0.0 * u
    while bits(going) != 0:
        part = part + 1.0
        load_passage(passage, sin, cos)
        last, length = going & (part >= parts), u
        if bits(last) != 0:
            load_end(passage, k, c, p, by_force)
            end, ending = seek(passage.end, TERMS, None, u, rate, FARTHER * u, last)
            found, length = found | ending, select(last, end, u)
        passing = going & (to_section >= time) & (to_section - time <= length)
        if bits(passing) != 0:
            crossing = crossing | passing
            keep_at(passage, passage.section, passing, to_section - time)
        if passage.watched:
            watch_peaks(passage, going, length, rate, k, c, p, part)
        if bits(going & preloaded) != 0:
            change, bend = changes_of(passage.drive, DRIVEN, length)
            into, away = keeps_sign(row(passage.drive, 0), change, going, into, away)
        load_sum(passage.drive, passage.drive, TERMS - 1, k, c, p * -row(passage.row, 0), by_force)  # L of what ends
        begins, slope = row(passage.drive, 0), row(passage.drive, 1)
        change, bend = changes_of(passage.drive, DRIVEN, length)
        pressed, pulled = keeps_sign(begins, change, going, pressed, pulled)
        rising, falling = keeps_sign(slope, bend, going, rising, falling)
        largest = abs(begins) + change
        strongest = select(going & (largest > strongest), largest, strongest)
        keep_at(passage, passage.y, going, length)
        swing, turned = turn(omega * length)
        sin, cos = (
            select(going, sin * turned + cos * swing, sin),
            select(going, cos * turned - sin * swing, cos),
        )
        time, going = select(going, time + length, time), going & ~last
    duration, short = of_stop(passage.duration, right), time < half_turn
    signs = (pressed & (time < duration + half_turn)) | ((pulled | (~by_force & (rising | falling))) & short)
    usual = (time < NEARLY * duration) & (duration < NEARLY * time)
    certain = signs | (usual & (speed * of_stop(passage.firm, right) > strongest))
    certain = certain & (~preloaded | (into | away) & short & (row(passage.y, 0) > 0.0))
    put(passage.parts, 0, select(ready, parts, row(passage.parts, 0)))
    return found & certain, crossing, time, sin, cos


@noinline
def watch_peaks(passage, going, length, rate, k, c, p, part):
    """Keep the largest delta and F/m_e of the contact, over the time `length` of its series number `part`."""
    load_force(passage, passage.force, k, c, p)
    first = part <= 1.0
    keep_larger(passage.largest, peak_within(passage.x, length, rate), going, first)
    keep_larger(passage.strongest, peak_within(passage.force, length, rate), going, first)


@inline
def keep_larger(kept, found, going, first):
    """Keep what is found, where it is the `first`, or larger than what was kept."""
    put(kept, 0, select(going & (first | (found > row(kept, 0))), found, row(kept, 0)))


@inline
def peak_within(c, u, rate):
    """The largest value of a series on [0, u] that turns back there once, or not."""
    first, (end, slope, _, _, _) = row(c, 0), expanded_at(c, 0, TERMS, u)
    largest, begins = select(end > first, end, first), row(c, 1)
    turning = (begins > 0.0) & (slope < 0.0)
    top = select(turning, u * begins / (begins - slope), 0.0 * u)
    found = peak(c, TERMS, None, top, rate, u, turning)
    return select(found > largest, found, largest)


@inline
def keep_at(passage, to, who, u):
    """The state of these orbits at u of the series."""
    for m in range(len(passage.push)):
        first = 2 * m
        put(to, first, select(who, at(passage.x, m * TERMS, TERMS, u), row(to, first)))
        put(to, first + 1, select(who, at(passage.v, m * TERMS, TERMS, u), row(to, first + 1)))
