"""A contact with a compliant stop: how it begins, goes on from series to series, and ends."""

import math

import numpy as np

from vibro_sweep.engine.compliant.contact_series import (
    begin_matrix,
    carry_matrix,
    end_of_contact,
    enter,
    go_on_in_contact,
    leave,
    load_contact,
    second_derivative,
    stored_energy,
    watch_contact,
)
from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.relaxing import bring_stops
from vibro_sweep.engine.compliant.slow_contact import fast_that_died, load_slow, slow_step
from vibro_sweep.engine.compliant.stop_laws import AT_PLACE, RELAXES
from vibro_sweep.engine.compliant.tangent_in_contact import CONTINUED, RELAXED, UNRELAXED, carry_over_contact
from vibro_sweep.engine.compliant.vectors_set_apart import fly_vectors_apart, set_vectors_apart
from vibro_sweep.engine.motion.energy_sums import add_contact
from vibro_sweep.engine.motion.orbits import wall_of
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.tables.flight import evaluate
from vibro_sweep.engine.variational import tangent_flight

# by how much one matrix may shrink vectors, as a logarithm: what shrinks more is lost beside what does not
MOST_SHRUNK = 2.0
MOST_STEPS = 2**20  # in a cell: a tenth of a second
BETWEEN_LOOKS = 2**14  # steps, at `halt`
NEARBY = 2.0**-16  # of the time to the end of a contact
BETWEEN_TRIES = 8  # to follow the slow motion alone


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
    begin_in_cell(contact, t)


@jit
def begin_in_cell(contact, t):
    """A contact begins in this cell, or goes on in it."""
    contact.steps, contact.ending, contact.uncarried = 0, False, 0.0
    contact.work -= stored_energy(contact, lane_of(contact.pressed))
    if t.wanted:
        begin_matrix(contact)


@inline
def go_on_in_cell(law, o, t):
    """A contact goes on in the next cell."""
    if law is not None:
        begin_in_cell(law.orbits[o.lane], t)


@inline
def stop_in_cell(law, stops, o, t, k, s):
    """A contact goes on beyond the end of cell k, at offset s."""
    if law is not None:
        leave_cell(law, stops, o, t, k, s, o.resting, False)


@inline
def takes_too_many(law, o):
    """Whether the series that comes next is one too many for a cell, or nobody waits for it any more."""
    if law is not None:
        contact = law.orbits[o.lane]
        contact.steps += 1
        return contact.steps > MOST_STEPS or (contact.steps % BETWEEN_LOOKS == 0 and law.halt[0] != 0)
    return False


@jit
def load_pressed(contact, q, o, t, k, s, remaining):
    """The series of a contact from offset s of cell k on. Returns how far it reaches."""
    n = lane_of(contact.pressed)
    step, goes_on = contact.step[n], contact.steps == 1 and not contact.entered
    if t.wanted and contact.damping[n] * contact.uncarried > MOST_SHRUNK:
        carry_on(contact, o, t)
    due = (goes_on or contact.steps % BETWEEN_TRIES == 0) and remaining > BETWEEN_TRIES * step
    if contact.fast > 0 or due:
        try_slow_motion(contact, q, o, t, k, s)
    if contact.fast > 0:
        load_slow(contact, o, n, contact.fast)
        return slow_step(contact, n, contact.fast)
    load_contact(contact, o, contact.pressed, q.omega)
    return step


@jit
def end_in_series(contact, o, left, last):
    """When contact ends within the time `left` of the series, infinite if it does not; how far the series is followed,
    and whether to the end of the cell."""
    d = end_of_contact(contact, o, contact.pressed, left)
    contact.ending = contact.fast > 0 and d < np.inf and not contact.ending
    if contact.ending:  # all digits of a are those of a series that begins nearby
        return np.inf, d * (1.0 - NEARBY), False
    return d, left, last


@jit
def press(contact, stops, o, records, t, k, s, u):
    """The contact over the time u of its series, which begins at offset s of cell k."""
    side = contact.pressed
    n = lane_of(side)
    sample_contact(contact, stops, o, records, k, side, s, s + u)
    add_contact(records.sums, o, contact.push, wall_of(stops, side), side, u)
    contact.time += u
    o.pressed_time += u
    if contact.watched:
        watch_contact(contact, o, side, u)
    if t.wanted:
        contact.acceleration = second_derivative(o.c[0], u)
        if contact.fast == 0:
            carry_matrix(contact, side, u)
    go_on_in_contact(contact, o, u)
    contact.entered = False
    contact.uncarried += u
    if t.wanted and contact.fast > 0:
        fly_vectors_apart(t, o.lane, contact, side, n, contact.fast, u)
        contact.uncarried = 0.0


@jit
def carry_on(contact, o, t):
    """Carry tangent vectors to where the contact is."""
    if contact.uncarried > 0.0:
        carry_over_contact(t, o.lane, contact, contact.pressed, contact.uncarried, False)
        contact.begun, contact.uncarried = CONTINUED, 0.0
        begin_matrix(contact)


@jit
def try_slow_motion(contact, q, o, t, k, s):
    """Follow the slow motion alone from here on, if the fast one has died away."""
    side, i = contact.pressed, o.lane
    n = lane_of(side)
    contact.fast = fast_that_died(contact, o, n, q.omega)
    if contact.fast == 0 or not t.wanted:
        return
    carry_on(contact, o, t)
    bring_stops(contact, o, k, s, q.width)
    if contact.relaxed[1 - n] > 0.0 or not set_vectors_apart(t, i, contact, side, n, contact.fast):
        contact.fast = 0


@jit
def leave_cell(law, stops, o, t, k, s, side, ended):
    """Take the orbit's state from a contact at offset s of cell k, where the cell or the contact has ended."""
    contact = law.orbits[o.lane]
    contact.work += stored_energy(contact, lane_of(side))
    leave(contact, o, stops, side)
    if t.wanted:
        if ended or contact.uncarried > 0.0:
            carry_over_contact(t, o.lane, contact, side, contact.uncarried, ended)
        t.cell[o.lane], t.offset[o.lane] = k, s
    contact.begun = CONTINUED
    keep_in_log(law, contact, o, k, s, ended)


@jit
def end_contact(law, stops, o, t, k, s):
    """The mass leaves the stop: exactly where the guard that ends the contact is zero."""
    contact, side = law.orbits[o.lane], o.resting
    n, y = lane_of(side), contact.y
    guard, then = contact.guard[n, contact.ended_by], contact.then[n, contact.ended_by]
    if then == AT_PLACE:
        y[0], y[1] = 0.0, min(y[1], 0.0)
    elif guard[1] * math.sqrt(contact.stiffness[n]) < guard[0]:  # what is better conditioned
        y[0] = -(guard[1] * y[1] + guard[2]) / guard[0]
    else:
        y[1], contact.low[1] = -(guard[0] * y[0] + guard[2]) / guard[1], 0.0
    if then == RELAXES:
        contact.relaxed[n] = contact.left[n] = y[0]
        contact.cell[n], contact.offset[n] = o.period * o.cells + k, s
    contact.close_until = o.period * o.cells + k + o.cells
    o.resting = contact.pressed = 0.0
    if contact.touched > 0.0:
        contact.restitutions -= y[1] / contact.touched
        contact.ended += 1
    leave_cell(law, stops, o, t, k, s, side, True)


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
        x, v = evaluate(o.c[0], u)
        samples[i, 0], samples[i, 1] = wall_of(stops, side) + side * x, side * v
        for j in range(1, len(contact.push)):
            x, v = evaluate(o.c[j], u)
            samples[i, 2 * j] = x + contact.push[j] * samples[i, 0]
            samples[i, 2 * j + 1] = v + contact.push[j] * samples[i, 1]
        i += 1
    o.samples_taken = i
