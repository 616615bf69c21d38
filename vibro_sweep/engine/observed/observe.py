"""What a scene observes of orbits: section points, their period, impacts, exponents.

An orbit goes through phases: its transient, at the end of which tangent vectors warm up; the record; and, if it turns
out to be periodic and exponents are wanted, three times one more period, the last of them beside the orbit. One that
its record shows to be under way may go through all of them again, from where the record ended (`settle`).
"""

import numpy as np

from vibro_sweep.engine.compliant.law import clear_contacts
from vibro_sweep.engine.compliant.relaxing import bring_stops, place_at
from vibro_sweep.engine.motion.orbits import reset_counts
from vibro_sweep.engine.observed.arrival import REPEAT, ROUNDING, is_under_way, look, set_scale
from vibro_sweep.engine.observed.averages import keep_averages
from vibro_sweep.engine.point_tables import to_masses
from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import put
from vibro_sweep.engine.variational.growth import excess_of_record, start_in_two
from vibro_sweep.engine.variational.multiplier_groups import BESIDE
from vibro_sweep.engine.variational.multipliers import begin_period, read_period
from vibro_sweep.engine.variational.spectrum import (
    begin_warm_up,
    close_spectrum,
    end_warm_up,
    is_free,
    period_of,
    periods_read,
    time_average,
)
from vibro_sweep.tables import exponents
from vibro_sweep.tables import outcomes as status
from vibro_sweep.tables.exponents import LEAST_RECORD

TRANSIENT, WARM_UP, RECORD, FLOQUET, PHASES = 0, 1, 2, 3, 6

periods_to_go = jit(exponents.periods_to_go)


@noinline
def begin_phase(e, w, plan, phase, points, results, lanes):
    """Set the orbits out, of each of the `lanes` its number among the results. Returns how often the growth of their
    tangent vectors is to be read, or -1: nothing to do."""
    if phase == TRANSIENT:
        e.tangent[0].wanted = e.strike[0].measured = False
        for i in range(len(lanes)):
            e.orbits[i].periods = results[lanes[i]].more - plan.warm_up
        return 0
    if phase == RECORD:
        e.strike[0].measured = plan.impacts
        set_out(e, plan.record)
        for i in range(len(lanes)):
            reset_counts(e.orbits[i])
            begin_contacts(e.law, e.tangent[0], i, plan.contacts)
            put(e.orbits[i].largest, 0, 0.0)
            e.orbits[i].impacts_logged, e.orbits[i].log_side = 0, plan.section_side
            if plan.energy and e.orbits[i].status == status.OK:
                keep_begin(e, w, points[lanes[i]], results[lanes[i]], e.orbits[i])
        return plan.parts
    if not plan.lyapunov or (plan.order > 0 and phase == FLOQUET + BESIDE):  # points of the map may be behind a stop
        return -1
    if phase == WARM_UP:
        begin_warm_up(e, len(lanes))
        set_out(e, plan.warm_up)
        return 0
    set_out(e, 0)
    begin_period(e, w, results, lanes, phase - FLOQUET)
    return 1


@jit
def set_out(e, periods):
    """The orbits are to be carried over so many periods."""
    for i in range(LANES):
        e.orbits[i].periods = periods


@noinline
def end_phase(e, w, plan, phase, points, results, sections, phases, running, lanes):
    """Keep what the phase has shown. One row for each orbit; `lanes` as of `begin_phase`."""
    if phase == WARM_UP:
        end_warm_up(e, len(lanes))
    elif phase == RECORD:
        for i in range(len(lanes)):
            k, o = lanes[i], e.orbits[i]
            if o.status == status.OK:
                keep_record(e, w, plan, points[k], results[k], sections[k], phases[k], running[k], o)
    elif phase >= FLOQUET:
        read_period(e, w, results, lanes, phase - FLOQUET)


@jit
def keep_begin(e, w, point, result, o):
    """Keep where the record begins."""
    for j in range(len(result.begin)):
        result.begin[j] = o.X[j]
    to_masses(point, result.begin[:], w.tables.row)
    result.begin_resting = o.resting
    keep_places(e.law, o, result, e.flights.oscillator[o.table, 0].width)


@inline
def keep_places(law, o, result, width):
    """Keep where stops are that relax."""
    if law is not None:
        for n in range(2):
            result.begin_relaxed[n] = place_at(law.orbits[o.lane], o, n, 0, 0.0, width)


@inline
def begin_contacts(law, t, i, watched):
    """Count the contacts of an orbit with compliant stops, and what they do to volumes, from here on."""
    if law is not None:
        start_in_two(t, i)
        clear_contacts(law.orbits[i], watched)


@inline
def keep_contacts(law, o, result, time, width):
    """Keep what is known of the contacts with compliant stops of the record, which lasts this time. width: of a
    cell."""
    if law is not None:
        contact = law.orbits[o.lane]
        bring_stops(contact, o, 0, 0.0, width)
        result.relaxed[0], result.relaxed[1] = contact.relaxed[0], contact.relaxed[1]
        result.contacts_left, result.contacts_right = contact.contacts[0], contact.contacts[1]
        result.contact_time = contact.time / time
        result.penetration_max = contact.peak if contact.peak > -np.inf else np.nan
        result.contact_force_max = contact.peak_force if contact.peak > -np.inf else np.nan
        result.restitution_mean = contact.restitutions / contact.ended if contact.ended > 0 else np.nan


@inline
def keep_excess(law, t, i, found):
    """Keep how much more than contacts do to volumes tangent vectors have grown by, up to the end of the record."""
    if law is not None:
        found.excess = excess_of_record(t, i)


@inline
def touches_of(law, o, result):
    """Impacts and contacts on the right and on the left: of a periodic orbit in the period in which they were counted
    last, else in the record."""
    right = o.impacts_right if result.period > 0 else result.impacts_right
    left = o.impacts_left if result.period > 0 else result.impacts_left
    if law is not None:
        contacts = law.orbits[o.lane].contacts
        right += contacts[1] if result.period > 0 else result.contacts_right
        left += contacts[0] if result.period > 0 else result.contacts_left
    return right, left


@noinline
def keep_record(e, w, plan, point, result, section, phase, running, o):
    """Keep the results of the record of an orbit."""
    result.impacts_right, result.impacts_left = o.impacts_right, o.impacts_left
    result.min_impact_speed = 0.0 if o.chatters > 0 else o.slowest if o.slowest < np.inf else np.nan
    result.contact_error = o.miss if o.slowest < np.inf else np.nan
    result.sticking_time = o.rest_time
    states, growth, T = w.section[o.lane], w.growth[o.lane], period_of(e, o)
    keep_contacts(e.law, o, result, plan.record * T, e.flights.oscillator[o.table, 0].width)
    numbers = len(result.end)
    for j in range(numbers):
        result.end[j] = o.X[j]
    to_masses(point, result.end[:], w.tables.row)
    if plan.states:
        turn_states(point, states, o, w.tables.row)
    if len(phase) > 0:
        keep_impacts(e, o, point, section, phase, w.tables.row)
    else:
        for n in range(len(section)):
            for j in range(numbers):
                section[n, j] = states[n, j]
    result.resting = o.resting
    if plan.states:
        set_scale(w.state[: states.shape[1]], o.largest, T)
        look(states, o, w.state, rounding_of(o, plan), w.fit, result)
    for n in range(len(running)):
        for j in range(numbers):
            running[n, j] = growth[n, j] / (periods_read(n, len(running), plan.record) * T)
    if plan.lyapunov:
        keep_excess(e.law, e.tangent[0], o.lane, w.multipliers[o.lane])
        time_average(growth, plan.record, plan.warm_up, T, result.lyapunov, result.lyapunov_error)


@jit
def rounding_of(o, plan):
    """The distance that rounding may leave between points that repeat themselves.

    Motion without impacts is linear: what repeats itself has no other period, and a free mode that keeps its energy
    adds up what rounding gives it, and drifts.
    """
    return REPEAT if is_free(o, plan) else ROUNDING


@jit
def turn_states(point, states, o, scratch):
    """The section states, and their sizes, of the masses themselves."""
    if not point.turned:
        return
    for j in range(states.shape[1]):
        o.largest[j] = 0.0
    for n in range(len(states)):
        to_masses(point, states[n], scratch)
        for j in range(states.shape[1]):
            o.largest[j] = max(o.largest[j], abs(states[n, j]))


@noinline
def close(e, w, plan, points, results, lanes):
    """Fill the results of the orbits that follow after all phases, and their statuses; `lanes` as of `begin_phase`."""
    for i in range(len(lanes)):
        o, point, result = e.orbits[i], points[lanes[i]], results[lanes[i]]
        failed = o.status != status.OK and o.status != status.NOT_COMPUTED
        if failed and result.status == status.NOT_SETTLED and result.period == 0:
            result.more = 0  # it has failed on its way: what is known of it is the record before
            continue
        if plan.lyapunov:
            if o.status == status.OK:
                close_spectrum(e, o, w, plan, point, result)
            else:  # averages of a record whose multipliers were not found
                put(result.lyapunov, 0, np.nan)
        if o.status != status.NOT_COMPUTED:
            result.status = o.status
        if plan.states and o.status == status.OK:
            right, left = touches_of(e.law, o, result)
            under_way = is_under_way(result) or (result.period == 0 and right + left == 0 and drifts(w.section[i]))
            if under_way and plan.record >= LEAST_RECORD:
                result.status = status.NOT_SETTLED
            if plan.attractors and not under_way:
                keep_averages(w.section[i], period_of(e, o), REPEAT, right, left, o, result)
        if o.status == status.OK:
            before = result.transient_periods + plan.record if result.transient_periods >= 0 else 0
            result.transient_periods = before + result.more
        result.more = periods_more(plan, result)


@jit
def drifts(states):
    """Whether a mass goes the same way from each section to the next one, and no less at the end: it goes away. Without
    contacts the motion is linear, and one that fades is known by its approach."""
    last = len(states) - 1
    for j in range(0, states.shape[1], 2):
        step = states[last, j] - states[0, j]
        going = last > 0 and abs(states[last, j] - states[last - 1, j]) > 0.5 * abs(states[1, j] - states[0, j])
        for n in range(last):
            going = going and (states[n + 1, j] - states[n, j]) * step > 0.0
        if going:
            return True
    return False


@jit
def periods_more(plan, result):
    """Forcing periods over which an orbit that is under way goes on before its next record; 0: this is its record.

    As many as its approach predicts, but at most as many again as it has been carried: far from where it goes it may
    have been faster, or slower.
    """
    so_far = result.transient_periods + plan.record
    if result.status != status.NOT_SETTLED or plan.settle <= so_far + plan.warm_up:
        return 0
    more = periods_to_go(result.approached_distance, result.approached_factor, 0.5 * REPEAT)
    if result.approached_distance == 0.0:  # it has arrived in the record
        more = 0.0
    more = min(more, float(so_far)) if more >= 0.0 else float(so_far)
    return int(min(max(more, 1.0 + plan.warm_up), plan.settle - so_far))


@jit
def keep_impacts(e, o, point, section, phase, scratch):
    """The logged impacts as points of an impact section; phase: omega t mod 2 pi."""
    width = e.flights.oscillator[o.table, 0].width
    for n in range(min(o.impacts_logged, len(phase))):
        row = e.records.impacts[o.lane, n]
        section[n, 0], section[n, 1] = o.stops[1] if row[3] > 0.0 else o.stops[0], row[4]
        for j in range(2, section.shape[1]):
            section[n, j] = row[3 + j]
        to_masses(point, section[n], scratch)
        phase[n] = point.omega * (row[1] * width + row[2])
    for n in range(min(o.impacts_logged, len(phase)), len(phase)):  # of an earlier record of an orbit that went on
        phase[n] = np.nan
        for j in range(section.shape[1]):
            section[n, j] = np.nan
