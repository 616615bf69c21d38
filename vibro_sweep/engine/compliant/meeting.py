"""What happens to eight orbits that meet a stop in their cells: an impact, or the passage through a contact."""

from vibro_sweep.engine.compliant.distance import finer_at, is_close_to_stop
from vibro_sweep.engine.compliant.passage import pass_contacts
from vibro_sweep.engine.compliant.passage_series import of_stop
from vibro_sweep.engine.compliant.relaxing import bring_stops, relaxed_after
from vibro_sweep.engine.motion.section import end_period
from vibro_sweep.engine.motion.strike import find_contact, gaps_at, rebound, strike
from vibro_sweep.engine.simd.columns import transposed
from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import bits, lanes_of
from vibro_sweep.engine.simd.memory import put, row


@inline
def meet_stops(law, strikes, waiting):
    """Cross a cell. Returns those, as bits, that fly freely, that meet a stop once, and that pass a contact with it."""
    if law is not None:
        return meet_stops_of(law, strikes, waiting)
    free, struck = strike(strikes, lanes_of(waiting))
    return free, struck, 0


@noinline
def meet_stops_of(law, strikes, waiting):
    """`meet_stops` where some stops are compliant."""
    passage, z = law.passage[0], transposed(strikes.z, strikes.tail)
    (right, left), finer = gaps_at(strikes, z), row(passage.finer, 0)
    free, touching, side, d, v, a, third = find_contact(strikes, z, right - finer, left + finer, lanes_of(waiting))
    free = free & ~(row(passage.close, 0) > 0.0)
    compliant = touching & (of_stop(passage.compliant, side > 0.0) > 0.0)
    struck, passed = touching & ~compliant, touching & ~touching
    if bits(struck) != 0:
        struck = rebound(strikes, z, struck, side, d, v, a, third)
    if bits(compliant) != 0:
        put(strikes.side, 0, side)
        put(strikes.offset, 0, d)
        passed = pass_contacts(passage, strikes, z, compliant, side, d, v)
    return bits(free), bits(struck | passed), bits(passed)


@inline
def is_open(law, e, o, k, readings):
    """Whether an orbit may meet a stop together with others in its cell k."""
    if law is not None:
        return is_open_to(law, e, o, k, readings)
    return True


@jit
def is_open_to(law, e, o, k, readings):
    """`is_open` where some stops are compliant: those that single contacts are kept of, or with stops that still relax,
    go alone. Sets how long a contact may last: over the section, if nothing but the state is read there.
    """
    contact, passage, i, records = law.orbits[o.lane], law.passage[0], o.lane, e.records
    alone = law.log.shape[1] > 0 or len(records.times) > 0 or records.impacts.shape[1] > 0
    if contact.relaxed[0] > 0.0 or contact.relaxed[1] > 0.0:
        bring_stops(contact, o, k, 0.0, e.strike[0].width[i])
    read = readings.parts > 0 and (o.done + 1) * readings.parts >= (o.read + 1) * o.periods
    passage.watched = contact.watched
    passage.finer[i] = finer_at(o, k)
    passage.close[i] = int(is_close_to_stop(contact, o, e.strike[0].width[i]))
    passage.ahead[i] = o.cells - k
    passage.last[i] = passage.ahead[i] + (o.cells if o.done + 1 < o.goal and not read else 0)
    return not (alone or contact.relaxed[0] > 0.0 or contact.relaxed[1] > 0.0)


@inline
def finish_meeting(law, e, o, f, passed, readings):
    """Finish what an orbit did at a stop: where it `passed` a contact, count that, and bring the orbit over the cells
    and the section that lie within."""
    if law is not None:
        if passed:
            finish_passage(law, e, o, f, readings)
        else:
            o.finer[0] = 0.0


@noinline
def finish_passage(law, e, o, f, readings):
    """`finish_meeting` of a contact."""
    contact, passage, i, q = law.orbits[o.lane], law.passage[0], o.lane, f.oscillator[0]
    n, crossed = 1 if e.strike[0].side[i] > 0.0 else 0, int(passage.crossed[i])
    contact.contacts[n] += 1
    contact.ended += 1
    contact.time += passage.time[i]
    contact.restitutions -= passage.speed_after[i] / passage.speed[i]
    if contact.watched:
        contact.peak = max(contact.peak, passage.largest[i])
        contact.peak_force = max(contact.peak_force, contact.mass * passage.strongest[i])
    o.pressed_time += passage.time[i]
    o.log_volume -= passage.damping[n, i] * passage.time[i]
    k = o.cell + crossed
    contact.close_until = o.period * o.cells + k + o.cells
    if passage.place[i] > 0.0:
        contact.left[n] = passage.place[i]
        contact.relaxed[n] = passage.place[i]
        contact.relaxed[n] = relaxed_after(contact, n, passage.rest[i])
        contact.cell[n], contact.offset[n] = o.period * o.cells + k + 1, 0.0
    if k >= o.cells:
        end_period(e, o, q, f.nodes, row(passage.X, i), readings)
        k -= q.cells
    o.cell, o.finer[0] = k, passage.finer[i]
