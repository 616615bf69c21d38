"""One orbit through one cell, event by event to the cell's end, where a stop is compliant.

As motion/impacts.py has it for rigid stops; a stop of each kind may be on either side. A contact is followed in its own
series to its end, or to the end of the cell, and goes on in the next one.
"""

import numpy as np

from vibro_sweep.engine.compliant.contact_series import leaves_by_force
from vibro_sweep.engine.compliant.distance import begin_finely, delta_of, set_delta
from vibro_sweep.engine.compliant.force_phase import set_phase, turn_phase
from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.pressing import TOO_MANY, begin_contact, stay_in_contact
from vibro_sweep.engine.compliant.relaxing import bring_stops, reach_of_relaxing, relax_by, set_distance, speed_of_stop
from vibro_sweep.engine.motion.energy_sums import add_flight
from vibro_sweep.engine.motion.first_contact import polished_contact, set_gap
from vibro_sweep.engine.motion.impacts import (
    EXPLAINED,
    MOST_EVENTS,
    end_chatter,
    impact,
    size_at,
)
from vibro_sweep.engine.motion.orbits import advance_exactly, is_finite, round_off, take_samples, wall_of
from vibro_sweep.engine.motion.rest import begin_rest, chatter, first_nonzero, stay_at_rest
from vibro_sweep.engine.simd.jit import jit, noinline
from vibro_sweep.engine.simd.memory import row
from vibro_sweep.engine.tables.flight import bound_third_over, bounds, load
from vibro_sweep.tables import outcomes as status

LARGEST = 1e100  # of a state: its square has to be a number
NEAR = 8.0 * 2.0**-52  # of the place of a stop, or the depth of its preload: lower bounces are a rest on it


@noinline
def cross_cell_with_law(law, f, stops, o, records, t, k, s):
    """Follow the orbit from offset s in cell k to the cell's end, through all that happens. Returns a status."""
    q, node, X, c1, contact = f.oscillator[0], f.nodes[k], o.X, o.c[0], law.orbits[o.lane]
    released, hit, leaving, order = False, 0.0, 0.0, 0
    if not (abs(X[0]) < LARGEST and abs(X[1]) < LARGEST):
        return status.NOT_FINITE
    if s == 0.0:
        begin_finely(o, k)
    if contact.pressed == 0.0:
        set_phase(contact, node.z[2 * len(o.c)], node.z[2 * len(o.c) + 1])
        turn_phase(contact, q.omega, s)
    while o.events < MOST_EVENTS:
        left = q.width - s
        last = left <= 1.001 * q.step
        left = left if last else q.step
        sin, cos = contact.phase[0], contact.phase[1]
        if o.resting != 0.0:
            side, pressed = o.resting, contact.pressed != 0.0
            if pressed:
                d = stay_in_contact(law, f, stops, o, records, t, k, s)
            else:
                round_off(o)
                most = contact.preload[lane_of(side)] if contact.compliant[lane_of(side)] else np.inf
                d = stay_at_rest(f, o, records, t, k, s, sin, cos, most)
            if d != d:
                return status.UNRESOLVED
            if d == np.inf:
                return status.OK
            if d == TOO_MANY:
                return status.TOO_STIFF
            s += d
            if not pressed:
                turn_phase(contact, q.omega, d)
            released, leaving, order = not pressed, 0.0, 1
            if pressed:
                unrelaxed = contact.relaxed[lane_of(side)] > 0.0
                if unrelaxed or X[1] != 0.0:
                    leaving, order = side, 2 if unrelaxed else 1
                else:
                    hit = side
            continue
        bring_stops(contact, o, k, s, q.width)
        for n in range(2):
            if contact.relaxed[n] > 0.0:
                reach = reach_of_relaxing(contact, n, left)
                if s + reach == s < q.width:  # what is left of it takes no time
                    contact.relaxed[n] = 0.0
                else:
                    left, last = reach, last and not reach < left
        side = leaving if leaving != 0.0 else hit if hit != 0.0 else place_of(contact, o, stops)
        rigid = side != 0.0 and not contact.compliant[lane_of(side)]
        if rigid and side * X[1] > 0.0:
            impact(f, stops, o, records, t, k, s, side, sin, cos)
            o.finer[1] = 0.0
        load(q.series, row(X, 0), sin, cos, o.c)
        reach, third = bounds(q, c1)
        if rigid:
            order = 1
            if X[1] == 0.0:
                order = first_nonzero(c1, 3 if released else 2)
                if side * c1[order] > 0.0:
                    begin_rest(f, o, records, t, k, s, side, 0.0)
                    continue
            else:
                w = chatter(q, stops, o, third, side, left)
                if w < np.inf:
                    end_chatter(q, stops, o, records, k, s, side, w)
                    turn_phase(contact, q.omega, w)
                    s += w
                    begin_rest(f, o, records, t, k, s, side, w)
                    continue
        elif side != 0.0 and leaving == 0.0:
            order = meet(law, f, stops, o, records, t, k, s, side, hit != 0.0, released)
            if order <= 0:
                hit, released = 0.0, False
                leaving, order = side if order < 0 else 0.0, 1
                continue
        hit, leaving, released = 0.0, 0.0, False
        d, side = next_touch(q, contact, o, stops, side, order, reach, left)
        if d != d:
            return status.UNRESOLVED
        end = min(d, left)
        take_samples(o, records, k, s, s + end)
        add_flight(records.sums, o, end)
        advance_exactly(o, end)
        turn_phase(contact, q.omega, end)
        if d == np.inf and (last or not is_finite(o)):
            relax_by(contact, end, o.period * o.cells + k + 1, 0.0)
            return status.OK if is_finite(o) else status.NOT_FINITE
        s += end
        relax_by(contact, end, o.period * o.cells + k, s)
        if d == np.inf:
            continue
        hit, place = side, contact.relaxed[lane_of(side)]
        miss = abs(delta_of(o, stops, side) - place)
        if miss > EXPLAINED * size_at(c1, d):
            return status.BEYOND_STOP
        o.miss = max(o.miss, miss)
        set_delta(o, stops, side, place)
        if contact.relaxed[lane_of(side)] == 0.0 and side * X[1] <= 0.0:  # it touched without speed
            X[1] = o.finer[1] = 0.0
            o.events += 1
    return status.EVENT_LIMIT


@jit
def place_of(contact, o, stops):
    """The side of the stop that the mass is at, or inside; 0 between the stops."""
    if delta_of(o, stops, 1.0) >= contact.relaxed[1]:
        return 1.0
    return -1.0 if delta_of(o, stops, -1.0) >= contact.relaxed[0] else 0.0


@jit
def meet(law, f, stops, o, records, t, k, s, side, hit, released):
    """The mass is at a compliant stop, or starts inside: contact begins, or a rest on its preload (0); or it starts by
    leaving a stop that relaxes (-1); or the order of the zero with which the mass leaves it."""
    contact, n, X, c1 = law.orbits[o.lane], lane_of(side), o.X, o.c[0]
    speed, inside, p = side * X[1], delta_of(o, stops, side), contact.preload[n]
    relative, unrelaxed = speed - speed_of_stop(contact, n), contact.relaxed[n] > 0.0
    if not hit and inside - contact.relaxed[n] > EXPLAINED * (abs(X[0]) + abs(wall_of(stops, side))):
        if leaves_by_force(contact, side) and contact.stiffness[n] * inside + contact.damping[n] * speed + p < 0.0:
            contact.relaxed[n] = contact.left[n] = inside
            contact.cell[n], contact.offset[n] = o.period * o.cells + k, s
            return -1
        contact.relaxed[n] = 0.0
        begin_contact(law, f, stops, o, t, k, s, side, False)
        return 0
    a = 2.0 * side * c1[2]
    if not unrelaxed and p > 0.0 and 0.0 < a < p:
        height = speed * speed / (2.0 * min(a, p - a))
        size = max(abs(wall_of(stops, side)), p / contact.stiffness[n])
        if relative > 0.0 and height < NEAR * size:
            X[1] = o.finer[1] = relative = 0.0
            o.chatters += 1
    if relative > 0.0:
        begin_contact(law, f, stops, o, t, k, s, side, not unrelaxed)
        return 0
    if relative < 0.0 or unrelaxed:
        return 1
    if released and a > 0.5 * p > 0.0:  # what pressed it on exceeds the preload from here on: delta'' is zero
        begin_contact(law, f, stops, o, t, k, s, side, True)
        contact.least = 3
        return 0
    order = first_nonzero(c1, 3 if released else 2)
    if side * c1[order] <= 0.0:
        return order
    if order > 2 or a < p:
        if p > 0.0:
            begin_rest(f, o, records, t, k, s, side, 0.0)
            return 0
    begin_contact(law, f, stops, o, t, k, s, side, True)
    return 0


@jit
def touch_of(q, contact, o, stops, side, order, reach, left):
    """Offset of the first touch of the stop on `side`, infinite if there is none. order: of the zero that the distance
    from it begins with."""
    n, delta = lane_of(side), delta_of(o, stops, side)
    if order == 0 and -delta > reach:
        return np.inf
    if contact.relaxed[n] == 0.0:
        set_gap(o.gap, o.c[0], -delta, side, order)
        return polished_contact(o.gap, bounds(q, o.gap[:])[1], left)
    set_distance(contact, n, side, o.c[0], delta, order)
    if not contact.gap[0] > 0.0:
        return 0.0
    return polished_contact(contact.gap, bound_third_over(contact.gap, left), left)


@jit
def next_touch(q, contact, o, stops, side, order, reach, left):
    """Offset and side of the first touch. side: of the stop that is left, or 0."""
    right = touch_of(q, contact, o, stops, 1.0, order if side > 0.0 else 0, reach, left)
    other = touch_of(q, contact, o, stops, -1.0, order if side < 0.0 else 0, reach, min(left, right))
    if not (other >= right or right != right):  # NaN, too, is passed on
        return other, -1.0
    return right, 1.0
