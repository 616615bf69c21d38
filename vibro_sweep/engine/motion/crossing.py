"""One orbit through one cell, event by event to the cell's end.

On either side there may be a stop of each kind. From event to event the state and the phase of the force are sums of
two floats each. A contact with a compliant stop is followed in its own series to its end, or to the end of the cell,
and goes on in the next one. law: None where all stops are rigid; then nothing of the others is compiled.
"""

import numpy as np

from vibro_sweep.engine.compliant.law import is_compliant, is_pressed, lane_of
from vibro_sweep.engine.compliant.pressing import TOO_MANY, stay_in_contact
from vibro_sweep.engine.compliant.relaxing import distance_to_touch, place_of_stop, relax_stops, series_of_stops
from vibro_sweep.engine.compliant.touching import after_contact, meet
from vibro_sweep.engine.motion.distance import begin_finely, delta_of, set_delta
from vibro_sweep.engine.motion.energy_sums import add_flight
from vibro_sweep.engine.motion.first_contact import first_contact, set_gap, size_at
from vibro_sweep.engine.motion.force_phase import set_phase, turn_phase
from vibro_sweep.engine.motion.impacts import EXPLAINED, end_chatter, impact, is_beyond
from vibro_sweep.engine.motion.orbits import advance_exactly, is_finite, round_off, take_samples
from vibro_sweep.engine.motion.rest import begin_rest, chatter, first_nonzero, stay_at_rest
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
    if not is_pressed(law, o):
        set_phase(o, node.z[2 * len(o.c)], node.z[2 * len(o.c) + 1])
        if s > 0.0:
            turn_phase(o, q.omega, s)
    while o.events < MOST_EVENTS:
        left = (q.width - s) - s_low
        last = left <= 1.001 * q.step
        left = left if last else q.step
        if o.resting != 0.0:
            side, pressed = o.resting, is_pressed(law, o)
            d = stay(law, f, stops, o, records, t, k, s)
            if d != d:
                return status.UNRESOLVED
            if d == np.inf:
                return status.OK
            if d == TOO_MANY:
                return status.TOO_STIFF
            s += d
            released, leaving, order = not pressed, 0.0, 1
            if law is not None:
                if pressed:
                    hit, leaving, order = after_contact(law.orbits[o.lane], X, side)
            continue
        left, last = series_of_stops(law, o, k, s, q.width, left, last)
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
                    s += w
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
        take_samples(o, records, k, s, s + end)
        add_flight(records.sums, o, end)
        advance_exactly(o, end)
        turn_phase(o, q.omega, end)
        if d == np.inf and (last or not is_finite(o)):
            relax_stops(law, o, end, k + 1, 0.0)
            return status.OK if is_finite(o) else status.NOT_FINITE
        s, s_low = add(s, s_low, end, 0.0)
        relax_stops(law, o, end, k, s)
        if d == np.inf:
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
def stay(law, f, stops, o, records, t, k, s):
    """The mass stays at a stop from offset s of cell k on, in contact or at rest. Returns the time to the end of that,
    infinite if not in this cell."""
    most = np.inf
    if law is not None:
        contact, n = law.orbits[o.lane], lane_of(o.resting)
        if contact.pressed != 0.0:
            return stay_in_contact(law, f, stops, o, records, t, k, s)
        if contact.compliant[n]:
            most = contact.preload[n]
    round_off(o)
    d = stay_at_rest(f, o, records, t, k, s, most)
    if d < np.inf:
        turn_phase(o, f.oscillator[0].omega, d)
    return d


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
            return distance_to_touch(law.orbits[o.lane], side, o.c[0], delta, order, left)
    set_gap(o.gap, o.c[0], -delta, side, order)
    return first_contact(o.gap, bounds(q, o.gap[:])[1], left)
