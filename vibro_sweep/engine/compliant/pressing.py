"""A contact with a compliant stop: how it begins, goes on, and ends."""

import math

import numpy as np

from vibro_sweep.engine.compliant.contact_series import (
    begin_matrix,
    carry_matrix,
    end_of_contact,
    enter,
    go_on_in_contact,
    integral_of_squared_slope,
    leave,
    load_contact,
    stored_energy,
    watch_contact,
)
from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.relaxing import bring_stops
from vibro_sweep.engine.compliant.slow_contact import fast_that_died, load_slow, slow_step
from vibro_sweep.engine.compliant.tangent_in_contact import CONTINUED, RELAXED, UNRELAXED, carry_over_contact
from vibro_sweep.engine.compliant.vectors_set_apart import fly_vectors_apart, set_vectors_apart
from vibro_sweep.engine.motion.energy_sums import add_contact
from vibro_sweep.engine.motion.force_phase import turn_phase
from vibro_sweep.engine.motion.orbits import wall_of
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import evaluate
from vibro_sweep.engine.variational import tangent_flight

# by how much one matrix may shrink vectors, as a logarithm: what shrinks more is lost beside what does not
MOST_SHRUNK = 2.0
MOST_STEPS = 2**20  # in a cell: a tenth of a second
BETWEEN_LOOKS = 2**14  # steps, at `halt`
NEARBY = 2.0**-16  # of the time to the end of a contact
BETWEEN_TRIES = 8  # to follow the slow motion alone
TOO_MANY = -1.0  # in place of a time


@jit
def begin_contact(law, f, stops, o, t, k, s, side, on_stop):
    """The mass touches the stop, or starts inside it. on_stop: whether delta is zero."""
    contact, n = law.orbits[o.lane], lane_of(side)
    enter(contact, o, stops, side)
    if on_stop:
        contact.y[0] = 0.0
    o.resting = contact.pressed = side
    contact.entered, contact.least, contact.touched = on_stop, 1, contact.y[1]
    contact.fast = 0
    contact.begun = UNRELAXED if contact.relaxed[n] > 0.0 else RELAXED if on_stop else CONTINUED
    if contact.relaxed[n] > 0.0:
        rest = contact.preload[n] / contact.stiffness[n]
        contact.decay = (contact.relaxed[n] + rest) / (contact.left[n] + rest)
    contact.relaxed[n] = 0.0
    contact.largest, contact.strongest = -np.inf, -np.inf
    contact.contacts[n] += 1
    contact.touched_last = n
    o.events += 1
    contact.row = -1
    contact.watched = contact.watched or law.log.shape[1] > 0
    if contact.logged < law.log.shape[1]:
        contact.row, line = contact.logged, law.log[o.lane, contact.logged]
        line[0], line[1], line[2] = o.period, k, s
        line[3] = line[4] = line[5] = line[8] = np.nan
        line[6], line[7] = side, contact.y[1]
    contact.logged += 1
    if t.wanted:
        tangent_flight.fly_to(t, o.lane, f.oscillator[0], f.nodes, k, s)


@jit
def stay_in_contact(law, f, stops, o, records, t, k, s):
    """Contact from offset s of cell k on. Returns the time to its end, infinite if not in this cell, or `TOO_MANY`."""
    q, contact, side, w = f.oscillator[0], law.orbits[o.lane], law.orbits[o.lane].pressed, 0.0
    n, carried, steps, ending = lane_of(side), 0.0, 0, False  # carried: so far tangent vectors are
    contact.work -= stored_energy(contact, n)
    if t.wanted:
        begin_matrix(contact)
    while True:
        steps += 1
        if steps > MOST_STEPS or (steps % BETWEEN_LOOKS == 0 and law.halt[0] != 0):
            return TOO_MANY
        left, step = q.width - s - w, contact.step[n]
        goes_on = steps == 1 and not contact.entered
        if contact.fast > 0 or ((goes_on or steps % BETWEEN_TRIES == 0) and left > BETWEEN_TRIES * step):
            carried = try_slow_motion(contact, o, t, q, k, s, w, carried)
        if contact.fast > 0:
            step = slow_step(contact, n, contact.fast)
            load_slow(contact, n, contact.fast)
        else:
            load_contact(contact, side, q.omega)
        last = left <= 1.001 * step
        left = left if last else step
        d = end_of_contact(contact, side, left)
        if d != d:
            return d
        if contact.fast > 0 and d < np.inf and not ending:  # all digits of a are those of a series that begins nearby
            left, d, last, ending = d * (1.0 - NEARBY), np.inf, False, True
        else:
            ending = False
        end = min(d, left)
        sample_contact(contact, stops, o, records, k, side, s + w, s + w + end)
        add_contact(records.sums, contact, wall_of(stops, side), side, end)
        contact.time += end
        if contact.watched:
            watch_contact(contact, side, end)
            contact.work += contact.damping[n] * integral_of_squared_slope(contact.c[0], end)
        if t.wanted and contact.fast == 0:
            carry_matrix(contact, side, end)
        go_on_in_contact(contact, end)
        turn_phase(contact, q.omega, end)
        contact.entered = False
        w += end
        if t.wanted and contact.fast > 0:
            fly_vectors_apart(t, o.lane, contact, side, n, contact.fast, end)
            carried = w
        if last or d < np.inf:
            break
        if t.wanted and contact.damping[n] * (w - carried) > MOST_SHRUNK:
            carry_over_contact(t, o.lane, contact, side, w - carried, False)
            contact.begun, carried = CONTINUED, w
            begin_matrix(contact)
    ended = d < np.inf
    if ended:
        end_contact(contact, o, k, s + w, side)
    contact.work += stored_energy(contact, n)
    leave(contact, o, stops, side)
    o.pressed_time += w
    if t.wanted:
        if ended or w > carried:
            carry_over_contact(t, o.lane, contact, side, w - carried, ended)
        t.cell[o.lane], t.offset[o.lane] = k, s + w
    contact.begun = CONTINUED
    keep_in_log(law, contact, o, k, s + w, ended)
    return w if ended else d


@jit
def try_slow_motion(contact, o, t, q, k, s, w, carried):
    """Follow the slow motion alone from here on, if the fast one has died away. Returns how far vectors are carried."""
    side, i = contact.pressed, o.lane
    n = lane_of(side)
    contact.fast = fast_that_died(contact, n, q.omega)
    if contact.fast == 0 or not t.wanted:
        return carried
    if w > carried:
        carry_over_contact(t, i, contact, side, w - carried, False)
        contact.begun = CONTINUED
        begin_matrix(contact)
    bring_stops(contact, o, k, s + w, q.width)
    if contact.relaxed[1 - n] > 0.0 or not set_vectors_apart(t, i, contact, side, n, contact.fast):
        contact.fast = 0
    return w


@jit
def end_contact(contact, o, k, s, side):
    """The mass leaves the stop: exactly where delta is zero, or the force."""
    n, y = lane_of(side), contact.y
    if contact.ends_by_force:
        stiffness, damping, preload = contact.stiffness[n], contact.damping[n], contact.preload[n]
        if damping * math.sqrt(stiffness) < stiffness:  # what is better conditioned
            y[0] = -(damping * y[1] + preload) / stiffness
        else:
            y[1], contact.low[1] = -(stiffness * y[0] + preload) / damping, 0.0
        contact.relaxed[n] = contact.left[n] = y[0]
        contact.cell[n], contact.offset[n] = o.period * o.cells + k, s
    else:
        y[0], y[1] = 0.0, min(y[1], 0.0)
    contact.close_until = o.period * o.cells + k + o.cells
    o.resting = contact.pressed = 0.0
    if contact.touched > 0.0:
        contact.restitutions -= y[1] / contact.touched
        contact.ended += 1


@jit
def keep_in_log(law, contact, o, k, s, ended):
    """What is known of the contact by now."""
    contact.peak, contact.peak_force = (
        max(contact.peak, contact.largest),
        max(contact.peak_force, contact.mass * contact.strongest),
    )
    if contact.row >= 0:
        line = law.log[o.lane, contact.row]
        line[9], line[10] = contact.largest, contact.mass * contact.strongest
        if ended:
            line[3], line[4], line[5], line[8] = o.period, k, s, contact.y[1]


@jit
def sample_contact(contact, stops, o, records, k, side, start, stop):
    """Take the samples that fall in cell k between the offset `start`, where the series begins, and `stop`."""
    times, samples, i = records.times, records.samples, o.samples_taken
    while i < len(times) and times[i, 0] == k and times[i, 1] <= stop:
        u = max(times[i, 1] - start, 0.0)
        x, v = evaluate(contact.c[0], u)
        samples[i, 0], samples[i, 1] = wall_of(stops, side) + side * x, side * v
        for j in range(1, len(contact.push)):
            x, v = evaluate(contact.c[j], u)
            samples[i, 2 * j] = x + contact.push[j] * samples[i, 0]
            samples[i, 2 * j + 1] = v + contact.push[j] * samples[i, 1]
        i += 1
    o.samples_taken = i
