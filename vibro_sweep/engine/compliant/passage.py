"""The passage through a contact, eight orbits at once: from the touch to the end of the cell of the release.

The contact takes two to four Taylor series, whose lengths follow from a guess of its time; in the last one its end is
found. The guess may be bad: then the orbit is left alone, as it is where that end is not the first one for certain,
and where the mass does not leave the stop freely. pressing.py follows such contacts one by one.

The end is the first (Polya; L h = h'' + 2 gamma h' + K h has no more zeros than 2 and the changes of sign of L h, on
intervals shorter than pi/kd): of delta, L delta = a, where a changes its sign once at most, or does not and presses,
or is small (`firm`); of the force F/m_e, L F/m_e = k a + c a' + K p, where that does not change its sign.
"""

import math

from vibro_sweep.engine.compliant.passage_series import (
    acceleration_of,
    at,
    choose_equations,
    derivatives_at,
    load_passage,
    of_stop,
    turn,
)
from vibro_sweep.engine.compliant.passage_tables import NEARLY, REACH, TERMS
from vibro_sweep.engine.motion.strike import bound_third, leaves_freely
from vibro_sweep.engine.simd.columns import put_transposed, rows_of, weigh
from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables import economy

LOOKS = 4  # at the end, each followed by a step towards it
FARTHER = 1.1  # how much longer than guessed the last series may be
TOP_LOOKS = 6  # at a peak, of which the last ones change nothing
CLOSE = 2.0**-54  # of the time, a third power: what a step of third order leaves
MARGIN = 1.0 + 1e-9  # of bounds that rounding may have moved


@inline
def change_of(passage, z, m, u):
    """By how much mass m moves in free flight within u after the inputs z, and its velocity then."""
    step, first = economy.TERMS, m * len(z) * economy.TERMS
    x, v = weigh(passage.series, first + step - 1, step, z), 0.0 * u
    for n in range(step - 2, 1, -1):
        v = v * u + x
        x = x * u + weigh(passage.series, first + n, step, z)
    v, x = v * u + x, x * u + z[2 * m + 1]
    return x * u, v * u + x


@inline
def guess(speed, a, duration, lean, pull):
    """How long the contact lasts, about."""
    y = (lean * a + pull) / speed
    size = abs(y)
    inner = select(size < 1.0, y, 1.0 / select(size < 1.0, 1.0, size))
    angle = inner / (1.0 + 0.28 * inner * inner) * (2.0 / math.pi)
    return duration * select(size < 1.0, 1.0 + angle, select(y < 0.0, angle, 2.0 - angle))


@inline
def seek_end(c, u, farthest, rate, wanted):
    """The zero of a series near u, where it falls, by Chebyshev's method. Returns it, and which lanes found it."""
    found = wanted & ~wanted
    for _ in range(LOOKS):
        f, slope, curve = derivatives_at(c, u)
        inverse = 1.0 / slope
        newton = -f * inverse
        after = u + (newton - curve * inverse * newton * newton)
        wanted = wanted & (slope < 0.0) & (after > 0.0) & (after <= farthest)
        u = select(wanted, after, u)
        left = abs(newton) * rate
        now = wanted & (left * left * left <= CLOSE * (u * rate))
        found, wanted = found | now, wanted & ~now
        if bits(wanted) == 0:
            break
    return u, found


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
def load_drive(passage, k, c, constant, by_force):
    """L of it: a, or k a + c a' + K p."""
    a = passage.drive
    for n in range(TERMS - 2):
        both = k * row(a, n) + c * ((n + 1.0) * row(a, n + 1))
        if n == 0:
            both = both + constant
        put(a, n, select(by_force, both, row(a, n)))


@inline
def changes_of(c, u):
    """By how much a series of so many terms changes at most within u, and its derivative."""
    size, slope = abs(row(c, TERMS - 3)), (TERMS - 3.0) * abs(row(c, TERMS - 3))
    for n in range(TERMS - 4, 0, -1):
        size = size * u + abs(row(c, n))
        if n > 1:
            slope = slope * u + float(n) * abs(row(c, n))
    return size * u * MARGIN, slope * u * MARGIN


@inline
def keeps_sign(value, change, going, positive, negative):
    """Which lanes are still positive, and negative, where a value changes by so much at most while they are `going`."""
    return positive & (~going | (value >= change)), negative & (~going | (-value >= change))


@jit
def pass_contacts(passage, strikes, z, touching, side, d, v):
    """Pass the contacts of the orbits that are `touching` a compliant stop, at d in their cells with the velocity v.

    Returns those that have left the stop and touch no other until the end of the cell in which they leave it, where
    `strikes.X` is their state then.
    """
    states, masses, y, right = len(passage.y), len(passage.push), passage.y, side > 0.0
    k, c, p = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    by_force, rate, width = of_stop(passage.by_force, right) > 0.0, of_stop(passage.rate, right), row(strikes.width, 0)
    wall, half_turn = select(right, row(strikes.right, 0), row(strikes.left, 0)), of_stop(passage.half_turn, right)
    choose_equations(passage, right)
    # the touch
    s, q = turn(row(passage.omega, 0) * d)
    sin, cos = z[states] * q + z[states + 1] * s, z[states + 1] * q - z[states] * s
    speed = side * v
    put(y, 0, 0.0)
    put(y, 1, speed)
    for m in range(1, masses):
        change, vm = change_of(passage, z, m, d)
        put(y, 2 * m, (z[2 * m] + change) - row(passage.push, m) * wall)
        put(y, 2 * m + 1, vm - row(passage.push, m) * v)
    about = guess(
        speed,
        acceleration_of(passage, sin, cos),
        of_stop(passage.duration, right),
        of_stop(passage.lean, right),
        of_stop(passage.pull, right),
    )
    # the contact
    omega, reach = row(passage.omega, 0), about * rate * (1.0 / REACH)
    parts = select(reach <= 1.0, 1.0, select(reach <= 2.0, 2.0, select(reach <= 3.0, 3.0, 4.0)))
    going = touching & (of_stop(passage.ends, right) > 0.0) & (reach <= 4.0)
    u, found, crossing = about / parts, going & ~going, going & ~going
    pressed, pulled, rising, falling = going, going, going, going  # the signs of L of what ends, and of its slope
    preloaded = by_force & (p > 0.0)  # delta may come to zero before the force does, if a changes its sign
    into, away = going, going
    strongest, time, part = 0.0 * u, 0.0 * u, 0.0 * u
    to_section = row(passage.ahead, 0) * width - d
    while bits(going) != 0:
        part = part + 1.0
        load_passage(passage, sin, cos)
        last, length = going & (part >= parts), u
        if bits(last) != 0:
            load_end(passage, k, c, p, by_force)
            end, ending = seek_end(passage.end, u, FARTHER * u, rate, last)
            found, length = found | ending, select(last, end, u)
        passing = going & (to_section >= time) & (to_section - time <= length)
        if bits(passing) != 0:
            crossing = crossing | passing
            keep_at(passage, passage.section, passing, to_section - time)
        if passage.watched:
            watch_peaks(passage, going, length, k, c, p, part)
        if bits(going & preloaded) != 0:
            change, bend = changes_of(passage.drive, length)
            into, away = keeps_sign(row(passage.drive, 0), change, going, into, away)
        load_drive(passage, k, c, p * -row(passage.row, 0), by_force)
        begins, slope = row(passage.drive, 0), row(passage.drive, 1)
        change, bend = changes_of(passage.drive, length)
        pressed, pulled = keeps_sign(begins, change, going, pressed, pulled)
        rising, falling = keeps_sign(slope, bend, going, rising, falling)
        largest = abs(begins) + change
        strongest = select(going & (largest > strongest), largest, strongest)
        keep_at(passage, y, going, length)
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
    put(passage.speed, 0, select(touching, speed, row(passage.speed, 0)))
    put(passage.time, 0, select(touching, time, row(passage.time, 0)))
    put(passage.parts, 0, select(touching, parts, row(passage.parts, 0)))
    certain = certain & (~preloaded | (into | away) & short & (row(y, 0) > 0.0))
    return leave_stop(passage, strikes, found & certain, crossing, side, d + time, sin, cos)


@noinline
def watch_peaks(passage, going, length, k, c, p, part):
    """Keep the largest delta and F/m_e of the contact, over the time `length` of its series number `part`."""
    load_force(passage, passage.force, k, c, p)
    first = part <= 1.0
    keep_larger(passage.largest, peak_within(passage.x, length), going, first)
    keep_larger(passage.strongest, peak_within(passage.force, length), going, first)


@inline
def keep_larger(kept, found, going, first):
    """Keep what is found, where it is the `first`, or larger than what was kept."""
    put(kept, 0, select(going & (first | (found > row(kept, 0))), found, row(kept, 0)))


@inline
def peak_within(c, u):
    """The largest value of a series on [0, u] that turns back there once, or not."""
    first, (end, slope, _) = row(c, 0), derivatives_at(c, u)
    largest, begins = select(end > first, end, first), row(c, 1)
    turns = (begins > 0.0) & (slope < 0.0)
    top = select(turns, u * begins / (begins - slope), 0.0 * u)
    for _ in range(TOP_LOOKS):
        f, slope, curve = derivatives_at(c, top)
        largest = select(turns & (f > largest), f, largest)
        after = top - 0.5 * slope / curve
        top = select(turns & (curve < 0.0) & (after > 0.0) & (after < u), after, top)
    return largest


@inline
def keep_at(passage, to, who, u):
    """The state of these orbits at u of the series."""
    for m in range(len(passage.push)):
        first = 2 * m
        put(to, first, select(who, at(passage.x, m * TERMS, u), row(to, first)))
        put(to, first + 1, select(who, at(passage.v, m * TERMS, u), row(to, first + 1)))


@jit
def leave_stop(passage, strikes, leaving, crossing, side, end, sin, cos):
    """Release the orbits that are `leaving` their stop, `end` after the beginning of the cell in which they touched it.

    Returns those that fly freely to the end of the cell in which they leave it.
    """
    masses, states, y, right = len(passage.push), len(passage.y), passage.y, side > 0.0
    k, c, p = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    by_force, wall = of_stop(passage.by_force, right) > 0.0, select(right, row(strikes.right, 0), row(strikes.left, 0))
    by_place = by_force & (c * c * k < k * k)  # of the place and the speed, that which is better conditioned
    place = select(by_place, -(c * row(y, 1) + p) / k, select(by_force, row(y, 0), 0.0))
    speed = select(by_force & ~by_place, -(k * place + p) / c, row(y, 1))
    put(passage.place, 0, place)
    put(passage.speed_after, 0, speed)
    put(y, 0, place)
    put(y, 1, speed)
    to_masses_of(passage, passage.y, passage.release, side, wall)
    to_masses_of(passage, passage.section, passage.landing, side, wall)
    put_transposed(passage.X, passage.landing)
    put(passage.release, states, sin)
    put(passage.release, states + 1, cos)
    if len(passage.release) > states + 2:
        put(passage.release, states + 2, 1.0)
    # the rest of the cell
    width = row(strikes.width, 0)
    crossed = math.floor(end / width)
    rest = (crossed + 1.0) * width - end
    over = crossed >= row(passage.ahead, 0)
    leaving = leaving & (speed < 0.0) & (rest >= 0.0) & (crossed < row(passage.last, 0)) & (crossing | ~over)
    z = rows_of(passage.release)
    for n in range(1, economy.TERMS):
        put(strikes.c, n, weigh(passage.series, n, economy.TERMS, z))
    third, after = bound_third(strikes, z), 2.0 * row(strikes.c, 2)
    leaving = leaving & leaves_freely(strikes, -speed, after, side, rest, third)
    # the relaxing stop falls behind: k delta + c delta' < 0 from the release on
    into = select(side * after > 0.0, side * after, 0.0) + rest * third
    leaving = leaving & (~by_force | (k * (-speed - rest * into) > c * into))
    put(passage.crossed, 0, crossed)
    put(passage.rest, 0, rest)
    for m in range(masses):
        change, v = change_of(passage, z, m, rest)
        if m == 0:
            change = side * place + change
            x = wall + change
            put(passage.finer, 0, (wall - (x - (x - wall))) + (change - (x - wall)))
        else:
            x = z[2 * m] + change
        put(strikes.landing, 2 * m, select(leaving, x, row(strikes.landing, 2 * m)))
        put(strikes.landing, 2 * m + 1, select(leaving, v, row(strikes.landing, 2 * m + 1)))
    put_transposed(strikes.X, strikes.landing)
    return leaving


@inline
def to_masses_of(passage, y, to, side, wall):
    """The coordinates and velocities x1, v1, ... from delta, delta', w2, ..."""
    put(to, 0, wall + side * row(y, 0))
    put(to, 1, side * row(y, 1))
    for m in range(1, len(passage.push)):
        put(to, 2 * m, row(y, 2 * m) + row(passage.push, m) * row(to, 0))
        put(to, 2 * m + 1, row(y, 2 * m + 1) + row(passage.push, m) * row(to, 1))
