"""The loop: eight orbits from section to section over the phase grid.

Each goes on by itself, over whole cells and periods, to the next cell in which it may strike (`seek`); there all of
them strike at once. None waits for another at a section, and none depends on another.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.kernels import status, tangent
from vibro_sweep.kernels.discontinuity import map_period
from vibro_sweep.kernels.flight import CHUNK, Flight, load, new_flight
from vibro_sweep.kernels.impacts import cross_cell, watch_rebound
from vibro_sweep.kernels.jit import entry, jit
from vibro_sweep.kernels.lanes import LANES, bits, eight, lanes_of, leading_lanes, new_lines, put, row, select
from vibro_sweep.kernels.orbits import ORBIT, Records, Stops, add_count, new_records, sample, take_off
from vibro_sweep.kernels.strike import IMPULSE, OFFSET, SIDE, SPEED, STRIKE, start_count, strike
from vibro_sweep.kernels.tangent import TANGENT


class Ensemble(NamedTuple):
    """Eight orbits on their way."""

    flights: Flight  # with a first axis: the tables of each oscillator
    orbits: np.ndarray  # (LANES,) ORBIT
    strike: np.ndarray  # (1,) STRIKE
    tangent: np.ndarray  # (1,) TANGENT
    records: Records  # with a first axis: one for each orbit


def new_ensemble(cells: int, impacts: int = 0, rests: int = 0, samples: int = 0) -> Ensemble:
    """Orbits of oscillators with at most so many cells, and room for what is kept of each."""
    orbits = new_lines(LANES, ORBIT)
    orbits["lane"] = np.arange(LANES)
    return Ensemble(
        new_flight(LANES, cells),
        orbits,
        new_lines(1, STRIKE),
        new_lines(1, TANGENT),
        new_records(LANES, impacts, rests, samples),
    )


@jit
def flight_of(e, o):
    """The tables of an orbit's oscillator."""
    n = o.table
    return Flight(e.flights.oscillator[n : n + 1], e.flights.nodes[n], e.flights.scan[n])


@jit
def stops_of(o):
    """The stops of an orbit."""
    return Stops(o.stops[0], o.stops[1], o.stops[2])


@jit
def records_of(e, o):
    """What is kept of an orbit."""
    n = o.lane
    return Records(e.records.impacts[n], e.records.rests[n], e.records.times, e.records.samples)


@jit
def control_points(scan, p, q, y0, y1, y2, y3):
    """Control points p, ..., p + 7 of a flight that starts at (y0, ..., y3); q: as counted from there."""
    return (
        eight(scan[4], p)
        + eight(scan[0], q) * y0
        + eight(scan[1], q) * y1
        + eight(scan[2], q) * y2
        + eight(scan[3], q) * y3
    )


@jit
def at_node(nodes, k, base, y0, y1, y2, y3):
    """X - r at node k of a free flight that has X - r = (y0, ..., y3) at node `base`."""
    E = nodes[np.uint64(k - base)].E  # unsigned: else numba looks for negative indices
    return (row(E, 0) * y0 + row(E, 1) * y1) + (row(E, 2) * y2 + row(E, 3) * y3)


@jit
def first_suspect(f, o, first):
    """The first cell from `first` on in which contact cannot be excluded; `cells` if there is none. Takes X there.

    The orbit is in free flight from node `base`. The control points of all cells (tables.py) are looked at, `CHUNK` at
    a time; an end of a cell may lie outside though all control points before it are inside.
    """
    scan, nodes, cells, bound = f.scan, f.nodes, f.oscillator[0].cells, f.oscillator[0].remainder
    base, y0, y1, y2, y3 = o.base, o.y[0], o.y[1], o.y[2], o.y[3]
    margin = (bound[0] * abs(y0) + bound[1] * abs(y1)) + (bound[2] * abs(y2) + bound[3] * abs(y3)) + bound[4]
    low, high = o.stops[0] + margin, o.stops[1] - margin
    k = cells
    for p in range(2 * first, 2 * cells, CHUNK):
        q = p - 2 * base
        a = control_points(scan, p, q, y0, y1, y2, y3)
        b = control_points(scan, p + LANES, q + LANES, y0, y1, y2, y3)
        a_inside, b_inside = (a >= low) & (a <= high), (b >= low) & (b <= high)
        if bits(~(a_inside & b_inside)) != 0:
            n = leading_lanes(a_inside)
            k = min((p + n + (leading_lanes(b_inside) if n == LANES else 0)) // 2, cells)
            break
    if k == base:  # X is known there, and better
        return k
    put(o.X, 0, at_node(nodes, k, base, y0, y1, y2, y3) + row(nodes[np.uint64(k)].z, 0))
    if k > first and not (low <= o.X[0] <= high):
        k -= 1
        put(o.X, 0, at_node(nodes, k, base, y0, y1, y2, y3) + row(nodes[k].z, 0))
    return k


@jit
def fly_to_node(o, nodes):
    """X after the free flight from `base` to the cell where the orbit is."""
    y = at_node(nodes, o.cell, o.base, o.y[0], o.y[1], o.y[2], o.y[3])
    put(o.X, 0, y + row(nodes[o.cell].z, 0))


@jit
def end_period(e, o, q, nodes, section, keep, growth, parts):
    """Take the orbit over the section."""
    o.cell = o.events = o.samples_taken = 0
    take_off(o, nodes)
    o.period += 1
    if keep:
        for i in range(4):
            section[o.lane, o.done, i] = o.X[i]
    o.done += 1
    t = e.tangent[0]
    if t.wanted:
        t.cell[o.lane] -= q.cells
        if parts > 0 and o.done * parts >= (o.read + 1) * o.periods:
            tangent.read_growth(t, o.lane, q, nodes, growth[o.lane, o.read])
            o.read += 1


@jit
def go_long_way(e, o, f, stops):
    """Follow the orbit to the end of its cell through all that happens."""
    q = f.oscillator[0]
    events, rested = o.events, o.offset > 0.0 or o.resting != 0.0
    o.status = cross_cell(f, stops, o, records_of(e, o), e.tangent[0], o.cell, o.offset)
    free = not (rested or o.events > events)
    o.cell += 1
    if free and q.stiff:
        fly_to_node(o, f.nodes)
    if q.stiff or not free:  # the less of a fast mode is left, the tighter the scan
        take_off(o, f.nodes)
    o.offset = 0.0


@jit
def seek(e, o, section, keep, growth, parts):
    """Carry an orbit on to the next cell in which it may strike. Whether there is one."""
    if o.done >= o.periods or o.status != status.OK:
        return False
    f = flight_of(e, o)
    q, nodes, X, t = f.oscillator[0], f.nodes, o.X, e.strike[0]
    stops = stops_of(o)
    sampled = len(e.records.times) > 0
    while o.done < o.periods and o.status == status.OK:
        if o.offset == 0.0 and o.resting == 0.0:
            if not sampled:
                o.cell = first_suspect(f, o, o.cell)
            elif o.cell > o.base:
                fly_to_node(o, nodes)
        if o.cell == q.cells:
            end_period(e, o, q, nodes, section, keep, growth, parts)
            continue
        if o.offset == 0.0 and o.resting == 0.0 and stops.left < X[0] < stops.right and not q.stiff:
            put(t.z, o.lane, row(X, 0))
            return True
        go_long_way(e, o, f, stops)
    return False


@jit
def settle(e, o, free, struck):
    """Go on to the end of the cell in which the orbit may have struck."""
    f, t, i = flight_of(e, o), e.strike[0], o.lane
    if not (free or struck):
        go_long_way(e, o, f, stops_of(o))
        return
    q, X, records = f.oscillator[0], o.X, records_of(e, o)
    watched = len(records.times) > 0 or (struck and len(records.impacts) > 0)
    if watched:
        load(q.series1, X[0], X[1], X[2], X[3], X[4], X[5], o.c1)
        load(q.series2, X[0], X[1], X[2], X[3], X[4], X[5], o.c2)
    if free:
        if watched:
            sample(o, records, o.cell, 0.0, q.width)
        o.cell += 1
        return
    hit = t.hit[i]
    if watched:
        watch_rebound(q, o, records, o.cell, hit[OFFSET], hit[SIDE], hit[SPEED], hit[IMPULSE])
    put(o.y, 0, row(X, 0) - row(f.nodes[o.cell].z, 0))
    o.cell += 1
    o.base = o.cell
    put(o.y, 0, at_node(f.nodes, 1, 0, o.y[0], o.y[1], o.y[2], o.y[3]) + select(lanes_of(15), row(hit, 0), 0.0))
    put(X, 0, row(o.y, 0) + row(f.nodes[o.cell].z, 0))


@entry
def carry(e, mapped, section, keep, growth, parts):
    """Carry each orbit over its `periods`, of forcing or iterations of the discontinuity mapping; see its `status`.

    mapped: None for the flow, for which the mapping then need not be compiled. section: (LANES, periods, 4) for the
    states at their ends, if they are to be kept. growth: (LANES, parts, 4) for the logarithms of the growth of the
    tangent vectors, read after each of so many parts of the periods.
    """
    t, s = e.tangent[0], e.strike[0]
    for i in range(LANES):
        e.orbits[i].done = e.orbits[i].read = 0
    start_count(s)
    waiting = free = struck = 0
    while True:
        before, waiting = waiting, 0
        for i in range(LANES):
            o, lane = e.orbits[i], 1 << i
            if mapped is not None:
                iterate(e, o, section, keep, growth, parts)
                continue
            if before & lane:
                settle(e, o, free & lane, struck & lane)
            if seek(e, o, section, keep, growth, parts):
                waiting |= lane
        if waiting == 0:
            break
        free, struck = strike(s, lanes_of(waiting))
        if t.wanted and struck != 0:
            for i in range(LANES):
                if struck >> i & 1:
                    o = e.orbits[i]
                    f = flight_of(e, o)
                    tangent.aim(t, i, f.oscillator[0], f.nodes, o.cell, s.hit[i, OFFSET])
            tangent.fly(t, lanes_of(struck))
            tangent.saltate(t, lanes_of(struck), row(s.steepness, 0))
    for i in range(LANES):
        add_count(e.orbits[i], s.hits[0, i], s.hits[1, i], s.slowest[i], s.miss[i])


@jit
def iterate(e, o, section, keep, growth, parts):
    """Carry one orbit over its `periods` of the discontinuity mapping."""
    f = flight_of(e, o)
    stops, records = stops_of(o), records_of(e, o)
    while o.done < o.periods and o.status == status.OK:
        o.status = map_period(f, stops, o, records, e.tangent[0])
        if o.status == status.OK:
            end_period(e, o, f.oscillator[0], f.nodes, section, keep, growth, parts)


@entry
def map_once(e):
    """One iteration of the discontinuity mapping by the first orbit, and by its tangent vectors if they are wanted."""
    o, t = e.orbits[0], e.tangent[0]
    f = flight_of(e, o)
    q = f.oscillator[0]
    map_period(f, stops_of(o), o, records_of(e, o), t)
    if t.wanted:
        tangent.fly_to(t, 0, q, f.nodes, q.cells, 0.0)
        tangent.apply_flight(t, tangent.only(0))
