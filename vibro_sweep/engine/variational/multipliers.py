"""Floquet multipliers of periodic orbits: eigenvalues of the monodromy matrix, from its factors.

Over one period tangent vectors Q_0 (orthonormal) become Z = Q_1 D U, with D the growths (diagonal, falling as far as
the vectors have found their directions) and U upper triangular with ones on its diagonal: products of well-conditioned
factors, in which nothing large hides anything small. The monodromy matrix has the eigenvalues of

    Q_0^T Q_1 D U,    and so of    D^1/2 (U Q_0^T Q_1) D^1/2,

a graded matrix (multiplier_groups.py).

Their error has three parts: rounding, also that of an impact at a low speed v, on which rounding of the state acts like
1/v^2, times the condition of each; what the second of two periods changes, times r/(1 - r) with r the largest modulus,
since the orbit itself still comes nearer to the periodic one by r a period; and what rounding of the orbit does to
them. That is seen in a third period, which begins beside the orbit in the direction that grows most: the first row of
U Q_0^T.
"""

import math

from vibro_sweep.engine.compliant.law import (
    begin_beside,
    contacts_of,
    count_contacts_anew,
    end_beside,
    is_at_rest,
    keep_between,
)
from vibro_sweep.engine.compliant.section_vectors import begin_with_places, count_vectors, end_with_places
from vibro_sweep.engine.motion.orbits import reset_counts, set_state
from vibro_sweep.engine.motion.together import flight_of, stops_of
from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.variational import tangent
from vibro_sweep.engine.variational.growth import excess
from vibro_sweep.engine.variational.multiplier_groups import AGAIN, BESIDE, find_multipliers
from vibro_sweep.engine.variational.orthonormal import columns_of, orthonormalise_closely, place_of
from vibro_sweep.tables import outcomes as status

ASIDE = 1e4  # units of rounding of the state by which the third begins beside the orbit, and
OFF = 16.0  # by how many of them rounding at one impact moves the orbit; that at others has nothing to do with it


@jit
def begin_period(e, w, results, lanes, which):
    """Set periodic orbits out for exactly one more period of each; beside the orbit those that touch a stop and do not
    rest: motion that touches none has the same multipliers there."""
    t = e.tangent[0]
    t.collected = True
    for i in range(len(lanes)):
        o, result = e.orbits[i], results[lanes[i]]
        goes = o.status == status.OK and result.period > 0
        if which == BESIDE:
            touches = o.impacts_left + o.impacts_right > 0 or o.pressed_time > 0.0
            goes = goes and touches and not is_at_rest(e.law, o)
        o.periods = result.period if goes else 0
        if goes:
            orthonormalise_closely(t, i)
            tangent.sort_vectors(t, i)
            for n in range(len(t.shear)):
                t.shear[n, i] = 0.0
            tangent.start_record(t, i)
            begin_with_places(e.law, t, i, o, flight_of(e, o).oscillator[0].width, w.axes[i], w.matrix)
            if which == BESIDE:
                found = w.multipliers[i]
                found.impacts_left, found.impacts_right = o.impacts_left, o.impacts_right
                found.rest_time, found.pressed_time = o.rest_time, o.pressed_time
                step_aside(e, o, w.beside[i, 0], w.state)
            reset_counts(o)
            count_contacts_anew(e.law, i)


@jit
def step_aside(e, o, direction, state):
    """Move the orbit by `ASIDE` units of its rounding in this direction of the frame of tangent vectors."""
    t, f, stops = e.tangent[0], flight_of(e, o), stops_of(o)
    size, omega, largest, longest = len(t.growth), f.oscillator[0].omega, 0.0, 0.0
    for m in range(size):
        unit = omega if m % 2 == 1 else 1.0
        state[m] = 0.0
        for j in range(size):
            state[m] += t.from_frame[size * m + j, o.lane] * direction[j]
        largest, longest = max(largest, abs(o.X[m]) / unit), max(longest, abs(state[m]) / unit)
    step = 2.0**-52 * ASIDE * largest / longest if longest > 0.0 else 0.0
    if not stops.left <= o.X[0] + step * state[0] <= stops.right:
        step = -step
    for m in range(size):
        state[m] = o.X[m] + step * state[m]
    keep_between(e.law, o.lane, state, stops)
    begin_beside(e.law, o, f.oscillator[0].width)
    set_state(o, f.nodes, stops, 0, 0.0, state)


@noinline
def read_period(e, w, results, lanes, which):
    """The multipliers over the first of three periods; with their errors over the next; and what the last adds."""
    t = e.tangent[0]
    for i in range(len(lanes)):
        o = e.orbits[i]
        if which == BESIDE and o.periods > 0:
            end_beside(e.law, i)
            found = w.multipliers[i]  # the other orbit may have failed, or touch the stops otherwise
            o.impacts_left, o.impacts_right = found.impacts_left, found.impacts_right
            o.rest_time, o.pressed_time = found.rest_time, found.pressed_time
            if o.status != status.OK:
                o.status, o.periods = status.OK, 0  # the orbit itself has not failed
        if o.periods > 0 and o.status == status.OK:
            omega, largest = e.flights.oscillator[o.table, 0].omega, o.largest[0]
            for j in range(2, len(t.growth), 2):
                largest = max(largest, o.largest[j])
            graze = 2.0**-52 * (omega * largest / o.slowest) ** 2
            instants = 1.0 + o.impacts_left + o.impacts_right + 2.0 * contacts_of(e.law, i)  # a touch and a release
            off = OFF / ASIDE * math.sqrt(instants)
            known = end_with_places(e.law, t, i, w.ends, w.matrix, w.logs, w.low)
            found = w.multipliers[i]
            if which == BESIDE:
                count = min(known, found.count)
            else:
                count = count_vectors(e.law, t, w.axes[i], w.ends, known)
            set_product(t, i, w.axes[i], w.ends, count, w.product)
            solved = find_multipliers(
                e.law, w.product, w.logs[:count], w.low, w.matrix, graze, off, found, w.beside[i], which
            )
            if not (solved or which == BESIDE):
                o.status = status.NOT_FINITE
            if which != BESIDE:
                found.count = count
                keep_sum(e.law, t, i, found, known, w.logs)
            if which == AGAIN:
                find_direction(t, i, w.axes[i], w.beside[i, 0])
    t.collected = False


@inline
def keep_sum(law, t, i, found, known, logs):
    """Keep how much the multipliers, and one more of those `known`, differ from what contacts do to volumes."""
    if law is not None:
        last, found.beyond = known - 1, 0.0
        if known > len(t.growth):
            found.beyond = (found.log[last] if found.count == known else logs[last]) - t.alone_by_itself[i]
        found.excess = excess(t, i, found.log, found.low + found.beyond)


@jit
def find_direction(t, i, axes, direction):
    """The first row of U Q_0^T."""
    columns = columns_of(t)
    for m in range(len(t.growth)):
        direction[m] = axes[m, 0]
        for k in range(1, columns):
            direction[m] += t.shear[place_of(columns, 0, k), i] * axes[m, k]


@jit
def set_product(t, i, begins, ends, count, product):
    """U Q_0^T Q_1 of so many vectors, the columns of Q_0 and Q_1."""
    columns = columns_of(t)
    for row in range(count):
        for column in range(count):
            total = 0.0
            for k in range(row, count):
                weight = 1.0 if k == row else t.shear[place_of(columns, row, k), i]
                for m in range(len(ends)):
                    total += weight * begins[m, k] * ends[m, column]
            product[row, column] = total
