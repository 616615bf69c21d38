"""A block: for each orbit the tables of its point, its motion, and what the scene observes of it."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.compliant.law import keep_between, relax_from, set_law
from vibro_sweep.engine.motion import strike
from vibro_sweep.engine.motion.ensemble import carry
from vibro_sweep.engine.motion.orbits import Stops, new_records, set_state
from vibro_sweep.engine.motion.together import Ensemble, Readings, flight_of, new_ensemble
from vibro_sweep.engine.observed.observe import PHASES, RECORD, begin_phase, close, end_phase
from vibro_sweep.engine.observed.two_modes import new_fit
from vibro_sweep.engine.point_tables import same_tables, set_graze, to_contact
from vibro_sweep.engine.records import Kind, point_of
from vibro_sweep.engine.simd.jit import exported, inline, jit, noinline
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.tables import build
from vibro_sweep.engine.variational import tangent
from vibro_sweep.engine.variational.multiplier_groups import multipliers_of
from vibro_sweep.tables import outcomes as status

LARGE = 8.0  # clearances that the motion r may measure before flights from a later node are formed without it
WARM_UP = 200  # periods for the tangent vectors to find their directions
ALL, TABLES, MOTION = range(
    3
)  # what `run_points` does: all, the tables alone, or the motion alone of orbits that have tables


class Plan(NamedTuple):
    """The plan of every orbit of a sweep."""

    transient: int
    record: int
    warm_up: int  # periods of the transient with tangent vectors
    settle: int  # periods up to which orbits that are under way go on; 0: none does
    states: bool  # of every recorded section, for the scene or to find the period of the orbit
    lyapunov: bool  # with `states`
    impacts: bool
    contacts: bool
    energy: bool
    attractors: bool  # with `lyapunov`
    section_side: float  # 0: the section is t = 0 mod T; else the stop of an impact section
    periods: int  # of the trajectory
    parts: int  # of the record, at which the growth of tangent vectors is read
    order: int  # of the discontinuity mapping; 0: the flow itself
    step: int = ALL  # else what is done of it


class Workspace(NamedTuple):
    """The arrays that one thread needs besides its points, allocated once for many blocks."""

    ensemble: Ensemble
    built: np.ndarray  # (LANES,) POINT: whose tables these are
    carried: np.ndarray  # (LANES,) POINT: whose oscillators the columns of `strike` and `tangent` hold
    section: np.ndarray  # (orbits, record, 2 N)
    growth: np.ndarray  # (LANES, parts, 2 N)
    state: np.ndarray  # (2 N,), room for numbers of one orbit
    fit: np.ndarray  # of two_modes.py
    lanes: np.ndarray  # (LANES,) the orbits of the block that are computed side by side
    # of multipliers.py, with n = 2 N vectors of as many numbers, or one more of 2 N + 2 numbers with compliant stops:
    axes: np.ndarray  # (LANES, numbers, vectors), and
    ends: np.ndarray  # those of one orbit
    beside: np.ndarray  # (LANES, 3, n)
    logs: np.ndarray  # (n,), and
    low: np.ndarray  # what rounding leaves of them
    product: np.ndarray  # (n, n)
    matrix: np.ndarray  # (n, n)
    multipliers: np.ndarray  # (LANES,) `multipliers_of`
    tables: build.Workspace


def new_workspace(plan: Plan, cells: int, samples: int, kind: Kind, orbits: int = LANES) -> Workspace:
    """Room for points with at most so many cells, and for the records of so many orbits side by side."""
    impacts, states = plan.record if plan.section_side else 0, 2 * kind.masses
    vectors, numbers = (states + 1, states + 2) if kind.compliant else (states, states)
    ensemble = new_ensemble(cells, kind)
    return Workspace(
        ensemble._replace(records=new_records(orbits, impacts=impacts, samples=samples, masses=kind.masses)),
        np.zeros(LANES, point_of(kind)),
        np.zeros(LANES, point_of(kind)),
        np.empty((orbits, plan.record if plan.states else 0, states)),
        np.empty((LANES, plan.parts, states)),
        np.empty(states),
        new_fit(),
        np.zeros(LANES, np.int64),
        np.empty((LANES, numbers, vectors)),
        np.empty((numbers, vectors)),
        np.empty((LANES, 3, vectors)),
        np.empty(vectors),
        np.zeros(vectors),
        np.empty((vectors, vectors)),
        np.empty((vectors, vectors)),
        np.zeros(LANES, multipliers_of(vectors)),
        build.new_workspace(kind.masses, kind.constant),
    )


@jit
def clearance(stops):
    """Half the way between the stops; of one stop how far it is from 0."""
    if stops.left > -np.inf and stops.right < np.inf:
        return 0.5 * (stops.right - stops.left)
    return abs(stops.right if stops.right < np.inf else stops.left)


@inline
def give_law(law, i, point, q):
    """Give orbit i of the oscillator q its compliant stops."""
    if law is not None:
        set_law(law, i, point, q)


@jit
def prepare(point, i, w, plan):
    """Orbit i gets the tables of its point, those of the orbit before it if they are the same; and its stops."""
    e, o, table = w.ensemble, w.ensemble.orbits[i], i
    if i > 0 and same_tables(point, w.built[e.orbits[i - 1].table]):
        table = e.orbits[i - 1].table
    o.table = table
    f = flight_of(e, o)
    q = f.oscillator[0]
    if not same_tables(point, w.built[table]):
        build.build(f, w.tables, point)
        w.built[table] = point
    set_graze(q, point)
    stops = Stops(point.stops[0], point.stops[1], point.stops[2], point.stops[3])
    o.from_base = q.stiff or q.largest > LARGE * clearance(stops)
    strike.set_stops(e.strike[0], i, stops)
    give_law(e.law, i, point, q)
    if not same_tables(point, w.carried[i]):
        strike.set_oscillator(e.strike[0], i, q)
        if plan.lyapunov:
            tangent.set_frame(e.tangent[0], i, q)
        w.carried[i] = point
    return stops


@jit
def set_orbits(points, starts, results, n, lanes, w, plan):
    """Give orbits the tables of their points of step n, and put them where they start, or go on; lanes: which they are,
    at most eight."""
    e, state = w.ensemble, w.state
    for i in range(LANES):
        o = e.orbits[i]
        o.status = status.NOT_COMPUTED
        if i >= len(lanes):
            continue
        k = lanes[i]
        point, result = points[n, k], results[n, k]
        if point.cells == 0:
            result.status = status.TOO_STIFF
            continue
        stops = prepare(point, i, w, plan)
        start, before = starts[min(n, 1), k], n if result.more > 0 else n - 1
        goes_on = before >= 0 and results[before, k].status in status.VALID
        result.more = result.more if result.more > 0 else plan.transient
        for j in range(len(state)):
            state[j] = results[before, k].end[j] if goes_on else start[j]
        phase = points[before, k].tau if goes_on else start[len(state) + 2]
        cell, offset = place_of(phase, point.tau, e.flights.oscillator[o.table, 0]) if plan.order == 0 else (0, 0.0)
        if goes_on:
            relax_from(e.law, i, results[before, k].relaxed, cell, offset)
        else:
            relax_from(e.law, i, start[len(state) : len(state) + 2], cell, offset)
        to_contact(point, state, stops, w.tables.row)
        if plan.order == 0:  # points of the map may lie beyond the stops
            keep_between(e.law, i, state, stops)
        set_state(o, e.flights.nodes[o.table], stops, cell, offset, state)


@jit
def place_of(phase, tau, q):
    """Cell and offset in the period at which the phase of the force is this one, and not tau, as at t = 0, where it is
    NaN."""
    turn = phase - tau
    if not 0.0 <= turn < 2.0 * math.pi:
        turn -= 2.0 * math.pi * np.floor(turn / (2.0 * math.pi))
    time = turn / q.omega
    cell = int(time / q.width) if time > 0.0 else 0
    return (cell, time - cell * q.width) if 0 < time and cell < q.cells else (0, 0.0)


@exported
def run_points(points, starts, results, sections, phases, running, w, plan, mapping):
    """Compute a block. n = steps, m = orbits; observations that are not asked for have no samples.

    points: (n, m) of `point_of`. starts: (2, m, 2 N + 3), at the first step, and at a step after one that failed:
    states, the places of stops that relax, and the phase of the force, NaN at t = 0; at the others an orbit goes on
    from where it ended, at the phase that the force had there, with the next point's numbers. results: (n, m) of
    `result_of`. sections: (n, m, record, 2 N). phases: (n, m, record), for an impact section. running: (n, m, parts,
    2 N), the exponents as they converge. mapping: as of `carry`.

    Orbits that are under way to where they go are put together anew, eight at a time, and go on (`plan.settle`).

    For single orbits it does one step of this at a time (`plan.step`, one block): so nothing else need be compiled.
    """
    together = points.shape[1] if plan.settle > 0 and len(points) == 1 else LANES  # chains do not wait for each other
    for first in range(0, points.shape[1], together):
        last = min(first + together, points.shape[1])
        for n in range(len(points)):
            again, left = False, last - first
            while left > 0:
                left, k = 0, first
                while k < last:
                    k, count = next_lanes(results[n], k, last, again, w.lanes)
                    lanes = w.lanes[:count]
                    run_lanes(points, starts, results, sections, phases, running, w, plan, mapping, n, lanes)
                    if w.ensemble.halt[0] != 0 or plan.step == MOTION:
                        return
                    for i in lanes:
                        left += results[n, i].more > 0
                again = True


@jit
def next_lanes(results, k, last, again, lanes):
    """The next orbits from k on, at most eight; again: of those that are under way. Returns where the search ended, and
    how many they are."""
    count = 0
    while k < last and count < LANES:
        if not again or results[k].more > 0:
            lanes[count] = k
            count += 1
        k += 1
    return k, count


@noinline
def run_lanes(points, starts, results, sections, phases, running, w, plan, mapping, n, lanes):
    """Compute orbits of step n, side by side; lanes: which they are, at most eight. The others as of `run_points`."""
    e = w.ensemble
    if plan.step != MOTION:
        set_orbits(points, starts, results, n, lanes, w, plan)
    if plan.step == TABLES:
        return
    for phase in range(PHASES):
        parts = 0 if plan.step == MOTION else begin_phase(e, w, plan, phase, points[n], results[n], lanes)
        if parts >= 0:
            keep = plan.states and (phase == RECORD or plan.step == MOTION)
            carry(e, mapping, Readings(w.section, keep, w.growth, parts))
            if plan.step == MOTION:
                return
            end_phase(e, w, plan, phase, points[n], results[n], sections[n], phases[n], running[n], lanes)
    close(e, w, plan, points[n], results[n], lanes)
