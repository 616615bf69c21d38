"""The moving state of an orbit, what is counted of it, and what is recorded of it."""

import functools
import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import exported, inline, jit, noinline
from vibro_sweep.engine.simd.lanes import state_and_rest
from vibro_sweep.engine.simd.memory import put, record, row
from vibro_sweep.engine.tables.flight import ORDER, evaluate, width_of
from vibro_sweep.engine.tables.products import change_within
from vibro_sweep.engine.tables.twofold import add
from vibro_sweep.tables import outcomes as status

FARTHEST = 2.0**127  # where a stop is at most for the search, which is in single precision: an infinite x1 is outside


class Stops(NamedTuple):
    """The walls, infinite where there is none, and the coefficient of restitution of each."""

    left: float
    right: float
    R_left: float
    R_right: float


@inline
def wall_of(stops, side):
    """Position of the stop on this side."""
    return stops.right if side > 0.0 else stops.left


@inline
def restitution_of(stops, side):
    return stops.R_right if side > 0.0 else stops.R_left


@functools.cache
def orbit_of(masses: int, constant: bool = False) -> np.dtype:
    """The record of one orbit: its motion, what is counted of it, and what it has written into its `Records`."""
    width = width_of(masses, constant)
    motion = [
        ("X", float, (width,)),  # x1, v1, x2, v2, at offset `offset` of cell `cell`; at a node then sin and cos
        ("y", float, (width,)),  # X - r at node `origin`, from which the exclusion test looks ahead
        ("start", float, (width,)),  # if `from_base`, and `origin` is no longer `base`: X, sin and cos at node `base`
        ("largest", float, (width,)),  # sizes of the section states that were kept
        # of the oscillator, for the search: in its tables the processor would have to look for them
        ("remainder", float, (2 * masses + 1,)),
        ("cells", np.int64),
        ("crossed", np.int64),  # of these cells those that `strike` crosses: all, or none if the system is stiff
        ("limits", float, 2),  # the stops; FARTHEST where there is none that near
        ("lane", np.int64),  # its place among eight
        ("table", np.int64),  # place of its oscillator's tables
        ("status", np.int64),
        ("periods", np.int64),  # to carry it over
        ("done", np.int64),  # of these
        ("goal", np.int64),  # of these those after which to look whether to go on (ensemble.py)
        ("read", np.int64),  # readings of the growth of tangent vectors
        ("cell", np.int64),
        ("offset", float),
        (
            "from_base",
            np.int64,
        ),  # 1 if states are formed from `base`: r is much larger than the clearance, or the system stiff
        ("ends", np.int64),  # the node at which a period ends; -1 (none) if `from_base`
        ("base", np.int64),  # the node where free flight began
        # `base`, or if `from_base` a later node: the less is left of a fast mode, the tighter the exclusion test
        ("origin", np.int64),
        ("candidate", np.int64),  # the next cell in which contact cannot be excluded, and
        ("low", float),  # what x1 at its beginning is held against
        ("high", float),
        ("stops", float, 4),  # left, right, and the restitution of each
        ("resting", float),  # side of the stop that M1 rests on, or 0
        ("fastest", float),  # largest |v1| before an impact since the start or the last rest
        ("c", float, (masses, ORDER)),  # Taylor coefficients of x1, x2, ...; of M1 at rest the free acceleration
        ("gap", float, (ORDER,)),  # of the gap to a stop, or of the free acceleration at rest (contact.py)
        ("finer", float, (2 * masses,)),  # what rounding left of X, from series to series (`advance_exactly`)
        ("phase", float, 2),  # sin and cos of the force from event to event (force_phase.py), and
        ("phase_low", float, 2),  # what rounding leaves of them
    ]
    counts = [
        ("period", np.int64),
        ("events", np.int64),  # impacts, grazes, and ends of rests in this period
        ("impacts_left", np.int64),
        ("impacts_right", np.int64),
        ("chatters", np.int64),  # sequences summed up
        ("slowest", float),  # least |v1| before an impact
        ("miss", float),  # how far from the stop an impact was found at most
        ("rest_time", float),
        ("pressed_time", float),  # in contact with compliant stops
        ("log_volume", float),  # ln|det| of the jumps of the discontinuity mapping
    ]
    log = [
        ("log_side", float),  # impacts on this side are logged; 0: on both
        ("impacts_logged", np.int64),  # or would have been, had there been room
        ("rests_logged", np.int64),
        ("samples_taken", np.int64),
    ]
    return record([*motion, *counts, *log])


class Records(NamedTuple):
    """What is recorded of an orbit; an observation that is not asked for has m = 0."""

    impacts: np.ndarray  # (m, 3 + 2 N): period, cell, offset, side, v1 before, x2, v2, ...
    rests: np.ndarray  # (m, 4): period, cell, offset, side at the onset of a rest, 0 at its end
    times: np.ndarray  # (m, 2): cell and offset in this period at which the motion is sampled
    samples: np.ndarray  # (m, 2 N)
    sums: np.ndarray | None  # (1,) `sums_of` (energy_sums.py)


def new_records(orbits: int, impacts: int = 0, rests: int = 0, samples: int = 0, masses: int = 2) -> Records:
    """Room for so many entries of each kind, for each of so many orbits; samples for one alone."""
    return Records(
        np.empty((orbits, impacts, 3 + 2 * masses)),
        np.empty((orbits, rests, 4)),
        np.empty((samples, 2)),
        np.empty((samples, 2 * masses)),
        None,
    )


@exported
def set_state(o, nodes, stops, cell, offset, state):
    """Set the state (2 N,) of an orbit at this offset of this cell, with nothing counted yet."""
    for j in range(2 * len(o.c)):
        o.X[j] = state[j]
    o.stops[0], o.stops[1], o.stops[2], o.stops[3] = stops.left, stops.right, stops.R_left, stops.R_right
    o.status, o.resting, o.fastest, o.cell, o.offset = status.OK, 0.0, 0.0, cell, offset
    o.period = o.events = o.impacts_logged = o.rests_logged = o.samples_taken = 0
    begin_free_flight(o, nodes, row(o.X, 0))
    reset_counts(o)
    round_off(o)


@jit
def load_constants(o, q):
    """Copy from the oscillator into the orbit the constants of the exclusion test, and set the limits of x1."""
    for j in range(len(o.remainder)):
        o.remainder[j] = q.remainder[j]
    o.cells, o.crossed = q.cells, 0 if q.stiff else q.cells
    o.ends = -1 if o.from_base else q.cells
    o.limits[0], o.limits[1] = max(o.stops[0], -FARTHEST), min(o.stops[1], FARTHEST)


@inline
def begin_free_flight(o, nodes, X):
    """Begin free flight with X at the node where the orbit is."""
    z = row(nodes[np.uint64(o.cell)].z, 0)
    X = state_and_rest(X, z, o.c)  # z ends in sin and cos
    o.base = o.origin = o.cell
    put(o.X, 0, X)
    put(o.y, 0, X - z)


@inline
def keep_start(o):
    """X where free flight began, before another takes its place."""
    if o.base == o.origin:
        put(o.start, 0, row(o.X, 0))


@jit
def is_finite(o):
    """Whether the velocities are numbers."""
    total = o.X[1]
    for j in range(3, 2 * len(o.c), 2):
        total += o.X[j]
    return math.isfinite(total)


@jit
def reset_counts(o):
    """Count impacts and rest from here on."""
    o.impacts_left = o.impacts_right = o.chatters = 0
    o.slowest, o.miss, o.rest_time, o.pressed_time, o.log_volume = np.inf, 0.0, 0.0, 0.0, 0.0


@jit
def add_count(o, left, right, slowest, miss):
    """Add impacts that were counted elsewhere."""
    o.impacts_left += int(left)
    o.impacts_right += int(right)
    o.slowest, o.miss = min(o.slowest, slowest), max(o.miss, miss)


@jit
def advance(o, u):
    """The state at offset u of the series."""
    X, c = o.X, o.c
    for i in range(len(c)):
        x, v = c[i, ORDER - 1], 0.0
        for n in range(ORDER - 2, -1, -1):
            v = v * u + x
            x = x * u + c[i, n]
        X[2 * i], X[2 * i + 1] = x, v


@jit
def round_off(o):
    """X is the state, and nothing is left of it."""
    for j in range(len(o.finer)):
        o.finer[j] = 0.0


@jit
def add_change(o, i, u):
    """Position and velocity of mass i at offset u of its series, and what rounding leaves of them."""
    X, finer = o.X, o.finer
    x, v = change_within(o.c[i], u)
    X[2 * i], finer[2 * i] = add(X[2 * i], finer[2 * i], x, 0.0)
    X[2 * i + 1], finer[2 * i + 1] = add(X[2 * i + 1], finer[2 * i + 1], v, 0.0)


@jit
def advance_exactly(o, u):
    """`advance` where a cell of a stiff oscillator takes thousands of series: else the roundings of all would add up.

    What is left of X does not fly on by itself: of a slow motion it hardly moves in the time u, of a fast one it is
    gone before there are many.
    """
    for i in range(len(o.c)):
        add_change(o, i, u)


@noinline
def take_samples(o, records, k, start, stop):
    """Take the samples that fall in cell k between the offset `start`, where the series begins, and `stop`."""
    times, samples = records.times, records.samples
    i = o.samples_taken
    while i < len(times) and times[i, 0] == k and times[i, 1] <= stop:
        u = max(times[i, 1] - start, 0.0)
        for j in range(len(o.c)):
            samples[i, 2 * j], samples[i, 2 * j + 1] = evaluate(o.c[j], u)
        if o.resting != 0.0:
            samples[i, 0], samples[i, 1] = o.X[0], 0.0
        i += 1
    o.samples_taken = i
