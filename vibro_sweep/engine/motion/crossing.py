"""One orbit through one cell, event by event to the cell's end.

On either side there may be a stop of each kind. From event to event the state and the phase of the force are sums of
two floats each. A contact with a compliant stop is followed in its own series to its end, or to the end of the cell,
and goes on in the next one. law: None where all stops are rigid; then nothing of the others is compiled.
"""

import numpy as np

from vibro_sweep.engine.compliant.law import is_compliant, is_pressed, lane_of
from vibro_sweep.engine.compliant.pressing import (
    end_contact,
    end_in_series,
    go_on_in_cell,
    load_pressed,
    press,
    stop_in_cell,
    takes_too_many,
)
from vibro_sweep.engine.compliant.relaxing import distance_to_touch, place_of_stop, relax_stops, series_of_stops
from vibro_sweep.engine.compliant.touching import after_contact, meet
from vibro_sweep.engine.motion.distance import begin_finely, delta_of, set_delta
from vibro_sweep.engine.motion.energy_sums import add_flight
from vibro_sweep.engine.motion.first_contact import first_contact, set_gap, size_at
from vibro_sweep.engine.motion.force_phase import set_phase, turn_phase
from vibro_sweep.engine.motion.impacts import EXPLAINED, end_chatter, impact, is_beyond
from vibro_sweep.engine.motion.orbits import add_change, advance_exactly, is_finite, take_samples
from vibro_sweep.engine.motion.rest import (
    begin_rest,
    carry_tangent,
    chatter,
    end_rest,
    first_nonzero,
    first_release,
    load_rest,
)
from vibro_sweep.engine.simd.jit import jit, noinline
from vibro_sweep.engine.simd.memory import row
from vibro_sweep.engine.tables.flight import bounds, load
from vibro_sweep.engine.tables.twofold import add
from vibro_sweep.tables import outcomes as status

MOST_EVENTS = 100_000  # impacts, grazes and rests in one forcing period; an orbit that needs more gets a status
LARGEST = 1e100  # of a state beside a compliant stop: its square has to be a number


@noinline
def cross_cell(law, f, stops, o, records, t, k, s):
    """Follow the orbit from offset s in cell k to the cell's end, through all that happens. Returns a status."""
    q, node, X, c1 = f.oscillator[0], f.nodes[k], o.X, o.c[0]
    # sides of the stop that it has just met, and that it leaves; order of the zero with which it does
    hit, leaving, order, released, s_low = 0.0, 0.0, 0, False, 0.0
    if law is not None:
        if not (abs(X[0]) < LARGEST and abs(X[1]) < LARGEST):
            return status.NOT_FINITE
    if s == 0.0:
        begin_finely(law, o, k)
        if law is None and is_beyond(stops, o, f, k):
            return status.BEYOND_STOP
    if is_pressed(law, o):
        go_on_in_cell(law, o, t)
    else:
        set_phase(o, node.z[2 * len(o.c)], node.z[2 * len(o.c) + 1])
        if s > 0.0:
            turn_phase(o, q.omega, s)
    while o.events < MOST_EVENTS:
        remaining = (q.width - s) - s_low
        stays, side = o.resting != 0.0, o.resting
        if stays:
            if is_pressed(law, o) and takes_too_many(law, o):
                return status.TOO_STIFF
            d, left, last = stay(law, q, o, t, k, s, remaining)
        else:
            last = remaining <= 1.001 * q.step
            left, last = series_of_stops(law, o, k, s, q.width, remaining if last else q.step, last)
            side = leaving if leaving != 0.0 else hit if hit != 0.0 else place_of(law, o, stops)
            rigid = side != 0.0 and not is_compliant(law, o, side)
            if rigid and side * X[1] > 0.0:
                impact(f, stops, o, records, t, k, s, side)
                o.finer[1] = 0.0
            load(q.series, row(X, 0), o.phase[0], o.phase[1], o.c)
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
                        turn_phase(o, q.omega, w)
                        s, s_low = add(s, s_low, w, 0.0)
                        begin_rest(f, o, records, t, k, s, side, w)
                        continue
            if law is not None:
                if side != 0.0 and leaving == 0.0 and not rigid:
                    order = meet(law, f, stops, o, records, t, k, s, side, hit != 0.0, released)
                    if order <= 0:
                        hit, released = 0.0, False
                        leaving, order = side if order < 0 else 0.0, 1
                        continue
            hit, leaving, released = 0.0, 0.0, False
            d, side = next_touch(law, q, o, stops, side, order, reach, left)
        if d != d:
            return status.UNRESOLVED
        end = min(d, left)
        pass_time(law, q, stops, o, records, t, k, s, end)
        turn_phase(o, q.omega, end)
        s, s_low = add(s, s_low, end, 0.0)
        ends = d == np.inf and (last or not is_finite(o))
        if not stays:
            relax_stops(law, o, end, k + 1 if ends else k, 0.0 if ends else s)
        if ends:
            if is_pressed(law, o):
                stop_in_cell(law, stops, o, t, k, s)
            return status.OK if is_finite(o) else status.NOT_FINITE
        if d == np.inf:
            continue
        if stays:
            hit, leaving, order, released = leave_stop(law, stops, o, records, t, k, s)
            continue
        hit, place = side, place_of_stop(law, o, side)
        miss = abs(delta_of(o, stops, side) - place)
        if miss > EXPLAINED * size_at(c1, d):
            return status.BEYOND_STOP
        o.miss = max(o.miss, miss)
        set_delta(o, stops, side, place)
        if place == 0.0 and side * X[1] <= 0.0:  # it touched the stop without speed: a graze is not an impact
            X[1] = o.finer[1] = 0.0
            o.events += 1
    return status.EVENT_LIMIT


@jit
def stay(law, q, o, t, k, s, remaining):
    """The series of the motion at a stop, pressed or at rest, from offset s of cell k on.

    Returns when the stop is left, infinite if not within the series; how far this is followed, and whether to the end
    of the cell, which is `remaining` away.
    """
    most, reach = np.inf, q.rest_step
    if law is not None:
        contact, n = law.orbits[o.lane], lane_of(o.resting)
        if contact.pressed != 0.0:
            reach = load_pressed(contact, q, o, t, k, s, remaining)
        elif contact.compliant[n]:
            most = contact.preload[n]
    last = remaining <= 1.001 * reach
    left = remaining if last else reach
    if law is not None:
        contact = law.orbits[o.lane]
        if contact.pressed != 0.0:
            return end_in_series(contact, o, left, last)
    load_rest(q, o)
    return first_release(o, left, most), left, last


@jit
def pass_time(law, q, stops, o, records, t, k, s, u):
    """Observe the motion over the time u of its series, from offset s of cell k on, and bring the state there."""
    if law is not None:
        contact = law.orbits[o.lane]
        if contact.pressed != 0.0:
            press(contact, stops, o, records, t, k, s, u)
            return
    take_samples(o, records, k, s, s + u)
    add_flight(records.sums, o, u)
    if o.resting == 0.0:
        advance_exactly(o, u)
        return
    for m in range(1, len(o.c)):
        add_change(o, m, u)
    o.rest_time += u
    if t.wanted:
        carry_tangent(t, o, q, u)
        t.cell[o.lane], t.offset[o.lane] = k, s + u


@jit
def leave_stop(law, stops, o, records, t, k, s):
    """The mass leaves the stop at offset s of cell k, after a contact or a rest. Returns of the flight to come the side
    of the stop that it is at without speed, or of the one that it leaves, the order of the zero with which it does,
    and whether a rest has ended."""
    if law is not None:
        contact, side = law.orbits[o.lane], o.resting
        if contact.pressed != 0.0:
            end_contact(law, stops, o, t, k, s)
            hit, leaving, order = after_contact(contact, o.X, side)
            return hit, leaving, order, False
    end_rest(o, records, k, s)
    return 0.0, 0.0, 1, True


@jit
def place_of(law, o, stops):
    """The side of the stop that the mass is at, or inside; 0 between the stops."""
    if delta_of(o, stops, 1.0) >= place_of_stop(law, o, 1.0):
        return 1.0
    return -1.0 if delta_of(o, stops, -1.0) >= place_of_stop(law, o, -1.0) else 0.0


@jit
def next_touch(law, q, o, stops, side, order, reach, left):
    """Offset and side of the first touch in the time `left`. side: of the stop that is left, or 0."""
    right = touch_of(law, q, o, stops, 1.0, order if side > 0.0 else 0, reach, left)
    other = touch_of(law, q, o, stops, -1.0, order if side < 0.0 else 0, reach, min(left, right))
    if not (other >= right or right != right):  # NaN, too, is passed on
        return other, -1.0
    return right, 1.0


@jit
def touch_of(law, q, o, stops, side, order, reach, left):
    """Offset of the first touch of the stop on `side`, infinite if there is none. order: of the zero that the distance
    from it begins with."""
    delta = delta_of(o, stops, side)
    if order == 0 and -delta > reach:
        return np.inf
    if law is not None:
        if place_of_stop(law, o, side) > 0.0:
            return distance_to_touch(law.orbits[o.lane], o, side, delta, order, left)
    set_gap(o.gap, o.c[0], -delta, side, order)
    return first_contact(o.gap, bounds(q, o.gap[:])[1], left)
