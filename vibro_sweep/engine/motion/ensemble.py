"""The loop: eight orbits from section to section over the phase grid.

Each goes on by itself, over whole cells and periods, to the next candidate cell, in which it may strike
(`advance_to_candidates`); there all of them strike at once. None waits for another at a section, and none
depends on another.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.compliant.meeting import finish_meeting, is_open, meet_stops
from vibro_sweep.engine.compliant.passed_contacts import add_passed, clear_passed
from vibro_sweep.engine.compliant.tangent_passage import carry_through
from vibro_sweep.engine.motion.coast import fly_periods, is_clear
from vibro_sweep.engine.motion.crossing import cross_cell
from vibro_sweep.engine.motion.discontinuity import map_period
from vibro_sweep.engine.motion.distance import is_close
from vibro_sweep.engine.motion.energy_sums import are_wanted
from vibro_sweep.engine.motion.impacts import watch_rebound
from vibro_sweep.engine.motion.orbits import add_count, begin_free_flight, keep_start, load_constants, take_samples
from vibro_sweep.engine.motion.scan import (
    candidate_state,
    first_candidate,
    is_inside,
    next_watched,
    open_cell,
    state_at,
    state_from_base,
)
from vibro_sweep.engine.motion.section import end_period, end_period_here
from vibro_sweep.engine.motion.strike import clear_counts
from vibro_sweep.engine.motion.together import flight_of, records_of, stops_of
from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import LANES, lanes_of, lowest, number
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables.flight import load
from vibro_sweep.engine.variational import tangent, tangent_flight
from vibro_sweep.tables import outcomes as status

CELLS_BETWEEN_LOOKS = 2**21  # cells over which orbits are carried (some tenths of a second) before `halt` is read


class Mapping(NamedTuple):
    """The discontinuity mapping in place of the flow: a type of its own, so that it is compiled only if asked for."""

    order: int  # 1 or 2


@inline
def under_way(o):
    """Whether an orbit has periods to go."""
    return o.done < o.goal and o.status == status.OK


@noinline
def set_node_state(o, X):
    """Set X at the node that the orbit has reached, before `resolve_events`."""
    if o.from_base:
        keep_start(o)
    put(o.X, 0, X)


@inline
def is_behind(law, o):
    """Whether the orbit, at a node, is behind a compliant stop: the search for the next contact begins before it."""
    if law is not None:
        return not o.stops[0] <= o.X[0] <= o.stops[1]
    return False


@noinline
def resolve_events(e, o, f, readings):
    """Follow the orbit from event to event to the end of its cell, or of the cell in which M1 leaves the stop."""
    q = f.oscillator[0]
    if o.from_base and o.offset == 0.0 and o.resting == 0.0:
        if q.stiff and o.cell > o.origin:
            o.cell = open_cell(f, o, o.cell)
        put(o.X, 0, state_from_base(o, f.nodes, o.cell))
        if o.cell == q.cells:
            end_period_here(e, o, f, readings)
            return
    while True:
        events, rested = o.events, o.offset > 0.0 or o.resting != 0.0 or is_close(e.law, o, q)
        o.status = cross_cell(e.law, f, stops_of(o), o, records_of(e, o), e.tangent[0], o.cell, o.offset)
        free = not (rested or o.events > events)
        o.cell += 1
        if not free:
            begin_free_flight(o, f.nodes, row(o.X, 0))
        elif o.from_base:
            X = state_from_base(o, f.nodes, o.cell)
            put(o.X, 0, X)
            o.origin = o.cell
            put(o.y, 0, X - row(f.nodes[np.uint64(o.cell)].z, 0))
        o.offset = 0.0
        if (o.resting == 0.0 and not is_behind(e.law, o)) or o.status != status.OK:
            return
        if o.cell == q.cells:
            end_period_here(e, o, f, readings)
            if o.done == o.goal:
                return
        if o.from_base:
            keep_start(o)


@noinline
def put_states_from_base(e, waiting):
    """Set the states at the beginning of the cell of those orbits for which r is large."""
    for i in range(LANES):
        if waiting >> i & 1:
            o = e.orbits[i]
            keep_start(o)
            put(e.strike[0].z, i, state_from_base(o, flight_of(e, o).nodes, o.cell))


@noinline
def coast(e, o, f, readings):
    """Go on to the last section before the end, if the orbit can strike no more.

    It is one flight if nothing is recorded in between; no samples are taken.
    """
    q, t = f.oscillator[0], e.tangent[0]
    periods = o.periods - o.done - 1
    if periods == 0 or not is_clear(q, o):
        return
    if readings.keep or readings.parts > 0:
        while o.done + 1 < o.periods:
            end_period(e, o, q, f.nodes, state_at(o, f.nodes, o.ends), readings)
        return
    fly_periods(q, f.nodes[q.cells].E, o, periods)
    begin_free_flight(o, f.nodes, row(o.X, 0))
    o.period += periods
    o.done += periods
    if t.wanted:
        t.cell[o.lane] -= periods * q.cells


@inline
def find_candidate(e, o, f, readings):
    """Find the next candidate cell, over a section if there is none before it.

    The last section is left to `advance_to_candidates`.
    """
    if is_close(e.law, o, f.oscillator[0]):
        o.candidate = o.cell
        return
    o.candidate = first_candidate(f, o)
    if o.candidate == o.ends and o.done + 1 < o.goal:
        X = state_at(o, f.nodes, o.ends)
        if is_inside(o, number(X, 0)):  # else the last cell is a candidate
            end_period(e, o, f.oscillator[0], f.nodes, X, readings)
            o.candidate = first_candidate(f, o)


@inline
def advance_to_candidates(e, advancing, readings):
    """Carry these orbits, as bits, on to their next candidate cells. Returns, as bits, those that have one.

    Each step is done for all of them before the next, so that the processor has work while one waits for its numbers.
    """
    summed, strikes = are_wanted(e.records.sums), e.strike[0]
    sampled = summed or len(e.records.times) > 0
    waiting = 0
    while advancing != 0:
        for i in range(LANES):
            if advancing >> i & 1:
                o = e.orbits[i]
                if summed:
                    o.candidate = o.cell
                elif sampled:
                    o.candidate = next_watched(flight_of(e, o), o, records_of(e, o).times)
                else:
                    find_candidate(e, o, flight_of(e, o), readings)
        for i in range(LANES):
            if advancing >> i & 1:
                o = e.orbits[i]
                f = flight_of(e, o)
                q = f.oscillator[0]
                k, X = candidate_state(o, f.nodes)
                o.cell = k
                inside = k < o.crossed and o.stops[0] < number(X, 0) < o.stops[1] and not summed
                if inside and is_open(e.law, e, o, k, readings):
                    put(strikes.z, i, X)
                    waiting |= 1 << i
                    advancing ^= 1 << i
                    continue
                if k == o.ends:
                    end_period(e, o, q, f.nodes, X, readings)
                    if o.done < o.goal:
                        if q.middle + q.swing < o.stops[1] and not sampled:
                            coast(e, o, f, readings)
                        continue
                else:
                    set_node_state(o, X)
                    resolve_events(e, o, f, readings)
                    if under_way(o):
                        continue
                advancing ^= 1 << i
    return waiting


@noinline
def watch_cell(e, o, f, free):
    """Keep an impact in the cell, and samples: of free flight, or before and after the impact."""
    q, strikes, records, i = f.oscillator[0], e.strike[0], records_of(e, o), o.lane
    z, states = strikes.z[i], 2 * len(q.series)
    load(q.series, row(strikes.z, i), z[states], z[states + 1], o.c)
    if free:
        take_samples(o, records, o.cell, 0.0, q.width)
    else:
        watch_rebound(q, o, records, o.cell, strikes.offset[i], strikes.side[i], strikes.speed[i], strikes.impulse[i])


@noinline
def resolve_cell(e, o, free, struck, readings):
    """Finish the cell of an orbit that is recorded there, or that neither flies freely nor strikes once."""
    f, X = flight_of(e, o), row(e.strike[0].z, o.lane)
    if free or struck:
        watch_cell(e, o, f, free)
    else:
        set_node_state(o, X)
        resolve_events(e, o, f, readings)


@inline
def finish_cells(e, waiting, free, struck, passed, readings):
    """Go on to the ends of the cells in which the `waiting` may have struck. Returns those that have periods to go."""
    left = waiting & ~(free | struck)
    if len(e.records.times) > 0:
        left = waiting
    elif e.records.impacts.shape[1] > 0:
        left |= struck
    while left != 0:
        i = lowest(left)
        left &= left - 1
        resolve_cell(e, e.orbits[i], free >> i & 1, struck >> i & 1, readings)
        if not under_way(e.orbits[i]):
            waiting ^= 1 << i
    while free != 0:
        e.orbits[lowest(free)].cell += 1
        free &= free - 1
    while struck != 0:
        o = e.orbits[lowest(struck)]
        f = flight_of(e, o)
        if not passed >> o.lane & 1:
            o.fastest = max(o.fastest, abs(e.strike[0].speed[o.lane]))
        finish_meeting(e.law, e, o, f, passed >> o.lane & 1, readings)
        struck &= struck - 1
        o.cell += 1
        begin_free_flight(o, f.nodes, row(e.strike[0].X, o.lane))
    return waiting


@noinline
def begin(e, readings):
    """Set how far orbits are carried before `halt` is read again. Returns those that have periods to go, as bits."""
    waiting = 0
    for i in range(LANES):
        o = e.orbits[i]
        if e.halt[0] != 0:
            o.status = status.NOT_COMPUTED
        elif o.done >= o.goal and o.status == status.OK:
            o.goal = min(o.periods, o.done + max(1, CELLS_BETWEEN_LOOKS // o.cells))
        if under_way(o) and is_behind(e.law, o) and o.from_base:
            keep_start(o)
        if under_way(o) and (o.offset > 0.0 or o.resting != 0.0 or is_behind(e.law, o)):
            resolve_events(e, o, flight_of(e, o), readings)
        waiting |= int(under_way(o)) << i
    return waiting


@jit
def carry(e, mapping, readings):
    """Carry each orbit over its `periods`, of forcing or iterations of the discontinuity mapping; see its `status`.

    mapping: None for the flow, or the `Mapping` that takes its place.
    """
    t, strikes = e.tangent[0], e.strike[0]
    from_base = 0
    for i in range(LANES):
        o = e.orbits[i]
        o.done = o.read = o.goal = 0
        if o.periods > 0 and o.status == status.OK:  # of others there may be no tables
            load_constants(o, flight_of(e, o).oscillator[0])
            from_base |= o.from_base << i
    clear_counts(strikes)
    clear_passed(e.law)
    if mapping is not None:
        for i in range(LANES):
            iterate(e, e.orbits[i], mapping, readings)
        return
    waiting = begin(e, readings)
    while True:
        waiting = advance_to_candidates(e, waiting, readings)
        if waiting == 0:
            waiting = begin(e, readings)
            if waiting == 0:
                break
            continue
        if waiting & from_base != 0:
            put_states_from_base(e, waiting & from_base)
        free, struck, passed = meet_stops(e.law, strikes, waiting)
        if t.wanted and struck != 0:
            left = struck
            while left != 0:
                i = lowest(left)
                left &= left - 1
                o = e.orbits[i]
                f = flight_of(e, o)
                tangent_flight.aim(t, i, f.oscillator[0], f.nodes, o.cell, strikes.offset[i])
            tangent_flight.fly(t, lanes_of(struck))
            hit = struck & ~passed  # as a number: where all stops are rigid the compiler knows that there are some
            if hit != 0:
                tangent.saltate(t, lanes_of(hit), row(strikes.jump, 0) / row(strikes.speed, 0), row(strikes.R, 0))
            carry_through(e.law, e, passed)
        waiting = finish_cells(e, waiting, free, struck, passed, readings)
    for i in range(LANES):
        add_count(e.orbits[i], strikes.hits[0, i], strikes.hits[1, i], strikes.slowest[i], strikes.miss[i])
        add_passed(e.law, e.orbits[i])


@noinline
def iterate(e, o, mapping, readings):
    """Carry one orbit over its `periods` of the discontinuity mapping."""
    f = flight_of(e, o)
    stops, records = stops_of(o), records_of(e, o)
    while o.done < o.periods and o.status == status.OK and e.halt[0] == 0:
        o.status = map_period(f, stops, o, records, e.tangent[0], mapping.order == 2)
        if o.status == status.OK:
            end_period_here(e, o, f, readings)
    if e.halt[0] != 0:
        o.status = status.NOT_COMPUTED
