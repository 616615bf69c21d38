"""Tangent vectors through the contacts of eight orbits at once; what touch and release do: tangent_in_contact.py."""

import math

from vibro_sweep.engine.compliant.contact_pieces import PIECES, TERMS
from vibro_sweep.engine.compliant.contact_rows import from_contact, of_stop
from vibro_sweep.engine.compliant.piece_series import next_group, tables_of
from vibro_sweep.engine.compliant.relaxing import GONE
from vibro_sweep.engine.simd.columns import rows_of, weigh
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import LANES, alike, bits, lanes_of, lowest, number, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables.flight import evaluate_rows
from vibro_sweep.engine.variational.growth import shrink_volumes
from vibro_sweep.engine.variational.orthonormal import watch
from vibro_sweep.engine.variational.tangent_flight import apply_flight

SMALLEST = 1e-15  # what a vector may grow by unseen


@inline
def carry_through(law, e, passed):
    """Carry the tangent vectors of the orbits that `passed` a contact, as bits, through it."""
    if law is not None:
        if passed != 0:
            carry_through_contacts(law.passage[0], e.strike[0], e.tangent[0], e.orbits, passed)


@noinline
def carry_through_contacts(passage, strikes, t, orbits, passed):
    """`carry_through` where there are some; their flight up to the touch is collected."""
    who, side, size = lanes_of(passed), row(strikes.side, 0), len(t.growth)
    right, time = side > 0.0, row(passage.time, 0)
    c, p = of_stop(passage.damping, right), of_stop(passage.preload, right)
    touch, release = p / row(passage.speed, 0), p / row(passage.speed_after, 0)
    by_force = of_stop(passage.by_force, right) > 0.0
    forgets, apart = who & by_force & ~(p > 0.0), GONE * c
    apply_flight(t, who)
    set_flight(passage, who, right, time)
    for j in range(size):
        to_contact(passage, t, side, j)
        vector = passage.vector
        put(vector, 1, row(vector, 1) - touch * row(vector, 0))
        fly_in_contact(passage, c, who)
        delta = row(vector, 0)
        put(vector, 1, row(vector, 1) + select(by_force, -c, release) * delta)
        for n in range(len(t.places) // size):
            chosen = who & (right if n == 1 else ~right)
            if bits(forgets) != 0:
                jump = apart * abs(row(t.places, n * size + j))
                forget(t, j, bits(chosen & forgets & (jump > SMALLEST)), jump)
            put(t.places, n * size + j, select(chosen, delta, row(t.places, n * size + j)))
            put(t.alone, n, select(chosen, 0.0, row(t.alone, n)))
        set_from_contact(passage, t, side, j, who)
    put(t.mixed, 0, select(who, 1.0, row(t.mixed, 0)))
    shrink_volumes(t, who, c * time)
    left, growth = passed, of_stop(passage.trace, right) * time - c * time
    while left != 0:
        i = lowest(left)
        left &= left - 1
        crossed = int(passage.crossed[i])
        t.volume[i] *= math.exp(number(growth, i))
        t.cell[i] = orbits[i].cell + crossed
        t.offset[i] = strikes.offset[i] + passage.time[i] - crossed * strikes.width[i]
    watch(t, who, alike(1.0))


@noinline
def forget(t, j, who, jump):
    """Count how much vector j of these orbits might have grown at a touch of a stop that still moves a little."""
    for i in range(LANES):
        if who >> i & 1:
            t.forgotten[j, i] += math.log(1.0 + number(jump, i))


@noinline
def set_flight(passage, who, right, time):
    """The flight of (delta, delta', w2, w2', ..) from the touch to the release of these contacts."""
    block, sign = tables_of(passage, right)
    E, states, masses, size = passage.flight, len(passage.y), len(passage.push), len(passage.touch) + 1
    h, piece = of_stop(passage.length, block), row(passage.piece, 0)
    while bits(who) != 0:
        now, n, p = next_group(who, block, piece)
        who = who & ~now
        v, at = time - p * h, n * PIECES + p
        for e in range(states):
            column = e - 1 if e > 0 else size - 1
            x, slope = evaluate_rows(passage.course, (at * size + column) * TERMS, TERMS, v)
            if p == 0 and e > 0:
                x, slope = time * x, x + time * slope
            turned = sign if e > 1 else 0.0 * sign + 1.0
            put(E, e, select(now, turned * x, row(E, e)))
            put(E, states + e, select(now, turned * slope, row(E, states + e)))
            for m in range(1, masses):
                first = (at * (masses - 1) + m - 1) * size + column
                x, slope = evaluate_rows(passage.others, first * TERMS, TERMS, v)
                if e == 2 * m:
                    x = x + 1.0
                if e == 2 * m + 1:
                    x, slope = x + time, slope + 1.0
                turned, at_place = sign if e < 2 else 0.0 * sign + 1.0, 2 * m * states + e
                put(E, at_place, select(now, turned * x, row(E, at_place)))
                put(E, at_place + states, select(now, turned * slope, row(E, at_place + states)))
        keep_digits(passage, now, n, at, p, v, time, sign)


@noinline
def keep_digits(passage, who, n, at, p, v, time, sign):
    """What a unit delta' makes of delta, which is small at a release, from what is zero there; and delta' from these.

    V E_01 + (what all other inputs make of delta) = 0, or k delta + c delta' + p = 0; and E A = A E. Where V is small
    beside these inputs their sum has fewer digits than the tables.
    """
    E, touch, inputs, states = passage.flight, passage.touch, len(passage.touch), len(passage.y)
    masses, k, c = len(passage.push), row(passage.stiffness, n), row(passage.damping, n)
    by_force, first = row(passage.by_force, n) > 0.0, 2 * n * masses
    delta, speed, size = 0.0 * v, 0.0 * v, 0.0 * v
    for e in range(1, inputs):
        x, slope = evaluate_rows(passage.course, (at * (inputs + 1) + e) * TERMS, TERMS, v)
        if p == 0:
            x, slope = time * x, x + time * slope
        delta, speed = delta + x * row(touch, e), speed + slope * row(touch, e)
        size = size + abs(x * row(touch, e))
    back, ahead = 0.0 * v, row(E, 0)  # of E_10 and E_11 what does not come from E_01
    for m in range(1, masses):
        other = sign * row(E, 2 * m + 1)
        back = back + other * row(passage.pull, first + 2 * m)
        ahead = ahead + other * row(passage.pull, first + 2 * m + 1)
    damping = row(passage.pull, first + 1)
    share, total = select(by_force, k + c * damping, 1.0), select(by_force, k * delta + c * speed, delta)
    total = total + select(by_force, c * ahead * row(touch, 0) + row(passage.preload, n), 0.0)
    small = -total / (share * row(touch, 0))
    who = who & (size < row(passage.length, n) * row(touch, 0)) & (~by_force | (abs(c * damping) < 0.5 * k))
    put(E, 1, select(who, small, row(E, 1)))
    put(E, states, select(who, small * row(passage.pull, first) + back, row(E, states)))
    put(E, states + 1, select(who, small * damping + ahead, row(E, states + 1)))


@inline
def fly_in_contact(passage, c, who):
    """Carry the tangent `vector`, (delta, delta' + c delta, w2, ...), from the touch to the release.

    In these coordinates no jump of size c or k acts at touch and release (tangent_in_contact.py).
    """
    E, states, vector = passage.flight, len(passage.y), passage.vector
    put(vector, 1, row(vector, 1) - select(who, c * row(vector, 0), 0.0))
    z = rows_of(vector)
    delta = weigh(E, 0, 1, z)
    put(vector, 0, select(who, delta, row(vector, 0)))
    for a in range(1, states):
        total = weigh(E, a * states, 1, z)
        if a == 1:
            total = total + c * delta
        put(vector, a, select(who, total, row(vector, a)))


@inline
def to_contact(passage, t, side, j):
    """Tangent vector j as (delta, delta', w2, ...)."""
    Z, back, size, to = t.Z, t.from_frame, len(t.growth), passage.vector
    for a in range(size):
        total = row(back, a * size) * row(Z, j)
        for m in range(1, size):
            total = total + row(back, a * size + m) * row(Z, m * size + j)
        put(to, a, total)
    for m in range(1, len(passage.push)):
        put(to, 2 * m, row(to, 2 * m) - row(passage.push, m) * row(to, 0))
        put(to, 2 * m + 1, row(to, 2 * m + 1) - row(passage.push, m) * row(to, 1))
    put(to, 0, side * row(to, 0))
    put(to, 1, side * row(to, 1))


@inline
def set_from_contact(passage, t, side, j, who):
    """Tangent vector j from (delta, delta', w2, ...)."""
    Z, frame, size, of = t.Z, t.to_frame, len(t.growth), passage.vector
    from_contact(passage, of, of, side, 0.0 * side)
    for m in range(size):
        total = row(frame, size * m) * row(of, 0)
        for a in range(1, size):
            total = total + row(frame, size * m + a) * row(of, a)
        put(Z, size * m + j, select(who, total, row(Z, size * m + j)))
