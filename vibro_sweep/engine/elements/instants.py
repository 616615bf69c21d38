"""What happens at one instant: impacts one after the other, touches and releases, who is held, everything else.

Guards that end within the rounding of the time end together. Of all closed rigid stops that are approached, the first
of the list is struck with its own R, then all are looked at again. Who is held: held_elements.py.
"""

import math

from vibro_sweep.engine.elements.element_machine import BY_FORCE, CELLS, RIGID, RUBS
from vibro_sweep.engine.elements.element_states import kick, place, set_speed
from vibro_sweep.engine.elements.held_elements import hold_candidates
from vibro_sweep.engine.elements.laws_of_elements import (
    FORCE,
    FREE,
    GUARDS,
    HELD,
    OPEN,
    PRESSED,
    REACH,
    RELAXED,
    RELAXING,
    SLIP,
    SLIP_DOWN,
    SLIP_UP,
    may_be_held,
)
from vibro_sweep.engine.elements.moving import depth, load_inputs, speed, time_of
from vibro_sweep.engine.elements.phases import across, find_phase
from vibro_sweep.engine.simd.jit import jit, noinline

IMPACT, TOUCH, RELEASE, REST, LEAVE, STICK, SLIPS = range(7)
TIE = 2.0**-50  # of the time: events that are not further apart are one instant; of the velocities: none
MOST_IMPACTS = 1000  # at one instant
FLAT = 2.0**-49  # of its place: a mass that bounces less high on a preloaded stop rests


@noinline
def happen(m, p, o, log, hit):
    """The instant at which guard `hit` ends the phase; -1: the start."""
    look(m, p, o, hit)
    strike(m, o, log)
    for e in range(len(o.modes)):
        o.candidate[e] = 0
        if m.kind[e] == RUBS:
            look_at_slip(m, o, e)
        elif m.kind[e] == RIGID:
            if is_closed(o, e):
                o.modes[e], o.at[e] = FREE, 1
                o.candidate[e] = speed(m, o, e) >= -slow(o) or bounces_end(m, p, o, e)
        else:
            look_at_compliant(m, p, o, log, e)
    hold_candidates(m, p, o)
    report(m, o, log)


@jit
def slow(o):
    return TIE * o.now[0].fastest


@jit
def look(m, p, o, hit):
    """Which guards end at this instant."""
    now, N = o.now[0], len(m.free)
    f = now.phase
    load_inputs(m, p, f, o)
    for e in range(len(o.modes)):
        o.before[e], o.at[e] = o.modes[e], 0
        for n in range(GUARDS):
            o.near[e, n] = 0
        if m.kind[e] == RUBS:
            now.fastest = max(now.fastest, abs(m.law[e, 0]))
    for j in range(N, 2 * N):
        now.fastest = max(now.fastest, abs(o.z[j]))
    t = time_of(m, o)
    for n in range(p.guards[f, 0]):
        value = slope = size = 0.0
        for j in range(len(o.q)):
            term = p.guard_series[f, n, j, 0] * o.q[j]
            value, size = value + term, size + abs(term)
            slope += p.guard_series[f, n, j, 1] * o.q[j]
        if n == hit or value <= TIE * (size + abs(t * slope)):
            o.near[p.element[f, n], p.guard[f, n]] = 1
    for e in range(len(o.modes)):
        if m.kind[e] == RIGID and o.near[e, REACH] != 0:
            place(m, o, e, 0.0)


@jit
def is_closed(o, e):
    """Of a rigid stop."""
    return o.before[e] == HELD or o.near[e, REACH] != 0


@jit
def strike(m, o, log):
    """Impacts, one after the other."""
    E, count, e = len(o.modes), 0, 0
    while e < E and count < MOST_IMPACTS:
        v = speed(m, o, e)
        if m.kind[e] == RIGID and is_closed(o, e) and v > slow(o):
            write(m, o, log, IMPACT, e, v)
            kick(m, o, e, m.law[e, 1])
            count, e = count + 1, 0
        else:
            e += 1
    for _ in range(100 * E if count == MOST_IMPACTS else 0):  # those that still approach come to rest together
        for e in range(E):
            if m.kind[e] == RIGID and is_closed(o, e) and speed(m, o, e) > 0.0:
                kick(m, o, e, 0.0)


@jit
def look_at_slip(m, o, e):
    w = speed(m, o, e)
    o.candidate[e] = abs(w) <= slow(o) or (o.near[e, SLIP] != 0 and w * (1 if o.before[e] == SLIP_UP else -1) <= 0.0)
    if not o.candidate[e]:
        o.modes[e] = SLIP_UP if w > 0.0 else SLIP_DOWN


@jit
def look_at_compliant(m, p, o, log, e):
    """The mode after this instant; where speed does not tell it, the stop is a candidate."""
    near, mode, s = o.near[e], o.modes[e], 2 * len(m.free) + m.relaxing[e]
    k, c, preload = m.law[e, 1], m.law[e, 2], m.law[e, 3]
    v = speed(m, o, e)
    if mode == PRESSED and m.kind[e] == BY_FORCE:
        if near[FORCE] != 0 or k * depth(m, o, e) + c * v + preload < 0.0:
            leave_by_force(m, o, log, e, near[FORCE] != 0)
            return
    if mode == RELAXING:
        if near[REACH] != 0:
            place(m, o, e, o.z[s])
            o.at[e] = 1
            if k * o.z[s] + c * v + preload > c * slow(o):  # the mass comes faster than the stop
                press(m, o, log, e)
                o.at[e] = 1 if o.z[s] == 0.0 else 0
                forget(o, s)
        elif near[RELAXED] != 0:
            o.modes[e] = FREE
            forget(o, s)
        return
    if mode == HELD or near[REACH] != 0 or near[OPEN] != 0:
        place(m, o, e, 0.0)
        o.at[e] = 1
        if abs(v) <= slow(o) or (may_be_held(m, e) and bounces_end(m, p, o, e)):
            o.candidate[e] = 1
        elif v > 0.0 and mode != PRESSED:
            press(m, o, log, e)
        elif v < 0.0:
            if mode == PRESSED:
                release(m, o, log, e)
            o.modes[e] = FREE


@jit
def bounces_end(m, p, o, e):
    """Whether the bounces to come on this stop are so low or so short that positions or times do not tell them."""
    v, mode = speed(m, o, e), o.modes[e]
    o.modes[e] = FREE
    f = find_phase(m, p, o.modes, o.made)
    o.modes[e] = mode
    load_inputs(m, p, f, o)
    pull = 0.0
    for i in range(len(m.free)):
        for j in range(len(o.q)):
            pull += m.row[e, i] * (p.A[f, len(m.free) + i, j] * o.q[j])
    if m.kind[e] == RIGID:
        tick = TIE * max(time_of(m, o), CELLS * m.width[0])
        return v <= 0.0 and -2.0 * v <= pull * (1.0 - m.law[e, 1]) * tick
    room = min(pull, m.law[e, 3] * across(m, e, e) - pull)
    return v * v <= 2.0 * room * FLAT * abs(m.law[e, 0])


@jit
def press(m, o, log, e):
    write(m, o, log, TOUCH, e, speed(m, o, e))
    o.modes[e], o.pressed[e] = PRESSED, 1


@jit
def release(m, o, log, e):
    write(m, o, log, RELEASE, e, speed(m, o, e))
    o.pressed[e] = 0


@jit
def leave_by_force(m, o, log, e, exactly):
    """The force is zero, or less after an impact, and the stop relaxes. exactly: of delta and delta' the one that is
    known with fewer digits follows from the other."""
    k, c, preload, s = m.law[e, 1], m.law[e, 2], m.law[e, 3], 2 * len(m.free) + m.relaxing[e]
    if exactly:
        if c * math.sqrt(k * across(m, e, e)) < k:
            place(m, o, e, -(c * speed(m, o, e) + preload) / k)
        else:
            set_speed(m, o, e, -(k * depth(m, o, e) + preload) / c)
    release(m, o, log, e)
    o.z[s], o.z_low[s] = depth(m, o, e), 0.0
    o.modes[e], o.at[e] = RELAXING, 2 if exactly else 1
    for j in range(len(o.z)):
        o.jump[s, j] = 0.0
        for i in range(len(m.free)):
            o.jump[s, j] += m.row[e, i] * o.jump[i, j]


@jit
def forget(o, s):
    """The stop is where it stands at rest."""
    o.z[s] = o.z_low[s] = 0.0
    for j in range(len(o.z)):
        o.jump[s, j] = 0.0


@jit
def report(m, o, log):
    """Log what the settling has changed."""
    for e in range(len(o.modes)):
        old, new = o.before[e], o.modes[e]
        if new == PRESSED and o.pressed[e] == 0:
            press(m, o, log, e)
        if new != PRESSED and o.pressed[e] != 0:
            release(m, o, log, e)
        if new == HELD and old != HELD:
            write(m, o, log, STICK if m.kind[e] == RUBS else REST, e, 0.0)
        elif old == HELD and new != HELD and m.kind[e] != RUBS:
            write(m, o, log, LEAVE, e, 0.0)
        elif (new == SLIP_UP or new == SLIP_DOWN) and new != old and old != FREE:  # at the start it is FREE
            write(m, o, log, SLIPS, e, 0.0)


@jit
def write(m, o, log, kind, e, v):
    """Log an event with the velocity v."""
    now, N = o.now[0], len(m.free)
    if now.logged < len(log.events):
        row = log.events[now.logged]
        row[0], row[1], row[2] = kind, e, 0.0
        if kind == SLIPS:
            row[2] = 1.0 if o.modes[e] == SLIP_UP else -1.0
        row[3], row[4], row[5] = now.period, now.cell * m.width[0] + now.offset, v
        for i in range(2 * N):
            row[6 + i] = o.z[i] + o.z_low[i]
    now.logged += 1
    now.events += 1
