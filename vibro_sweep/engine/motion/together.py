"""The motion of eight orbits, with the tables of their oscillators, and what is read of them."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.compliant.law import Law, new_law
from vibro_sweep.engine.halting import halt_of_thread
from vibro_sweep.engine.motion.orbits import Records, Stops, new_records, orbit_of
from vibro_sweep.engine.motion.strike import strikes_of
from vibro_sweep.engine.records import Kind
from vibro_sweep.engine.simd.jit import inline
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import new_lines
from vibro_sweep.engine.tables.flight import Flight, new_flight
from vibro_sweep.engine.variational.tangent import tangents_of


class Ensemble(NamedTuple):
    """The motion of eight orbits."""

    flights: Flight  # with a first axis: the tables of each oscillator
    orbits: np.ndarray  # (LANES,) `orbit_of`
    strike: np.ndarray  # (1,) `strikes_of`
    tangent: np.ndarray  # (1,) `tangents_of`
    records: Records  # with a first axis: one for each orbit
    halt: np.ndarray  # (1,): not 0 where their results are not awaited any more (engine/halting.py)
    law: Law | None  # of compliant stops


class Readings(NamedTuple):
    """The readings of eight orbits at the ends of their periods, and where they are kept."""

    states: np.ndarray  # (LANES, periods, 2 N): the states there
    keep: bool  # whether they are kept
    growth: np.ndarray  # (LANES, parts, 2 N): logarithms of the growth of the tangent vectors since the first one
    parts: int  # of the periods, after each of which the growth is read; 0: never


def new_ensemble(cells: int, kind: Kind, impacts: int = 0, rests: int = 0, samples: int = 0) -> Ensemble:
    """Orbits of oscillators with at most so many cells, and room for what is kept of each."""
    masses, constant, compliant = kind
    halt = halt_of_thread()
    orbits = new_lines(LANES, orbit_of(masses, constant))
    orbits["lane"] = np.arange(LANES)
    return Ensemble(
        new_flight(LANES, cells, masses, constant),
        orbits,
        new_lines(1, strikes_of(masses, constant)),
        new_lines(1, tangents_of(masses, compliant)),
        new_records(LANES, impacts, rests, samples, masses),
        halt,
        new_law(kind, halt),
    )


@inline
def flight_of(e, o):
    """The tables of an orbit's oscillator."""
    n = np.uint64(o.table)  # unsigned: else numba looks for negative indices
    return Flight(e.flights.oscillator[n], e.flights.nodes[n], e.flights.scan[n])


@inline
def stops_of(o):
    """The stops of an orbit."""
    return Stops(o.stops[0], o.stops[1], o.stops[2], o.stops[3])


@inline
def records_of(e, o):
    """The records of an orbit."""
    n = o.lane
    return Records(e.records.impacts[n], e.records.rests[n], e.records.times, e.records.samples, e.records.sums)
