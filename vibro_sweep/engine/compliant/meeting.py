"""What happens to eight orbits that meet a stop in their cells: an impact, or the passage through a contact."""

from vibro_sweep.engine.compliant.contact_rows import of_stop
from vibro_sweep.engine.compliant.passage import pass_contacts
from vibro_sweep.engine.compliant.passed_contacts import count_passed
from vibro_sweep.engine.compliant.relaxing import bring_stops, relaxed_after
from vibro_sweep.engine.motion.distance import finer_at, is_close_to_stop
from vibro_sweep.engine.motion.orbits import round_off
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
        count_passed(passage, passed, side > 0.0)
    return bits(free), bits(struck | passed), bits(passed)


@inline
def is_open(law, e, o, k, readings):
    """Whether an orbit may meet a stop together with others in its cell k."""
    if law is not None:
        alone = law.log.shape[1] > 0 or len(e.records.times) > 0 or e.records.impacts.shape[1] > 0
        read = readings.parts > 0 and (o.done + 1) * readings.parts >= (o.read + 1) * o.periods
        return not alone and is_open_to(
            law.orbits[o.lane], law.passage[0], o, k, e.flights.oscillator[o.table, 0], read
        )
    return True


@jit
def is_open_to(contact, passage, o, k, q, read):
    """`is_open` where some stops are compliant: those with stops that still relax go alone, and those that single
    contacts are kept of. Sets how long a contact may last: over the section, if nothing but the state is `read` there.
    """
    i = o.lane
    if contact.relaxed[0] > 0.0 or contact.relaxed[1] > 0.0:
        bring_stops(contact, o, k, 0.0, q.width)
    passage.watched = contact.watched
    passage.finer[i] = finer_at(o, k)
    passage.close[i] = int(is_close_to_stop(contact, o, q))
    passage.ahead[i] = o.cells - k
    passage.last[i] = passage.ahead[i] + (o.cells if o.done + 1 < o.goal and not read else 0)
    return not (contact.relaxed[0] > 0.0 or contact.relaxed[1] > 0.0)


@inline
def finish_meeting(law, e, o, f, passed, readings):
    """Finish what an orbit did at a stop: where it `passed` a contact, bring it over the cells and the section that lie
    within."""
    if law is not None:
        if passed:
            finish_passage(law.orbits[o.lane], law.passage[0], e.strike[0], o)
            if o.cell >= o.cells:
                pass_section(law.passage[0], e, o, f, readings)
        else:
            round_off(o)


@jit
def finish_passage(contact, passage, strikes, o):
    """`finish_meeting` of a contact, up to the section. The stop that it leaves begins to relax."""
    i = o.lane
    o.cell += int(passage.crossed[i])
    contact.close_until = o.period * o.cells + o.cell + o.cells
    if passage.place[i] > 0.0:
        n = 1 if strikes.side[i] > 0.0 else 0
        contact.touched_last = n
        contact.left[n] = contact.relaxed[n] = passage.place[i]
        contact.relaxed[n] = relaxed_after(contact, n, passage.rest[i])
        contact.cell[n], contact.offset[n] = o.period * o.cells + o.cell + 1, 0.0
    round_off(o)
    o.finer[0] = passage.finer[i]


@noinline
def pass_section(passage, e, o, f, readings):
    """Bring an orbit over the section that it crossed in contact."""
    k, finer, q = o.cell, o.finer[0], f.oscillator[0]
    end_period(e, o, q, f.nodes, row(passage.X, o.lane), readings)
    o.cell, o.finer[0] = k - q.cells, finer
